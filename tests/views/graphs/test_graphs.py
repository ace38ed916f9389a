"""The graphs of an architecture: which there are, and what each shows."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from archgen import pipeline
from archgen.diagnostics.diagnostic import Diagnostic, Severity
from archgen.diagnostics.source_span import NO_SPAN
from archgen.model.architecture import Architecture, PortEdge, ProjectInfo, View
from archgen.model.component import Component, Connection, DiagramLayout, Group, Input, Output
from archgen.model.deployment import Container, Host, Link
from archgen.model.message_types import ConceptualType
from archgen.model.node import Endpoint, Node, Qos
from archgen.model.selector_evaluation import Selection
from archgen.views.graphs import (
    draw_component,
    draw_components,
    draw_group,
    draw_hosts,
    draw_implementation,
    draw_overview,
    draw_ros_graph,
    make_all_graphs,
)
from archgen.views.graphs.graph_folding import MAX_ARROWS, MAX_BOXES, fold_graph
from archgen.views.graphs.selection_graphs import draw_functional_part, draw_implementation_part
from archgen.views.lookup import Lookup, make_lookup
from archgen.views.picture_shapes import Arrow, Box, Cluster, Graph
from archgen.views.search import make_host_entries
from archgen.views.tables.deployment_tables import make_link_table
from archgen.views.timing.timing_lookup import analyse_with_chains
from tests.architectures import generated, robot, topics
from tests.timings import timed


def make(groups: str, wires: str, types: str = "") -> Architecture:
    """Build an architecture from `g: a b, h: c`, `g.a.x > h.c.y` and `Type of x = pkg/srv/Name`."""
    parts = {name.strip(): members.split() for name, members in (each.split(":") for each in groups.split(","))}
    pairs = [tuple(end.strip() for end in wire.split(">")) for wire in wires.split("|") if wire.strip()]
    inputs: dict[str, Input] = {}
    outputs: dict[str, Output] = {}
    for name, _ in pairs:
        if name.count(".") == 2:
            outputs[name] = Output(name, name.split(".")[2], name.rsplit(".", 1)[0], type=f"T {name.split('.')[2]}")
    for source, target in pairs:
        carried = tuple(name for name in outputs if name == source or name.startswith(f"{source}."))
        kind = ("group", "component", "output")[source.count(".")]
        connection = Connection(target, source, kind, source, carried)  # type: ignore[arg-type]
        known = inputs.get(target, Input(target, target.split(".")[2], target.rsplit(".", 1)[0]))
        inputs[target] = replace(known, connections=(*known.connections, connection))
    made = {
        f"{g}.{c}": Component(
            f"{g}.{c}",
            c,
            g,
            c.capitalize(),
            inputs={port.name: port for port in inputs.values() if port.component == f"{g}.{c}"},
            outputs={port.name: port for port in outputs.values() if port.component == f"{g}.{c}"},
        )
        for g, members in parts.items()
        for c in members
    }
    mapped = dict(each.split(" = ") for each in types.split("|") if each)
    connections = tuple(one for port in inputs.values() for one in port.connections)
    return Architecture(
        ProjectInfo("p", "Project"),
        groups={
            g: Group(g, g.capitalize(), components={c: made[f"{g}.{c}"] for c in members})
            for g, members in parts.items()
        },
        components=made,
        inputs=inputs,
        outputs=outputs,
        connections=connections,
        edges=tuple(PortEdge(output, one.input) for one in connections for output in one.outputs),
        types={name: ConceptualType(name, message) for name, message in mapped.items()},
    )


def text(graph: Graph) -> list[str]:
    """Write a graph's arrows as `tail > head: label [style] (count)`."""
    return [
        f"{a.tail} > {a.head}"
        + (f": {a.label}" if a.label else "")
        + (f" [{a.style}]" if a.style != "data" else "")
        + (f" ({a.count})" if a.count > 1 else "")
        for a in graph.arrows
    ]


SMALL = make("g: a b, h: c d", "g.a.x > g.b.i | g.a.x > h.c.i | g.b.y > h.c.j | h.c.z > g.a.k | g > h.d.all")


def view(architecture: Architecture = SMALL) -> Lookup:
    return make_lookup(architecture)


def test_the_ids_of_all_graphs() -> None:
    assert [graph.id for graph in make_all_graphs(SMALL)] == [
        "overview",
        "overview_upright",
        "components",
        "groups/g",
        "groups/h",
        "components/g.a",
        "components/g.b",
        "components/h.c",
        "components/h.d",
    ]


