"""The low level where it is left out: one test for each sentence of the language about it."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from archgen.model.architecture import Architecture

Derived = Callable[[str], Architecture]

PAIR = """
groups:
  g:
    components:
      camera: {outputs: {image: sensor_msgs/msg/Image, info: Unmapped}}
      viewer: {inputs: {both: camera}}
nodes:
  cam: {implements: camera%s}
  view: {implements: viewer%s}
"""


def ends(architecture: Architecture, *nodes: str) -> list[str]:
    """Give endpoints as `node use name message`."""
    return [
        f"{e.node} {e.use} {e.name} {(e.message or '?').rpartition('/')[2]}"
        for e in architecture.endpoints
        if not nodes or e.node in nodes
    ]


def test_one_node_exposes_exactly_the_ports(derived: Derived) -> None:
    assert ends(derived(PAIR % ("", ""))) == [
        "cam publishes /g/camera/image Image",
        "cam publishes /g/camera/info ?",
        "view subscribes /g/camera/image Image",
        "view subscribes /g/camera/info ?",
    ]


def test_what_an_endpoint_knows(derived: Derived) -> None:
    architecture = derived(PAIR % (", publishes: {image: {topic: img, qos: sensor_data}}", ""))
    image, info, reads, _ = architecture.endpoints
    assert (image.port, image.component, image.type) == ("g.camera.image", "g.camera", "sensor_msgs/msg/Image")
    assert (image.written, image.name_written, image.qos.profile, image.at.line) == (True, True, "sensor_data", 8)
    assert (info.written, info.name_written, info.qos.written, info.type) == (False, False, False, "Unmapped")
    assert (reads.port, reads.sources, reads.name) == ("g.viewer.both", ("g.camera.image",), "/img")


@pytest.mark.parametrize(
    ("written", "name"),
    [
        ("image", "/image"),
        ("/camera/image", "/camera/image"),
        ("~/image", "/cam/image"),
        ("namespace: /front, a", "/front/a"),
        ("namespace: front, ~/a", "/front/cam/a"),
        ("namespace: /front/, name: usb, ~/a", "/front/usb/a"),
        ("namespace: /front, /a", "/a"),
        ("namespace: /front, ~", "/front/cam"),
        ("namespace: /front, '{node}/a'", "/front/cam/a"),
    ],
)
def test_names_resolve_in_namespace_and_name(derived: Derived, written: str, name: str) -> None:
    *keys, topic = written.split(", ")
    more = "".join(f", {key}" for key in keys)
    topic = "'~'" if topic == "~" else topic
    architecture = derived(PAIR % (f"{more}, publishes: {{image: {topic}}}", ""))
    assert [e.name for e in architecture.endpoints if e.port == "g.camera.image"] == [name]
    assert next(e.name for e in architecture.endpoints if e.node == "view") == name  # the reader's is its producer's


def test_one_output_on_several_topics(derived: Derived) -> None:
    architecture = derived(PAIR % (", publishes: {image: [/a, /b]}", ""))
    assert ends(architecture, "view") == [
        "view subscribes /a Image",
        "view subscribes /b Image",
        "view subscribes /g/camera/info ?",
    ]


def test_a_reader_that_writes_its_topic_reads_that_one(derived: Derived) -> None:
    architecture = derived(PAIR % (", publishes: {image: [/a, /b]}", ", subscribes: {both: /b}"))
    assert ends(architecture, "view") == ["view subscribes /b Image"]
    assert architecture.endpoints[-1].name_written


def test_a_reader_that_writes_another_topic_is_kept_for_the_rules_to_judge(derived: Derived) -> None:
    last = derived(PAIR % (", publishes: {image: /a}", ", subscribes: {both: /x}")).endpoints[-1]
    assert (last.name, last.name_written, last.sources) == ("/x", True, ())


def test_several_outputs_on_one_topic_reach_all_its_readers(derived: Derived) -> None:
    architecture = derived("""
groups:
  g:
    components:
      planner: {outputs: {command: geometry_msgs/msg/Twist}}
      joystick: {outputs: {command: geometry_msgs/msg/Twist}}
      base: {inputs: {command: planner.command}}
nodes:
  p: {implements: planner, publishes: {command: /cmd_vel}}
  j: {implements: joystick, publishes: {command: /cmd_vel}}
  b: {implements: base}
""")
    topic = architecture.topics["/cmd_vel"]
    assert [e.node for e in topic.writers] == ["p", "j"]
    assert topic.readers[0].sources == ("g.planner.command", "g.joystick.command")  # the named one first


SHARED = """
groups:
  g:
    components:
      camera: {outputs: {image: sensor_msgs/msg/Image, info: std_msgs/msg/String}}
      viewer: {inputs: {image: camera.image, info: camera.info}}
