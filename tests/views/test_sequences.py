"""Sequences of use cases: lifelines, messages, pieces for paper, pages, chapter, drawings on demand."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen import pipeline
from archgen.products import project_views
from archgen.products.output_options import OutputOptions
from archgen.views import drawing_set
from archgen.views.drawings_on_demand import DrawingsOnDemand
from archgen.views.elements.functional_level import list_component_facts
from archgen.views.lookup import Lookup
from archgen.views.pages import report_outline, site_pages
from archgen.views.picture_shapes import Lifeline, SequenceChart
from archgen.views.report.front_pages import make_use_case_table
from archgen.views.report.printed_report import make_printed_report
from archgen.views.report.report_drawings import is_piece_of, make_report_drawings
from archgen.views.sequences import sequence_blocks, sequence_charts
from archgen.views.shapes import Facts, Figure, Paragraph, Table

ROBOT = """\
archgen: 1
use_cases:
  UC-1: Plain
  UC-4:
    title: Fetching water
    description: She is thirsty.
    actors: {resident: The resident}
    steps:
      - {from: resident, to: speech, say: asks for water}
      - {from: speech, to: mind, say: passes on the words}
      - {from: mind, to: mind.thought, say: thinks}
      - {from: mind, to: planner.plan}
      - {from: planner, to: mind}
      - {from: mind, to: speech, say: never heard}
      - {from: mind, to: mind, say: gives up}
groups:
  g:
    components:
      speech: {title: Ears, inputs: {voice: {external: The resident speaks, medium: physical}}, outputs: {words: Words}}
      mind:
        inputs: {words: speech.words, plan: planner.plan}
        components:
          entry: {inputs: {words: self.words}, outputs: {idea: Words}}
          thought: {inputs: {idea: entry.idea, plan: self.plan}}
      planner: {outputs: {plan: Plan}}
  h: {components: {alone: {outputs: {x: Words}}}}