def test_overview_counts_connections_between_groups() -> None:
    graph = draw_overview(view())
    assert text(graph) == ["g > h (3)", "h > g"]
    assert graph.asked == 4
    assert graph.alt == "2 groups of components. Most runs from G to H (3); H to G (1)."


def test_components_draws_inside_one_by_one_and_between_merged() -> None:
    graph = draw_components(view())
    assert text(graph) == ["g.a > g.b", "g > h (3)", "h > g"]
    assert graph.arrows[1].flows == (
        "A · x (T x) → C · i",
        "B · y (T y) → C · j",
        "A · x (T x) → D · all",
    )


def test_a_group_has_neighbours_left_and_right() -> None:
    graph = draw_group(view(), "g")
    assert text(graph) == [
        "g.a > g.b: T x",
        "g.a > >h.c: T x",
        "g.b > >h.c: T y",
        "<h.c > g.a: T z",
        "g.a > >h.d: T x",
        "g.b > >h.d: T y",
    ]
    sides = {box.id: (box.side, box.emphasis) for box in graph.boxes}
    assert sides["<h.c"] == ("left", "neighbour")
    assert sides[">h.c"] == ("right", "neighbour")
    assert sides["g.a"] == (None, "normal")
    assert graph.alt == "G with 2 components and 1 flow among them. It is fed by H. It is read by H."


def test_many_flows_fold_the_neighbours() -> None:
    wires = "|".join(f"h.c{at}.x > g.a.i{at}" for at in range(46))
    graph = draw_group(make_lookup(make("g: a, h: " + " ".join(f"c{at}" for at in range(46)), wires)), "g")
    assert text(graph) == ["<h > g.a: 46 (46)"]
    assert graph.boxes[1].lines == ("C0", "C1", "C2", "C3", "C4", "and 41 more")
    assert graph.notes == ("Neighbours are folded: a box for each group, with the number of flows.",)


def test_a_component_has_its_ports() -> None:
    graph = draw_component(view(), "h.c")
    assert graph.boxes[0].ports_in == (("in i", "i"), ("in j", "j"))
    assert graph.boxes[0].ports_out == (("out z", "z"),)
    assert text(graph) == ["<g.a > h.c: T x", "<g.b > h.c: T y", "h.c > >g.a: T z"]
    assert [(arrow.tail_port, arrow.head_port) for arrow in graph.arrows] == [
        (None, "in i"),
        (None, "in j"),
        ("out z", None),
    ]


def test_a_whole_group_as_source_has_an_asterisk() -> None:
    graph = draw_component(view(), "h.d")
    assert text(graph) == ["<g > h.d: * all of these"]
    assert graph.boxes[1].lines == ("whole group", "T x", "T y")
    assert "star" in graph.legend


def test_one_type_is_written_once_for_an_output() -> None:
    architecture = make("g: a b c", "g.a.x > g.b.i | g.a.x > g.c.i")
    assert text(draw_component(view(architecture), "g.a")) == ["g.a > >g.b: T x", "g.a > >g.c"]


def test_of_hundreds_of_ports_there_is_one_arrow_to_each_neighbour() -> None:
    wires = [f"g.a.x{at} > {'g.b' if at % 3 else 'h.c'}.i{at}" for at in range(90)]
    graph = draw_component(view(make("g: a b, h: c", " | ".join(wires))), "g.a")
    assert text(graph) == ["g.a > >h.c: 30 flows (30)", "g.a > >g.b: 60 flows (60)"]
    assert (graph.boxes[0].ports_out, graph.boxes[0].lines[-1]) == ((), "90 outputs")
    assert graph.asked == 90


@pytest.mark.parametrize("kind", ["srv", "action"])
def test_services_and_actions_run_from_client_to_server(kind: str) -> None:
    style = {"srv": "service", "action": "action"}[kind]
    architecture = make("g: server client", "g.server.ask > g.client.call", f"T ask = pkg/{kind}/Ask")
    assert text(draw_components(view(architecture))) == [f"g.client > g.server [{style}]"]
    client, server = (draw_component(view(architecture), name) for name in ("g.client", "g.server"))
    assert text(client) == [f"g.client > >g.server: T ask [{style}]"]
    assert text(server) == [f"<g.client > g.server: T ask [{style}]"]
    # The caller is at the left and the server at the right, ports included.
    assert (client.boxes[0].ports_in, client.boxes[0].ports_out) == ((), (("in call", "call"),))
    assert (server.boxes[0].ports_in, server.boxes[0].ports_out) == ((("out ask", "ask"),), ())
    assert [box.side for graph in (client, server) for box in graph.boxes[1:]] == ["right", "left"]


