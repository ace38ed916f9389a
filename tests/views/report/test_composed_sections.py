"""Composed components and component types in the printed report."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

import pytest

from archgen import pipeline
from archgen.views import drawing_set
from archgen.views.lookup import make_lookup
from archgen.views.pages.report_outline import DocumentEdition, make_report
from archgen.views.report.printed_report import make_printed_report, walk_sections
from archgen.views.shapes import Facts, Figure, Inlines, Markdown, Outline, Section, Table

ROBOT = """
archgen: 1
component_types:
  motor: {title: Motor, functionality: Turns., inputs: {target: Goal}, outputs: {state: State}}
  fast_motor: {is: motor, title: Fast motor, functionality: Turns fast.}
groups:
  arms:
    components:
      arm:
        inputs: {goal: planner.goal}
        outputs: {state: {from: elbow.state}}
        components:
          shoulder: {is: motor, inputs: {target: self.goal}}
          elbow: {is: fast_motor, inputs: {target: self.goal}, functionality: Bends.}
          hand:
            inputs: {goal: self.goal}
            components:
              finger:
                inputs: {goal: self.goal}
                components:
                  tip: {is: motor, inputs: {target: self.goal}}
                  nail: {inputs: {goal: self.goal}, components: {edge: {is: motor, inputs: {target: self.goal}}}}
      planner: {inputs: {state: arm.state}, outputs: {goal: Goal}}
"""


@pytest.fixture
def outlines(tmp_path: Path) -> tuple[Outline, Outline]:
    """Return the outline of all documents, and that of the printed report."""
    (tmp_path / "archgen.yaml").write_text(ROBOT)
    lookup = make_lookup(pipeline.check_project(tmp_path).architecture)
    edition = DocumentEdition(drawings=drawing_set.make_drawings(lookup, None, "implementation"))
    return make_report(lookup, edition), make_printed_report(lookup, edition)


def list_titles(sections: Sequence[Section], depth: int = 0) -> Iterator[str]:
    """Yield the titles of sections, indented by their depth."""
    for section in sections:
        yield f"{'  ' * depth}{section.title}"
        yield from list_titles(section.sections, depth + 1)


def find_section(outline: Outline, anchor: str) -> Section:
    """Return the section with this anchor."""
    return next(section for section in walk_sections(outline.sections) if section.anchor == anchor)


def read_text(inlines: Inlines) -> str:
    """Return runs as text."""
    return "".join(f"{' | ' if run.line_break else ''}{run.text}" for run in inlines)


def find_table(section: Section, anchor: str) -> Table:
    """Return the table of a section with this anchor."""
    return next(block for block in section.blocks if isinstance(block, Table) and block.anchor == anchor)


def list_texts(section: Section) -> list[str]:
    """Return what a section says in the project's own words."""
    return [block.text for block in section.blocks if isinstance(block, Markdown)]


def test_components_stand_below_the_one_that_they_are_inside_of(outlines: tuple[Outline, Outline]) -> None:
    _, printed = outlines
    body = [section for section in printed.sections if section.anchor.startswith(("group:", "page:component_types"))]
    assert list(list_titles(body)) == [
        "Arms",
        "  Arm",
        "    Shoulder",
        "    Elbow",
        "    Hand",
        "      Finger",
        "  Planner",
        "Types of components",
        "  Motor",
        "  Fast motor",
    ]


def test_below_four_headings_a_table_has_all_that_is_inside(outlines: tuple[Outline, Outline]) -> None:
    table = find_table(
        find_section(outlines[1], "component:arms.arm.hand.finger"), "table:components/arms.arm.hand.finger"
    )
    assert [read_text(row[0]) for row in table.rows] == ["Tip", "Nail · Edge"]
    assert table.row_anchors == ("component:arms.arm.hand.finger.tip", "component:arms.arm.hand.finger.nail.edge")


def test_a_composed_component_has_its_picture_and_what_stands_behind_its_ports(
    outlines: tuple[Outline, Outline],
) -> None:
    section = find_section(outlines[1], "component:arms.arm")
    assert [block.graph for block in section.blocks if isinstance(block, Figure)] == ["report/composed/arms.arm"]
    table = find_table(section, "table:ports/arms.arm")
    assert [column.title for column in table.columns] == ["Use", "Port", "Type", "From / to", "Inside"]
    assert [[read_text(cell) for cell in row] for row in table.rows] == [
        ["in", "goal", "Goal", "Planner · goal", "Shoulder · target | Elbow · target | Hand · goal"],
        ["out", "state", "State", "Planner · state", "Elbow · state"],
    ]


def test_the_texts_of_a_type_are_said_once(outlines: tuple[Outline, Outline]) -> None:
    _, printed = outlines
    assert list_texts(find_section(printed, "component_type:motor")) == ["Turns."]
    shoulder = find_section(printed, "component:arms.arm.shoulder")
    assert list_texts(shoulder) == []
    facts = next(block for block in shoulder.blocks if isinstance(block, Facts))
    (type_cell,) = [value for name, value in facts.rows if name == "Type"]
    assert (read_text(type_cell), type_cell[0].ref) == ("Motor", "component_type:motor")
    assert list_texts(find_section(printed, "component:arms.arm.elbow")) == ["Bends."]


def test_no_anchor_stands_twice(outlines: tuple[Outline, Outline]) -> None:
    for outline in outlines:
        sections = list(walk_sections(outline.sections))
        anchors = [section.anchor for section in sections]
        tables = [block for section in sections for block in section.blocks if isinstance(block, Table)]
        anchors += [anchor for table in tables for anchor in (table.anchor, *table.row_anchors) if anchor]
        assert len(anchors) == len(set(anchors))


def test_the_annex_of_nodes_says_where_a_component_is(outlines: tuple[Outline, Outline]) -> None:
    annex = find_section(outlines[1], "nodes:arms")
    assert [section.title for section in annex.sections] == [
        "Arm · Shoulder",
        "Arm · Elbow",
        "Arm · Hand · Finger · Tip",
        "Arm · Hand · Finger · Nail · Edge",
        "Planner",
    ]


def test_an_instance_repeats_the_settings_of_its_type_only_where_it_sets_others(tmp_path: Path) -> None:
    settings = "parameters: {gain: 1}, operations: {stop: Ok}, "
    text = ROBOT.replace("{title: Motor, ", f"{{title: Motor, {settings}")
    (tmp_path / "archgen.yaml").write_text(
        text.replace("elbow: {is: fast_motor, ", "elbow: {is: fast_motor, parameters: {gain: 2}, ")
    )
    outline = make_report(make_lookup(pipeline.check_project(tmp_path).architecture), DocumentEdition())
    tables = {
        anchor: [block.caption for block in find_section(outline, anchor).blocks if isinstance(block, Table)]
        for anchor in ("component_type:motor", "component:arms.arm.shoulder", "component:arms.arm.elbow")
    }
    assert {"Motor: parameters", "Motor: operations"} <= set(tables["component_type:motor"])
    assert not [caption for caption in tables["component:arms.arm.shoulder"] if caption.endswith(("ters", "tions"))]
    assert [caption for caption in tables["component:arms.arm.elbow"] if caption.endswith(("ters", "tions"))] == [
        "Elbow: parameters"
    ]
