"""Tests of the rules on what fires whom: what they say, and where they keep quiet."""

from __future__ import annotations

from tests.judged_projects import check_text

_RULES = {"endless-trigger", "deadlocked-trigger"}


def told(text: str) -> list[str]:
    found = (d for d in check_text(text) if d.rule in _RULES)
    return [f"{d.span.line} {d.severity} {d.rule}: {d.message}" for d in found]


def test_what_fires_itself() -> None:
    text = """
groups:
  g:
    components:
      a: {inputs: {back: a.out}, outputs: {out: std_msgs/msg/Empty}}
nodes:
  a: {implements: a, timing: {BEHAVIOUR}}
"""
    assert told(text.replace("BEHAVIOUR", "behaviour: event")) == [
        "7 error endless-trigger: `a` fires itself without an end"
    ]
    assert told(text.replace("BEHAVIOUR", "wcet: 1 ms")) == [
        "7 warning endless-trigger: `a` fires itself without an end"
    ]


def test_where_nobody_wrote_of_time_nothing_is_said() -> None:
    text = """
groups:
  g:
    components:
      a: {inputs: {back: b.out}, outputs: {out: std_msgs/msg/Empty}}
      b: {inputs: {on: a.out}, outputs: {out: std_msgs/msg/Empty}}
"""
    assert told(text) == []