def test_partners_outside_are_dashed() -> None:
    port = Input("g.a.voice", "voice", "g.a", external="The user speaks", medium="physical", type="Speech")
    architecture = make("g: a", "")
    changed = replace(architecture.components["g.a"], inputs={"voice": port})
    graph = draw_component(view(replace(architecture, components={"g.a": changed})), "g.a")
    assert text(graph) == ["external left g.a.voice > g.a: Speech [physical]"]
    assert (graph.boxes[1].title, graph.boxes[1].style, graph.boxes[1].side) == ("The user speaks", "physical", "left")


def low(*uses: tuple[str, str, str], **qos: Qos) -> Architecture:
    """Build a low level from (node, use, topic); node `n_a` implements `g.a`."""
    architecture = make("g: a b c", "")
    names = dict.fromkeys(node for node, _, _ in uses)
    flows = {"serves": "service", "calls": "service"}
    points = tuple(
        Endpoint(node, use, topic, flows.get(use, "topic"), None, None, "pkg/msg/M", qos=qos.get(topic[1:], Qos()))  # type: ignore[arg-type]
        for node, use, topic in uses
    )
    nodes = {name: Node(name, name, (f"g.{name[2:]}",), name=name) for name in names}
    return replace(architecture, nodes=nodes, endpoints=points, topics=topics(points))


def test_implementation_puts_topics_between_nodes() -> None:
    architecture = low(
        ("n_a", "publishes", "/x"),
        ("n_b", "subscribes", "/x"),
        ("n_b", "publishes", "/y"),
        ("n_c", "subscribes", "/y"),
        ("n_b", "calls", "/ask"),
        ("n_c", "serves", "/ask"),
        x=Qos(reliability="best_effort", durability="transient_local", written=True),
    )
    graph = draw_implementation(view(architecture), "g.b")
    assert text(graph) == [
        "<n_a > topic /x",
        "topic /x > n_b",
        "n_b > topic /y",
        "topic /y > >n_c",
        "n_b > topic /ask [service]",
        "topic /ask > >n_c [service]",
    ]
    boxes = {box.id: box for box in graph.boxes}
    assert boxes["topic /x"].lines == ("pkg/msg/M", "best effort, latched")
    assert boxes["topic /ask"].style == "service"
    assert boxes["n_b"].emphasis == "subject"


def test_implementation_looks_at_the_topics_of_its_nodes_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    lookup = view(low(("n_a", "publishes", "/x"), ("n_b", "subscribes", "/x")))
    monkeypatch.delattr(Architecture, "list_carriers")  # such a picture is drawn for each of 10,000 components
    assert text(draw_implementation(lookup, "g.b")) == ["<n_a > topic /x", "topic /x > n_b"]


def test_implementation_folds_a_neighbour_all_of_whose_topics_are_taken() -> None:
    uses = [("n_a", "publishes", f"/x{at}") for at in range(3)] + [("n_b", "subscribes", f"/x{at}") for at in range(3)]
    graph = draw_implementation(view(low(*uses)), "g.b")
    assert text(graph) == ["<n_a > topic * n_a", "topic * n_a > n_b"]
    assert graph.boxes[1].title == "* all topics of n_a"
    assert graph.boxes[1].lines == ("/x0", "/x1", "/x2")
    assert "star" in graph.legend


def test_implementation_draws_each_topic_where_one_is_not_taken() -> None:
    uses = [("n_a", "publishes", f"/x{at}") for at in range(4)] + [("n_b", "subscribes", f"/x{at}") for at in range(3)]
    assert len(draw_implementation(view(low(*uses)), "g.b").arrows) == 6


def test_of_hundreds_of_topics_those_of_the_same_nodes_are_one_box() -> None:
    uses = [(node, use, f"/x{at}") for at in range(90) for node, use in (("n_b", "publishes"), ("n_c", "subscribes"))]
    graph = draw_implementation(view(low(*uses)), "g.b")
    assert text(graph) == ["n_b > topic + /x0", "topic + /x0 > >n_c"]
    assert (graph.boxes[1].title, graph.boxes[1].lines[-1]) == ("90 topics", "and 83 more")
    assert "star" not in graph.legend


