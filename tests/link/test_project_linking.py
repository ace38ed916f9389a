"""Elements as they are declared: titles, owners, places, types, timing, and what is missing or makes no sense."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction

import pytest

from archgen.diagnostics.diagnostic import Diagnostic
from archgen.model.architecture import Architecture
from archgen.model.declared_timing import Trigger

Linked = Callable[[str], tuple[Architecture, tuple[Diagnostic, ...]]]
Told = Callable[[str], list[str]]


def test_nothing_written_is_an_empty_architecture(linked: Linked) -> None:
    architecture, found = linked("")
    assert found == ()
    assert (architecture.project.id, architecture.project.title) == ("robot", "Robot")
    assert (architecture.components, architecture.nodes, architecture.types) == ({}, {}, {})


def test_titles_are_made_from_ids_and_places_are_those_of_keys(linked: Linked) -> None:
    architecture, _ = linked("""
project: {id: r, version: 1.10}
groups:
  environment_state:
    components:
      object_recognition:
      other: {title: No, functionality: 12}
""")
    group = architecture.groups["environment_state"]
    component = architecture.components["environment_state.object_recognition"]
    assert (group.title, group.at.line, group.at.column) == ("Environment State", 4, 3)
    assert (component.title, component.at.line) == ("Object Recognition", 6)
    other = group.components["other"]
    assert (other.title, other.functionality) == ("No", "12")
    assert architecture.project.version == "1.10"


def test_unknown_and_known_to_be_none_are_told_apart(linked: Linked) -> None:
    architecture, _ = linked("groups: {g: {components: {a: , b: {inputs: {}, outputs: {}, requirements: []}}}}")
    a, b = architecture.components.values()
    assert (a.inputs_known, a.outputs_known, a.requirements_known) == (False, False, False)
    assert (b.inputs_known, b.outputs_known, b.requirements_known) == (True, True, True)


def test_owners_are_inherited(linked: Linked) -> None:
    architecture, _ = linked("""
partners: {certh: CERTH-ITI, tum: }
groups:
  g: {owner: certh, components: {a: , b: {title: B, owner: tum}}}
nodes:
  n: b
  m: {implements: a, owner: tum}
  o: [a, b]
""")
    assert [c.owner for c in architecture.components.values()] == ["certh", "tum"]
    assert [n.owner for n in architecture.nodes.values()] == ["tum", "tum", "certh"]


def test_ports(linked: Linked) -> None:
    architecture, _ = linked("""
groups:
  g:
    components:
      c:
        inputs: {p: {external: A hand, medium: physical}, q: {type: Pose, optional: true}, r: , s: []}
        outputs: {p: {type: Sound, external: The user hears, medium: physical}, q: "Point   cloud"}
""")
    p, q, r, s = architecture.inputs.values()
    assert (p.external, p.medium, p.from_written) == ("A hand", "physical", False)
    assert (q.type, q.optional, q.type_at.column) == ("Pose", True, 69)
    assert (r.from_written, s.from_written) == (False, True)
    assert [(o.id, o.type, o.medium) for o in architecture.outputs.values()] == [
        ("g.c.p", "Sound", "physical"),
        ("g.c.q", "Point cloud", "ros"),
    ]


def test_types_are_the_projects_then_shipped_then_the_rest_by_name(linked: Linked) -> None:
    architecture, found = linked("""
groups:
  g:
    components:
      c:
        inputs: {a: {type: Pose}}
        outputs: {b: Laser scan, c: sensor_msgs/Image, d: Nothing known, e: Plan on request}
types:
  Laser scan: my_msgs/msg/Scan
  Plan on request: {message: my_msgs/srv/Plan, request: Goal, response: Route, size: 2 kB}
