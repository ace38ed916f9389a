"""Linux without real-time priorities, simulated: a queue for each core, EEVDF with kept lag or CFS, and nothing of archgen's.

Whoever wakes up goes to an idle core, else to the one that an adversary picks; a core without work pulls what waits
elsewhere. Times are in microseconds.
"""

from __future__ import annotations

import random
from collections import deque
from dataclasses import dataclass, field
from heapq import heappop, heappush


@dataclass
class Task:
    """An activity: periodic where it has a period, else fired by others; `uses` is its time on the only GPU, in the middle."""

    name: str
    cost: int
    process: int
    period: int = 0
    fires: tuple[str, ...] = ()
    uses: int = 0


@dataclass
class Kernel:
    """What is known of the scheduler: turns of `slice_time`, noticed at each `tick`; `threads` of each process."""

    cores: int
    slice_time: int
    tick: int
    threads: list[int]
    urgent: frozenset[int] = frozenset()
    """Processes with a real-time priority."""


@dataclass(eq=False)
class _Thread:
    process: int
    core: int = 0
    v: float = 0.0
    lag: float = 0.0
    deadline: float = 0.0
    left: int = 0
    job: tuple[Task, int] | None = None
    uses: int = 0
    after: int = 0
    turn_start: float = 0.0


@dataclass
class FairRun:
    """One run; `worst` then has the longest response of each activity."""

    kernel: Kernel
    tasks: dict[str, Task]
    dice: random.Random
    is_eevdf: bool
    placement: str
    worst: dict[str, int] = field(default_factory=dict)

    def run(self, end: int, *, at_once: bool) -> None:  # noqa: C901 - the events of one moment, one after the other
        """Let time pass."""
        kernel, dice = self.kernel, self.dice
        self.now = 0
        self.queues: list[list[_Thread]] = [[] for _ in range(kernel.cores)]
        self.current: list[_Thread | None] = [None] * kernel.cores
        self.started = [0] * kernel.cores
        self.check_at = [1 << 60] * kernel.cores
        self.floor = [0.0] * kernel.cores
        self.phase = [dice.randrange(kernel.tick) if kernel.tick else 0 for _ in range(kernel.cores)]
        self.idle = [[_Thread(process) for _ in range(count)] for process, count in enumerate(kernel.threads)]
        self.waiting: list[deque[tuple[Task, int]]] = [deque() for _ in kernel.threads]
        self.gpu: deque[_Thread] = deque()
        self.gpu_end = 1 << 60
        arrivals: list[tuple[int, str]] = []
        for task in self.tasks.values():
            if task.period:
                heappush(arrivals, (0 if at_once else dice.randrange(task.period), task.name))
        while True:
            ends = [self.started[core] + thread.left if thread else 1 << 60 for core, thread in enumerate(self.current)]
            self.now = min(arrivals[0][0], *ends, *self.check_at, self.gpu_end)
            if self.now > end:
                return
            self._advance()
            for core, thread in enumerate(self.current):
                if thread and not thread.left:
                    self._end_part(core, thread)
            if self.gpu_end <= self.now:
                self._end_use()
            while arrivals[0][0] <= self.now:
                _, name = heappop(arrivals)
                heappush(arrivals, (self.now + self.tasks[name].period, name))
                self._activate(name)
            for core in range(kernel.cores):
                if self.check_at[core] <= self.now or self.current[core] is None:
                    self._pick(core)

    def _advance(self) -> None:
        for core, thread in enumerate(self.current):
            if thread:
                ran = self.now - self.started[core]
                thread.left -= ran
                if thread.process not in self.kernel.urgent:
                    thread.v += ran
                self.started[core] = self.now
            runnable = self._on(core)
            if runnable:
                self.floor[core] = max(self.floor[core], min(each.v for each in runnable))

    def _on(self, core: int) -> list[_Thread]:
        current = self.current[core]
        return [
            each
            for each in (*self.queues[core], *([current] if current else []))
            if each.process not in self.kernel.urgent
        ]

    def _average(self, core: int) -> float:
        runnable = self._on(core)
        return sum(each.v for each in runnable) / len(runnable) if runnable else self.floor[core]

    def _activate(self, name: str) -> None:
        task = self.tasks[name]
        self.waiting[task.process].append((task, self.now))
        self._feed(task.process)

    def _feed(self, process: int) -> None:
        while self.waiting[process] and self.idle[process]:
            thread = self.idle[process].pop(self.dice.randrange(len(self.idle[process])))
            self._take_job(thread)
            self._wake(thread)

    def _take_job(self, thread: _Thread) -> None:
        # Any order of activities, but each takes its own jobs in their order.
        queue = self.waiting[thread.process]
        firsts = {task.name: at for at, (task, _) in reversed(list(enumerate(queue)))}
        at = self.dice.choice(sorted(firsts.values()))
        task, since = queue[at]
        del queue[at]
        thread.job, thread.uses = (task, since), task.uses
        before = self.dice.randrange(task.cost + 1) if task.uses else task.cost
        thread.left, thread.after = max(before, 1), max(task.cost - max(before, 1), 0)

    def _wake(self, thread: _Thread) -> None:
        free = [core for core in range(self.kernel.cores) if self.current[core] is None and not self.queues[core]]
        if free:
            core = self.dice.choice(free)
        elif self.placement == "last":
            core = thread.core
        elif self.placement == "fullest":
            core = max(range(self.kernel.cores), key=lambda each: len(self.queues[each]))
        else:
            core = self.dice.randrange(self.kernel.cores)
        self._place(thread, core)
        current = self.current[core]
        is_urgent = thread.process in self.kernel.urgent
        if is_urgent:
            # Real-time threads are pushed to wherever something less urgent runs.
            victims = [
                each
                for each, other in enumerate(self.current)
                if other is None or other.process not in self.kernel.urgent
            ]
            if victims:
                target = core if core in victims else self.dice.choice(victims)
                self.queues[core].remove(thread)
                self.queues[target].append(thread)
                thread.core = target
                self._pick(target)
        elif current is None or (
            current.process not in self.kernel.urgent
            and self.dice.random() < 0.5
            and (
                thread.deadline < current.deadline
                if self.is_eevdf
                else current.v - thread.v > self.kernel.slice_time / 3
            )
        ):
            self._pick(core)

    def _place(self, thread: _Thread, core: int) -> None:
        limit = self.kernel.slice_time + self.kernel.tick
        if self.is_eevdf:
            count = len(self._on(core))
            lag = max(-limit, min(thread.lag, limit))
            thread.v = self._average(core) - (lag * (count + 1) / count if count else 0)
            thread.deadline = thread.v + self.kernel.slice_time
        else:
            shifted = thread.v - self.floor[thread.core] + self.floor[core]
            thread.v = max(shifted, self.floor[core] - self.kernel.slice_time)
        thread.core = core
        self.queues[core].append(thread)

    def _leave(self, thread: _Thread) -> None:
        limit = self.kernel.slice_time + self.kernel.tick
        thread.lag = max(-limit, min(self._average(thread.core) - thread.v, limit))

    def _pick(self, core: int) -> None:  # noqa: C901 - as a kernel has it
        kernel, current = self.kernel, self.current[core]
        if current:
            self.queues[core].append(current)
            self.current[core] = None
        # A real-time thread that waits anywhere comes first.
        for other in range(kernel.cores):
            for thread in [each for each in self.queues[other] if each.process in kernel.urgent]:
                self.queues[other].remove(thread)
                self.queues[core].append(thread)
                thread.core = core
        if not self.queues[core]:
            self._pull(core)
        queue = self.queues[core]
        self.check_at[core] = 1 << 60
        if not queue:
            return
        urgent = [each for each in queue if each.process in kernel.urgent]
        if urgent:
            chosen = urgent[0]
        elif self.is_eevdf:
            for each in queue:
                if each.v >= each.deadline:
                    each.deadline = each.v + kernel.slice_time
            average = sum(each.v for each in queue) / len(queue)
            eligible = [each for each in queue if each.v <= average + 1e-6]
            chosen = min(eligible, key=lambda each: each.deadline)
        else:
            chosen = min(queue, key=lambda each: each.v)
        queue.remove(chosen)
        self.current[core], self.started[core] = chosen, self.now
        if chosen.process not in kernel.urgent:
            turn = max(int(chosen.deadline - chosen.v), 1) if self.is_eevdf else kernel.slice_time
            due = self.now + min(turn, kernel.slice_time)
            if kernel.tick:
                due += -(due - self.phase[core]) % kernel.tick
            self.check_at[core] = max(due, self.now + 1)

    def _pull(self, core: int) -> None:
        others = [each for each in range(self.kernel.cores) if each != core and self.queues[each]]
        if others:
            source = self.dice.choice(others)
            thread = self.dice.choice(self.queues[source])
            self._leave(thread)
            self.queues[source].remove(thread)
            self._place(thread, core)

    def _end_part(self, core: int, thread: _Thread) -> None:
        if thread.uses:
            self._leave(thread)
            self.current[core] = None
            self.check_at[core] = 1 << 60
            self.gpu.append(thread)
            if len(self.gpu) == 1:
                self.gpu_end = self.now + thread.uses
            self._pick(core)
            return
        assert thread.job is not None
        task, since = thread.job
        self.worst[task.name] = max(self.worst.get(task.name, 0), self.now - since)
        thread.job = None
        if self.waiting[thread.process]:
            self._take_job(thread)  # it goes on without sleeping
        else:
            self._leave(thread)
            self.current[core] = None
            self.check_at[core] = 1 << 60
            self.idle[thread.process].append(thread)
        for name in task.fires:
            self._activate(name)
        if self.current[core] is None:
            self._pick(core)

    def _end_use(self) -> None:
        thread = self.gpu.popleft()
        self.gpu_end = self.now + self.gpu[0].uses if self.gpu else 1 << 60
        thread.uses, thread.left, thread.after = 0, thread.after, 0
        if thread.left:
            self._wake(thread)
            return
        thread.left = 0
        # What computes nothing after its use ends with it.
        task, since = thread.job or (None, 0)
        assert task is not None
        self.worst[task.name] = max(self.worst.get(task.name, 0), self.now - since)
        self.idle[thread.process].append(thread)
        for name in task.fires:
            self._activate(name)
        self._feed(thread.process)
