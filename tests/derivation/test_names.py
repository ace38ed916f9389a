"""Names of the low level: what planned nodes are called, what all nodes share."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from archgen.derivation.ros_names import default_port_name, shared_topic_names
from archgen.model.architecture import Architecture

Derived = Callable[[str], Architecture]


def test_a_port_without_a_topic_has_one_named_after_it() -> None:
    assert default_port_name("group.component.port") == "/group/component/port"


def test_topics_that_all_nodes_share() -> None:
    assert "/tf" in shared_topic_names(())
    assert {"/estop", "/stop", "/tf"} <= shared_topic_names(("estop", "/stop"))


def test_a_topic_is_shared_a_service_of_the_same_name_is_not(derived: Derived) -> None:
    architecture = derived("""
ros: {distro: jazzy, shared_topics: [/all]}
groups: {g: {components: {a: {outputs: {o: std_msgs/msg/Int8, s: std_srvs/srv/Trigger}}}}}
nodes: {n: {implements: a, publishes: {o: /all}, serves: {s: /all}}}
""")
    assert {key: topic.shared for key, topic in architecture.topics.items()} == {"/all": True, "/all (service)": False}


def test_a_planned_node_takes_the_first_name_that_is_free(derived: Derived) -> None:
    architecture = derived("""
groups: {g: {components: {c: , d: , e: }}, h: {components: {c: }}}
nodes: {d: {}, g_d: {}, e: {}, g_e: {}, g_e_2: {}}
""")
    assert {n.implements[0]: n.id for n in architecture.nodes.values() if not n.written} == {
        "g.c": "c",
        "g.d": "g_d_2",
        "g.e": "g_e_3",
        "h.c": "h_c",
    }


def test_an_internal_entry_goes_where_its_message_belongs(derived: Derived) -> None:
    node = """{implements: c, internal: {
    publishes: {p: {message: std_srvs/srv/Trigger}, q: {message: std_msgs/msg/Int8, qos: sensor_data}},
    serves: {r: {message: std_msgs/msg/Int8}, s: },
    subscribes: {t: {message: nav2_msgs/action/Wait}},
    calls: {u: {message: std_msgs/msg/Int8}, v: }}}"""
    architecture = derived(f"groups: {{g: {{components: {{c: }}}}}}\nnodes: {{n: {node}}}")
    assert [(e.label[-1], e.use, e.flow, e.qos.profile, e.written) for e in architecture.endpoints] == [
        ("p", "serves", "service", "default", True),
        ("q", "publishes", "topic", "sensor_data", True),
        ("t", "calls", "action", "default", True),
        ("r", "publishes", "topic", "default", True),
        ("s", "serves", "service", "default", True),
        ("u", "subscribes", "topic", "default", True),
        ("v", "calls", "service", "default", True),
    ]


WRITERS = """
groups: {{g: {{components: {{a: {{outputs: {{o: Open}}}}, b: {{inputs: {{i: a.o}}}}}}}}}}
nodes:
  one: {{implements: a, publishes: {{o: {{topic: /p, message: std_msgs/msg/Int8}}}}}}
  two: {{implements: a, publishes: {{o: {{topic: /q, message: std_msgs/msg/Int16}}}}}}
  reader: {{implements: b, subscribes: {{i: {topic}}}}}
types: {{Open: {{status: planned}}}}
"""


@pytest.mark.parametrize(
    ("topic", "message", "sources"),
    [
        ("/p", "std_msgs/msg/Int8", ("g.a.o",)),
        ("/q", "std_msgs/msg/Int16", ("g.a.o",)),
        ("/other", "std_msgs/msg/Int8", ()),  # of no source: message and type still come from the first one
    ],
)
def test_a_reader_takes_the_message_of_the_topic_that_it_names(
    derived: Derived, topic: str, message: str, sources: tuple[str, ...]
) -> None:
    (reader,) = (e for e in derived(WRITERS.format(topic=topic)).endpoints if e.node == "reader")
    assert (reader.message, reader.type, reader.sources) == (message, "Open", sources)
