"""The start-up as report and site show it: tables by phase, a picture without what follows by itself, and a node's own words."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import pytest

from archgen import pipeline
from archgen.model.architecture import Architecture
from archgen.products import project_views
from archgen.products.output_options import OutputOptions
from archgen.views.elements.element_card import make_card
from archgen.views.graphs.start_graph import draw_start
from archgen.views.lookup import DocumentScope, Lookup, make_lookup
from archgen.views.pages import report_outline, site_pages
from archgen.views.shapes import Bullets, Inlines, Paragraph, Table
from archgen.views.start_phrases import describe_start
from archgen.views.tables.element_rows import list_element_rows
from archgen.views.tables.start_table import make_start_blocks
from tests.running import ROOT

Derived = Callable[[str], Architecture]


def plain(inlines: Inlines) -> str:
    return "".join(("\n" if part.line_break else "") + part.text for part in inlines)


@pytest.fixture(scope="module")
def lookup() -> Lookup:
    return make_lookup(pipeline.check_project(ROOT / "examples" / "bringup").architecture)


def test_a_table_for_each_phase_and_what_was_given_up(lookup: Lookup) -> None:
    lead, *tables, dropped_lead, dropped = make_start_blocks(lookup)
    assert isinstance(lead, Paragraph)
    assert [table.anchor for table in tables if isinstance(table, Table)] == [
        "table:start/network",
        "table:start/simulators",
        "table:start/core",
        "table:start/components",
    ]
    network, core = tables[0], tables[2]
    assert isinstance(network, Table)
    assert isinstance(core, Table)
    assert [plain(cell) for cell in network.rows[0]] == [
        "1",
        "set_clock\nprogram on Computer of the robot",
        "chronyd -q 'server ntp.office.example iburst'\nas the user root\nneeds rights to run as the user root",
        "nothing",
        "it has ended, within 30 s",
    ]
    assert [plain(cell) for cell in core.rows[2]][3:] == ["map_server (its start; manages it)", "at once"]
    assert isinstance(dropped_lead, Paragraph)
    assert isinstance(dropped, Bullets)
    assert len(dropped.items) == 4


def test_the_picture_has_what_does_not_follow_by_itself(lookup: Lookup) -> None:
    graph = draw_start(lookup)
    arrows = {(arrow.tail.removeprefix("step "), arrow.head.removeprefix("step ")) for arrow in graph.arrows}
    assert arrows == {
        ("phase network", "set_clock"),
        ("set_clock", "phase simulators"),
        ("phase simulators", "stage"),
        ("stage", "phase core"),
        ("phase core", "parcel_registry"),
        ("phase core", "map_server"),
        ("map_server", "lifecycle_manager"),
        ("parcel_registry", "phase components"),
        ("lifecycle_manager", "phase components"),
        ("phase components", "amcl"),
        ("phase components", "navigation"),
        ("navigation", "planner_server"),
        ("amcl", "planner_server"),
        ("planner_server", "controller_server"),
        ("controller_server", "navigation_manager"),
        ("navigation_manager", "dispatcher"),
        ("navigation_manager", "display"),
    }
    boxes = {box.title: box for box in graph.boxes}
    assert boxes["stage"].lines == ("program on sim_pc",)
    assert boxes["navigation"].ref == "container:navigation"
    assert graph.alt == "12 steps in 4 phases: network, simulators, core, components."


def test_nothing_is_shown_where_the_project_says_nothing(derived: Derived) -> None:
    plain_lookup = make_lookup(derived("groups: {g: {components: {a: A}}}\nnodes: {a: a}"))
    assert make_start_blocks(plain_lookup) == []
    assert draw_start(plain_lookup).boxes == ()


def test_what_is_too_much_for_a_picture_is_counted(derived: Derived) -> None:
    nodes = ", ".join(f"p{at}: {{kind: program, command: [p], start: {{phase: core}}}}" for at in range(75))
    graph = draw_start(make_lookup(derived(f"nodes: {{{nodes}}}")))
    assert len(graph.boxes) == 71
    assert graph.notes == ("5 later steps not drawn: the tables have all of them.",)


def test_of_many_waits_those_that_are_needed_most_are_named_and_the_rest_is_counted(derived: Derived) -> None:
    names = [f"p{at}" for at in range(11)]
    nodes = ", ".join(f"{name}: {{kind: program, command: [p], start: {{phase: core}}}}" for name in names)
    last = f"last: {{kind: program, command: [p], start: {{phase: core, after: [{', '.join(names)}]}}}}"
    table = make_start_blocks(make_lookup(derived(f"nodes: {{{nodes}, {last}}}")))[1]
    assert isinstance(table, Table)
    waits = plain(table.rows[-1][3])
    assert [name for name in names if f"{name} (as written)" in waits] == names[:8]
    assert waits.endswith("and for 3 others that are needed no more than these: archgen start names them")


def test_contradictions_stand_below_the_tables(derived: Derived) -> None:
    *_, lead, lines = make_start_blocks(
        make_lookup(derived("nodes: {a: {kind: program, start: b}, b: {kind: program, start: a}}"))
    )
    assert isinstance(lead, Paragraph)
    assert isinstance(lines, Bullets)
    assert [plain(line) for line in lines.items] == ["a cannot start after b after a"]


def test_what_a_node_says_in_a_line(derived: Derived) -> None:
    nodes = derived("""
