"""Composed components open to a depth: frames in frames, arrows to what stands in them, and pictures that would get too large."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen import pipeline
from archgen.emit.graphviz import graph_drawing
from archgen.model.architecture import Architecture
from archgen.model.selector_evaluation import evaluate_selector
from archgen.views.graphs import draw_components, draw_composed, draw_group, make_all_graphs
from archgen.views.graphs.composed_graph import list_opened
from archgen.views.graphs.selection_graphs import draw_view
from archgen.views.lookup import make_lookup
from archgen.views.picture_shapes import Graph

ROBOT = """
archgen: 1
component_types:
  motor: {title: Motor, inputs: {target: Goal}, outputs: {state: State}}
groups:
  arms:
    components:
      arm:
        inputs: {goal: planner.goal}
        outputs: {state: {from: hand.state}}
        components:
          elbow: {is: motor, inputs: {target: self.goal}}
          hand:
            inputs: {goal: self.goal}
            outputs: {state: {from: finger.state}}
            components:
              finger: {is: motor, inputs: {target: self.goal}}
      planner: {inputs: {state: arm.state}, outputs: {goal: Goal}}
  outside: {components: {reader: {inputs: {state: arm.state}}}}
views:
  closed: {show: arm}
  opened: {show: arm, depth: 1}
  kept: {show: arm, depth: 0}
"""
FRAMES = ["open arms.arm in arms", "open arms.arm.hand in open arms.arm"]


def read_project(tmp_path: Path, text: str) -> Architecture:
    (tmp_path / "archgen.yaml").write_text(text)
    return pipeline.check_project(tmp_path).architecture


@pytest.fixture
def robot(tmp_path: Path) -> Architecture:
    return read_project(tmp_path, ROBOT)


def boxes_of(graph: Graph) -> list[str]:
    """List the boxes with the frames that they stand in."""
    return [f"{box.id} in {box.cluster}" if box.cluster else box.id for box in graph.boxes]


def frames_of(graph: Graph) -> list[str]:
    """List the frames that stand in others."""
    return [f"{cluster.id} in {cluster.parent}" for cluster in graph.clusters if cluster.parent]


def arrows_of(graph: Graph) -> list[str]:
    return sorted(f"{arrow.tail} > {arrow.head}" for arrow in graph.arrows)


@pytest.mark.parametrize(
    ("depth", "boxes", "frames"),
    [
        (0, ["arms.arm in arms", "arms.planner in arms", ">outside.reader"], []),
        (
            1,
            ["arms.arm.elbow in open arms.arm", "arms.arm.hand in open arms.arm", "arms.planner in arms", ">outside.reader"],
            FRAMES[:1],
        ),
        (
            2,
            ["arms.arm.elbow in open arms.arm", "arms.arm.hand.finger in open arms.arm.hand", "arms.planner in arms", ">outside.reader"],
            FRAMES,
        ),
    ],
)  # fmt: skip
def test_a_group_opens_level_by_level(robot: Architecture, depth: int, boxes: list[str], frames: list[str]) -> None:
    graph = draw_group(make_lookup(robot), "arms", depth)
    assert (boxes_of(graph), frames_of(graph), graph.notes) == (boxes, frames, ())


def test_deeper_than_there_is_anything_is_as_deep_as_there_is(robot: Architecture) -> None:
    lookup = make_lookup(robot)
    assert draw_group(lookup, "arms", 1_000_000) == draw_group(lookup, "arms", 2)
    assert draw_group(lookup, "outside", 3) == draw_group(lookup, "outside")


def test_what_is_opened_goes_level_by_level_from_the_boxes_of_a_picture(robot: Architecture) -> None:
    assert list_opened(robot, ("arms.arm", "arms.planner"), 0) == set()
    assert list_opened(robot, ("arms.arm", "arms.planner"), 1) == {"arms.arm"}
    assert list_opened(robot, ("arms.arm.elbow", "arms.arm.hand"), 1) == {"arms.arm.hand"}


def test_arrows_run_to_what_stands_in_the_frames(robot: Architecture) -> None:
    assert arrows_of(draw_group(make_lookup(robot), "arms", 2)) == [
        "arms.arm.hand.finger > >outside.reader",
        "arms.arm.hand.finger > arms.planner",
        "arms.planner > arms.arm.elbow",
        "arms.planner > arms.arm.hand.finger",
    ]


def test_a_composed_component_opens_what_is_inside_behind_its_ports(robot: Architecture) -> None:
    graph = draw_composed(make_lookup(robot), "arms.arm", 1)
    assert boxes_of(graph) == [
        "arms.arm.elbow in arms.arm",
        "arms.arm.hand.finger in open arms.arm.hand",
        "in goal",
        "out state",
    ]
    assert arrows_of(graph) == [
        "arms.arm.hand.finger > out state",
        "in goal > arms.arm.elbow",
        "in goal > arms.arm.hand.finger",
    ]


def test_the_picture_of_everything_has_frames_in_the_frames_of_groups(robot: Architecture) -> None:
    graph = draw_components(make_lookup(robot), 2)
    assert (graph.layout, frames_of(graph)) == ("framed", FRAMES)
    assert [cluster.id for cluster in graph.clusters if not cluster.parent] == ["arms", "outside"]
    assert sum(arrow.count for arrow in graph.arrows) == graph.asked == 4


@pytest.mark.parametrize(
    ("view", "depth", "opened"),
    [("closed", 0, False), ("closed", 1, True), ("opened", 0, True), ("kept", 2, False)],
)
def test_a_view_opens_as_deep_as_it_says_else_as_is_asked(
    robot: Architecture, view: str, depth: int, *, opened: bool
) -> None:
    project_view = robot.views[view]
    selection, _ = evaluate_selector(project_view.show, robot)
    graph = draw_view(make_lookup(robot), project_view, selection, depth)
    inside = ["arms.arm.elbow in open arms.arm", "arms.arm.hand in open arms.arm"]
    assert boxes_of(graph)[:2] == (inside if opened else ["arms.arm", "arms.planner"])
    assert [cluster.lines for cluster in graph.clusters] == ([("Arms",)] if opened else [])


def test_all_pictures_are_open_to_the_depth_that_is_asked_for(robot: Architecture) -> None:
    graphs = {graph.id: graph for graph in make_all_graphs(robot, depth=2)}
    opened = [name for name, graph in graphs.items() if any(each.id.startswith("open ") for each in graph.clusters)]
    assert opened == ["components", "groups/arms", "composed/arms.arm", "views/closed", "views/opened"]


def test_what_is_not_designed_yet_stands_in_the_frame(tmp_path: Path) -> None:
    text = """
