"""Every layout draws every arrow, and lets no box, title or text meet another."""

from __future__ import annotations

import re
from dataclasses import replace
from itertools import combinations
from pathlib import Path
from typing import Literal

import pytest

from archgen import pipeline
from archgen.emit.graphviz import graph_drawing
from archgen.emit.graphviz.box_styles import style_box
from archgen.emit.graphviz.framed_layout import lay_out_framed
from archgen.emit.graphviz.label_places import declutter_labels
from archgen.emit.graphviz.placed_scene import Scene, SceneLine, ScenePart
from archgen.emit.graphviz.styled_graph import style_graph
from archgen.model.architecture import View
from archgen.views.graphs import draw_group, make_all_graphs
from archgen.views.lookup import make_lookup
from archgen.views.picture_shapes import Arrow, Box, Cluster, Graph
from tests.architectures import generated, robot
from tests.emit.graphviz.overlaps import overlapping_parts, rectangles_meet
from tests.property_sizes import list_seeds, try_some
from tests.timings import timed

ROBOT = make_all_graphs(robot(1))


def faults(graph: Graph) -> list[str]:
    """Say what is wrong with a drawing: what meets, what lies in a frame that is not its own, what is missing."""
    drafted, scene = graph_drawing.lay_out_graph(graph, {})
    wrong = [f"{one} meets {other}" for one, other in overlapping_parts(scene)]
    frames = [(frame.name, frame.rectangle) for frame in scene.frames]
    wrong += [f"{a} meets {b}" for (a, one), (b, two) in combinations(frames, 2) if rectangles_meet(one, two, -0.5)]
    home = {drafted.dot_names[box.id]: box.cluster for box in graph.boxes}
    names = {f"c{at}": cluster.id for at, cluster in enumerate(graph.clusters)}
    for part in scene.parts:
        if part.name in home:
            inside = [names[name] for name, rectangle in frames if rectangles_meet(part.rectangle, rectangle, -0.5)]
            own = home[part.name] if home[part.name] in names.values() else None
            if inside != ([own] if own else []):
                wrong.append(f"{part.name} lies in {inside}, not in {own}")
    missing = {arrow.id for arrow in graph.arrows} - {line.arrow for line in scene.lines}
    boxes = {box.id for box in graph.boxes} - {
        box.id for box in graph.boxes if drafted.dot_names[box.id] in {part.name for part in scene.parts}
    }
    wrong += [
        f"the text of {edge} is left out" for edge in drafted.label_attributes if f"l{edge[1:]}" not in _names(scene)
    ]
    return [*wrong, *(f"{name} is not drawn" for name in sorted(missing | boxes))]


def _names(scene: Scene) -> set[str]:
    return {part.name for part in scene.parts}


@pytest.mark.parametrize("graph", ROBOT, ids=[graph.id for graph in ROBOT])
def test_pictures_of_a_robot(graph: Graph) -> None:
    assert faults(graph) == []
    assert sum(arrow.count for arrow in graph.arrows) == graph.asked


@pytest.mark.parametrize("example", try_some(["examples/first_robot", "example_ramcip"]))
def test_pictures_of_timing(example: str) -> None:
    architecture = pipeline.check_project(Path(__file__).parents[3] / example).architecture
    graphs = [g for g in make_all_graphs(architecture, timed=timed(architecture)) if g.id.startswith("timing")]
    assert graphs
    assert [(graph.id, wrong) for graph in graphs if (wrong := faults(graph))] == []


@pytest.mark.parametrize("example", try_some(["examples/first_robot", "example_ramcip"]))
def test_pictures_of_the_examples(example: str) -> None:
    checked = pipeline.check_project(Path(__file__).parents[3] / example)
    graphs = make_all_graphs(checked.architecture, findings=checked.findings)
    wrong = [(graph.id, faults(graph)) for graph in graphs]
    assert [each for each in wrong if each[1]] == []
    assert [graph.id for graph in graphs if graph.asked != sum(arrow.count for arrow in graph.arrows)] == []


@pytest.mark.parametrize("seed", list_seeds(20))
def test_two_hundred_groups(seed: int) -> None:
    view = make_lookup(generated(seed, 10, 3 + seed % 10, 40 + 6 * seed))
    wrong = [(name, faults(draw_group(view, name))) for name in view.architecture.groups]
    assert [each for each in wrong if each[1]] == []


@pytest.mark.parametrize("seed", list_seeds(8))
def test_other_architectures_as_a_whole(seed: int) -> None:
    architecture = generated(seed, 2 + 2 * seed, 9, 30 + 10 * seed)
    whole = [graph for graph in make_all_graphs(architecture) if graph.layout in {"two-step", "overview"}]
    assert [graph.id for graph in whole] == ["overview", "overview_upright", "components", "ros"]
    assert [(graph.id, faults(graph)) for graph in whole if faults(graph)] == []


