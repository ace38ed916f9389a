"""Pictures of composed components: closed in the pictures around them, open in one of their own."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen import pipeline
from archgen.diagnostics.diagnostic import Diagnostic, Severity
from archgen.diagnostics.source_span import NO_SPAN
from archgen.emit.graphviz import graph_drawing
from archgen.model.architecture import Architecture
from archgen.views import graphs
from archgen.views.graphs import draw_components, draw_composed, draw_group, make_all_graphs
from archgen.views.graphs.selection_graphs import draw_functional_part
from archgen.views.lookup import make_lookup
from archgen.views.picture_shapes import Arrow, Graph, GraphKind

ROBOT = """
archgen: 1
component_types:
  motor: {title: Motor, inputs: {target: Goal}, outputs: {state: State}}
groups:
  arms:
    components:
      arm:
        inputs: {goal: planner.goal}
        outputs: {state: {from: elbow.state}}
        components:
          shoulder: {is: motor, inputs: {target: self.goal}}
          elbow: {is: motor, inputs: {target: self.goal}}
          watch: {inputs: {a: shoulder.state, map: world.map}}
          hand:
            inputs: {goal: self.goal}
            components:
              finger: {is: motor, inputs: {target: self.goal}}
      planner: {inputs: {state: arm.state}, outputs: {goal: Goal}}
  outside:
    autoconnect: types
    components:
      world: {outputs: {map: Map}}
      reader: {inputs: {inside: arms.arm.elbow.state}}
      viewer: {inputs: {map: {type: Map}}}
"""


def read_project(tmp_path: Path, text: str) -> Architecture:
    """Return the architecture of a one-file project."""
    (tmp_path / "archgen.yaml").write_text(text)
    return pipeline.check_project(tmp_path).architecture


@pytest.fixture
def robot(tmp_path: Path) -> Architecture:
    """Return an arm with a hand inside, and what is around it."""
    return read_project(tmp_path, ROBOT)


def list_boxes(graph: Graph) -> list[str]:
    """Return the ids of a picture's boxes."""
    return [box.id for box in graph.boxes]


def list_arrows(graph: Graph) -> list[str]:
    """Return the arrows of a picture as `tail > head`, with how many flows they stand for."""
    return [f"{arrow.tail} > {arrow.head} ({arrow.count})" for arrow in graph.arrows]


def find_arrow(graph: Graph, tail: str, head: str) -> Arrow:
    """Return the arrow between two boxes."""
    return next(arrow for arrow in graph.arrows if (arrow.tail, arrow.head) == (tail, head))


def test_a_group_shows_a_composed_component_as_one_box(robot: Architecture) -> None:
    graph = draw_group(make_lookup(robot), "arms")
    assert list_boxes(graph) == ["arms.arm", "arms.planner", "<outside.world", ">outside.reader"]
    box = graph.boxes[0]
    assert (box.style, box.lines, box.ref) == ("composed", ("4 components",), "component:arms.arm")
    assert "composed" in graph.legend


def test_what_comes_through_one_port_of_a_composed_component_is_one_flow(robot: Architecture) -> None:
    graph = draw_group(make_lookup(robot), "arms")
    assert list_arrows(graph) == [
        "<outside.world > arms.arm (1)",
        "arms.arm > arms.planner (1)",
        "arms.arm > >outside.reader (1)",
        "arms.planner > arms.arm (1)",
    ]
    assert find_arrow(graph, "arms.planner", "arms.arm").flows == ("Planner · goal (Goal) → Arm · goal",)
    assert find_arrow(graph, "arms.arm", "arms.planner").flows == ("Arm · state (State) → Planner · state",)
    # Past the ports, the way inside is named.
    assert find_arrow(graph, "<outside.world", "arms.arm").flows == ("World · map (Map) → Arm · watch.map",)
    assert find_arrow(graph, "arms.arm", ">outside.reader").flows == ("Arm · elbow.state (State) → Reader · inside",)


def test_the_picture_of_everything_has_composed_components_closed(robot: Architecture) -> None:
    graph = draw_components(make_lookup(robot))
    assert list_boxes(graph) == ["arms.arm", "arms.planner", "outside.world", "outside.reader", "outside.viewer"]