nodes:
  driver: {implements: camera, publishes: {image: /image}, internal: {publishes: {raw: }}}
  calibration: {implements: camera, internal: {subscribes: {raw: }}}
  view: {implements: viewer}
"""


def test_several_nodes_carry_what_they_name(derived: Derived) -> None:
    architecture = derived(SHARED)
    assert ends(architecture, "driver", "calibration") == [
        "driver publishes /image Image",
        "driver publishes /g/camera/raw ?",
        "calibration subscribes /g/camera/raw ?",
    ]
    # What none of them names has the name that it would have, so that the reader can be drawn.
    assert ends(architecture, "view") == ["view subscribes /image Image", "view subscribes /g/camera/info String"]
    assert architecture.endpoints[-1].sources == ("g.camera.info",)
    assert architecture.topics["/g/camera/info"].writers == ()


def test_internal_topics_match_by_name_and_pass_the_message_on(derived: Derived) -> None:
    architecture = derived("""
groups: {g: {components: {c: {outputs: {o: T}}}}}
nodes:
  a: {implements: c, publishes: {o: }, internal: {publishes: {x: {topic: /raw, message: sensor_msgs/Image}}}}
  b: {implements: c, internal: {subscribes: {y: {topic: /raw}}, calls: {s: {name: /s}}}}
  d: {implements: c, internal: {serves: {s: {name: /s, message: std_srvs/srv/Trigger}}}}
""")
    assert ends(architecture, "b") == ["b subscribes /raw Image", "b calls /s Trigger"]
    raw = architecture.topics["/raw"]
    assert [(e.internal, e.port, e.component) for e in raw.writers] == [(True, None, "g.c")]
    assert architecture.topics["/s"].flow == "service"


def test_an_internal_name_in_a_node_of_two_components_belongs_to_the_one_that_shares_it(derived: Derived) -> None:
    architecture = derived("""
groups: {g: {components: {c: {outputs: {o: T}}, d: {outputs: {p: T}}}}}
nodes:
  a: {implements: [c, d], internal: {publishes: {x: }}}
  b: {implements: d, internal: {subscribes: {x: }}}
""")
    assert [e.name for e in architecture.endpoints if e.internal] == ["/g/d/x", "/g/d/x"]


def test_a_component_without_nodes_gets_a_planned_one(derived: Derived) -> None:
    architecture = derived("""
groups:
  g: {owner: p, components: {camera: {outputs: {o: T}, timing: {rate: 5 Hz}}, lidar: }}
  h: {components: {camera: , lidar: , g_lidar: }}
partners: {p: }
nodes:
  lidar: {implements: h.lidar}
""")
    planned = [node for node in architecture.nodes.values() if not node.written]
    assert [(node.id, node.implements) for node in planned] == [
        ("camera", ("g.camera",)),
        ("g_lidar", ("g.lidar",)),  # `lidar` is taken
        ("h_camera", ("h.camera",)),
        ("h_g_lidar", ("h.g_lidar",)),
    ]
    first = planned[0]
    assert (first.status, first.owner, first.full_name, str(first.timing["g.camera"].rate)) == (
        "planned",
        "p",
        "/camera",
        "5 Hz",
    )
    assert ends(architecture, "camera") == ["camera publishes /g/camera/o ?"]


def test_a_node_without_component_keeps_what_it_wrote(derived: Derived) -> None:
    architecture = derived("""
nodes:
  relay: {namespace: /x, subscribes: {in: {topic: /raw}}, publishes: {out: {message: std_msgs/msg/String}}}
  tool: {publishes: {raw: {topic: /raw, message: std_msgs/msg/Bool}}}
""")
    assert ends(architecture) == [
        "relay publishes /x/out String",
        "relay subscribes /raw Bool",
        "tool publishes /raw Bool",
    ]
    assert [(e.port, e.internal) for e in architecture.endpoints] == [(None, False)] * 3


def test_services_and_actions_are_served_and_called(derived: Derived) -> None:
    architecture = derived("""
groups:
  g:
    components:
      planner: {outputs: {plan: nav2_msgs/action/ComputePathToPose, stop: std_srvs/srv/Trigger, path: T}}
      driver: {inputs: {mixed: [planner.plan, planner.stop, planner.path]}}
nodes:
  p: {implements: planner, serves: {plan: /compute_path}}
  d: {implements: driver, subscribes: {mixed: {qos: sensor_data}}}
