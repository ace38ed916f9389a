"""Over random processes: never more callbacks at once than threads, never two of one group."""

from __future__ import annotations

import random
from dataclasses import replace
from itertools import pairwise

import pytest

from archgen.model.declared_timing import SchedulingOrder
from archgen.simulation.event_loop import run_plan
from archgen.simulation.plan_builder import build_plan
from archgen.timing.system.timing_system import Activity, Arc, Executor, ResourceUse, SharedResource, StoringCallback
from tests.property_sizes import try_some
from tests.simulation.systems import MS, arc, event, system, timed

ORDERS: tuple[SchedulingOrder | None, ...] = (
    None,
    None,
    "ros2_executor",
    "fifo",
    "non_preemptive",
    "round_robin",
    "edf",
)
HOST_ORDERS: tuple[SchedulingOrder | None, ...] = (
    None,
    "fixed_priority",
    "non_preemptive",
    "fifo",
    "round_robin",
    "edf",
)


def _draw_activity(dice: random.Random, at: int, arcs: list[Arc]) -> Activity:
    name, cost = f"n{at}", dice.randint(0, 4)
    firing, read = (sorted({f"n{dice.randrange(at)}" for _ in range(2)}) if at else [] for _ in range(2))
    read = [source for source in read if source not in firing]
    arcs += [arc(source, name, depth=dice.choice((None, 1, 3))) for source in (*firing, *read)]
    made = timed(name, dice.randint(8, 40), cost)
    if firing and dice.random() < 0.7:
        made = event(name, cost, *firing, mode=dice.choice(("any", "all", "match")), within=dice.choice((0, 9)))
    process = dice.randrange(3)
    return replace(
        made,
        host=dice.choice(("h", "h", None)) if process == 0 else "h",
        executor=f"p{process}",
        callback_group=dice.choice((f"p{process}.a", f"p{process}.b", None)),
        priority=dice.choice((None, 1, 5, 9)),
        cores=dice.choice(((), (), (0,), (0, 1))),
        storing={source: StoringCallback(dice.randint(0, 2)) for source in read},
        uses={"gpu": ResourceUse(3, 1)} if dice.random() < 0.3 else {},
    )


def _count_at_once(intervals: list[tuple[int, int]]) -> int:
    """Return how many intervals overlap at most; one that ends where another begins does not."""
    edges = sorted([(start, 1) for start, _ in intervals] + [(end, -1) for _, end in intervals])
    depth = most = 0
    for _, change in edges:
        depth += change
        most = max(most, depth)
    return most


@pytest.mark.parametrize("first", try_some(range(0, 200, 50), 2))
def test_threads_and_groups_are_never_taken_twice(first: int) -> None:
    jobs_seen = 0
    for seed in range(first, first + 50):
        dice = random.Random(seed)  # noqa: S311 - a test's dice
        arcs: list[Arc] = []
        activities = [_draw_activity(dice, at, arcs) for at in range(dice.randint(2, 9))]
        executors = {
            f"p{at}": Executor(f"p{at}", dice.choice((1, 1, 2, 3)), None, dice.choice(ORDERS)) for at in range(3)
        }
        of = system(
            activities,
            arcs,
            {"h": dice.choice((1, 2, 3))},
            executors=executors,
            resources={"gpu": SharedResource("gpu", None, dice.choice((None, "fifo", "fixed_priority")))},
            host_orders={"h": order} if (order := dice.choice(HOST_ORDERS)) else {},
        )
        plan = build_plan(of)
        run = run_plan(plan, seed, 400 * MS, range(len(plan.activities)))
        spans = {
            one.id: [
                (start, end)
                for start, end in zip(run.activities.job_starts[at], run.activities.job_ends[at], strict=False)
                if end > start
            ]
            for at, one in enumerate(plan.activities)
        }
        jobs_seen += sum(map(len, spans.values()))
        for key, executor in executors.items():
            busy = [span for one in activities if one.executor == key for span in spans[one.id]]
            assert _count_at_once(busy) <= (executor.threads or 1), (seed, key)
        for group in {one.callback_group for one in activities} - {None}:
            assert _count_at_once([s for one in activities if one.callback_group == group for s in spans[one.id]]) <= 1
        for at, one in enumerate(plan.activities):
            ends = [end for end in run.activities.job_ends[at] if end >= 0]
            fired_in_order = activities[at].callback_group is not None
            assert not fired_in_order or all(old <= new for old, new in pairwise(ends)), (seed, one.id)
    assert jobs_seen > 1000