def test_a_composed_component_opens_in_a_picture_of_its_own(robot: Architecture) -> None:
    graph = draw_composed(make_lookup(robot), "arms.arm")
    assert (graph.id, graph.kind, graph.clusters[0].title) == ("composed/arms.arm", "composed", "Arm")
    assert [(box.id, box.style, box.lines) for box in graph.boxes if box.cluster] == [
        ("arms.arm.shoulder", "component", ("Motor",)),
        ("arms.arm.elbow", "component", ("Motor",)),
        ("arms.arm.watch", "component", ()),
        ("arms.arm.hand", "composed", ("1 component",)),
    ]
    ports = [(box.id, box.side, box.lines) for box in graph.boxes if box.style == "port"]
    assert ports == [
        ("in goal", "left", ("Goal", "from Planner")),
        ("out state", "right", ("State", "to Planner")),
    ]


def test_its_ports_are_joined_to_what_stands_behind_them(robot: Architecture) -> None:
    graph = draw_composed(make_lookup(robot), "arms.arm")
    assert list_arrows(graph) == [
        "arms.arm.shoulder > arms.arm.watch (1)",
        "in goal > arms.arm.shoulder (1)",
        "in goal > arms.arm.elbow (1)",
        "in goal > arms.arm.hand (1)",
        "arms.arm.elbow > out state (1)",
        # Past its ports: these have boxes outside of the frame.
        "<outside.world > arms.arm.watch (1)",
        "arms.arm.elbow > >outside.reader (1)",
    ]
    assert graph.asked == sum(arrow.count for arrow in graph.arrows)


def test_the_innermost_one_names_who_is_outside_of_all(robot: Architecture) -> None:
    graph = draw_composed(make_lookup(robot), "arms.arm.hand")
    assert list_boxes(graph) == ["arms.arm.hand.finger", "in goal"]
    assert graph.boxes[1].lines == ("Goal", "from Planner")


def test_what_autoconnect_joined_is_marked(robot: Architecture) -> None:
    graph = draw_group(make_lookup(robot), "outside")
    assert find_arrow(graph, "outside.world", "outside.viewer").is_made
    assert not find_arrow(graph, "outside.world", ">arms.arm").is_made
    assert "made" in graph.legend
    assert "made" not in draw_group(make_lookup(robot), "arms").legend


def test_what_autoconnect_gives_on_is_dotted(tmp_path: Path) -> None:
    text = """
archgen: 1
groups:
  g:
    components:
      shell:
        outputs: {o: State, p: {from: leaf.p}}
        autoconnect: ports
        components: {leaf: {outputs: {o: State, p: State}}}
      reader: {inputs: {o: shell.o, p: shell.p}}
"""
    architecture = read_project(tmp_path, text)
    graph = draw_composed(make_lookup(architecture), "g.shell")
    assert find_arrow(graph, "g.shell.leaf", "out o").is_made
    assert not find_arrow(graph, "g.shell.leaf", "out p").is_made
    assert {name: port.is_made for name, port in architecture.shells["g.shell"].outputs.items()} == {
        "o": True,
        "p": False,
    }


@pytest.mark.parametrize(
    ("places", "badge"),
    [
        ({"arms.arm.hand.finger": Severity.NOTE}, ("note", 1)),
        (
            {"arms.arm.hand.finger": Severity.NOTE, "arms.arm.hand": Severity.ERROR, "arms.arm": Severity.WARNING},
            ("error", 3),
        ),
        ({"arms.arm.elbow.state": Severity.WARNING, "arms.arm.goal": Severity.NOTE}, ("warning", 2)),
        ({"arms.planner": Severity.ERROR}, (None, 0)),
    ],
)
def test_a_closed_box_has_the_badge_of_the_worst_finding_inside_and_their_number(
    robot: Architecture, places: dict[str, Severity], badge: tuple[str | None, int]
) -> None:
    findings = [Diagnostic("rule", "text", NO_SPAN, severity, element=place) for place, severity in places.items()]
    graph = draw_group(make_lookup(robot, findings), "arms")
    box = next(box for box in graph.boxes if box.id == "arms.arm")
    assert (box.badge, box.badge_count) == badge


def test_a_counted_badge_says_how_many_findings_are_inside(robot: Architecture) -> None:
    findings = [
        Diagnostic("rule", "text", NO_SPAN, Severity.WARNING, element=name)
        for name in ("arms.arm.elbow", "arms.arm.watch", "arms.planner")
    ]
    graph = draw_group(make_lookup(robot, findings), "arms")
    text = (graph_drawing.draw_picture(graph, {}, ("svg",)).svg or b"").decode()
    assert "2 findings inside, the worst is: warning" in text
    assert ">W 2</text>" in text
    assert "badge:inside" in graph.legend
    assert ">W</text>" in text