""")
    assert ends(architecture) == [
        "p serves /compute_path ComputePathToPose",
        "p serves /g/planner/stop Trigger",
        "p publishes /g/planner/path ?",
        "d subscribes /g/planner/path ?",
        "d calls /compute_path ComputePathToPose",
        "d calls /g/planner/stop Trigger",
    ]
    assert architecture.topics["/compute_path"].flow == "action"
    assert [e.qos.profile for e in architecture.endpoints if e.node == "d"] == ["sensor_data", "default", "default"]


def test_the_message_decides_what_an_entry_in_the_wrong_section_is(derived: Derived) -> None:
    architecture = derived("""
groups:
  g:
    components:
      planner: {outputs: {stop: std_srvs/srv/Trigger}}
      button: {inputs: {stop: planner.stop}}
nodes:
  p: {implements: planner, publishes: {stop: /stop}}
  b: {implements: button, subscribes: {stop: }}
""")
    assert ends(architecture) == ["p serves /stop Trigger", "b calls /stop Trigger"]
    assert architecture.nodes["p"].uses[0].use == "publishes"


def test_a_service_whose_message_nobody_named_is_one_by_its_section(derived: Derived) -> None:
    architecture = derived(PAIR % (", serves: {info: /ask}", ""))
    assert ends(architecture)[1] == "cam serves /ask ?"
    assert ends(architecture, "view")[1] == "view calls /ask ?"


def test_external_ports_may_have_a_topic_and_physical_ones_have_none(derived: Derived) -> None:
    architecture = derived("""
groups:
  g:
    components:
      c:
        inputs: {web: {external: A page, type: Pose}, light: {external: Light, medium: physical}}
        outputs: {log: {type: T, external: A screen}, beep: {type: Sound, medium: physical}}
      d: {inputs: {ear: c.beep}}
nodes:
  n: {implements: c, subscribes: {web: /web}}
  m: {implements: d}
""")
    assert ends(architecture) == ["n publishes /g/c/log ?", "n subscribes /web Pose"]


def test_inputs_that_nothing_feeds_yet(derived: Derived) -> None:
    architecture = derived("""
groups: {g: {components: {stub: , c: {inputs: {open: , waiting: stub}}}}}
nodes: {n: c}
""")
    assert ends(architecture, "n") == ["n subscribes /g/c/open ?"]  # the topic of `waiting` will be its producer's


def test_shared_topics(derived: Derived) -> None:
    architecture = derived("""
ros: {shared_topics: [/estop]}
groups:
  g:
    components:
      a: {outputs: {o: T}}
      b: {outputs: {o: T}}
      c: {inputs: {i: a.o}}
nodes:
  x: {implements: a, publishes: {o: /estop}, internal: {publishes: {tf: /tf}}}
  y: {implements: b, publishes: {o: /estop}}
  z: {implements: c}
""")
    assert [(topic.name, topic.shared) for topic in architecture.topics.values()] == [("/estop", True), ("/tf", True)]
    assert architecture.topics["/estop"].readers[0].sources == ("g.a.o",)


def test_a_message_written_at_a_node_counts_there(derived: Derived) -> None:
    architecture = derived(PAIR % (", publishes: {info: {message: std_msgs/String}}", ""))
    topic = architecture.topics["/g/camera/info"]
    assert (topic.messages, topic.types) == (("std_msgs/msg/String",), ("Unmapped",))
    assert topic.writers[0].message_at.line == 8


def test_topics_gather_messages_types_and_the_largest_size(derived: Derived) -> None:
    architecture = derived("""
types: {A: {message: m/msg/A, size: 1 kB}, B: {message: m/msg/B, size: 2 kB}}
groups: {g: {components: {c: {outputs: {a: A, b: B}}}}}
nodes: {n: {implements: c, publishes: {a: /x, b: /x}}}
""")
    topic = architecture.topics["/x"]
    assert (topic.messages, topic.types, str(topic.size)) == (("m/msg/A", "m/msg/B"), ("A", "B"), "2 kB")


def test_a_topic_and_a_service_of_one_name_are_two(derived: Derived) -> None:
    architecture = derived("""
groups: {g: {components: {c: {outputs: {a: m/msg/A, b: m/srv/B}}}}}
nodes: {n: {implements: c, publishes: {a: /x}, serves: {b: /x}}}
""")
    assert [(key, topic.name, topic.flow) for key, topic in architecture.topics.items()] == [
        ("/x", "/x", "topic"),
        ("/x (service)", "/x", "service"),
    ]
