"""Parameters and operations on cards, pages and in the record: what is declared, what counts, and where it comes from."""

from __future__ import annotations

from pathlib import Path

from archgen import pipeline
from archgen.cli.show_command import format_card
from archgen.views.elements.element_card import make_card
from archgen.views.elements.functional_level import make_component_blocks
from archgen.views.elements.implementation_level import make_node_blocks
from archgen.views.elements.parameter_blocks import make_parameter_blocks
from archgen.views.lookup import Lookup, make_lookup
from archgen.views.records.resolved_record import write_record
from archgen.views.report.condensed_blocks import condense_component
from archgen.views.shapes import Inlines, Table
from archgen.views.tables.element_rows import list_element_rows

ROBOT = """\
archgen: 1
ros: {parameters: {use_sim_time: true}}
groups:
  g:
    components:
      c:
        title: C
        parameters:
          speed: {type: float, value: 0.8, unit: m/s, range: [0, 1.5], description: Never fast., read_only: true}
          mode: {choices: [fast, slow], value: slow}
          map: {type: string}
          side: {from: self.side}
          topic: /scan
        open: [Follow]
        operations: {get: Pose, set: {request: {gain: float64}, call: asynchronous}}
      plain: P
nodes:
  n: {implements: c, parameter_files: [a.yaml], parameters: {mode: fast}, parameter_commands: {Follow.x: [cat, y]}}
  own: {implements: plain, parameters: {x: {y: 1}}}
"""


def look(folder: Path) -> Lookup:
    (folder / "archgen.yaml").write_text(ROBOT, encoding="utf-8")
    (folder / "a.yaml").write_text("n: {ros__parameters: {speed: 1}}", encoding="utf-8")
    return make_lookup(pipeline.check_project(folder).architecture)


def cells(table: Table) -> list[list[str]]:
    def plain(inlines: Inlines) -> str:
        return "".join(each.text for each in inlines if hasattr(each, "text"))

    return [[column.title for column in table.columns], *([plain(cell) for cell in row] for row in table.rows)]


def tables(blocks: object, name: str) -> list[list[list[str]]]:
    assert isinstance(blocks, tuple | list)
    return [cells(block) for block in blocks if isinstance(block, Table) and block.anchor.startswith(name)]


def test_a_component_shows_what_it_declares(tmp_path: Path) -> None:
    lookup = look(tmp_path)
    component = lookup.architecture.components["g.c"]
    blocks = make_component_blocks(lookup, component)
    assert tables(blocks, "table:set/") == [
        [
            ["Parameter", "Type", "Value", "Unit", "May be", "Remarks"],
            ["speed", "float", "0.8", "m/s", "0 to 1.5", "read-only; Never fast."],
            ["mode", "", "slow", "", "fast, slow", ""],
            ["map", "string", "still to be given", "", "", ""],
            ["side", "", "from self.side", "", "", ""],
            ["topic", "", "/scan", "", "", ""],
            ["Follow.*", "", "", "", "any", "open set"],
        ]
    ]
    assert tables(blocks, "table:operations/") == [
        [["Operation", "Request", "Response", "Remarks"], ["get", "", "Pose", ""], ["set", "gain: float64", "", "asynchronous"]]
    ]  # fmt: skip
    # On paper they stay tables, behind that of the ports.
    condensed = condense_component(lookup, component, blocks)
    assert [block.anchor for block in condensed if isinstance(block, Table)] == [
        "table:set/g.c",
        "table:operations/g.c",
    ]
    assert make_parameter_blocks(lookup.architecture.components["g.plain"]) == []
    card = format_card(make_card(lookup, "component", "g.c"))
    for line in (
        "speed = 0.8 m/s (float, 0 to 1.5, read-only)",
        "map = ? (still to be given) (string)",
        "get() -> Pose",
    ):
        assert line in card


def test_a_node_shows_what_counts_and_where_it_comes_from(tmp_path: Path) -> None:
    lookup = look(tmp_path)
    node = lookup.architecture.nodes["n"]
    assert tables(make_node_blocks(lookup, node), "table:parameters/") == [
        [
            ["Parameter", "Value", "From"],
            ["speed", "1", "a.yaml"],
            ["mode", "fast", "node"],
            ["map", "still to be given", ""],
            ["side", "from self.side", ""],
            ["topic", "/scan", "component"],
            ["use_sim_time", "true", "all nodes"],
            ["Follow.x", "cat y", "output of a command"],
        ]
    ]
    card = format_card(make_card(lookup, "node", "n"))
    for line in (
        "speed = 1 <- a.yaml:1",
        "mode = fast <- node (archgen.yaml:18)",
        "use_sim_time = true <- ros.parameters (archgen.yaml:2)",
        "Follow.x = cat y <- command (archgen.yaml:18)",
    ):
        assert line in card
    effective = write_record("node", node, lookup)["effective_parameters"]
    assert isinstance(effective, dict)
    assert effective["map"] == {"origin": "none"}
    assert effective["speed"] == {"origin": "file", "value": 1}
    side = lookup.architecture.components["g.c"].parameters["side"]
    assert write_record("parameter", side, lookup) == {"from": "self.side"}


def test_lists_have_a_row_for_each_parameter_of_a_node_and_each_operation(tmp_path: Path) -> None:
    lookup = look(tmp_path)
    columns, rows = list_element_rows(lookup, "parameters")
    assert columns == ("parameter", "node", "components", "type", "value", "unit", "may_be", "from", "place")
    assert rows[:3] == [
        ("speed", "n", "g.c", "float", "1", "m/s", "0 to 1.5", "a.yaml", "a.yaml:1:30"),
        ("mode", "n", "g.c", "", "fast", "", "fast, slow", "node", "archgen.yaml:18:68"),
        ("map", "n", "g.c", "string", "", "", "", "", "archgen.yaml:11:11"),
    ]
    assert rows[-2:] == [
        ("use_sim_time", "own", "g.plain", "", "true", "", "", "all nodes", "archgen.yaml:2:34"),
        ("x.y", "own", "g.plain", "", "1", "", "", "node", "archgen.yaml:19:48"),
    ]
    assert list_element_rows(lookup, "operations")[1] == [
        ("get", "g.c", "", "Pose", "", "", "archgen.yaml:15:22"),
        ("set", "g.c", "gain: float64", "", "asynchronous", "", "archgen.yaml:15:33"),
    ]


def test_where_every_parameter_is_accepted_a_star_says_so(tmp_path: Path) -> None:
    file = tmp_path / "robot.yaml"
    file.write_text('groups: {g: {components: {c: {parameters: {x: 1}, open: ["*"]}}}}\n', encoding="utf-8")
    lookup = make_lookup(pipeline.check_project(file).architecture)
    (rows,) = tables(make_parameter_blocks(lookup.architecture.components["g.c"]), "table:set/")
    assert [row[0] for row in rows] == ["Parameter", "x", "*"]
    assert "*: anything" in format_card(make_card(lookup, "component", "g.c"))