""")
    assert found == ()
    assert [(t.name, t.message, t.origin) for t in architecture.types.values()] == [
        ("Laser scan", "my_msgs/msg/Scan", "project"),
        ("Plan on request", "my_msgs/srv/Plan", "project"),
        ("Pose", "geometry_msgs/msg/Pose", "shipped"),
        ("Goal", None, "project"),
        ("Nothing known", None, "project"),
        ("Route", None, "project"),
        ("sensor_msgs/msg/Image", "sensor_msgs/msg/Image", "message"),
    ]
    assert architecture.types["Plan on request"].message_at.line == 10


def test_one_type_under_two_spellings(told: Told) -> None:
    assert told("types:\n  sensor_msgs/Image: {size: 1 MB}\n  sensor_msgs/msg/Image: {size: 2 MB}") == [
        (
            "3:3 conflicting-values: the type `sensor_msgs/msg/Image` is declared twice: blanks and the way letters are"
            " composed do not count (2:3 declared here) | keep one of them"
        )
    ]


def test_a_node(linked: Linked) -> None:
    architecture, found = linked("""
groups: {g: {components: {c: {outputs: {o: T}, inputs: {i: }}}}}
hosts: {pc: {cores: 4}}
containers: {box: {host: pc, threads: 1}}
nodes:
  n:
    implements: c
    kind: [lifecycle, composable]
    namespace: perception
    container: box
    status: adapted
    publishes: {o: {topic: [a, ~/b], qos: {profile: sensor_data, depth: 3, deadline: 100 ms}}}
    subscribes: {i: {qos: system_default}}
    internal: {publishes: {debug: {topic: ~/debug, message: sensor_msgs/Image}}}
    parameters: {rate: 5, deep: {x: [1, no]}}
""")
    assert found == ()
    node = architecture.nodes["n"]
    assert (node.kinds, node.full_name, node.host, node.status) == (
        ("lifecycle", "composable"),
        "/perception/n",
        "pc",
        "adapted",
    )
    assert node.parameters == {"rate": 5, "deep": {"x": [1, "no"]}}
    o, i, debug = node.uses
    assert (o.port, o.topics, [place.column for place in o.topic_places]) == ("g.c.o", ("a", "~/b"), [29, 32])
    assert o.qos is not None
    assert (o.qos.reliability, o.qos.depth, str(o.qos.deadline), o.qos.written) == ("best_effort", 3, "100 ms", True)
    assert i.qos is not None
    assert (i.qos.profile, i.qos.reliability, i.qos.depth) == ("system_default", "best_effort", None)
    assert (debug.key, debug.port, debug.internal, debug.message) == ("debug", None, True, "sensor_msgs/msg/Image")


def test_deployment_requirements_views_and_policies(linked: Linked) -> None:
    architecture, found = linked("""
