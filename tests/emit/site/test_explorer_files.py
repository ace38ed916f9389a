"""The scripts with the explorer's data: plain calls, small files, addresses instead of anchors."""

from __future__ import annotations

import json
import re

import pytest

from archgen.emit.site import html_text
from archgen.emit.site.page_links import SiteLinks
from archgen.emit.site.script_files import build_explorer_files, find_explorer_address, list_explorer_scripts
from archgen.views.explorer.map_shapes import ExplorerMap
from archgen.views.shapes import Page, Section

LINKS = SiteLinks(
    {"page:explorer": "explorer.html", "group:a": "groups/a.html"}, {"component:a.b": "groups/a.html#b"}, {}, {}
)


def page(anchor: str) -> Page:
    return Page("x.html", anchor, "X", "x", Section(anchor, "X"))


def read_calls(text: str) -> list[tuple[str, list[list[object]]]]:
    return [
        (json.loads(name), json.loads(rows))
        for name, rows in re.findall(r'^archgenExplorer\.addRows\(("\w+"),(.*)\);$', text, re.MULTILINE)
    ]


def test_rows_stand_with_the_addresses_of_their_pages() -> None:
    tables = {
        "groups": (("group:a", "a", "A", (1, -0.5)), ("group:none", "none", "", ())),
        "components": (("component:a.b", "a.b"),),
        "keys": (("tag", "group:a"),),
    }
    ((path, data),) = build_explorer_files(ExplorerMap(tables), LINKS).items()
    assert path == "assets/explorer/data-1.js"
    assert read_calls(data.decode()) == [
        ("groups", [["groups/a.html", "a", "A", [1, -0.5]], ["", "none", "", []]]),
        ("components", [["groups/a.html#b", "a.b"]]),
        ("keys", [["tag", "group:a"]]),
        ("icons", [list(icon) for icon in html_text.list_icons()]),
    ]


def test_hostile_text_stays_text() -> None:
    text = "</script><script>alert(1)</script>\u2028\ud800\"');"
    files = build_explorer_files(ExplorerMap({"keys": (("tag", text),)}), LINKS)
    (_, rows), _ = read_calls(files["assets/explorer/data-1.js"].decode())
    assert rows == [["tag", text.replace("\ud800", "\ufffd")]]


def test_a_large_map_comes_in_files_of_which_none_holds_up_the_page() -> None:
    rows = tuple((f"component:{number}", f"g.c{number}", "x" * 60) for number in range(9000))
    files = build_explorer_files(ExplorerMap({"components": rows, "keys": (("tag", "a"),)}), LINKS)
    assert len(files) > 2
    assert max(map(len, files.values())) < 400_000
    names = [row[1] for data in files.values() for table, made in read_calls(data.decode()) if table == "components" for row in made]  # fmt: skip
    assert names == [row[1] for row in rows]
    begin_script, scripts = list_explorer_scripts(tuple(files))
    assert begin_script not in scripts
    assert scripts[: len(files)] == tuple(files)
    assert scripts[-1] == "assets/explorer/main.js"


@pytest.mark.parametrize(
    ("anchor", "address"),
    [
        ("component:a.b", "explorer.html#level=components&pick=a.b"),
        ("group:a", "explorer.html#level=components&pick=a"),
        ("node:n n", "explorer.html#level=nodes&pick=n%20n"),
        ("host:h", "explorer.html#level=hosts&pick=h"),
        ("component_type:motor", "explorer.html#level=components&sel=is%3Amotor"),
        ("topic:/t", None),
        ("page:index", None),
    ],
)
def test_pages_of_what_has_a_box_lead_to_it(anchor: str, address: str | None) -> None:
    assert find_explorer_address(page(anchor), LINKS) == address
    assert find_explorer_address(page(anchor), SiteLinks({}, {}, {}, {})) is None
