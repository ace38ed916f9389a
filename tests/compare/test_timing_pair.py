"""Which changes make it necessary to analyse the timing of both versions, and which can make a figure worse."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any, cast

import pytest

from archgen.compare import Change
from archgen.compare.architecture_version import ArchitectureVersion
from archgen.compare.asked_limits import analyse_timing_pair, can_affect_timing
from archgen.compare.comparison import ChangeKind
from archgen.compare.losses.timing_causes import TimingCauses
from archgen.model.quantity import Quantity
from tests.compare.conftest import Checked
from tests.compare.elements import by_key, pair, with_values

TIMED = """\
groups: {g: {components: {a: {outputs: {x: std_msgs/msg/Int8}}, b: {inputs: {x: a.x}}}}}
nodes:
  na: {implements: a, timing: {rate: 10 Hz, wcet: 2 ms}, host: pc}
  nb: {implements: b, timing: {behaviour: event, wcet: 5 ms}, host: pc}
hosts: {pc: {cores: 1}}
"""
CHAIN = TIMED + "chains: {c: {through: [a, b]}}\n"
RATE = Change("changed", "component", "g.a", key="timing.rate")


@pytest.mark.parametrize(
    ("kind", "element_kind", "key", "affects"),
    [
        ("changed", "component", "timing.rate", True),
        ("changed", "component", "co_owners", False),  # once only `owner` was listed
        ("changed", "component", "owner", False),
        ("changed", "node", "co_owners", False),
        ("changed", "node", "host", True),
        ("changed", "node", "parameters.x", False),
        ("changed", "port", "qos", True),
        ("changed", "connection", None, True),
        ("added", "component", None, True),
        ("removed", "host", None, True),
        ("renamed", "component", None, False),
        ("moved", "component", None, False),
        ("added", "partner", None, False),
        ("added", "requirement", None, False),
        ("removed", "view", None, False),
        ("added", "policy", None, False),
        ("changed", "use_case", "title", False),
        ("changed", "project", "shared_topics", False),
    ],
)
def test_what_can_affect_timing(kind: ChangeKind, element_kind: str, key: str | None, affects: bool) -> None:  # noqa: FBT001
    assert can_affect_timing(Change(kind, element_kind, "x", key=key)) is affects


def test_timing_is_analysed_only_for_chains_and_overloads(checked: Checked) -> None:
    def analysed(before: str, after: str, *changes: Change) -> bool:
        return (
            analyse_timing_pair(ArchitectureVersion(checked(before)), ArchitectureVersion(checked(after)), changes)
            is not None
        )

    assert analysed(CHAIN, CHAIN, RATE)
    assert analysed(CHAIN, TIMED, RATE)
    assert analysed(TIMED, CHAIN, RATE)
    assert not analysed(CHAIN, CHAIN)
    assert not analysed(CHAIN, CHAIN, Change("renamed", "component", "g.a"))
    assert analysed(CHAIN, CHAIN, Change("renamed", "component", "g.a"), RATE)
    assert not analysed(TIMED, TIMED, RATE)  # nothing is overloaded
    full = TIMED.replace("wcet: 5 ms", "wcet: 99 ms")
    assert analysed(TIMED, full, RATE)
    assert not analysed(full, TIMED, RATE)
    bare = TIMED.replace("hosts: {pc: {cores: 1}}\n", "").replace(", host: pc", "")
    assert not analysed(bare, bare, RATE)
    just = TIMED.replace("wcet: 5 ms", "wcet: 98 ms")  # exactly one core
    assert analysed(TIMED, just, RATE) == analysed(TIMED, full, RATE)


def test_what_could_not_be_read_is_not_analysed(checked: Checked) -> None:
    whole = ArchitectureVersion(checked(CHAIN))
    part = ArchitectureVersion(replace(whole.architecture, unread_keys=frozenset({"x"})))
    assert analyse_timing_pair(part, whole, [RATE]) is None
    assert analyse_timing_pair(whole, part, [RATE]) is None


def quantity(text: str) -> Quantity:
    return Quantity(cast("Any", int(text)), text)


@pytest.mark.parametrize(
    ("element_kind", "key", "before", "after", "worse"),
    [
        ("host", "cores", 4, 2, True),
        ("host", "cores", 2, 4, False),
        ("host", "cores", 2, 2, False),
        ("host", "cores", None, 2, True),
        ("host", "cores", 2, None, True),
        ("container", "threads", 2, 1, True),
        ("link", "bandwidth", quantity("2"), quantity("1"), True),
        ("link", "bandwidth", quantity("1"), quantity("2"), False),
        ("link", "latency.worst", quantity("1"), quantity("2"), True),
        ("link", "latency.worst", quantity("2"), quantity("2"), False),
        ("link", "latency.best", quantity("2"), quantity("1"), False),
        ("component", "timing.wcet", quantity("1"), quantity("2"), True),
        ("component", "timing.wcet", quantity("2"), quantity("1"), False),
        ("component", "timing.bcet", quantity("2"), quantity("1"), False),
        ("component", "timing.response", quantity("2"), quantity("1"), False),
        ("component", "timing.jitter", quantity("1"), quantity("2"), True),
        ("component", "timing.every", 2, 1, True),
        ("component", "timing.throttle", quantity("1"), quantity("2"), False),
        ("component", "timing.rate", quantity("1"), quantity("2"), True),  # either way: another rate, another load
        ("component", "timing.outputs.x.max_gap", quantity("2"), quantity("1"), True),
        ("component", "role", "sink", "filter", False),
        ("node", "timing.g.a.wcet", quantity("2"), quantity("1"), True),
        ("node", "host", "a", "b", True),
        ("node", "kind", None, "driver", True),
        ("type", "size", quantity("1"), quantity("2"), True),
        ("type", "size", quantity("2"), quantity("1"), False),
        ("type", "message", "a", "b", True),
        ("type", "request", "a", "b", False),
        ("chain", "deadline", quantity("2"), quantity("1"), True),
        ("output", "type", "T", "U", False),
        ("port", "qos", "a", "b", True),
        ("port", "topic", "a", "b", False),
        ("component", "title", "a", "b", False),
    ],
)
def test_what_can_make_a_figure_worse(element_kind: str, key: str, before: object, after: object, worse: bool) -> None:  # noqa: FBT001
    sides = [
        by_key(with_values(f"{element_kind} x", {} if value is None else {key: value})) for value in (before, after)
    ]
    context = SimpleNamespace(versions=pair(sides[0], sides[1]))
    causes = TimingCauses(cast("Any", context), cast("Any", None))
    assert causes.can_worsen(Change("changed", element_kind, "x", key=key)) is worse


def test_whole_elements_can_always_make_a_figure_worse_names_never() -> None:
    causes = TimingCauses(cast("Any", SimpleNamespace(versions=pair({}, {}))), cast("Any", None))
    assert causes.can_worsen(Change("added", "component", "g.a"))
    assert causes.can_worsen(Change("changed", "connection", "g.a.x"))
    assert not causes.can_worsen(Change("renamed", "component", "g.a"))
    assert not causes.can_worsen(Change("added", "view", "v"))