groups: {g: {components: {a: A, b: B}}}
nodes:
  a: {implements: a, kind: lifecycle, start: {phase: core, after: b, by: m, respawn: true, user: u, directory: /d, environment: {A: b}}}
  b: {implements: b, start: {once: true, ready: {within: 2 s}}}
  c: {implements: b, start: {ready: {topic: /t, service: /s, file: /f, wait: 1 s, within: 2 s}, respawn: true, respawn_delay: 1 s}}
  m: {kind: program, command: [m]}
""").nodes
    assert {name: describe_start(node) for name, node in nodes.items()} == {
        "a": "in the phase core; after g.b; brought into the state active by m; in /d; as the user u; with A=b; started again at once",
        "b": "once, to its end within 2 s",
        "c": "up when the file /f is there, a message has come on /t, /s is offered and 1 s have passed within 2 s; started again after 1 s",
        "m": "",
    }


def test_cards_and_lists_have_it(lookup: Lookup) -> None:
    facts = dict(make_card(lookup, "node", "parcel_registry").facts)
    assert facts["command"] == "parcel-registry --listen 8080 --store /var/lib/parcels"
    assert facts["start"].startswith(
        "in the phase core; up when the port 8080 accepts connections within 10 s; started"
    )
    columns, rows = list_element_rows(lookup, "start_up")
    listed = [dict(zip(columns, row, strict=True)) for row in rows]
    assert [row["id"] for row in listed][:3] == ["set_clock", "stage", "parcel_registry"]
    assert (listed[6]["kind"], listed[6]["place"]) == ("container", "start_up.yaml:103:3")
    assert listed[4]["waits_for"] == "map_server"


def test_report_and_site_have_it_where_there_is_something() -> None:
    for name, has_start in (("bringup", True), ("first_robot", False)):
        views = project_views.make_views(pipeline.check_project(ROOT / "examples" / name), OutputOptions())
        pages = {page.anchor for page in site_pages.make_pages(views.lookup, views.edition)}
        chapters = {section.anchor for section in report_outline.make_report(views.lookup, views.edition).sections}
        found = ("start_up" in views.drawings, "page:start_up" in pages, "page:start_up" in chapters)
        assert found == (has_start,) * 3


def test_of_a_part_only_its_steps_are_shown_under_their_numbers(lookup: Lookup) -> None:
    part = replace(lookup, scope=DocumentScope(nodes=frozenset({"stage", "planner_server"})))
    _, *tables, _, dropped = make_start_blocks(part)
    numbers = [plain(row[0]) for table in tables if isinstance(table, Table) for row in table.rows]
    assert numbers == ["2", "7", "8"]
    assert isinstance(dropped, Bullets)
    assert len(dropped.items) == 4
    assert [row[1] for row in list_element_rows(part, "start_up")[1]] == ["stage", "navigation", "planner_server"]
    assert make_start_blocks(replace(lookup, scope=DocumentScope(nodes=frozenset()))) == []
