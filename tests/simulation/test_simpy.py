"""SimPy, an independent simulator, gives the same schedules event by event."""

from __future__ import annotations

from collections.abc import Generator
from typing import Any

import pytest
import simpy

from tests.simulation.systems import arc, event, jobs, system, timed

Jobs = dict[str, list[tuple[float, float, float]]]
Process = Generator[Any, Any, None]


class _Machine:
    """One core with preemptive priorities (smaller first in SimPy), or a core for each where nothing is shared."""

    def __init__(self, *, shared: bool) -> None:
        self.env = simpy.Environment()
        self.shared = simpy.PreemptiveResource(self.env) if shared else None
        self.jobs: Jobs = {}

    def job(self, core: Any, name: str, fired: float, priority: int, cost: int) -> Process:  # noqa: ANN401 - SimPy has no types
        left: float = cost
        started = None
        while left or started is None:
            begun = None
            with core.request(priority=priority) as asked:
                try:
                    yield asked
                    begun = self.env.now
                    yield self.env.timeout(left)
                    left, started = 0, begun if started is None else started
                except simpy.Interrupt:
                    done = self.env.now - (self.env.now if begun is None else begun)
                    left, started = left - done, begun if started is None and done else started
        self.jobs.setdefault(name, []).append((fired, started, self.env.now))

    def element(self, name: str, priority: int, cost: int, inbox: Any, outbox: list[Any]) -> Process:  # noqa: ANN401
        core = self.shared or simpy.PreemptiveResource(self.env)
        while True:
            fired = yield inbox.get()
            yield self.env.process(self.job(core, name, fired, priority, cost))
            for box in outbox:
                box.put(self.env.now)

    def clock(self, period: int, inbox: Any) -> Process:  # noqa: ANN401 - SimPy has no types
        while True:
            inbox.put(self.env.now)
            yield self.env.timeout(period)


@pytest.mark.parametrize("shared", [False, True])
@pytest.mark.parametrize(
    ("periods", "costs"), [((10, 14), (2, 3, 3, 1)), ((7, 23), (1, 6, 2, 1)), ((13, 17), (5, 1, 4, 2))]
)
def test_a_pipeline_and_a_clock_beside_it(periods: tuple[int, int], costs: tuple[int, ...], *, shared: bool) -> None:
    names = ("camera", "beside", "filter", "sink")
    until = 300
    machine = _Machine(shared=shared)
    boxes = {name: simpy.Store(machine.env) for name in names}
    outs = {"camera": [boxes["filter"]], "filter": [boxes["sink"]]}
    for at, name in enumerate(names):
        machine.env.process(machine.element(name, at, costs[at], boxes[name], outs.get(name, [])))
    for period, name in zip(periods, names[:2], strict=True):
        machine.env.process(machine.clock(period, boxes[name]))
    machine.env.run(until + 0.5)

    place = {"host": "h"} if shared else {}
    ours = system(
        [
            timed("camera", periods[0], costs[0], priority=9, **place),
            timed("beside", periods[1], costs[1], priority=8, **place),
            event("filter", costs[2], "camera", priority=7, **place),
            event("sink", costs[3], "filter", priority=6, **place),
        ],
        [arc("camera", "filter"), arc("filter", "sink")],
    )
    assert jobs(ours, until) == machine.jobs
