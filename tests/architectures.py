"""Architectures made by a seeded generator, for tests and benchmarks that need more than a few components by hand.

`robot()` has the shape of the case study: 10 groups, 61 components, the largest of 21, 138 connections (58 inside
groups), a node for each component, endpoints and topics. `generated()` takes any shape. The wiring is invented.
"""

from __future__ import annotations

import random
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace

from archgen.model.architecture import Architecture, Partner, PortEdge, ProjectInfo
from archgen.model.component import Component, Connection, Group, Input, Output
from archgen.model.deployment import Container, Host, Link
from archgen.model.message_types import ConceptualType, flow_of
from archgen.model.node import Endpoint, Node, Topic
from archgen.model.quantity import parse_quantity

ROBOT: Mapping[str, tuple[str, ...]] = {
    "Sensors and User Input": [
        "RGB-D Head Camera",
        "RGB-D Hand Camera",
        "Front Laser Scanner",
        "Rear Laser Scanner",
        "Microphone Array",
        "Touch Display Input",
        "Wheel and Joint Encoders",
        "Smart Home Sensors",
    ],  # type: ignore[dict-item]
    "Robot State": ("Localisation", "Arm State Estimator", "Hand Tactile Monitor", "Battery and Fault Monitor"),
    "Environment State": (
        "Object Recognition",
        "Object Pose Tracking",
        "Appliance State Monitor",
        "Obstacle Detection",
        "Door and Light Detector",
    ),
    "Environment Model": ("Metric Map", "Semantic Map", "Object Memory", "Furniture Registry"),
    "Human State": (
        "Skeleton Tracking",
        "Face Identification",
        "Activity Recognition",
        "Affect Estimator",
        "Speech Recognition",
        "Fall Detector",
    ),
    "Human Model": ("Daily Routine Model", "Preference Store", "Virtual User Model", "Cognitive Skills Profile"),
    "Cognitive Reasoning": (
        "Situation Assessment",
        "Assistance Decision",
        "Risk Estimator",
        "Dialogue Intent Reasoner",
    ),
    "Robot Task Scheduler": ("Task Sequencer", "Resource Arbiter"),
    "Communication Planner": ("Dialogue Manager", "Speech Synthesis", "Projector and Display Presenter"),
    "Robot Action Planner": (
        "Global Path Planner",
        "Human-aware Local Planner",
        "Base Controller",
        "Docking Behaviour",
        "Grasp Planner",
        "Grasp Quality Check",
        "Arm Motion Planner",
        "Arm Trajectory Follower",
        "Hand Synergy Controller",
        "Hand Force Controller",
        "Elevation Controller",
        "Handover Planner",
        "Handover Monitor",
        "Placing Planner",
        "Appliance Manipulation",
        "Gaze Controller",
        "Speed and Separation Monitor",
        "Collision Checker",
        "Emergency Stop Handler",
        "Action Monitor",
        "Recovery Behaviours",
    ),
}
_PAIRS = (
    "0>1 5|0>2 6|0>4 7|0>3 1|1>2 3|1>3 2|1>9 5|2>3 6|2>4 2|3>2 1|3>9 5|3>6 2|4>5 4|4>6 4|4>9 3|5>6 5|5>8 2|6>7 3|"
    "6>8 3|7>8 1|7>9 5|8>6 1|9>7 3|9>1 1"
)
"""Connections between groups of the robot: 80 on 24 pairs, feedback included."""
_INSIDE = (0, 4, 5, 3, 7, 4, 5, 1, 2, 27)
_MESSAGES = (
    "sensor_msgs/msg/Image",
    "sensor_msgs/msg/PointCloud2",
    "geometry_msgs/msg/PoseStamped",
    "nav_msgs/msg/OccupancyGrid",
    "vision_msgs/msg/Detection3DArray",
    "std_srvs/srv/Trigger",
    "std_msgs/msg/String",
    "control_msgs/action/FollowJointTrajectory",
    None,
)


def robot(seed: int = 1) -> Architecture:
    """Make an architecture of the case study's shape."""
    chooser = random.Random(seed)  # noqa: S311 - a test's dice
    groups = [(slug(title), title, tuple(components)) for title, components in ROBOT.items()]
    wires = _robot_wires(chooser, [len(components) for _, _, components in groups])
    return assemble(groups, wires, chooser)