def test_a_part_opens_what_is_selected_in_part(robot: Architecture) -> None:
    lookup = make_lookup(robot)
    part = draw_functional_part(lookup, "x", "Part", {"arms.arm.elbow", "arms.arm.hand.finger"})
    assert list_boxes(part) == ["arms.arm.elbow", "arms.arm.hand", "arms.planner", "outside.reader"]
    whole = draw_functional_part(lookup, "x", "Whole", set(robot.leaves_of("arms.arm")))
    assert list_boxes(whole) == ["arms.arm", "outside.world", "arms.planner", "outside.reader"]


def test_a_port_that_nothing_inside_carries_stays_a_port(tmp_path: Path) -> None:
    text = """
archgen: 1
groups:
  g:
    components:
      source: {outputs: {a: Goal}}
      shell: {inputs: {a: source.a, b: source.a}, outputs: {o: State}, components: {leaf: {inputs: {a: self.a}}}}
      reader: {inputs: {o: shell.o}}
"""
    lookup = make_lookup(read_project(tmp_path, text))
    assert list_boxes(draw_group(lookup, "g")) == ["g.source", "g.shell", "g.reader"]
    assert sorted(list_arrows(draw_group(lookup, "g"))) == ["g.shell > g.reader (1)", "g.source > g.shell (2)"]
    graph = draw_composed(lookup, "g.shell")
    assert list_boxes(graph) == ["g.shell.leaf", "in a", "in b", "out o"]
    assert list_arrows(graph) == ["in a > g.shell.leaf (1)"]


def test_what_is_given_on_as_it_came_runs_from_port_to_port(tmp_path: Path) -> None:
    text = """
archgen: 1
groups:
  g:
    components:
      source: {outputs: {a: Goal}}
      shell: {inputs: {a: source.a}, outputs: {o: {from: self.a}}, components: {leaf: {inputs: {a: self.a}}}}
      reader: {inputs: {o: shell.o}}
"""
    lookup = make_lookup(read_project(tmp_path, text))
    assert sorted(list_arrows(draw_group(lookup, "g"))) == ["g.shell > g.reader (1)", "g.source > g.shell (1)"]
    assert sorted(list_arrows(draw_composed(lookup, "g.shell"))) == ["in a > g.shell.leaf (1)", "in a > out o (1)"]


def test_there_is_a_picture_for_each_composed_component(robot: Architecture) -> None:
    ids = {graph.id for graph in make_all_graphs(robot)}
    assert {"composed/arms.arm", "composed/arms.arm.hand", "components/arms.arm.elbow"} <= ids
    assert "components/arms.arm" not in ids


@pytest.mark.parametrize("shell", ["arms.arm", "arms.arm.hand"])
def test_ports_stand_on_the_line_of_the_frame(robot: Architecture, shell: str) -> None:
    graph = draw_composed(make_lookup(robot), shell)
    styled_graph, scene = graph_drawing.lay_out_graph(graph, {})
    left, _, right, _ = scene.frames[0].rectangle
    sides = {"left": left, "right": right}
    places = {part.name: part for part in scene.parts}
    for box in graph.boxes:
        part = places[styled_graph.dot_names[box.id]]
        if box.style == "port":
            assert part.x == pytest.approx(sides[box.side or ""])
        elif box.side:
            assert part.rectangle[2] < left or part.rectangle[0] > right
        else:
            assert left < part.rectangle[0] < part.rectangle[2] < right


def test_very_many_composed_components_have_pictures_only_where_single_ones_have(
    robot: Architecture, monkeypatch: pytest.MonkeyPatch
) -> None:
    def list_composed(*, draws_components: bool) -> list[str]:
        undrawn = frozenset[GraphKind]() if draws_components else frozenset[GraphKind]({"component"})
        pictures = make_all_graphs(robot, undrawn_kinds=undrawn)
        return [graph.id for graph in pictures if graph.kind == "composed"]

    assert list_composed(draws_components=False) == ["composed/arms.arm", "composed/arms.arm.hand"]
    monkeypatch.setattr(graphs, "MAX_COMPOSED_PICTURES", 1)
    assert list_composed(draws_components=False) == []
    assert len(list_composed(draws_components=True)) == 2