types: {Words: std_msgs/msg/String, Plan: std_srvs/srv/Trigger}
"""


def look_up(folder: Path, text: str = ROBOT, selector: str = "") -> Lookup:
    (folder / "robot.yaml").write_text(text, encoding="utf-8")
    checked = pipeline.check_project(folder / "robot.yaml")
    selection = project_views.select_elements(checked, selector)[0] if selector else None
    return project_views.make_scoped_lookup(checked, OutputOptions(selection, selector))


def test_the_chart_of_a_use_case(tmp_path: Path) -> None:
    chart = sequence_charts.make_sequence_chart(look_up(tmp_path), "UC-4")
    assert (chart.id, chart.title) == ("sequences/UC-4", "Fetching water")
    assert [(each.title, each.kind, each.ref) for each in chart.lifelines] == [
        ("The resident", "actor", None),
        ("Ears", "component", "component:g.speech"),
        ("Mind", "composed", "component:g.mind"),
        ("Thought", "component", "component:g.mind.thought"),
        ("Planner", "component", "component:g.planner"),
    ]
    assert [(m.number, m.tail, m.head, m.text, m.detail, m.style, m.ref) for m in chart.messages] == [
        (1, 0, 1, "asks for water", "Voice", "physical", None),
        (2, 1, 2, "passes on the words", "Words", "data", "type:Words"),
        (3, 2, 3, "thinks", "Words", "data", "type:Words"),
        (4, 2, 4, "", "Plan", "service", "type:Plan"),
        (5, 4, 2, "", "Plan", "service", "type:Plan"),
        (6, 2, 1, "never heard", "no connection", "broken", None),
        (7, 2, 2, "gives up", "", "inner", None),
    ]
    assert chart.legend == ("step:data", "step:service", "physical", "step:inner", "step:broken", "external")
    assert chart.alt.startswith("A sequence of 7 steps of UC-4. 1: The resident to Ears: asks for water. ")


def test_blocks_tell_what_is_wrong_and_list_the_steps(tmp_path: Path) -> None:
    lookup = look_up(tmp_path)
    facts, warning, figure, table = sequence_blocks.make_sequence_blocks(lookup, lookup.architecture.use_cases["UC-4"])
    assert isinstance(facts, Facts)
    assert isinstance(warning, Paragraph)
    assert "".join(run.text for run in warning.inlines) == "Step 6 runs along no connection."
    assert isinstance(figure, Figure)
    assert isinstance(table, Table)
    assert (figure.graph, table.anchor) == ("sequences/UC-4", "table:steps/UC-4")
    cells = [["".join(run.text for run in cell) for cell in row] for row in table.rows]
    assert cells[0] == ["1", "The resident", "Ears", "asks for water", "Voice"]
    assert cells[5:] == [
        ["6", "Mind", "Ears", "never heard", "no connection"],
        ["7", "Mind", "itself", "gives up", ""],
    ]
    assert list(sequence_blocks.make_sequence_blocks(lookup, lookup.architecture.use_cases["UC-1"])) == []


def test_components_name_the_use_cases_in_which_they_take_part(tmp_path: Path) -> None:
    lookup = look_up(tmp_path)
    facts = {
        each.title: each.value for each in list_component_facts(lookup, lookup.architecture.components["g.speech"])
    }
    assert [(run.text, run.ref) for run in facts["Takes part in"]] == [("UC-4", "use_case:UC-4")]
    facts_alone = list_component_facts(lookup, lookup.architecture.components["h.alone"])
    assert "Takes part in" not in {each.title for each in facts_alone}


def long_robot(steps: int) -> str:
    """Return a ring of eleven components and a use case that goes round."""
    ring = "".join(f"      c{at}: {{inputs: {{i: c{(at + 10) % 11}.o}}, outputs: {{o: Words}}}}\n" for at in range(11))
    lines = "".join(f"      - {{from: c{at % 11}, to: c{(at + 1) % 11}, say: s{at}}}\n" for at in range(steps))
    return f"archgen: 1\nuse_cases:\n  UC-4:\n    steps:\n{lines}groups:\n  g:\n    components:\n{ring}types: {{Words: std_msgs/msg/String}}\n"


@pytest.mark.parametrize(("steps", "pieces"), [(5, [5]), (6, [3, 3]), (40, [5] * 8)])
def test_pieces_for_paper_have_few_lifelines_and_are_even(steps: int, pieces: list[int], tmp_path: Path) -> None:
    charts = sequence_charts.make_printed_charts(look_up(tmp_path, long_robot(steps)), "UC-4")
    assert [len(chart.messages) for chart in charts] == pieces
    assert all(len(chart.lifelines) <= 6 for chart in charts)
    assert [message.number for chart in charts for message in chart.messages] == list(range(1, steps + 1))
    if len(charts) > 1:
        assert [chart.id for chart in charts][:2] == ["sequences/UC-4/1", "sequences/UC-4/2"]
        assert charts[0].title == f"UC-4: steps 1 to {pieces[0]}"
    # What has no words says what it runs along; the legend stands once.
    assert {message.detail for chart in charts for message in chart.messages} == ({"Words"} if steps == 5 else {""})
    assert [chart.legend for chart in charts] == [()] * (len(pieces) - 1) + [("step:data",)]


def test_pieces_for_paper_leave_what_words_say_to_the_table(tmp_path: Path) -> None:
    silent = long_robot(7).replace(", say: s3", "")
    charts = sequence_charts.make_printed_charts(look_up(tmp_path, silent), "UC-4")
    assert [message.detail for chart in charts for message in chart.messages] == ["", "", "", "Words", "", "", ""]


def test_drawings_at_once_and_on_demand(tmp_path: Path) -> None:
    lookup = look_up(tmp_path)
    drawings = drawing_set.make_drawings(lookup, None, "functional")
    assert [name for name in drawings if name.startswith("sequences/")] == ["sequences/UC-4"]
    on_demand = DrawingsOnDemand(lookup, "functional")
    assert on_demand["sequences/UC-4"] == drawings["sequences/UC-4"]
    assert "sequences/UC-1" not in on_demand
    for selector, expected in (("g.mind.thought", ["sequences/UC-4"]), ("h", [])):
        selection = project_views.select_elements(pipeline.check_project(tmp_path / "robot.yaml"), selector)[0]
        part = drawing_set.make_drawings(look_up(tmp_path, selector=selector), selection, "functional")
        assert [name for name in part if name.startswith("sequences/")] == expected


def test_pages_and_chapter(tmp_path: Path) -> None:
    lookup = look_up(tmp_path)
    edition = report_outline.DocumentEdition(drawings=drawing_set.make_drawings(lookup, None, "implementation"))
    page = next(page for page in site_pages.make_pages(lookup, edition) if page.anchor == "use_case:UC-4")
    assert [block.graph for block in page.section.blocks if isinstance(block, Figure)] == ["sequences/UC-4"]
    chapter = next(s for s in report_outline.make_report(lookup, edition).sections if s.anchor == "page:use_cases")
    assert [(section.anchor, section.title) for section in chapter.sections] == [
        ("use_case:UC-4", "UC-4: Fetching water")
    ]
    assert not [
        s
        for s in report_outline.make_report(look_up(tmp_path, selector="g"), edition).sections
        if s.anchor == "page:use_cases"
    ]
    table = make_use_case_table(lookup, has_chapter=True)
    assert table is not None
    assert table.row_anchors == ("use_case:UC-1", None)


def test_the_printed_report_has_the_pieces(tmp_path: Path) -> None:
    lookup = look_up(tmp_path, long_robot(6))
    edition = report_outline.DocumentEdition(drawings=drawing_set.make_drawings(lookup, None, "implementation"))
    chapter = next(s for s in make_printed_report(lookup, edition).sections if s.anchor == "page:use_cases")
    figures = [block for block in chapter.sections[0].blocks if isinstance(block, Figure)]
    assert [figure.graph for figure in figures] == ["sequences/UC-4/1", "sequences/UC-4/2"]
    drawings = make_report_drawings(lookup, edition.drawings)
    assert {figure.graph for figure in figures} <= set(drawings)
    assert "sequences/UC-4" not in drawings


def test_a_use_case_whose_id_ends_like_a_piece_is_none() -> None:
    piece = SequenceChart("sequences/UC-1/2", "", (Lifeline("a"),), ())
    assert is_piece_of(piece, "sequences/UC-1")
    assert not is_piece_of(piece, "sequences/UC")
