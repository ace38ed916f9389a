"""With fixed priorities and all released at once the analysis is exact: it is what a schedule drawn tick by tick shows."""

from __future__ import annotations

from collections import deque
from fractions import Fraction
from math import lcm
from random import Random

from archgen.timing.run_analysis import analyse_system
from archgen.timing.system.timing_system import Activity, TimingSystem

_PERIODS = (3, 4, 5, 6, 8, 10, 12)
Task = tuple[int, int]
"""Period and execution time."""


def _drawn(tasks: list[Task]) -> list[int]:
    """Draw the schedule of tasks by falling priority, over two rounds of what all periods have in common."""
    whole = lcm(*(period for period, _ in tasks))
    waiting = [deque[list[int]]() for _ in tasks]
    worst = [0] * len(tasks)
    for now in range(2 * whole):
        for (period, cost), queue in zip(tasks, waiting, strict=True):
            if now % period == 0:
                queue.append([now, cost])
        at = next((number for number, queue in enumerate(waiting) if queue), None)
        if at is None:
            continue
        job = waiting[at][0]
        job[1] -= 1
        if not job[1]:
            waiting[at].popleft()
            worst[at] = max(worst[at], now + 1 - job[0])
    return worst


def _analysed(tasks: list[Task]) -> list[object]:
    activities = {
        f"t{at}": Activity(
            f"t{at}", f"t{at}", None, "periodic", period=period, wcet=cost, host="pc", priority=len(tasks) - at
        )
        for at, (period, cost) in enumerate(tasks)
    }
    system = TimingSystem(Fraction(1), activities, (), {}, {}, cores={"pc": 1})
    return [response.worst.value for response in analyse_system(system).responses.values()]


def test_responses_are_those_of_the_schedule() -> None:
    dice = Random(1973)  # noqa: S311 - the same sets each time
    full = 0
    for _ in range(400):
        tasks = [
            (period, dice.randint(1, max(period // 2, 1))) for period in dice.choices(_PERIODS, k=dice.randint(1, 4))
        ]
        load = sum(Fraction(cost, period) for period, cost in tasks)
        if load > 1:
            continue
        full += load == 1
        assert _analysed(tasks) == _drawn(tasks), tasks
    assert full > 5  # a core without any slack as well
