"""Systems by hand, in ms, for tests of the simulation."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction

from archgen.model.declared_timing import SchedulingOrder
from archgen.simulation.event_loop import run_plan
from archgen.simulation.plan_builder import build_plan
from archgen.timing.system.timing_system import Activity, Arc, Executor, StoringCallback, TimingSystem

MS = 1000
"""Units of the engine in one ms."""


def arc(source: str, target: str, **rest: object) -> Arc:
    """Make an arc from an activity's `out` to another's input, which is called as the source is."""
    return replace(Arc(source, "out", target, source, f"/{source}", "topic"), **rest)  # type: ignore[arg-type]


def call(client: str, server: str) -> tuple[Arc, Arc]:
    """Make the two arcs between a client and a server."""
    answer = Arc(server, "serve", client, "ask", "/serve", "service", role="answer")
    return replace(answer, source=client, output="ask", target=server, input="serve", role="request"), answer


def timed(name: str, period: int, wcet: int, **rest: object) -> Activity:
    """Make a periodic activity whose execution time never changes."""
    return replace(Activity(name, name, None, "periodic", period=period, wcet=wcet, bcet=wcet), **rest)  # type: ignore[arg-type]


def event(name: str, wcet: int, *triggers: str, **rest: object) -> Activity:
    """Make an activity that inputs fire."""
    made = Activity(name, name, None, "event", wcet=wcet, bcet=wcet, triggers=triggers)
    return replace(made, **rest)  # type: ignore[arg-type]


def system(
    activities: Sequence[Activity], arcs: Sequence[Arc] = (), cores: Mapping[str, int] | None = None, **rest: object
) -> TimingSystem:
    """Put a system together. `threads` are those of containers, in which each activity has a callback group of its own."""
    boxes: Mapping[str, int | None] = rest.pop("threads", {})  # type: ignore[assignment]
    activities = [
        replace(one, executor=one.executor or f"container {one.container}", callback_group=one.callback_group or one.id)
        if one.container in boxes
        else one
        for one in activities
    ]
    orders: Mapping[int | None, SchedulingOrder] = {1: "ros2_executor"}
    made = {
        f"container {name}": Executor(f"container {name}", count, None, orders.get(count))
        for name, count in boxes.items()
    }
    rest["executors"] = {**made, **rest.get("executors", {})}  # type: ignore[dict-item]
    names = [activity.id for activity in activities]
    return replace(
        TimingSystem(
            Fraction(1_000_000),
            dict(zip(names, activities, strict=True)),
            tuple(arcs),
            {name: tuple(one for one in arcs if one.target == name) for name in names},
            {name: tuple(one for one in arcs if one.source == name) for name in names},
            cores=cores or {},
        ),
        **rest,  # type: ignore[arg-type]
    )


def within(process: str, *activities: Activity, group: str | None = "one") -> list[Activity]:
    """Put activities into a process and a callback group (None: reentrant)."""
    return [replace(one, executor=process, callback_group=group) for one in activities]


def process(name: str, threads: int = 1, order: str | None = None) -> dict[str, Executor]:
    """Make a process with threads."""
    return {name: Executor(name, threads, None, order)}  # type: ignore[arg-type]


def stores(wcet: int = 0) -> StoringCallback:
    """Make a callback that stores a message in always the same time."""
    return StoringCallback(wcet, wcet)


def jobs(of: TimingSystem, until: int, seed: int = 0) -> dict[str, list[tuple[float, float, float]]]:
    """Run a system (seed 0: all phases zero, all execution times the longest); give (fired, started, ended) in ms."""
    plan = build_plan(of)
    run = run_plan(plan, seed, until * MS, range(len(plan.activities)))
    return {
        step.id: [
            (fired / MS, start / MS, end / MS)
            for fired, start, end in zip(
                run.activities.job_activations[at],
                run.activities.job_starts[at],
                run.activities.job_ends[at],
                strict=False,
            )
        ]
        for at, step in enumerate(plan.activities)
    }
