"""Tests of the rules on timing that has no effect: what they say, where, and where they keep quiet."""

from __future__ import annotations

import pytest

from tests.judged_projects import check_text

TEXT = """
groups:
  g:
    components:
      a: {outputs: {out: std_msgs/msg/Empty, plan: nav_msgs/srv/GetPlan, later: Not mapped yet}}
      b: {inputs: {one: a.out, plan: a.plan, later: a.later}, outputs: {two: std_msgs/msg/Empty}}
hosts: {pc: {cores: 4}, board: {cores: 1}, cloud: {}}
nodes:
  a: {implements: a, timing: {rate: 10 Hz}}
  b:
    implements: b
    HOST
    timing: {TIMING}
"""


def told(timing: str, host: str = "host: pc") -> list[str]:
    text = TEXT.replace("TIMING", timing).replace("HOST", host)
    found = (d for d in check_text(text) if d.rule in {"idle-timing", "absent-core"})
    return [f"{d.span.line}:{d.span.column} {d.severity} {d.rule}: {d.message}" for d in found]


@pytest.mark.parametrize(
    ("timing", "message"),
    [
        ("rate: 5 Hz, every: 2", "33 warning idle-timing: `every` of `b` has no effect: its period fires it"),
        ("period: 5 ms, trigger: all", "37 warning idle-timing: `trigger` of `b` has no effect: its period fires it"),
        (
            "behaviour: once, throttle: 1 s",
            "41 warning idle-timing: `throttle` of `b` has no effect: it works once, at the start",
        ),
        (
            "behaviour: on_demand, every: 2",
            "43 warning idle-timing: `every` of `b` has no effect: calls fire it, each of them",
        ),
        (
            "calls: {plan: 2, one: 3}",
            "31 warning idle-timing: `calls` of `b` has no effect for `g.b.one`: it is a topic, which nobody calls",
        ),
        (
            "outputs: {two: {max_gap: 1 s}}",
            "24 warning idle-timing: `max_gap` of `g.b.two` has no effect: it is published at each activation",
        ),
        ("core: 4", "20 warning absent-core: `b` is pinned to core 4, but `pc` has the cores 0 to 3"),
    ],
)
def test_what_has_no_effect_is_said_at_its_place(timing: str, message: str) -> None:
    assert told(timing) == [f"13:{message}"]


def test_a_host_with_one_core_has_core_0() -> None:
    assert told("core: 1", "host: board") == [
        "13:20 warning absent-core: `b` is pinned to core 1, but `board` has only core 0"
    ]


@pytest.mark.parametrize(
    "timing",
    [
        "behaviour: event, rate: 10 Hz, every: 1",
        "trigger: all, throttle: 5 ms",
        "calls: {plan: 2, later: 3}",
        "outputs: {two: {conditional: true, max_gap: 1 s}}",
        "core: 3",
    ],
)
def test_what_counts_is_no_finding(timing: str) -> None:
    assert told(timing) == []
    assert told("core: 9", "host: cloud") == []
