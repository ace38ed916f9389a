"""Promises, versions and deprecations on pages, in cards, lists and the search."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.pipeline import check_project
from archgen.views.elements.element_card import make_card
from archgen.views.elements.functional_level import make_composed_blocks, make_type_blocks
from archgen.views.elements.port_tables import describe_promise, make_port_blocks
from archgen.views.lookup import Lookup, make_lookup
from archgen.views.pages.context_pages import make_context_pages, make_topic_pages
from archgen.views.search import make_search_entries
from archgen.views.shapes import Facts, Table
from archgen.views.tables.element_rows import list_element_rows
from archgen.views.tables.functional_tables import make_type_table
from tests.agreeing import text

ROBOT = """\
component_types:
  m1: {version: 1, deprecated: {until: 2999-01-01, use: m2}}
  m2: {outputs: {o: T}}
groups:
  g:
    components:
      a:
        outputs:
          rows: {type: T, promise: {rate: 10 Hz, max_gap: 150 ms, max_age: 200 ms, unit: m, frame: base, range: [0, 30]}, version: 2, deprecated: {until: 2999-06-01, use: new}}
          new: {type: T, promise: {unit: cm}}
          far: {type: T, deprecated: {use: g.b.x}}
          none: {deprecated: {}, external: the world}
      b: {inputs: {i: {from: a.rows, freshness: 1 s}, j: a.new}, outputs: {x: T}}
      w: {outputs: {o: {from: in.o, version: 3, deprecated: {}}}, components: {in: {is: m2}}}
      c: {inputs: {k: w.o}}
types: {T: {message: std_msgs/msg/Bool, version: 5, deprecated: {use: U}}, U: std_msgs/msg/Bool}
"""


@pytest.fixture
def lookup(tmp_path: Path) -> Lookup:
    (tmp_path / "robot.yaml").write_text(ROBOT, encoding="utf-8")
    checked = check_project(tmp_path / "robot.yaml")
    return make_lookup(checked.architecture, checked.findings)


def _rows(lookup: Lookup, component: str, kind: str, row: int) -> list[str]:
    blocks = make_port_blocks(lookup, lookup.architecture.components[component])
    table = next(block for block in blocks if isinstance(block, Table) and block.kind == kind)
    return [text(cell) for cell in table.rows[row]]


def test_outputs_have_badges_and_say_what_they_promise(lookup: Lookup) -> None:
    outputs = (lookup, "g.a", "table:outputs")
    first, last = _rows(*outputs, 0), _rows(*outputs, 1)
    assert first[0] == "rows version 2 deprecated"
    assert first[-1] == (
        "promised: 10 Hz, gaps up to 150 ms, no older than 200 ms, 0 to 30 m, in the frame base; "
        "deprecated until 2999-06-01: use new"
    )
    assert (last[0], last[-1]) == ("new", "promised: in cm")
    assert _rows(*outputs, 2)[-1] == "deprecated: use B · x"
    assert _rows(*outputs, 3)[-1] == "deprecated"


def test_readers_are_marked_where_they_name_what_is_going_away(lookup: Lookup) -> None:
    inputs = (lookup, "g.b", "table:inputs")
    assert _rows(*inputs, 0)[1] == "A · rows deprecated"
    assert _rows(*inputs, 0)[-1] == "no older than 1 s"
    assert _rows(*inputs, 1)[1] == "A · new"
    assert _rows(lookup, "g.c", "table:inputs", 0)[1].endswith(" deprecated")


def test_composed_components_types_and_component_types(lookup: Lookup) -> None:
    architecture = lookup.architecture
    tables = [b for b in make_composed_blocks(lookup, architecture.shells["g.w"]) if isinstance(b, Table)]
    assert text(next(t for t in tables if t.anchor == "table:outputs/g.w").rows[0][0]) == "o version 3 deprecated"
    facts = next(b for b in make_type_blocks(lookup, architecture.component_types["m1"]) if isinstance(b, Facts))
    said = {name: text(value) for name, value in facts.rows}
    assert (said["Version"], said["Deprecated"]) == ("1", "deprecated until 2999-01-01: use M2")
    table = make_type_table(lookup)
    assert table
    assert [text(cell) for cell in table.rows[0]][-1].startswith("version 5; deprecated (no day named, use U instead)")


def test_cards_lists_and_the_search(lookup: Lookup) -> None:
    card = make_card(lookup, "output", "g.a.rows")
    assert dict(card.facts)["deprecated"] == "until 2999-06-01, use new instead"
    assert dict(make_card(lookup, "type", "T").facts)["version"] == "5"
    assert dict(make_card(lookup, "component type", "m1").facts)["deprecated"] == "until 2999-01-01, use m2 instead"
    columns, rows = list_element_rows(lookup, "connections")
    row = dict(zip(columns, rows[0], strict=True))
    assert (row["version"], row["deprecated"]) == ("2", "until 2999-06-01, use new instead")
    assert row["promise"].startswith("10 Hz, gaps up to 150 ms")
    lines = {entry.title: entry.line for entry in make_search_entries(lookup, ())}
    assert "version 2 · deprecated (until 2999-06-01, use new instead)" in lines["A · rows"]


def test_nothing_is_described_where_nothing_is_promised() -> None:
    assert describe_promise(None) == ""


def test_pages_of_topics_and_types_say_it(tmp_path: Path) -> None:
    (tmp_path / "robot.yaml").write_text(f"{ROBOT}nodes: {{a: a}}\n", encoding="utf-8")
    checked = check_project(tmp_path / "robot.yaml")
    lookup = make_lookup(checked.architecture, checked.findings)
    pages = {page.section.anchor: page for page in (*make_topic_pages(lookup), *make_context_pages(lookup, tuple))}
    topic, kind = (
        {name: text(value) for name, value in next(b for b in pages[name].section.blocks if isinstance(b, Facts)).rows}
        for name in ("topic:/g/a/rows", "type:T")
    )
    assert topic["Promised"].startswith("10 Hz, gaps up to 150 ms")
    assert (topic["Version"], topic["Deprecated"]) == ("2", "deprecated until 2999-06-01: use new")
    assert kind["Deprecated"] == "deprecated: use U"