def test_every_connection_is_accounted_for_in_the_widest_picture() -> None:
    architecture = robot(1)
    (graph,) = (graph for graph in ROBOT if graph.id == "components")
    inside = [arrow for arrow in graph.arrows if "." in arrow.tail]
    assert sum(arrow.count for arrow in inside) == 58
    assert sum(arrow.count for arrow in graph.arrows) == len(architecture.connections) == 138


HOSTILE = (
    "<b>bold</b> & <script>alert(1)</script>",
    '"]; evil [label="x',
    r"\N \G {a|b} \l",
    "\x00\x07\x1b[31mred\u202e",
    "שלום עולם ومرحبا بالعالم",
    "🤖🚀 机器人 emoji",
    "two hundred letters in one word " + "w" * 200,
    "many words " * 20,
    "",
    "&lt;&#x41;&nbsp;",
)


def hostile(layout: str) -> Graph:
    boxes = tuple(
        Box(
            f"b{at}",
            text,
            (text,),
            ref=text,
            tooltip=text,
            cluster=f"c{at % 2}" if layout not in {"flow", "overview"} else None,
        )
        for at, text in enumerate(HOSTILE)
    )
    if layout == "group":
        boxes = tuple(
            Box(b.id, b.title, b.lines, ref=b.ref, cluster="c0" if at < 6 else None, side=None if at < 6 else "right")
            for at, b in enumerate(boxes)
        )
    arrows = tuple(
        Arrow(f"a{at}", f"b{at}", f"b{(at + 3) % 10}", text, ref=text, flows=(text, text))
        for at, text in enumerate(HOSTILE)
    )
    titles = (HOSTILE[0], HOSTILE[1])[: 1 if layout == "group" else 2]
    clusters = tuple(Cluster(f"c{at}", text, (text,), tooltip=text) for at, text in enumerate(titles))
    return Graph(
        f"hostile/{layout}",
        HOSTILE[0],
        layout,  # type: ignore[arg-type]
        boxes,
        arrows,
        () if layout in {"flow", "overview"} else clusters,
        notes=HOSTILE[:3],
        alt=HOSTILE[3],
        kind="view",
    )


@pytest.mark.parametrize("layout", ["flow", "group", "two-step", "overview"])
def test_hostile_texts(layout: str) -> None:
    from lxml import etree

    graph = hostile(layout)
    assert [fault for fault in faults(graph) if not (layout in {"two-step", "overview"} and "the text" in fault)] == []
    links = dict.fromkeys(HOSTILE, "javascript:alert(1)")
    made = graph_drawing.draw_picture(graph, links, ("svg", "svg_outlines", "pdf", "png"))
    assert made.svg is not None
    assert made.svg_outlines is not None
    root = etree.fromstring(made.svg)
    etree.fromstring(made.svg_outlines)
    texts = ["".join(str(part) for part in each.itertext()) for each in root.iter("{http://www.w3.org/2000/svg}text")]
    assert "<b>bold</b> & " in " ".join(texts).replace("  ", " ")
    assert not list(root.iter("{http://www.w3.org/2000/svg}script", "{http://www.w3.org/2000/svg}a"))
    assert b"javascript" not in made.svg


def test_what_found_no_place_is_said() -> None:
    graph = hostile("two-step")
    made = graph_drawing.draw_picture(graph, {}, ("svg",))
    lost = sum("the text" in fault for fault in faults(graph))
    assert lost > 0
    assert f"{lost} of the texts beside arrows had no place here" in (made.svg or b"").decode()


def test_a_box_with_ports_takes_arrows_at_its_ports() -> None:
    subject = Box("s", "Subject", ports_in=(("in a", "a"), ("in b", "b")), ports_out=(("out a", "a"),))
    boxes = (subject, Box("l", "Left", side="left"), Box("r", "Right", side="right"))
    arrows = (
        Arrow("1", "l", "s", "Type", head_port="in b"),
        Arrow("2", "s", "r", head_port=None, tail_port="out a"),
        Arrow("3", "s", "l", tail_port="in a", style="service"),
    )
    graph = Graph("ports", "Ports", "flow", boxes, arrows, kind="component")
    assert faults(graph) == []
    drafted, scene = graph_drawing.lay_out_graph(graph, {})
    by_arrow = {line.arrow: line for line in scene.lines}
    assert by_arrow["3"].tail == drafted.dot_names["l"], "laid out from left to right"
    assert by_arrow["3"].attributes["dir"] == '"back"', "and drawn from client to server"


def test_views_of_the_project_in_either_size() -> None:
    from dataclasses import replace

    views = {
        "small": View("small", "Small", "human_state.fall_detector", colour="owner"),
        "large": View("large", "Large", "human_state robot_state robot_action_planner"),
        "low": View("low", "Low", "robot_state", level="implementation", colour="status"),
    }
    graphs = {graph.id: graph for graph in make_all_graphs(replace(robot(1), views=views))}
    drawn = [graphs[f"views/{name}"] for name in views]
    assert [graph.layout for graph in drawn] == ["flow", "two-step", "flow"]
    assert [(graph.id, faults(graph)) for graph in drawn if faults(graph)] == []