def generated(seed: int, groups: int, components: int, connections: int) -> Architecture:
    """Make an architecture with so many groups, at most so many components in each, and so many connections."""
    chooser = random.Random(seed)  # noqa: S311 - a test's dice
    made = []
    for at in range(groups):
        titles = [_title(chooser, at, each) for each in range(chooser.randint(1, components))]
        made.append((f"group_{at}", f"Group {at} {chooser.choice(_NOUNS)}", tuple(titles)))
    everyone = [(at, each) for at, (_, _, titles) in enumerate(made) for each in range(len(titles))]
    wires = set[tuple[tuple[int, int], tuple[int, int]]]()
    for _ in range(connections * 4):
        tail = chooser.choice(everyone)
        near = [one for one in everyone if one[0] == tail[0]] if chooser.random() < 0.4 else everyone
        head = chooser.choice(near)
        if tail != head and len(wires) < connections:
            wires.add((tail, head))
    return assemble(made, sorted(wires), chooser)


_NOUNS = [
    "perception",
    "planning",
    "control of the left and the right arm",
    "models",
    "safety",
    "speech",
    "driving",
    "memory",
]
_WORDS = [
    "Fast",
    "Object",
    "Human",
    "Scene",
    "Long-term",
    "Grasp",
    "Map",
    "Person",
    "Trajectory",
    "Audio",
    "Collision-free",
    "Force",
]
_TASKS = [
    "Tracker",
    "Estimator",
    "Planner",
    "Monitor",
    "Recognition",
    "Store",
    "Controller",
    "Arbiter",
    "Interface and Display",
]


def _title(chooser: random.Random, group: int, at: int) -> str:
    return f"{chooser.choice(_WORDS)} {chooser.choice(_TASKS)} {group}.{at}"


def _robot_wires(chooser: random.Random, sizes: Sequence[int]) -> list[tuple[tuple[int, int], tuple[int, int]]]:
    wires = set[tuple[tuple[int, int], tuple[int, int]]]()
    for pair in _PAIRS.split("|"):
        ends, count = pair.split(" ")
        tail, head = (int(end) for end in ends.split(">"))
        while sum(w[0][0] == tail and w[1][0] == head for w in wires) < int(count):
            wires.add(((tail, chooser.randrange(sizes[tail])), (head, chooser.randrange(sizes[head]))))
    for group, inside in enumerate(_INSIDE):
        while sum(w[0][0] == group == w[1][0] for w in wires) < inside:
            one, other = chooser.sample(range(sizes[group]), 2)
            forward = chooser.random() < 0.9
            first, last = sorted((one, other), reverse=not forward)
            wires.add(((group, first), (group, last)))
    return sorted(wires)


def slug(title: str) -> str:
    """Make an id from a title."""
    return "_".join("".join(c if c.isalnum() else " " for c in title.lower()).split())


def assemble(
    groups: Sequence[tuple[str, str, Sequence[str]]],
    wires: Iterable[tuple[tuple[int, int], tuple[int, int]]],
    chooser: random.Random,
) -> Architecture:
    """Build the model from groups (id, title, components' titles) and wires between (group, component) indices."""
    names = [[f"{slug(title)}" for title in titles] for _, _, titles in groups]
    ids = {(g, c): f"{groups[g][0]}.{name}" for g, row in enumerate(names) for c, name in enumerate(row)}
    titles = {ids[g, c]: title for g, (_, _, row) in enumerate(groups) for c, title in enumerate(row)}
    outputs = {each: _outputs(each, titles[each], chooser) for each in ids.values()}
    inputs: dict[str, dict[str, Input]] = {each: {} for each in ids.values()}
    for tail, head in wires:
        _wire(chooser, outputs[ids[tail]], inputs, ids[tail], ids[head])
    made = {
        each: Component(
            id=each,
            name=each.split(".")[1],
            group=each.split(".")[0],
            title=titles[each],
            owner=f"partner_{list(ids.values()).index(each) % 4}",
            role="source" if not inputs[each] else chooser.choice(("filter", "filter", "sink", "reactive", None)),
            inputs=inputs[each],
            inputs_known=True,
            outputs=outputs[each],
            outputs_known=True,
        )
        for each in ids.values()
    }
    return _with_nodes(_architecture(groups, made), chooser)


def _outputs(component: str, title: str, chooser: random.Random) -> dict[str, Output]:
    kinds = chooser.sample(("State", "Events", "Result", "Images", "Poses"), chooser.choice((1, 2, 2, 3)))
    return {
        kind.lower(): Output(f"{component}.{kind.lower()}", kind.lower(), component, type=f"{title} {kind.lower()}")
        for kind in kinds
    }


def _wire(
    chooser: random.Random,
    outputs: Mapping[str, Output],
    inputs: dict[str, dict[str, Input]],
    tail: str,
    head: str,
) -> None:
    output = chooser.choice(list(outputs.values()))
    whole = chooser.random() < 0.1
    name = f"{tail.split('.')[1]}_{output.name}"[:60]
    carried = tuple(outputs[key].id for key in outputs) if whole else (output.id,)
    connection = Connection(
        f"{head}.{name}", tail, "component" if whole else "output", tail if whole else output.id, carried
    )
    inputs[head][name] = Input(
        f"{head}.{name}",
        name,
        head,
        (connection,),
        optional=chooser.random() < 0.1,
        from_written=True,
    )


