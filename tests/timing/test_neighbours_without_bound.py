"""On several cores, who has a neighbour without a bound has none: any amount of the neighbour's work may wait to run."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from archgen.model.architecture import Architecture
from archgen.timing.run_analysis import analyse_architecture

Derived = Callable[[str], Architecture]

PROJECT = """
groups: {g: {components: {a: {}, b: {}, c: {}, d: {}}}}
nodes:
  a: {implements: a, host: pc, timing: {period: 10 ms, wcet: WCET}}
  b: {implements: b, host: pc, timing: {period: 10 ms, wcet: WCET}}
  c: {implements: c, host: pc, timing: {period: 100 ms, wcet: 5 ms}}
  d: {implements: d, host: pc, timing: {period: 100 ms, wcet: 5 ms}}
hosts: {pc: {cores: 2, scheduling: fixed_priority}}
"""


@pytest.mark.parametrize(("wcet", "bounded"), [("2 ms", True), ("9 ms", False)])
def test_a_neighbour_without_a_bound_leaves_none(derived: Derived, wcet: str, *, bounded: bool) -> None:
    """With 9 ms, a has 0.9 + B = 1, where 2 B = min(0.9, B) + 0.05 + 0.05: no bound, and b neither.

    c has 0.05 + (0.9 + 0.9 + 0.05) / 2 < 1, and theirs in its way; so has d.
    """
    found = analyse_architecture(derived(PROJECT.replace("WCET", wcet))).responses
    assert {name: one.worst.value is not None for name, one in found.items()} == dict.fromkeys("abcd", bounded)
    assert ("diverged" in found["c"].worst.assumptions) is not bounded
