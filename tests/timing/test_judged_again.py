"""Judging many versions of one project: what is the same is found once, and a place that moved is told as it is."""

from __future__ import annotations

import pytest

from archgen import pipeline
from archgen.timing import run_analysis as module

PROJECT = """\
archgen: 1
groups:
  g:
    components:
      a: {outputs: {x: std_msgs/msg/Empty}}
      b: {inputs: {x: a.x}}
nodes:
  a: {implements: a, timing: {rate: 10 Hz, wcet: 60 ms}, host: pc}
  b: {implements: b, timing: {rate: 10 Hz, wcet: 60 ms}, host: pc}
hosts: {pc: {cores: 1}}
"""


def found(text: str) -> list[tuple[str, int]]:
    return [(d.rule, d.span.line) for d in pipeline.check_text(text) if d.rule == "overloaded-host"]


def test_the_same_system_is_analysed_once(monkeypatch: pytest.MonkeyPatch) -> None:
    first = found(PROJECT)
    assert first
    with monkeypatch.context() as patched:
        patched.setattr(module, "analyse_system", lambda *_, **__: pytest.fail("it is known already"))
        assert found(PROJECT) == first
        assert found(PROJECT + "# a comment\n") == first


def test_what_moved_or_changed_is_analysed_again() -> None:
    first = found(PROJECT)
    assert found(f"# a comment\n{PROJECT}") == [(rule, line + 1) for rule, line in first]
    assert found(PROJECT.replace("60 ms", "40 ms")) == []
    assert found(PROJECT.replace("cores: 1", "cores: 2")) == []
