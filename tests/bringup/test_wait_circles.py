"""Which waits stay out so that none closes a circle: always the least needed, and never one too many."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from archgen.bringup.plan_shapes import NEEDS, Wait, WaitReason
from archgen.bringup.wait_circles import keep_acyclic
from archgen.model.graph_search import find_reachable, find_rings
from tests.quiet_seconds import measure_quiet_seconds

STEPS = [f"s{at}" for at in range(7)]
WAITS = st.lists(
    st.builds(Wait, st.sampled_from(STEPS), st.sampled_from(STEPS), st.sampled_from(list[WaitReason](NEEDS))),
    max_size=25,
    unique_by=lambda wait: (wait.awaited, wait.waiting, wait.reason),
)


def successors_of(waits: list[Wait]) -> dict[str, list[str]]:
    return {step: [wait.waiting for wait in waits if wait.awaited == step] for step in STEPS}


@settings(max_examples=200, deadline=None)
@given(WAITS)
def test_what_stays_has_no_circle_and_what_does_not_would_close_one(waits: list[Wait]) -> None:
    kept, dropped = keep_acyclic(STEPS, waits)
    assert sorted(map(repr, [*kept, *(each.wait for each in dropped)])) == sorted(map(repr, waits))
    assert find_rings(successors_of(kept)) == []
    for each in dropped:
        needed = [wait for wait in kept if wait.need >= each.wait.need]
        assert each.wait.awaited in find_reachable(successors_of(needed), [each.wait.waiting])
        assert (each.circle[0], each.circle[-1]) == (each.wait.waiting, each.wait.awaited)
        pairs = {(wait.awaited, wait.waiting) for wait in needed}
        assert set(zip(each.circle, each.circle[1:], strict=False)) <= pairs


def test_of_waits_needed_alike_few_stay_out() -> None:
    waits = [Wait("s0", f"s{at}", "data") for at in range(1, 7)] + [Wait(f"s{at}", "s0", "data") for at in (1, 2)]
    _, dropped = keep_acyclic(STEPS, waits)
    assert len(dropped) == 2


@pytest.mark.slow
def test_three_thousand_steps_with_loops_take_little_time() -> None:
    steps = [f"s{at}" for at in range(3000)]
    reasons: tuple[WaitReason, ...] = ("data", "sampled", "optional", "service")
    waits = [
        Wait(steps[at], steps[(at + ahead) % 3000], reasons[(at + ahead) % 4])
        for at in range(3000)
        for ahead in (1, 7, 31, -3 - at % 11)
    ]
    answers = []
    assert measure_quiet_seconds(lambda: answers.append(keep_acyclic(steps, waits))) < 4  # it is 0.8 s
    ((kept, dropped),) = answers
    assert len(kept) + len(dropped) == 12_000
    assert find_rings(_group(steps, kept)) == []


def _group(steps: list[str], waits: list[Wait]) -> dict[str, list[str]]:
    grouped: dict[str, list[str]] = {step: [] for step in steps}
    for wait in waits:
        grouped[wait.awaited].append(wait.waiting)
    return grouped