archgen: 1
groups:
  g:
    components:
      source: {outputs: {a: Goal}}
      shell: {inputs: {a: source.a, b: source.a}, components: {leaf: {inputs: {a: self.a}}}}
"""
    graph = draw_group(make_lookup(read_project(tmp_path, text)), "g", 1)
    assert boxes_of(graph) == ["g.source in g", "g.shell.leaf in open g.shell", "g.shell in open g.shell"]
    assert [box.title for box in graph.boxes] == ["Source", "Leaf", "Not designed yet"]
    assert arrows_of(graph) == ["g.source > g.shell", "g.source > g.shell.leaf"]


def test_a_picture_that_would_get_too_large_is_opened_less_deep_and_says_so(tmp_path: Path) -> None:
    cells = ", ".join(f"c{at}: {{is: cell}}" for at in range(15))
    modules = ", ".join(f"m{at}: {{is: module}}" for at in range(6))
    text = (
        "archgen: 1\ncomponent_types:\n  cell: {outputs: {o: T}}\n"
        f"  module: {{components: {{{cells}}}}}\n  machine: {{components: {{{modules}}}}}\n"
        "groups: {g: {components: {x: {is: machine}}}}\n"
    )
    graph = draw_group(make_lookup(read_project(tmp_path, text)), "g", 2)
    assert len(graph.boxes) == 6
    (note,) = graph.notes
    assert note == (
        "Components of components are only 1 level deep here: with more of them open the picture would be larger than "
        "70 boxes and 160 arrows."
    )


@pytest.mark.parametrize("name", ["groups/arms", "components", "composed/arms.arm", "views/opened"])
def test_frames_stand_in_their_frames_with_all_of_their_boxes(robot: Architecture, name: str) -> None:
    graph = next(graph for graph in make_all_graphs(robot, depth=2) if graph.id == name)
    styled_graph, scene = graph_drawing.lay_out_graph(graph, {})
    places = {frame.name: frame.rectangle for frame in scene.frames}
    numbers = {cluster.id: f"c{at}" for at, cluster in enumerate(graph.clusters)}
    assert set(numbers.values()) <= places.keys()
    inner = [(places[numbers[each.id]], each.parent) for each in graph.clusters if each.parent]
    parts = {part.name: part.rectangle for part in scene.parts}
    inner += [(parts[styled_graph.dot_names[box.id]], box.cluster) for box in graph.boxes if box.cluster]
    assert inner
    for (left, bottom, right, top), parent in inner:
        outer = places[numbers[parent or ""]]
        assert outer[0] < left < right < outer[2]
        assert outer[1] < bottom < top < outer[3]
    # Outer frames first: they are painted over one another.
    order = [frame.name for frame in scene.frames]
    assert all(order.index(numbers[e.parent]) < order.index(numbers[e.id]) for e in graph.clusters if e.parent)