def test_ros_frames_nodes_by_group() -> None:
    architecture = low(("n_a", "publishes", "/x"), ("n_b", "subscribes", "/x"), ("n_a", "publishes", "/x"))
    alone = Node("alone", "Alone", namespace="/tools")
    graph = draw_ros_graph(view(replace(architecture, nodes={**architecture.nodes, "alone": alone})))
    assert text(graph) == ["n_a > n_b"]
    assert [(box.id, box.cluster) for box in graph.boxes] == [
        ("n_a", "g"),
        ("n_b", "g"),
        ("alone", "namespace /tools"),
    ]


def test_hosts_have_containers_nodes_and_links() -> None:
    nodes = {
        "a": Node("a", "A", host="pc"),
        "b": Node("b", "B", host="pc", container="box"),
        "c": Node("c", "C"),
    }
    architecture = replace(
        make("g: a", ""),
        nodes=nodes,
        hosts={name: Host(name, name.upper(), 4) for name in ("pc", "arm", "eye")},
        containers={"box": Container("box", "Box", "pc", 1)},
        links={"can": Link("can", "CAN", ("pc", "arm")), "lan": Link("lan", "LAN", ("pc", "arm", "eye"))},
    )
    graph = draw_hosts(view(architecture))
    assert text(graph) == [
        "host pc > host arm: CAN [link]",
        "link lan > host pc [link]",
        "link lan > host arm [link]",
        "link lan > host eye [link]",
    ]
    own = "Nodes with a process of their own"
    assert [(box.id, box.lines, box.rows) for box in graph.boxes] == [
        ("host pc", ("4 cores, 2 nodes",), (("Box (1 thread)", ""), ("b", "\u2013"), (own, ""), ("a", "\u2013"))),
        ("host arm", ("4 cores, 0 nodes",), ()),
        ("host eye", ("4 cores, 0 nodes",), ()),
        ("no host", (), ()),
        ("link lan", (), ()),
    ]


def test_a_link_names_its_protocol_and_its_devices() -> None:
    names = ["eye", "arm", "leg", "hand", "head"]
    bus = Link("bus", "Bus", ("pc",), devices=("g.eye",), protocol="canopen")
    architecture = replace(
        make(f"g: {' '.join(names)}", ""),
        hosts={name: Host(name, name.upper()) for name in ("pc", "plc")},
        links={
            "bus": bus,
            "far": replace(bus, id="far", connects=()),
            "full": Link("full", "Full", ("pc", "plc"), devices=tuple(f"g.{name}" for name in names)),
            "lan": Link("lan", "LAN", ("pc", "plc"), protocol="ethercat"),
        },
    )
    graph = draw_hosts(view(architecture))
    assert text(graph) == [
        "link bus > host pc [link]",
        "link full > host pc [link]",
        "link full > host plc [link]",
        "host pc > host plc: LAN\nEtherCAT [link]",
    ]
    assert [(box.id, box.lines) for box in graph.boxes if box.style == "link"] == [
        ("link bus", ("CANopen", "Eye")),
        ("link full", ("5 devices",)),
    ]
    table = make_link_table(view(architecture))
    assert table is not None
    assert table.caption == "Links between hosts and devices"
    assert [column.title for column in table.columns] == ["Link", "Connects", "Protocol", "Bandwidth", "Latency"]
    assert [["".join(part.text for part in cell) for cell in row[1:3]] for row in table.rows] == [
        ["PC, Eye", "CANopen"],
        ["Eye", "CANopen"],
        ["PC, PLC, Eye, Arm, Leg, Hand, Head", ""],
        ["PC, PLC", "EtherCAT"],
    ]
    lines = [entry.line for entry in make_host_entries(view(architecture)) if entry.kind == "link"]
    assert lines[:2] == ["link · CANopen · pc, g.eye", "link · CANopen · g.eye"]


LOADED = """\
archgen: 1
hosts: {pc: {cores: 2}, spare: {cores: 1}}
groups: {g: {components: {a: {outputs: {x: std_msgs/msg/Empty}, timing: {rate: 10 Hz, wcet: 50 ms}}}}}
nodes: {n_a: {implements: a, host: pc}}
"""


def test_a_host_has_a_bar_of_its_load(tmp_path: Path) -> None:
    (tmp_path / "robot.yaml").write_text(LOADED)
    architecture = pipeline.check_project(tmp_path / "robot.yaml").architecture
    graph = draw_hosts(replace(view(architecture), timing=analyse_with_chains(architecture)))
    assert [(box.id, box.load, box.rows) for box in graph.boxes] == [
        ("host pc", (25.0, "load 25 %"), (("n_a", "10 Hz, up to 50 ms"),)),
        ("host spare", None, ()),
    ]


