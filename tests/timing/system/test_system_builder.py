"""What is read off an architecture: activities, arcs, sizes, what comes from outside."""

from __future__ import annotations

from fractions import Fraction

import pytest

from archgen.timing.system.system_builder import build_system
from archgen.timing.system.timing_system import Activity, Arc, TimingSystem
from tests.timing.random_systems import architecture

MS = 10**6

TEXT = """
groups:
  g:
    components:
      eye: {outputs: {seen: {type: Seen}, spare: {type: Seen}}}
      mind: {inputs: {a: eye.seen, b: {from: eye.spare, optional: true}, world: {external: Light, medium: physical}}, outputs: {told: {type: Seen}, ask: {type: Ask}}}
      hand: {inputs: {do: mind.told, ask: mind.ask}}
      late: {inputs: {told: mind.told}, outputs: {out: {type: Seen}}, timing: {wcet: 2 ms}}
  h:
    components:
      hand: {inputs: {do: g.mind.told}, timing: {rate: 50 Hz}}
types: {Seen: {message: std_msgs/msg/String, size: 1 kB}, Ask: {message: std_srvs/srv/Trigger}}
nodes:
  head: {implements: [g.eye, g.mind], host: p, container: box}
  arm: {implements: [g.hand, h.hand], host: q, subscribes: {g.hand.do: {qos: {profile: default, depth: 3}}}}
  rest: {implements: g.late, host: r, subscribes: {told: {qos: {history: keep_all}}}}
containers: {box: {threads: 3, host: p}}
hosts: {p: {cores: 2}, q: {}, r: {cores: 4}}
links:
  slow: {connects: [p, q], latency: {best: 1 ms, worst: 9 ms}}
  fast: {connects: [p, q], latency: {best: 2 ms, worst: 3 ms}, bandwidth: 80 Mbit/s}
  dark: {connects: [q, p]}
"""


def _system(text: str) -> TimingSystem:
    return build_system(architecture(text))[0]


def _line(system: TimingSystem, arc: Arc) -> str:
    latency = [None if ticks is None else ticks * system.tick / MS for ticks in (arc.best, arc.worst)]
    marks = [mark for mark, is_set in (("optional", arc.optional), ("asked", arc.depth_written)) if is_set]
    return (
        f"{arc.source} {arc.output} > {arc.target} {arc.input} {arc.role} on {arc.topic} by {arc.link} {latency[0]}..{latency[1]}"
        f" depth {arc.depth} size {arc.size} {' '.join(marks)}@{arc.at.line}:{arc.at.column} {arc.queue_at.line}"
    )


def test_arcs_join_writers_with_readers_over_the_quickest_link() -> None:
    """Of several links the one with the least worst latency counts; none joins q or p with r. Inside `head` it is memory."""
    system = _system(TEXT)
    assert [_line(system, arc) for arc in system.arcs] == [
        "head.mind g.mind.told > arm.g.hand g.hand.do data on /g/mind/told by fast 2..3 depth 3 size 1000 asked@7:27 15",
        "head.mind g.mind.told > arm.h.hand h.hand.do data on /g/mind/told by fast 2..3 depth 10 size 1000 @11:27 0",
        "head.mind g.mind.told > rest g.late.told data on /g/mind/told by None None..None depth None size 1000 @8:29 16",
        "arm.g.hand g.hand.ask > head.mind g.mind.ask request on /g/mind/ask by fast 2..3 depth 10 size None @7:43 0",
        "head.mind g.mind.ask > arm.g.hand g.hand.ask answer on /g/mind/ask by fast 2..3 depth 10 size None @7:43 0",
        "head.eye g.eye.seen > head.mind g.mind.a data on memory g.eye.seen by None 0..0 depth 10 size 1000 @6:26 0",
        "head.eye g.eye.spare > head.mind g.mind.b data on memory g.eye.spare by None 0..0 depth 10 size 1000 optional@6:46 0",
    ]


def test_activities_are_called_after_node_and_component() -> None:
    """Two components of `arm` are called `hand`: their complete ids tell them apart."""
    activities = _system(TEXT).activities
    assert [(a.id, a.node, a.component, a.behaviour, a.host, a.container) for a in activities.values()] == [
        ("head.eye", "head", "g.eye", None, "p", "box"),
        ("head.mind", "head", "g.mind", "event", "p", "box"),
        ("arm.g.hand", "arm", "g.hand", "event", "q", None),
        ("arm.h.hand", "arm", "h.hand", "periodic", "q", None),
        ("rest", "rest", "g.late", "event", "r", None),
    ]
    assert [(a.triggers, a.inputs, a.outputs) for a in activities.values()] == [
        ((), (), ("g.eye.seen", "g.eye.spare")),
        (("g.mind.a", "g.mind.b"), ("g.mind.a", "g.mind.b", "g.mind.world"), ("g.mind.told", "g.mind.ask")),
        (("g.hand.do",), ("g.hand.do", "g.hand.ask"), ()),
        ((), ("h.hand.do",), ()),
        (("g.late.told",), ("g.late.told",), ("g.late.out",)),
    ]
    assert [(a.at.line, a.at.column, a.behaviour_inferred) for a in activities.values()] == [
        (14, 3, True),
        (14, 3, True),
        (15, 3, True),
        (11, 41, True),
        (8, 71, True),
    ]