hosts: {a: , b: }
links: {lan: {connects: [a, b], bandwidth: 1 Gbit/s, latency: 2 ms}}
use_cases: {UC-4: }
requirements: {R-1: {title: It works, use_cases: [UC-4]}, R-2: }
views: {v: {show: "tag:safety", colour: owner, layout: {direction: top-bottom}}}
policies: {p: {forbid: {from: a, to: "role:sink"}}}
ros: {distro: jazzy, shared_topics: [/estop]}
layout: {direction: left-right}
""")
    assert found == ()
    link = architecture.links["lan"]
    assert (link.title, link.connects, str(link.best), str(link.worst)) == ("Lan", ("a", "b"), "2 ms", "2 ms")
    assert link.bandwidth is not None
    assert link.bandwidth.value == 10**9
    assert [(r.id, r.title, r.use_cases) for r in architecture.requirements.values()] == [
        ("R-1", "It works", ("UC-4",)),
        ("R-2", "R-2", ()),
    ]
    view, policy = architecture.views["v"], architecture.policies["p"]
    assert (view.show, view.show_at.column, view.layout.direction, view.level) == (
        "tag:safety",
        19,
        "top-bottom",
        "functional",
    )
    assert (policy.forbid_from, policy.forbid_to, policy.to_at.column) == ("a", "role:sink", 38)
    assert (architecture.distro, architecture.shared_topics) == ("jazzy", ("/estop",))


def test_what_a_link_names_that_is_no_host_is_kept_as_unresolved(linked: Linked) -> None:
    architecture, _ = linked("hosts: {pc: }\nlinks: {lan: {connects: [pc, pq]}}")
    assert (architecture.links["lan"].connects, architecture.links["lan"].unresolved) == (("pc",), ("pq",))


def test_links_and_chains_may_be_stubs(linked: Linked) -> None:
    architecture, found = linked("links: {lan: {title: LAN}}\nchains: {c: {deadline: 1 s}}")
    assert found == ()
    assert (architecture.links["lan"].connects, architecture.chains["c"].through) == ((), ())


def test_latencies_are_in_their_order(told: Told) -> None:
    assert told("hosts: {a: , b: }\nlinks: {l: {connects: [a, b], latency: {best: 2 ms, worst: 1.5 ms}}}") == [
        "2:47 wrong-value: the best latency (2 ms) is above the worst (1.5 ms) (2:60 the worst) | exchange them"
    ]
    assert told("hosts: {a: , b: }\nlinks: {l: {connects: [a, b], latency: 2 ms}}") == []


def test_a_node_runs_on_the_host_of_its_container(told: Told) -> None:
    text = "hosts: {a: , b: }\ncontainers: {c: {host: a}, d: }\nnodes: {n: {container: %s, host: %s}}"
    assert told(text % ("c", "a")) == []
    assert told(text % ("d", "b")) == []  # nobody has said yet where the container runs
    assert told(text % ("c", "b")) == [
        (
            "3:33 conflicting-values: `n` runs in the container `c`, which is on another host: `a` (2:14 the container)"
            " | leave `host` out: a node in a container runs on the container's host"
        )
    ]


def test_one_name_in_the_program_becomes_one_topic(told: Told) -> None:
    text = "nodes: {n: {%s: {a: {topic: %s, own_name: x, message: std_msgs/msg/Empty}}}}"
    assert told(text % ("publishes", "/a")) == []
    help_text = "leave `own_name` out, and write what becomes of each name of the program in `remaps`"
    assert told(text % ("publishes", "[/a, /b]")) == [
        f"1:56 conflicting-values: `a` of `n` has 2 topics, but one name in the program | {help_text}"
    ]


def test_views_and_policies_that_say_nothing_are_left_out(linked: Linked) -> None:
    architecture, _ = linked("views: {v: {title: V}}\npolicies: {p: , q: {forbid: {from: a}}}")
    assert (architecture.views, architecture.policies) == ({}, {})


TIMED = "groups: {g: {components: {c: {inputs: {i: , j: }, outputs: {o: T}, timing: {%s}}}}}"


def test_timing(linked: Linked) -> None:
    architecture, found = linked(
        TIMED % "behaviour: event, trigger: {all: [i, j]}, every: 3, calls: {j: 1/3}, wcet: 80 ms, bcet: 0 ms,"
        " outputs: {o: {conditional: true, max_gap: 10 s}}, priority: 0"
    )
    assert found == ()
    timing = architecture.components["g.c"].timing
    assert timing is not None
    assert timing.trigger == Trigger("all", ("g.c.i", "g.c.j"))
    assert (timing.behaviour, timing.every, timing.calls, timing.priority) == ("event", 3, {"g.c.j": Fraction(1, 3)}, 0)
    assert (timing.outputs["g.c.o"].conditional, str(timing.outputs["g.c.o"].max_gap)) == (True, "10 s")
    assert timing.places["every"].column == 126


@pytest.mark.parametrize(
    ("written", "trigger"),
    [("any", Trigger("any")), ("all", Trigger("all")), ("[i]", Trigger("any", ("g.c.i",)))],
)
def test_triggers(linked: Linked, written: str, trigger: Trigger) -> None:
    timing = linked(TIMED % f"trigger: {written}")[0].components["g.c"].timing
    assert timing is not None
    assert timing.trigger == trigger


@pytest.mark.parametrize(
    ("written", "line"),
    [
        ("period: 0 ms", "85 wrong-value: a period cannot be zero | leave it out where it is not known"),
        ("rate: 0.0 Hz", "83 wrong-value: a rate cannot be zero | leave it out where it is not known"),
        (
            "period: 10 ms, rate: 100 Hz",
            (
                "98 wrong-value: `rate` and `period` are both written (1:85 the period)"
                " | write one of them: each follows from the other"
            ),
        ),
        (
            "bcet: 3 ms, wcet: 2 ms",
            (
                "83 wrong-value: the best case execution time (`bcet`, 3 ms) is above the worst (`wcet`, 2 ms)"
                " (1:95 the worst case) | exchange them, or leave `bcet` out"
            ),
        ),
    ],
)
def test_timing_that_makes_no_sense(told: Told, written: str, line: str) -> None:
    assert told(TIMED % written) == [f"1:{line}"]


@pytest.mark.parametrize("written", ["period: 10 ms, wcet: 15 ms", "period: 10 ms, jitter: 20 ms", "wcet: 0 ms"])
def test_timing_that_is_strange_but_legal(told: Told, written: str) -> None:
    assert told(TIMED % written) == []


ACTIVITIES = """
groups:
  g:
    components:
      a: {inputs: {i: }, timing: {wcet: 2 ms}}
      b: {inputs: {j: }, timing: {wcet: 3 ms}}
