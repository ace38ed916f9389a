"""Write what the explorer's page reads: classic scripts with the tables of the map, so that it works from the disk too."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence

from archgen.emit.site import status_marks
from archgen.emit.site.html_text import replace_forbidden
from archgen.emit.site.page_links import SiteLinks
from archgen.views.explorer.map_shapes import LINKED_TABLES, ExplorerMap, Row
from archgen.views.shapes import Page, split_anchor

EXPLORER_ANCHOR = "page:explorer"
"""The anchor of the explorer's page."""
EXPLORER_STYLE = "assets/explorer/explorer.css"
_BEGIN_SCRIPT = "assets/explorer/data.js"
"""Runs before anything is drawn, so that the static page does not show first."""
_PAGE_SCRIPTS = (
    "grammar",
    "properties",
    "closest",
    "select",
    "colours",
    "state",
    "choice",
    "visible",
    "words",
    "layout",
    "routes",
    "drawing",
    "light",
    "camera",
    "minimap",
    "panel",
    "tools",
    "legend",
    "list",
    "save",
    "keys",
    "main",
)
"""The page's own scripts, in the order in which they build on one another."""
_MAX_PART_LETTERS = 200_000
"""The letters of one script: larger ones would hold up the page while they are read."""
_ELEMENT_KINDS = frozenset({"component", "component_type", "group", "node", "host"})
"""Kinds of pages whose element is on the map."""


def build_explorer_files(explorer_map: ExplorerMap, links: SiteLinks) -> dict[str, bytes]:
    """Return the scripts with the tables, by path, in the order in which the page reads them."""
    files: dict[str, bytes] = {}
    calls: list[str] = []
    size = 0
    for call in _write_calls(explorer_map, links):
        if calls and size + len(call) > _MAX_PART_LETTERS:
            files[_part_path(len(files))] = "".join(calls).encode()
            calls, size = [], 0
        calls.append(call)
        size += len(call)
    files[_part_path(len(files))] = "".join(calls).encode()
    return files


def list_explorer_scripts(map_parts: Sequence[str]) -> tuple[str, tuple[str, ...]]:
    """Return the path of the script that begins, and of those that run when the page is read."""
    return _BEGIN_SCRIPT, (*map_parts, *(f"assets/explorer/{name}.js" for name in _PAGE_SCRIPTS))


def find_explorer_address(page: Page, links: SiteLinks) -> str | None:
    """Return the address that shows a page's element on the map, relative to the site's folder; None if it has none.

    Of a component type all instances are lit.
    """
    kind, element_id = split_anchor(page.anchor)
    if EXPLORER_ANCHOR not in links.pages or kind not in _ELEMENT_KINDS:
        return None
    level = {"node": "nodes", "host": "hosts"}.get(kind, "components")
    # Ids have no letter that an address would have to write in another way, but for those of strangers' files.
    from urllib.parse import quote

    choice = ("sel", f"is:{element_id}") if kind == "component_type" else ("pick", element_id)
    return f"{links.pages[EXPLORER_ANCHOR]}#level={level}&{choice[0]}={quote(choice[1], safe='')}"


def _part_path(number: int) -> str:
    return f"assets/explorer/data-{number + 1}.js"


def _write_calls(explorer_map: ExplorerMap, links: SiteLinks) -> Iterator[str]:
    """Yield a call for each table, several for a long one; and one with the icons of states, which pages have as well."""
    for name, rows in {**explorer_map.tables, "icons": status_marks.list_icons()}.items():
        texts = [_write_row(row, name, links) for row in rows]
        while texts:
            size, count = 0, 0
            while count < len(texts) and (not count or size + len(texts[count]) < _MAX_PART_LETTERS - 100):
                size += len(texts[count]) + 1
                count += 1
            yield f"archgenExplorer.addRows({json.dumps(name)},[{','.join(texts[:count])}]);\n"
            texts = texts[count:]


def _write_row(row: Row, table: str, links: SiteLinks) -> str:
    if table in LINKED_TABLES:
        anchor, *values = row
        row = (links.pages.get(str(anchor)) or links.places.get(str(anchor)) or "", *values)
    return replace_forbidden(json.dumps(row, ensure_ascii=False, separators=(",", ":")))