def test_hosts_links_and_topics_of_the_system() -> None:
    system = _system(TEXT)
    assert system.external_inputs == {"head.mind": ("g.mind.world",)}
    assert system.optional_inputs == frozenset({"g.mind.b"})
    assert (system.cores, system.executors["container box"].threads) == ({"p": 2, "q": None, "r": 4}, 3)
    assert system.bandwidths == {"slow": None, "fast": 10_000_000, "dark": None}
    assert system.served_outputs == frozenset({("head.mind", "g.mind.ask")})
    assert system.topic_writers["memory g.eye.seen"] == (("head.eye", "g.eye.seen"),)
    assert "/g/mind/ask" not in system.topic_writers
    assert set(system.topic_sizes.values()) == {1000}


_NODE = """
groups:
  g:
    components:
      src: {{outputs: {{out: std_msgs/msg/Empty}}}}
      x: {{inputs: {{i: src.out}}, outputs: {{out: std_msgs/msg/Empty{serve}}}}}
types: {{Ask: {{message: std_srvs/srv/Trigger}}}}
nodes:
  n: {{implements: g.x, timing: {{{timing}}}}}
"""


def _activity(timing: str, serve: str = "") -> tuple[Activity, Fraction]:
    system = _system(_NODE.format(timing=timing, serve=serve))
    return system.activities["n"], system.tick


@pytest.mark.parametrize(
    ("timing", "behaviour", "inferred", "triggers"),
    [
        ("", "event", True, ("g.x.i",)),
        ("period: 5 ms", "periodic", True, ()),
        ("behaviour: periodic", "periodic", False, ()),
        ("behaviour: once", "once", False, ()),
        ("behaviour: event, period: 5 ms", "event", False, ("g.x.i",)),
        ("trigger: [i]", "event", True, ("g.x.i",)),
        ("trigger: {all: [i]}", "event", True, ("g.x.i",)),
    ],
)
def test_a_behaviour_is_written_or_inferred(
    timing: str, behaviour: str, inferred: object, triggers: tuple[str, ...]
) -> None:
    activity, _ = _activity(timing)
    assert (activity.behaviour, activity.behaviour_inferred, activity.triggers) == (behaviour, inferred, triggers)


def test_figures_are_in_ticks() -> None:
    activity, tick = _activity(
        "trigger: {all: [i]}, jitter: 3 ms, wcet: 5 ms, bcet: 2 ms, response: 9 ms, every: 4, throttle: 7 ms,"
        " priority: 3, core: 1, outputs: {out: {conditional: true, max_gap: 20 ms}}"
    )
    ticks = (activity.jitter, activity.wcet, activity.bcet, activity.response, activity.throttle)
    assert [count and count * tick / MS for count in ticks] == [3, 5, 2, 9, 7]
    assert (activity.mode, activity.every, activity.priority, activity.core) == ("all", 4, 3, 1)
    assert activity.conditional == frozenset({"g.x.out"})
    assert {key: gap * tick / MS for key, gap in activity.max_gaps.items()} == {"g.x.out": 20}
    plain, _ = _activity("")
    assert (plain.jitter, plain.wcet, plain.bcet, plain.response, plain.throttle) == (0, None, None, None, 0)
    assert (plain.mode, plain.every, plain.priority, plain.core, plain.conditional) == (
        "any",
        1,
        None,
        None,
        frozenset(),
    )


def test_what_belongs_to_no_component_is_the_first_ones() -> None:
    text = """
groups: {g: {components: {a: {outputs: {out: Data}}, c: {outputs: {out: Data}}}}}
nodes:
  n: {implements: [a, c], internal: {publishes: {debug: {topic: ~/debug, message: std_msgs/msg/String}}}}
  m: {internal: {subscribes: {debug: {topic: /n/debug, message: std_msgs/msg/String}}}}
types: {Data: {message: std_msgs/msg/String, size: 1 kB}}
"""
    system = _system(text)
    assert {name: activity.outputs for name, activity in system.activities.items()} == {
        "n.a": ("g.a.out", "/n/debug"),
        "n.c": ("g.c.out",),
        "m": (),
    }
    assert [(arc.source, arc.target, arc.topic) for arc in system.arcs] == [("n.a", "m", "/n/debug")]


def test_an_arc_is_where_its_input_names_the_output_else_where_it_is_read() -> None:
    """Both write on one topic, so that each reader has both; a node that nobody wrote reads at its input."""
    text = """groups: {g: {components: {
  a: {outputs: {out: Data}},
  c: {outputs: {out: Data}},
  b: {inputs: {x: a.out}},
  d: {inputs: {x: c.out}}}}}
nodes:
  a: {implements: a, publishes: {out: {topic: /t}}}
  c: {implements: c, publishes: {out: {topic: /t}}}
  d: {implements: d, subscribes: {x: {topic: /t}}}
types: {Data: {message: std_msgs/msg/String, size: 1 kB}}
"""
    assert [f"{arc.source}>{arc.target} {arc.at.line}:{arc.at.column}" for arc in _system(text).arcs] == [
        "a>d 9:35",
        "c>d 5:19",
        "a>b 4:19",
        "c>b 4:16",
    ]


def test_an_activity_is_where_its_timing_is_written_else_its_node_else_its_component() -> None:
    text = """groups: {g: {components: {
  a: {outputs: {out: Data}},
  b: {inputs: {x: a.out}, timing: {period: 10 ms}},
  c: {inputs: {x: a.out}}}}}
nodes:
  c: {implements: c}
  d: {}
types: {Data: {message: std_msgs/msg/String, size: 1 kB}}
"""
    places = {name: f"{activity.at.line}:{activity.at.column}" for name, activity in _system(text).activities.items()}
    assert places == {"a": "2:3", "b": "3:27", "c": "6:3", "d": "7:3"}