def test_meetings_are_found() -> None:
    parts = (
        ScenePart("a", {}, 0, 0, 10, 10),
        ScenePart("b", {}, 6, 6, 10, 10, "label"),
        ScenePart("c", {}, 0, 0, 4, 4, "mark"),
    )
    assert list(overlapping_parts(Scene(parts=parts))) == [("a", "b")]


def test_a_frame_without_boxes_is_left_out() -> None:
    clusters = (Cluster("full", "Full"), Cluster("empty", "Empty"))
    graph = Graph("g", "G", "framed", (Box("a", "A", cluster="full"),), (), clusters=clusters, kind="overview")
    scene = lay_out_framed(style_graph(graph, lambda _: None))
    assert [frame.name for frame in scene.frames] == ["c0"]


def test_a_box_with_ports_shows_status_and_subject_in_its_frame() -> None:
    def head(box: Box) -> str:
        return style_box(box, lambda _: None)["label"].partition("COLOR")[0]

    plain = Box("a", "A", ports_in=(("i", "i"),))
    assert head(plain) == '<<TABLE STYLE="ROUNDED" BORDER="1" '
    assert head(replace(plain, emphasis="subject")) == '<<TABLE STYLE="ROUNDED" BORDER="2" '
    assert head(replace(plain, status="planned")) == '<<TABLE STYLE="ROUNDED,DASHED" BORDER="1" '
    assert head(replace(plain, status="adapted")) == '<<TABLE STYLE="ROUNDED,DOTTED" BORDER="1" '
    assert head(replace(plain, change="added")) == '<<TABLE STYLE="ROUNDED" BORDER="3" '


@pytest.mark.parametrize("layout", ["flow", "two-step", "overview", "framed"])
def test_the_flow_runs_the_way_that_the_project_asks_for(
    layout: Literal["flow", "two-step", "overview", "framed"],
) -> None:
    boxes = (Box("a", "The first"), Box("b", "The second"))
    graph = Graph("g", "G", layout, boxes, (Arrow("ab", "a", "b"),), kind="overview")
    for direction in ("left-right", "top-bottom"):
        drafted, scene = graph_drawing.lay_out_graph(replace(graph, direction=direction), {})
        parts = {part.name: part for part in scene.parts}
        one, two = (parts[drafted.dot_names[name]] for name in "ab")
        right, down = two.x - one.x, one.y - two.y
        onwards, aside = (right, down) if direction == "left-right" else (down, right)
        assert onwards > abs(aside) + 30, direction


def _straight_line(edge: str, y: float) -> SceneLine:
    return SceneLine(edge, edge, "a", "b", {}, f"0,{y} 30,{y} 70,{y} 100,{y}")


def test_a_label_between_two_arrows_moves_onto_its_own() -> None:
    label = ScenePart("l0", {}, 50, 6, 30, 8, "label")
    scene = Scene(lines=(_straight_line("0", 0), _straight_line("1", 12)), parts=(label,))
    (placed,) = declutter_labels(scene).parts
    assert (placed.x, placed.y) == (50, 0)


def test_a_label_keeps_off_other_arrows_where_it_can() -> None:
    crossing = SceneLine("1", "1", "a", "b", {}, "50,-40 50,-10 50,10 50,40")
    label = ScenePart("l0", {}, 50, 6, 30, 8, "label")
    (placed,) = declutter_labels(Scene(lines=(_straight_line("0", 0), crossing), parts=(label,))).parts
    assert placed.y == 0
    assert abs(placed.x - 50) > 15


def test_a_long_chain_is_wrapped_in_its_frame() -> None:
    boxes = tuple(Box(f"b{at}", f"Component {at}", cluster="g") for at in range(10))
    arrows = tuple(Arrow(f"a{at}", f"b{at}", f"b{at + 1}") for at in range(9))
    graph = Graph("components", "A", "two-step", boxes, arrows, (Cluster("g", "G"),), asked=9, kind="components")
    _, scene = graph_drawing.lay_out_graph(graph, {})
    left, bottom, right, top = scene.bounds()
    assert right - left < 3 * (top - bottom)
    places = {part.name: part for part in scene.parts}
    rows = sorted({round(part.y) for name, part in places.items() if re.fullmatch("n[0-9]", name)})
    assert len(rows) > 1
    # What leads to the next row stays above that row.
    lowest = min(y for line in scene.lines for _, y in line.curve)
    assert lowest >= min(part.rectangle[1] for part in places.values() if part.kind == "box")
    assert list(overlapping_parts(scene)) == []
