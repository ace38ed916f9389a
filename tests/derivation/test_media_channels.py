"""Data that does not travel over ROS: over which channels nodes exchange it, and what stays in the memory of one node."""

from __future__ import annotations

from collections.abc import Callable

from archgen.derivation.low_level import mark_inner_memory
from archgen.derivation.media_channels import derive_channels
from archgen.derivation.port_endpoints import find_node_parts
from archgen.model.architecture import Architecture
from archgen.model.node import Topic

Derived = Callable[[str], Architecture]


def describe(topic: Topic) -> str:
    writers = " ".join(f"{each.node}:{each.port}" for each in topic.writers)
    readers = " ".join(f"{each.node}:{each.port}<{','.join(each.sources)}" for each in topic.readers)
    return f"{topic.flow} {topic.medium}: {writers} > {readers}"


FLEET = """
groups:
  g:
    components:
      drone: {outputs: {pose: {type: Pose, medium: MQTT}, state: {type: State, medium: mqtt}, image: Picture}}
      depot: {outputs: {orders: {type: Order, medium: rest}}}
      station: {inputs: {every: drone, orders: depot.orders}}
      screen: {inputs: {pose: drone.pose}}
types: {Order: {request: Query, response: Orders}, Picture: sensor_msgs/msg/Image, Pose: {size: 100 B}}
nodes:
  drone: {implements: drone, publishes: {pose: {topic: [fleet/pose, backup/pose]}}}
  left: {implements: screen, subscribes: {pose: }}
  right: {implements: screen}
"""


def test_channels_are_gathered_by_medium_and_name(derived: Derived) -> None:
    architecture = derived(FLEET)
    assert {name: describe(channel) for name, channel in architecture.channels.items()} == {
        "mqtt fleet/pose": "topic mqtt: drone:g.drone.pose > station:g.station.every<g.drone.pose left:g.screen.pose<g.drone.pose",
        "mqtt backup/pose": "topic mqtt: drone:g.drone.pose > station:g.station.every<g.drone.pose left:g.screen.pose<g.drone.pose",
        "mqtt g.drone.state": "topic mqtt: drone:g.drone.state > station:g.station.every<g.drone.state",
        "rest g.depot.orders (service)": "service rest: depot:g.depot.orders > station:g.station.orders<g.depot.orders",
    }
    assert list(architecture.topics) == ["/g/drone/image"]
    sizes = [channel.size for channel in architecture.channels.values()]
    assert [str(size) for size in sizes] == ["100 B", "100 B", "None", "None"]


def test_all_that_nodes_use_is_listed_together(derived: Derived) -> None:
    architecture = derived(FLEET)
    assert [name for name, _ in architecture.list_carriers()] == ["/g/drone/image", *architecture.channels]
    ends = [end.name for end in architecture.list_endpoints() if end.node == "left"]
    assert ends == ["mqtt fleet/pose", "mqtt backup/pose"]
    assert derive_channels(architecture, find_node_parts(architecture)) == architecture.channels


def test_what_is_planned_for_a_component_without_ros_is_a_program(derived: Derived) -> None:
    nodes = derived(FLEET).nodes
    assert {name: node.kinds for name, node in nodes.items() if not node.written} == {
        "depot": ("program",),
        "station": ("node",),
    }


def media(architecture: Architecture) -> dict[str, str]:
    return {port.id: port.medium for port in architecture.list_ports()}


PAIR = """
groups:
  g:
    components:
      a: {{outputs: {{x: {sent}, y: T}}}}
      b: {{inputs: {{x: {read}}}}}
      c: {{inputs: {{y: a.y}}}}
nodes: {{n: {{implements: [a, b]{listed}}}}}
"""


def test_what_stays_in_one_node_is_memory(derived: Derived) -> None:
    architecture = derived(PAIR.format(sent="T", read="a.x", listed=""))
    assert media(architecture) == {"g.a.x": "memory", "g.a.y": "ros", "g.b.x": "memory", "g.c.y": "ros"}
    assert list(architecture.topics) == ["/g/a/y"]
    assert list(architecture.channels) == ["memory g.a.x"]
    # The same objects below components and groups.
    assert architecture.outputs["g.a.x"] is architecture.groups["g"].components["a"].outputs["x"]
    assert architecture.inputs["g.b.x"] is architecture.components["g.b"].inputs["x"]
    assert mark_inner_memory(architecture).outputs == architecture.outputs


def test_what_a_node_lists_reaches_outside_or_has_a_medium_is_no_memory(derived: Derived) -> None:
    for sent, read, listed in (
        ("T", "a.x", ", publishes: {x: }"),
        ("T", "a.x", ", subscribes: {x: /x}"),
        ("{type: T, external: The world}", "a.x", ""),
        ("{type: T, medium: can}", "a.x", ""),
        ("T", "{from: a.x, medium: ros}", ""),
    ):
        architecture = derived(PAIR.format(sent=sent, read=read, listed=listed))
        assert "memory" not in media(architecture).values()


def test_what_is_read_inside_and_outside_is_sent_and_kept(derived: Derived) -> None:
    architecture = derived("""
groups:
  g:
    components:
      a: {outputs: {x: T}}
      b: {inputs: {x: a.x}}
      c: {inputs: {x: a.x}}
nodes: {n: {implements: [a, b]}}
""")
    assert media(architecture) == {"g.a.x": "ros", "g.b.x": "memory", "g.c.x": "ros"}
    (topic,) = architecture.topics.values()
    assert [each.node for each in topic.readers] == ["c"]
    (channel,) = architecture.channels.values()
    assert describe(channel) == "topic memory: n:g.a.x > n:g.b.x<g.a.x"


def test_several_nodes_or_one_component_share_no_memory(derived: Derived) -> None:
    architecture = derived("""
groups:
  g:
    components:
      a: {outputs: {x: T}}
      b: {inputs: {x: a.x}}
nodes: {n: {implements: [a, b]}, m: {implements: b}}
""")
    assert set(media(architecture).values()) == {"ros"}