def test_findings_are_badges() -> None:
    found = [
        Diagnostic(rule, "text", NO_SPAN, severity, element="g.a")
        for rule, severity in (("one", Severity.NOTE), ("two", Severity.ERROR))
    ]
    badges = {box.id: box.badge for graph in make_all_graphs(SMALL, findings=found)[2:3] for box in graph.boxes}
    assert badges == {"g.a": "error", "g.b": None, "h.c": None, "h.d": None}


def test_a_selection_has_grey_neighbours() -> None:
    graph = draw_functional_part(view(), "overview", "Part", {"g.b"})
    assert text(graph) == ["g.a > g.b: T x", "g.b > h.c: T y", "g.b > h.d: T y"]
    assert [(box.id, box.emphasis) for box in graph.boxes] == [
        ("g.b", "normal"),
        ("g.a", "neighbour"),
        ("h.c", "neighbour"),
        ("h.d", "neighbour"),
    ]


def test_the_graphs_of_a_selection() -> None:
    chosen = Selection(frozenset({"g.b"}), frozenset())
    assert [graph.id for graph in make_all_graphs(SMALL, chosen)] == ["overview", "groups/g", "components/g.b"]


def test_a_large_selection_has_frames_and_folded_neighbours() -> None:
    architecture = robot(1)
    chosen = {name for name in architecture.components if name.startswith(("human_state.", "robot_action_planner."))}
    graph = draw_functional_part(make_lookup(architecture), "views/x", "X", chosen)
    assert graph.layout == "two-step"
    assert [cluster.id for cluster in graph.clusters] == ["human_state", "robot_action_planner"]
    assert all(box.cluster for box in graph.boxes if box.emphasis == "normal")
    grey = {box.id for box in graph.boxes if box.emphasis == "neighbour"}
    assert {"around sensors_and_user_input", "around robot_state"} <= grey
    assert sum(arrow.count for arrow in graph.arrows) == graph.asked


def test_views_choose_level_colour_and_direction() -> None:
    owned = {name: replace(each, owner=f"p{at}") for at, (name, each) in enumerate(SMALL.components.items())}
    asked = View("v", "V", "g", colour="owner", layout=DiagramLayout("top-bottom"))
    graph = make_all_graphs(replace(SMALL, components=owned, views={"v": asked}))[-1]
    assert (graph.id, graph.direction) == ("views/v", "top-bottom")
    assert graph.legend_colours == ((0, "owner: p0"), (1, "owner: p1"))
    assert [box.colour for box in graph.boxes if box.emphasis == "normal"] == [0, 1]


def test_above_the_budget_each_group_is_a_list_of_its_components() -> None:
    architecture = generated(3, 8, 20, 150)
    whole = draw_components(make_lookup(architecture))
    assert len(whole.boxes) > MAX_BOXES
    graph = fold_graph(whole)
    assert len(graph.boxes) <= MAX_BOXES
    assert len(graph.arrows) <= MAX_ARROWS
    folded = [box for box in graph.boxes if box.style == "fold"]
    assert [box.title for box in folded] == [cluster.title for cluster in whole.clusters]
    for box in folded:
        inside = [each.title for each in whole.boxes if each.cluster == box.id]
        assert box.lines[0].startswith(f"{len(inside)} inside")
        assert " · ".join(box.lines[1:]) == " · ".join(inside)
    hidden = whole.asked - graph.asked
    said = "Each group is one box that lists what is in it, because the picture would be larger than 70 boxes and 160 arrows; "
    assert graph.notes == (said + f"{hidden} flows inside not drawn.",)


def test_a_long_list_ends_with_how_many_more_there_are() -> None:
    boxes = tuple(Box(f"b{at}", f"A box of number {at:02}", cluster="big") for at in range(72))
    (box,) = fold_graph(Graph("x", "X", "two-step", boxes, (), (Cluster("big", "Big"),), kind="ros")).boxes
    assert box.lines[:2] == ("72 inside", "A box of number 00 · A box of number 01")
    assert box.lines[13:] == ("A box of number 24 · A box of number 25", "and 46 more")


