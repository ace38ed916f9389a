"""Tests of quality of service: every policy, offered against requested."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import pytest

from archgen.analyses import qos_compatibility
from archgen.analyses.qos_compatibility import QosConflict, find_qos_conflicts, incompatible_qos
from archgen.diagnostics.diagnostic import Diagnostic, Severity
from archgen.diagnostics.source_span import Span
from archgen.model.architecture import Architecture, ProjectInfo
from archgen.model.node import Endpoint, Node, Qos, Topic
from archgen.model.quantity import Quantity, parse_quantity
from tests.judged_projects import check_text

_VALUES: dict[str, tuple[str | None, ...]] = {
    "reliability": ("best_effort", "reliable"),
    "durability": ("volatile", "transient_local"),
    "deadline": (None, "0 s", "10 ms", "100 ms"),
    "liveliness": ("automatic", "manual_by_topic"),
    "lease_duration": (None, "0 s", "10 ms", "100 ms"),
    "history": ("keep_last", "keep_all"),
    "depth": (None, "1", "100"),
    "lifespan": (None, "10 ms", "100 ms"),
}
_TOO_LITTLE = {
    ("reliability", "best_effort", "reliable"),
    ("durability", "volatile", "transient_local"),
    ("liveliness", "automatic", "manual_by_topic"),
    *((policy, offer, "10 ms") for policy in ("deadline", "lease_duration") for offer in (None, "0 s", "100 ms")),
    *((policy, offer, "100 ms") for policy in ("deadline", "lease_duration") for offer in (None, "0 s")),
}


def _qos(policy: str, value: str | None) -> Qos:
    given: Any = parse_quantity(value, "duration") if value else None
    if value and not isinstance(given, Quantity):
        given = int(value) if value.isdigit() else value
    return replace(Qos(), **{policy: given})


@pytest.mark.parametrize(
    ("policy", "offered", "requested"),
    [(policy, a, b) for policy, values in _VALUES.items() for a in values for b in values],
)
def test_an_offer_must_be_as_good_as_the_request(policy: str, offered: str | None, requested: str | None) -> None:
    found = [clash.policy for clash in find_qos_conflicts(_qos(policy, offered), _qos(policy, requested))]
    assert found == ([policy.replace("_", " ")] if (policy, offered, requested) in _TOO_LITTLE else [])


@pytest.mark.parametrize("policy", ["deadline", "lease_duration"])
def test_a_duration_of_one_nanosecond_is_given(policy: str) -> None:
    (clash,) = find_qos_conflicts(_qos(policy, None), _qos(policy, "1 ns"))
    assert clash.policy == policy.replace("_", " ")
    assert list(find_qos_conflicts(_qos(policy, "1 ns"), _qos(policy, "1 ns"))) == []


def _judge(writer: Qos, reader: Qos, *, distro: str | None = "jazzy", planned: str = "") -> list[Diagnostic]:
    nodes = {
        name: Node(name, name, written=name != planned, at=Span("a.yaml", 9, 1, 9, 2)) for name in ("lidar", "mapper")
    }
    ends = (
        Endpoint(
            "lidar", "publishes", "/scan", "topic", "a.lidar.scan", "a.lidar", qos=writer, at=Span("a.yaml", 1, 1, 1, 2)
        ),
        Endpoint(
            "mapper", "subscribes", "/scan", "topic", "a.map.scan", "a.map", qos=reader, at=Span("a.yaml", 2, 1, 2, 2)
        ),
    )
    topic = Topic("/scan", "topic", (), (), ends[:1], ends[1:])
    made = Architecture(ProjectInfo("p", "P"), distro=distro, nodes=nodes, endpoints=ends, topics={"/scan": topic})
    return list(incompatible_qos(made))


_SENSOR = Qos("sensor_data", reliability="best_effort", depth=5, written=True)
_RELIABLE = Qos(written=True)


def test_the_message_says_what_happens_on_the_robot() -> None:
    requested = replace(_RELIABLE, deadline=parse_quantity("50 ms", "duration"))
    (diagnostic,) = _judge(replace(_SENSOR, deadline=parse_quantity("0.1 s", "duration")), requested)
    assert diagnostic.message == (
        "`mapper` receives nothing from `lidar` on `/scan`: it asks for reliable delivery and a message every 50 ms,"
        " and is offered best effort only and one every 0.1 s"
    )
    assert diagnostic.help == (
        "needed: `reliability: reliable` or `best_effort` on both sides; a `deadline` of 50 ms or less at the publisher"
    )
    assert (diagnostic.span.line, diagnostic.labels[0].span.line, diagnostic.severity) == (2, 1, None)


def test_a_side_left_out_makes_it_a_warning() -> None:
    (diagnostic,) = _judge(_SENSOR, Qos())
    assert diagnostic.severity is Severity.WARNING
    assert diagnostic.message.endswith("(`mapper` leaves `qos` out, so the profile `default` counts)")


def test_many_ends_of_one_topic_are_judged_by_their_settings(monkeypatch: pytest.MonkeyPatch) -> None:
    calls = []

    def count(*pair: Qos) -> Iterator[QosConflict]:
        calls.append(pair)
        return find_qos_conflicts(*pair)

    monkeypatch.setattr(qos_compatibility, "find_qos_conflicts", count)
    nodes = "".join(
        f"  n{number}: {{implements: a.c, publishes: {{o: {{topic: /t}}}}, subscribes: {{i: {{topic: /t, qos: {{reliability: {('reliable', 'best_effort')[number % 2]}}}}}}}}}\n"
        for number in range(30)
    )
    text = "archgen: 1\nproject: {id: x}\nros: {distro: jazzy}\ngroups: {a: {components: {c: {outputs: {o: T}, inputs: {i: T}}}}}\ntypes: {T: std_msgs/msg/String}\nnodes:\n"
    check_text(text + nodes)
    assert 0 < len(calls) < 10


def test_planned_nodes_and_ros_1_have_nothing_to_agree_on() -> None:
    assert _judge(_SENSOR, Qos(), planned="mapper") == []
    assert _judge(_SENSOR, _RELIABLE, distro="noetic") == []
    assert len(_judge(_SENSOR, _RELIABLE, distro=None)) == 1


def test_a_side_left_to_the_middleware_makes_it_a_warning() -> None:
    (diagnostic,) = _judge(_SENSOR, Qos("system_default", written=True))
    assert diagnostic.severity is Severity.WARNING
    assert diagnostic.message.endswith("(`mapper` leaves it to the middleware, whose usual values count)")


def test_a_side_that_nobody_wrote_has_its_node_as_place() -> None:
    text = """\
groups:
  g:
    components:
      scanner: {outputs: {scan: sensor_msgs/msg/LaserScan}}
      mapper: {inputs: {scan: scanner.scan}}
nodes:
  lidar: {implements: scanner, publishes: {scan: {qos: sensor_data}}}
  mapper: {implements: mapper}
"""
    (diagnostic,) = (d for d in check_text(text) if d.rule == "incompatible-qos")
    assert (diagnostic.span.line, diagnostic.span.column, diagnostic.labels[0].span.line) == (8, 3, 7)
