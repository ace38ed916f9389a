"""Endpoints, field by field: which of several statements about a message, a topic or a type counts."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from archgen.model.architecture import Architecture
from archgen.model.node import Endpoint

Derived = Callable[[str], Architecture]

PAIR = """
groups:
  g:
    components:
      a: {{outputs: {{o: {sent}}}}}
      b: {{inputs: {{i: {{from: a.o{expected}}}}}}}
nodes:
  writer: {{implements: a{written}}}
  reader: {{implements: b{read}}}
types:
  Known: std_msgs/msg/Int8
  Other: std_msgs/msg/Int16
  Open: {{status: planned}}
"""


def reader_of(architecture: Architecture) -> Endpoint:
    (endpoint,) = (e for e in architecture.endpoints if e.node == "reader")
    return endpoint


@pytest.mark.parametrize(
    ("statements", "message", "kind"),
    [
        (("Known", "", "", ""), "std_msgs/msg/Int8", "Known"),
        (("Known", "Other", "", ""), "std_msgs/msg/Int8", "Other"),
        (("Open", "Other", "", ""), "std_msgs/msg/Int16", "Other"),
        (("Open", "Open", "", ""), None, "Open"),
        (("", "Other", "", ""), "std_msgs/msg/Int16", "Other"),
        (("", "", "", ""), None, None),
        (("Open", "Other", "std_msgs/msg/Int32", ""), "std_msgs/msg/Int32", "Other"),
        (("Known", "Other", "std_msgs/msg/Int32", "std_msgs/msg/Int64"), "std_msgs/msg/Int64", "Other"),
        (("Known", "", "", "std_msgs/msg/Int64"), "std_msgs/msg/Int64", "Known"),
    ],
)
def test_what_a_node_writes_outranks_what_is_sent_and_that_what_is_expected(
    derived: Derived, statements: tuple[str, str, str, str], message: str | None, kind: str | None
) -> None:
    """The statements: the type that is sent, the one that is expected, the messages that writer and reader name."""
    sent, expected, written, read = statements
    text = PAIR.format(
        sent=sent,
        expected=f", type: {expected}" if expected else "",
        written=f", publishes: {{o: {{message: {written}}}}}" if written else "",
        read=f", subscribes: {{i: {{message: {read}}}}}" if read else "",
    )
    endpoint = reader_of(derived(text))
    assert (endpoint.message, endpoint.type, endpoint.written) == (message, kind, bool(read))


@pytest.mark.parametrize(
    ("entry", "use", "flow", "message"),
    [
        ("", "subscribes", "topic", None),
        (", type: Known", "subscribes", "topic", "std_msgs/msg/Int8"),
        (", type: Call", "calls", "service", "std_srvs/srv/Trigger"),
        (", type: Act", "calls", "action", "nav2_msgs/action/Wait"),
    ],
)
def test_an_input_that_comes_from_outside_has_its_own_topic(
    derived: Derived, entry: str, use: str, flow: str, message: str | None
) -> None:
    text = f"""
groups: {{g: {{components: {{b: {{inputs: {{i: {{external: The user{entry}}}}}}}}}}}}}
nodes: {{reader: {{implements: b}}}}
types: {{Known: std_msgs/msg/Int8, Call: std_srvs/srv/Trigger, Act: nav2_msgs/action/Wait}}
"""
    endpoint = reader_of(derived(text))
    assert (endpoint.use, endpoint.flow, endpoint.name, endpoint.message) == (use, flow, "/g/b/i", message)
    assert (endpoint.sources, endpoint.written, endpoint.name_written) == ((), False, False)


@pytest.mark.parametrize(
    ("section", "body", "use", "flow"),
    [
        ("subscribes", "/t", "subscribes", "topic"),
        ("calls", "/t", "calls", "service"),
        ("calls", "{name: /t, message: nav2_msgs/action/Wait}", "calls", "action"),
        ("subscribes", "{topic: /t, message: std_srvs/srv/Trigger}", "calls", "service"),
    ],
)
def test_an_entry_of_an_input_from_outside_names_its_topic(
    derived: Derived, section: str, body: str, use: str, flow: str
) -> None:
    text = f"""
groups: {{g: {{components: {{b: {{inputs: {{i: {{external: The user}}}}}}}}}}}}
nodes: {{reader: {{implements: b, {section}: {{i: {body}}}}}}}
"""
    endpoint = reader_of(derived(text))
    assert (endpoint.use, endpoint.flow, endpoint.name) == (use, flow, "/t")
    assert (endpoint.written, endpoint.name_written) == (True, True)


MIXED = """
groups:
  g:
    components:
      a: {outputs: {o: std_msgs/msg/Int8, s: std_srvs/srv/Trigger, act: nav2_msgs/action/Wait, light: {medium: physical}, u: Unknown}}
      b: {inputs: {i: [a.o, a.s, a.act, a.light], u: a.u, light: {from: a.light, medium: physical}}}
nodes:
  writer: {implements: a%s}
  reader: {implements: b%s}