nodes:
"""


def test_one_node_has_one_timing_written_in_either_place(linked: Linked, told: Told) -> None:
    nodes = linked(f"{ACTIVITIES}  n: {{implements: a, timing: {{rate: 10 Hz}}}}\n  m: b")[0].nodes
    assert [(str(t.rate), str(t.wcet)) for t in nodes["n"].timing.values()] == [("10 Hz", "2 ms")]
    assert [(str(t.rate), str(t.wcet)) for t in nodes["m"].timing.values()] == [("None", "3 ms")]
    assert told(f"{ACTIVITIES}  n: {{implements: a, timing: {{wcet: 2 ms}}}}") == [
        (
            "8:37 conflicting-values: `wcet` is written at the node `n` and at the component that it implements"
            " (5:41 written here) | keep one of them: a component with one node has one timing"
        )
    ]
    assert told(f"{ACTIVITIES}  n: {{implements: a, timing: {{bcet: 5 ms}}}}") == [
        (
            "8:37 wrong-value: the best case execution time (`bcet`, 5 ms) is above the worst (`wcet`, 2 ms)"
            " (5:41 the worst case) | exchange them, or leave `bcet` out"
        )
    ]


def test_the_timing_of_a_component_with_several_nodes_is_not_inherited(linked: Linked) -> None:
    nodes = linked(f"{ACTIVITIES}  n: {{implements: a, timing: {{rate: 10 Hz}}}}\n  m: a")[0].nodes
    assert [(str(t.rate), str(t.wcet)) for t in nodes["n"].timing.values()] == [("10 Hz", "None")]
    assert nodes["m"].timing == {}


def test_a_node_of_several_components_has_one_activity_for_each(linked: Linked) -> None:
    node = linked(f"{ACTIVITIES}  n: {{implements: [a, b], timing: {{priority: 5, trigger: [i]}}}}")[0].nodes["n"]
    assert [(component, str(t.wcet), t.priority, t.trigger) for component, t in node.timing.items()] == [
        ("g.a", "2 ms", 5, Trigger("any", ("g.a.i",))),
        ("g.b", "3 ms", 5, None),
    ]


def test_a_node_without_component_times_its_own_keys(linked: Linked) -> None:
    node = linked("nodes: {n: {subscribes: {x: }, timing: {trigger: [x]}}}")[0].nodes["n"]
    assert node.timing[""].trigger == Trigger("any", ("x",))
    assert [(use.key, use.port) for use in node.uses] == [("x", None)]


def test_what_of_its_executor_a_node_says_itself_has_a_place_and_the_rest_none(linked: Linked) -> None:
    architecture, _ = linked("""
nodes:
  n: {threads: 2, reentrant: true}
  m:
""")
    places = {
        name: {key: at.line for key, at in node.executor_places.items()} for name, node in architecture.nodes.items()
    }
    assert places == {"n": {"threads": 3, "reentrant": 3}, "m": {}}
