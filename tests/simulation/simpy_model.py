"""A second simulator, written on SimPy from the manual alone: it shares no code with archgen, not even the plan.

Durations are whole microseconds. Cores are preemptive with priorities, or first come first served (one or several), or
run a ROS 2 single-threaded executor; a task without a core has one of its own.
"""

from __future__ import annotations

from collections.abc import Generator, Sequence
from dataclasses import dataclass, field
from typing import Any

import simpy

Process = Generator[Any, Any, None]
Reads = tuple[int, ...]
Job = tuple[int, int, int, Reads]
"""Fired, started, ended, and of each wire into the task the number of the writer's job that was read."""


@dataclass(frozen=True)
class Wire:
    """Data on their way: from a task's end, `delay` later at the reader. `kind` is fires, together or sampled."""

    source: str
    delay: int
    kind: str


@dataclass(frozen=True)
class Task:
    """A task: a clock where `period` is not 0, else fired by its wires."""

    name: str
    core: str | None
    cost: int
    priority: int
    period: int = 0
    phase: int = 0
    every: int = 1
    throttle: int = 0
    wires: tuple[Wire, ...] = ()


@dataclass
class _State:
    task: Task
    waiting: list[tuple[int, int, Reads]] = field(default_factory=list)
    """Fired, the wire that did (-1 for none, -2 for all together), and what came with it."""
    holds: list[int] = field(default_factory=list)
    fresh: dict[int, int] = field(default_factory=dict)
    fired: int | None = None
    seen: int = 0
    started: int = 0
    is_running: bool = False
    jobs: list[Job] = field(default_factory=list)
    bell: Any = None


class Model:
    """Tasks on cores: `cores` says of each whether it is `priority`, `fifo1`, `fifo2` or `executor`."""

    def __init__(self, tasks: Sequence[Task], cores: dict[str, str]) -> None:
        self.env = simpy.Environment()
        self.executors = {name for name, kind in cores.items() if kind == "executor"}
        self.states = {task.name: _State(task, holds=[-1] * len(task.wires)) for task in tasks}
        for state in self.states.values():
            state.bell = self.env.event()
        self.readers = {
            task.name: [
                (other.name, at, w) for other in tasks for at, w in enumerate(other.wires) if w.source == task.name
            ]
            for task in tasks
        }
        self.bells = {name: self.env.event() for name in cores}
        shared = {name: self._resource(kind) for name, kind in cores.items() if kind != "executor"}
        for task in tasks:
            if task.period:
                self.env.process(self._clock(task))
            if task.core is None or cores[task.core] != "executor":
                core = shared[task.core] if task.core else simpy.PriorityResource(self.env)
                ranked = task.core is not None and cores[task.core] == "priority"
                self.env.process(self._thread(self.states[task.name], core, ranked=ranked))
        for name, kind in cores.items():
            if kind == "executor":
                self.env.process(self._executor(name, [s for s in self.states.values() if s.task.core == name]))

    @property
    def now(self) -> int:
        """Give the moment, in us."""
        return int(self.env.now)

    def run(self, until: int) -> dict[str, list[Job]]:
        """Give all jobs that end up to a moment, by task."""
        self.env.run(until + 0.5)
        return {name: state.jobs for name, state in self.states.items()}

    def _resource(self, kind: str) -> Any:  # noqa: ANN401 - SimPy has no types
        if kind == "priority":
            return simpy.PreemptiveResource(self.env)
        return simpy.PriorityResource(self.env, capacity=int(kind.removeprefix("fifo")))

    def _clock(self, task: Task) -> Process:
        yield self.env.timeout(task.phase)
        while True:
            self._fire(self.states[task.name], -1, ())
            yield self.env.timeout(task.period)

    def _fire(self, state: _State, wire: int, came: Reads) -> None:
        # rcl counts a tick as done that comes while another one waits.
        if wire == -1 and state.task.core in self.executors and len(state.waiting) > state.is_running:
            return
        state.waiting.append((self.now, wire, came))
        core = state.task.core
        if core is not None:
            self.bells[core].succeed()
            self.bells[core] = self.env.event()
        state.bell.succeed()
        state.bell = self.env.event()

    def _arrive(self, state: _State, at: int, number: int) -> None:
        kind = state.task.wires[at].kind
        if kind == "sampled":
            state.holds[at] = number
            return
        if kind == "together":
            state.fresh[at] = number
            if len(state.fresh) < sum(wire.kind == "together" for wire in state.task.wires):
                return
            came = tuple(state.fresh[one] for one in sorted(state.fresh))
            state.fresh.clear()
            wire = -2
        else:
            came, wire = (number,), at
        state.seen += 1
        if state.seen % state.task.every:
            return
        if state.fired is not None and self.now - state.fired < state.task.throttle:
            return
        state.fired = self.now
        self._fire(state, wire, came)

    def _start(self, state: _State) -> Reads:
        """Take in what fired the job that waits longest; tell what its wires hold."""
        _, wire, came = state.waiting[0]
        if wire == -2:
            together = [at for at, one in enumerate(state.task.wires) if one.kind == "together"]
            for at, number in zip(together, came, strict=True):
                state.holds[at] = number
        elif wire >= 0:
            state.holds[wire] = came[0]
        return tuple(state.holds)

    def _end(self, state: _State, started: int, reads: Reads) -> None:
        fired, _, _ = state.waiting.pop(0)
        state.jobs.append((fired, started, self.now, reads))
        for name, at, wire in self.readers[state.task.name]:
            if wire.delay:
                self.env.process(self._travel(wire.delay, name, at, len(state.jobs) - 1))
            else:
                self._arrive(self.states[name], at, len(state.jobs) - 1)

    def _travel(self, delay: int, name: str, at: int, number: int) -> Process:
        yield self.env.timeout(delay)
        self._arrive(self.states[name], at, number)

    def _thread(self, state: _State, core: Any, *, ranked: bool) -> Process:  # noqa: ANN401 - SimPy has no types
        while True:
            while not state.waiting:
                yield state.bell
            rank = -state.task.priority if ranked else state.waiting[0][0]
            left, started = state.task.cost, -1
            reads: Reads = ()
            while left:
                with core.request(priority=rank) as asked:
                    begun = None
                    try:
                        yield asked
                        begun = self.now
                        if started < 0:
                            started, reads = begun, self._start(state)
                        yield self.env.timeout(left)
                    except simpy.Interrupt:
                        done = 0 if begun is None else self.now - begun
                        if done == 0 and left == state.task.cost:
                            started = -1
                        left -= done
                    else:
                        left = 0
                        self._end(state, started, reads)

    def _executor(self, name: str, members: list[_State]) -> Process:
        while True:
            clocks = [one for one in members if one.waiting and one.task.period]
            others = [one for one in members if one.waiting and not one.task.period]
            # A subscription has one turn, and takes the oldest of its own.
            turns = [(one, -1) for one in clocks]
            turns += [(one, wire) for one in others for wire in sorted({wire for _, wire, _ in one.waiting})]
            if not turns:
                yield self.bells[name]
                continue
            for one, wire in turns:
                place = next((at for at, job in enumerate(one.waiting) if job[1] == wire), None)
                if place is not None:
                    one.waiting.insert(0, one.waiting.pop(place))
                    started, reads = self.now, self._start(one)
                    one.is_running = True
                    yield self.env.timeout(one.task.cost)
                    one.is_running = False
                    self._end(one, started, reads)