"""


def texts_of(architecture: Architecture, node: str) -> list[str]:
    return [
        f"{e.use} {e.name} {e.flow} {' '.join(e.sources)}".strip() for e in architecture.endpoints if e.node == node
    ]


def test_an_input_reads_topics_and_calls_services_by_what_its_sources_are(derived: Derived) -> None:
    assert texts_of(derived(MIXED % ("", "")), "reader") == [
        "subscribes /g/a/o topic g.a.o",
        "calls /g/a/s service g.a.s",
        "calls /g/a/act action g.a.act",
        "subscribes /g/a/u topic g.a.u",
    ]


def test_an_entry_in_one_section_leaves_the_other_as_it_is(derived: Derived) -> None:
    assert texts_of(derived(MIXED % ("", ", calls: {i: /other}")), "reader") == [
        "calls /other service",
        "subscribes /g/a/o topic g.a.o",
        "subscribes /g/a/u topic g.a.u",
    ]
    assert texts_of(derived(MIXED % ("", ", subscribes: {i: }")), "reader") == [
        "subscribes /g/a/o topic g.a.o",
        "calls /g/a/s service g.a.s",
        "calls /g/a/act action g.a.act",
        "subscribes /g/a/u topic g.a.u",
    ]


def test_an_entry_in_the_wrong_section_is_read_as_if_it_were_in_the_right_one(derived: Derived) -> None:
    assert texts_of(derived(MIXED % ("", ", calls: {u: /right}")), "reader")[-1] == "subscribes /right topic"


def test_what_a_writer_is_called_and_how(derived: Derived) -> None:
    text = MIXED % (", publishes: {o: [/p, /q]}, serves: {s: {name: /call}, u: /unknown}", "")
    architecture = derived(text)
    writers = [e for e in architecture.endpoints if e.node == "writer"]
    assert [(e.use, e.name, e.flow, e.written, e.name_written) for e in writers] == [
        ("publishes", "/p", "topic", True, True),
        ("publishes", "/q", "topic", True, True),
        ("serves", "/call", "service", True, True),
        ("serves", "/g/a/act", "action", False, False),
        ("serves", "/unknown", "service", True, True),
    ]
    assert texts_of(architecture, "reader") == [
        "subscribes /p topic g.a.o",
        "subscribes /q topic g.a.o",
        "calls /call service g.a.s",
        "calls /g/a/act action g.a.act",
        "calls /unknown service g.a.u",
    ]


def test_several_nodes_carry_only_what_they_list(derived: Derived) -> None:
    text = """
groups: {g: {components: {a: {inputs: {i: , j: }, outputs: {o: std_msgs/msg/Int8, p: std_msgs/msg/Int8}}}}}
nodes: {one: {implements: a, publishes: {o: }, subscribes: {i: }}, two: {implements: a, publishes: {p: /p}}}
"""
    assert [f"{e.node} {e.use} {e.name}" for e in derived(text).endpoints] == [
        "one publishes /g/a/o",
        "one subscribes /g/a/i",
        "two publishes /p",
    ]


def test_what_arrives_is_all_that_stands_on_the_topic_unless_all_nodes_share_it(derived: Derived) -> None:
    text = """
ros: {distro: jazzy, shared_topics: [/all]}
groups:
  g:
    components:
      a: {outputs: {o: std_msgs/msg/Int8, p: std_msgs/msg/Int8}}
      c: {outputs: {o: std_msgs/msg/Int8, p: std_msgs/msg/Int8}}
      b: {inputs: {i: a.o, j: a.p}}
nodes:
  writer: {implements: a, publishes: {o: /same, p: /all}}
  third: {implements: c, publishes: {o: /same, p: /all}}
  reader: {implements: b}
"""
    assert texts_of(derived(text), "reader") == [
        "subscribes /same topic g.a.o g.c.o",
        "subscribes /all topic g.a.p",
    ]


def test_internal_readers_take_message_and_type_of_the_writer_of_their_name(derived: Derived) -> None:
    text = """
groups: {g: {components: {a: {outputs: {o: Known, s: Call}}, c: {title: C}}}}
nodes:
  one: {implements: a, publishes: {o: /o}, serves: {s: /s}, internal: {publishes: {k: {message: std_msgs/msg/Int16}}}}
  two: {implements: a, publishes: {}, internal: {subscribes: {k: , x: /o, y: {topic: /o, message: std_msgs/msg/Int64}, z: /none}, calls: {s: /s}}}
  free: {implements: c, internal: {subscribes: {k: }, serves: {v: }}}
  bare: {subscribes: {q: /o}, publishes: {r: {message: std_srvs/srv/Trigger}}}
types: {Known: std_msgs/msg/Int8, Call: nav2_msgs/action/Wait}
"""
    endpoints = [e for e in derived(text).endpoints if not e.port]
    assert [
        f"{e.node} {e.use} {e.name} {e.flow} {e.message} {e.type} {e.component} {e.internal}" for e in endpoints
    ] == [
        "one publishes /g/a/k topic std_msgs/msg/Int16 None g.a True",
        "two subscribes /g/a/k topic std_msgs/msg/Int16 None g.a True",
        "two subscribes /o topic std_msgs/msg/Int8 Known g.a True",
        "two subscribes /o topic std_msgs/msg/Int64 None g.a True",
        "two subscribes /none topic None None g.a True",
        "two calls /s action nav2_msgs/action/Wait Call g.a True",
        "free subscribes /g/c/k topic None None g.c True",
        "free serves /g/c/v service None None g.c True",
        "bare serves /r service std_srvs/srv/Trigger None None False",
        "bare subscribes /o topic std_msgs/msg/Int8 Known None False",
    ]