def _architecture(groups: Sequence[tuple[str, str, Sequence[str]]], made: Mapping[str, Component]) -> Architecture:
    inputs = {port.id: port for each in made.values() for port in each.inputs.values()}
    connections = tuple(one for port in inputs.values() for one in port.connections)
    outputs = {port.id: port for each in made.values() for port in each.outputs.values()}
    types = sorted({port.type for port in outputs.values() if port.type})
    return Architecture(
        ProjectInfo("robot", "A robot"),
        partners={f"partner_{at}": Partner(f"partner_{at}", f"Partner {at}") for at in range(4)},
        groups={
            key: Group(key, title, owner="partner_1", components={c.name: c for c in made.values() if c.group == key})
            for key, title, _ in groups
        },
        components=made,
        inputs=inputs,
        outputs=outputs,
        connections=connections,
        edges=tuple(PortEdge(output, one.input) for one in connections for output in one.outputs),
        types={name: ConceptualType(name, _MESSAGES[at % len(_MESSAGES)]) for at, name in enumerate(types)},
    )


def _with_nodes(architecture: Architecture, chooser: random.Random) -> Architecture:
    nodes = {
        each.id: Node(
            each.name if each.name not in _names(architecture, each.id) else each.id.replace(".", "_"),
            each.title,
            (each.id,),
            name=each.name,
            namespace=f"/{each.group}",
            kinds=(chooser.choice(("node", "lifecycle", "composable")),),
            status=chooser.choice(("existing", "adapted", "planned")),
            container="vision" if chooser.random() < 0.1 else None,
            host=chooser.choice(("main_pc", "arm_pc", "vision_pc", None)),
        )
        for each in architecture.components.values()
    }
    endpoints = tuple(point for each, node in nodes.items() for point in _endpoints(architecture, each, node))
    return replace(
        architecture,
        nodes={node.id: node for node in nodes.values()},
        endpoints=endpoints,
        topics=topics(endpoints),
        hosts={
            key: Host(key, title)
            for key, title in (("main_pc", "Main PC"), ("arm_pc", "Arm PC"), ("vision_pc", "Vision PC"))
        },
        containers={"vision": Container("vision", "Vision pipeline", "vision_pc", 4)},
        links={
            "lan": Link(
                "lan", "Gigabit LAN", ("main_pc", "arm_pc", "vision_pc"), parse_quantity("1 Gbit/s", "bandwidth")
            ),
            "can": Link(
                "can",
                "CAN bus",
                ("main_pc", "arm_pc"),
                parse_quantity("1 Mbit/s", "bandwidth"),
                worst=parse_quantity("2 ms", "duration"),
            ),
        },
    )


def _names(architecture: Architecture, component: str) -> set[str]:
    return {other.name for other in architecture.components.values() if other.id != component}


def _endpoints(architecture: Architecture, component: str, node: Node) -> Iterable[Endpoint]:
    for output in architecture.components[component].outputs.values():
        message = architecture.message_of(output)
        flow = flow_of(message)
        use = "publishes" if flow == "topic" else "serves"
        name = "/" + output.id.replace(".", "/")
        yield Endpoint(node.id, use, name, flow, output.id, component, message, output.type, sources=())  # type: ignore[arg-type]
    for port in architecture.components[component].inputs.values():
        for connection in port.connections:
            for source in connection.outputs:
                output = architecture.outputs[source]
                message = architecture.message_of(output)
                flow = flow_of(message)
                use = "subscribes" if flow == "topic" else "calls"
                name = "/" + source.replace(".", "/")
                yield Endpoint(node.id, use, name, flow, port.id, component, message, output.type, sources=(source,))  # type: ignore[arg-type]


def topics(endpoints: Iterable[Endpoint]) -> dict[str, Topic]:
    """Collect the topics that the endpoints use."""
    found: dict[str, list[Endpoint]] = {}
    for endpoint in endpoints:
        found.setdefault(endpoint.label, []).append(endpoint)
    return {
        name: Topic(
            name,
            used[0].flow,
            tuple(dict.fromkeys(one.message for one in used if one.message)),
            tuple(dict.fromkeys(one.type for one in used if one.type)),
            tuple(one for one in used if one.use in {"publishes", "serves"}),
            tuple(one for one in used if one.use in {"subscribes", "calls"}),
        )
        for name, used in found.items()
    }
