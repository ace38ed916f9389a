"""Timing pictures: every activity is there with its figure, filled by its step of the scale."""

from __future__ import annotations

from dataclasses import replace

import pytest

from archgen.model.selector_evaluation import evaluate_selector
from archgen.timing.analysis import EventPace
from archgen.views.drawing_set import make_drawings
from archgen.views.graphs import make_all_graphs
from archgen.views.lookup import DocumentScope, make_lookup
from archgen.views.picture_shapes import Chart, Graph
from archgen.views.timing import timing_lookup as timed_module
from archgen.views.timing import value_format
from archgen.views.timing.timing_lookup import analyse_with_chains
from tests.architectures import generated, robot
from tests.judged_projects import judge_ramcip
from tests.timings import exact, timed


@pytest.fixture(scope="module")
def pictures() -> dict[str, Graph]:
    architecture = judge_ramcip().architecture
    graphs = make_all_graphs(architecture, timed=timed(architecture))
    return {graph.id: graph for graph in graphs if graph.id.startswith("timing")}


def test_the_whole_and_each_group_are_drawn(pictures: dict[str, Graph]) -> None:
    architecture = judge_ramcip().architecture
    homes = {node.implements[0].split(".")[0] for node in architecture.nodes.values() if node.implements}
    assert set(pictures) == {"timing", *(f"timing/{group}" for group in homes)}


def test_every_activity_stands_in_the_whole_with_its_figure(pictures: dict[str, Graph]) -> None:
    architecture = judge_ramcip().architecture
    analysis = timed(architecture).analysis
    boxes = {box.id: box for box in pictures["timing"].boxes}
    assert set(boxes) == set(analysis.system.activities)
    assert {name: box.fill for name, box in boxes.items()} == {
        n: value_format.find_period_step(p) for n, p in analysis.paces.items()
    }
    assert {name: box.lines for name, box in boxes.items()} == {
        n: value_format.format_box_lines(p) for n, p in analysis.paces.items()
    }
    assert boxes["object_recognizer"].lines == ("5 Hz · 200 ms",)
    assert boxes["object_recognizer"].fill == "to_300_ms"


def test_flows_add_up(pictures: dict[str, Graph]) -> None:
    assert [g.id for g in pictures.values() if sum(arrow.count for arrow in g.arrows) != g.asked] == []


def test_neighbours_are_grey_and_carry_their_figure(pictures: dict[str, Graph]) -> None:
    grey = [box for graph in pictures.values() for box in graph.boxes if box.emphasis == "neighbour"]
    assert grey
    assert [box.id for box in grey if box.fill] == []
    assert [box.id for box in grey if box.style == "component" and not box.lines] == []


def test_the_legend_has_the_whole_scale_and_what_else_is_used(pictures: dict[str, Graph]) -> None:
    keys = [key for key in pictures["timing"].legend if key.startswith("pace:")]
    scale = ["to_10_ms", "to_30_ms", "to_100_ms", "to_300_ms", "to_1_s", "slower"]
    assert keys == [f"pace:{step}" for step in (*scale, "on_demand")]


def test_what_nobody_wrote_is_unknown() -> None:
    architecture = robot(1)
    graphs = make_all_graphs(architecture, timed=timed(architecture))
    (whole,) = (graph for graph in graphs if graph.id == "timing")
    assert {(box.fill, box.lines) for box in whole.boxes} == {("unknown", ("?",))}


def test_a_pace_that_differs_from_the_producers_stands_at_the_arrow() -> None:
    architecture = generated(3, 2, 3, 6)
    found = timed(architecture)
    arc = next(each for each in found.analysis.system.arcs if each.flow == "topic")
    analysis = replace(found.analysis, outputs={(arc.source, arc.output): EventPace("event", exact(3), exact(1))})
    graphs = make_all_graphs(architecture, timed=timed_module.make_timing_lookup(analysis))
    labels = {arrow.label for graph in graphs if graph.id.startswith("timing/") for arrow in graph.arrows}
    assert "3 Hz" in labels


def test_of_a_part_there_is_what_it_does_with_grey_neighbours_and_its_share_in_charts() -> None:
    architecture = judge_ramcip().architecture
    selection, _ = evaluate_selector("human_state", architecture)
    view = make_lookup(
        architecture,
        scope=DocumentScope(selection.components, selection.nodes),
        timing_lookup=analyse_with_chains(architecture),
    )
    drawn = make_drawings(view, selection, "implementation")
    whole = drawn["timing"]
    assert isinstance(whole, Graph)
    mine = {box.id for box in whole.boxes if box.emphasis != "neighbour"}
    assert mine == {
        "skeleton_tracker",
        "face_recognizer",
        "activity_classifier",
        "fall_watch",
        "voice_activity",
        "transcriber",
    }
    (grey,) = (box for box in whole.boxes if box.id == "around robot_action_planner")
    assert (grey.emphasis, grey.title, grey.fill) == ("neighbour", "Robot Action Planner", None)
    assert grey.lines[-1].startswith("and ")
    assert sum(arrow.count for arrow in whole.arrows) == whole.asked
    charts = {name: chart for name, chart in drawn.items() if isinstance(chart, Chart)}
    assert set(charts) == {
        "chains/fall_to_call",
        "chains/speech_to_reply",
        "load",
        "load/vision_pc",
        "load/interaction_pc",
    }
    call = charts["chains/fall_to_call"]
    assert [bar.title for bar in call.bars if not bar.is_outside][:2] == ["skeleton_tracker", "fall_watch"]
    assert call.notes == ("Grey names stand outside of the selected part.",)
    assert charts["load"].notes == ()