def test_what_a_picture_is_about_stays_open_where_its_neighbours_fold() -> None:
    boxes = tuple(Box(f"b{at}", "B", cluster="own" if at < 60 else f"other{at % 2}") for at in range(80))
    frames = (
        Cluster("own", "Own"),
        Cluster("other0", "O", emphasis="neighbour"),
        Cluster("other1", "P", emphasis="neighbour"),
    )
    graph = fold_graph(Graph("x", "X", "two-step", boxes, (), frames, kind="view"))
    assert [box.id for box in graph.boxes if box.style == "fold"] == ["other0", "other1"]
    assert graph.notes[0].startswith("Each group of neighbours is one box that lists what is in it, ")


def test_what_cannot_be_folded_says_so() -> None:
    boxes = tuple(Box(f"b{at}", "B") for at in range(71))
    assert fold_graph(Graph("x", "X", "flow", boxes, (), kind="ros")).notes == (
        "This picture is larger than 70 boxes and 160 arrows: select a part to see it well.",
    )


def test_folding_merges_what_runs_between_frames() -> None:
    boxes = tuple(Box(f"b{at}", "B", cluster="big" if at < 70 else "small") for at in range(72))
    arrows = (Arrow("1", "b0", "b1"), Arrow("2", "b1", "b71"), Arrow("3", "b2", "b71"), Arrow("4", "b70", "b71"))
    graph = fold_graph(
        Graph(
            "x", "X", "two-step", boxes, arrows, (Cluster("big", "Big"), Cluster("small", "Small")), asked=4, kind="ros"
        )
    )
    assert [box.id for box in graph.boxes] == ["big", "small"]
    assert text(graph) == ["big > small (2)"]
    assert graph.boxes[0].lines[0] == "70 inside, 1 flow among them"


def test_what_feeds_a_component_is_named_by_its_title() -> None:
    view = make_lookup(make("g: a b", "g.a.x > g.b.y"))
    assert [arrow.flows for arrow in draw_component(view, "g.b").arrows] == [("A · x → y",)]


def test_an_arrow_at_a_shared_topic_names_all_its_flows() -> None:
    lookup = make_lookup(low(("a", "publishes", "/t"), ("b", "subscribes", "/t"), ("c", "subscribes", "/t")))
    graph = draw_implementation_part(lookup, "views/v", "V", frozenset({"a", "b", "c"}))
    flows = {arrow.id: arrow.flows for arrow in graph.arrows}
    assert len(flows["a>topic /t"]) == 2
    assert len(flows["topic /t>b"]) == 1


def test_every_graph_says_what_it_shows() -> None:
    views = {
        "parts": View("parts", "Parts", "*", level="functional"),
        "code": View("code", "Code", "*", level="implementation"),
    }
    graphs = make_all_graphs(replace(robot(), views=views))
    assert {(graph.id.partition("/")[0], "/" in graph.id, graph.kind) for graph in graphs} == {
        ("overview", False, "overview"),
        ("overview_upright", False, "overview"),
        ("components", False, "components"),
        ("groups", True, "group"),
        ("components", True, "component"),
        ("implementation", True, "implementation"),
        ("ros", False, "ros"),
        ("views", True, "view"),
    }


ONE_TURNED_BACK = """\
archgen: 1
layout: {direction: top-bottom}
hosts: {pc: {cores: 2}}
groups:
  g: {components: {a: {outputs: {o: std_msgs/msg/Empty}, timing: {rate: 1 Hz, wcet: 1 ms}}}}
  h:
    layout: {direction: left-right}
    components: {b: {inputs: {i: a.o}}, c: {inputs: {i: a.o}, layout: {direction: left-right}}}
nodes: {a: {implements: a, host: pc}, b: {implements: b, host: pc}, c: {implements: c, host: pc}}
views: {v: {show: g}, w: {show: g, layout: {direction: left-right}}}
"""


def test_every_picture_runs_as_the_project_says_unless_its_element_says_otherwise(tmp_path: Path) -> None:
    (tmp_path / "robot.yaml").write_text(ONE_TURNED_BACK)
    architecture = pipeline.check_project(tmp_path / "robot.yaml").architecture
    graphs = make_all_graphs(architecture, timed=timed(architecture))
    assert {graph.kind for graph in graphs} >= {
        *("overview", "components", "group", "component", "implementation", "ros", "timing", "view"),
    }
    assert [graph.id for graph in graphs if graph.direction != "top-bottom"] == [
        *("groups/h", "components/h.c", "implementation/h.c", "timing/h", "views/w"),
    ]
