"""Random systems whose events go to and fro between hosts or pinned cores, and a simulator of its own for them.

The simulator shares no code with archgen: it knows the system from the same drawn figures, in us, and runs it under orders
that are as bad as may be for somebody. It says how long each way of an event took, and each activation.
"""

from __future__ import annotations

import heapq
import random
from collections import defaultdict
from dataclasses import dataclass, field
from itertools import count

from tests.timing.sketches import sketch

PERIODS = (20, 25, 40, 50, 100, 100, 200)
"""In ms."""
ORDERS = ("first come", "last come", "ranks", "dice", "starving")


@dataclass
class Step:
    """An element: where it runs, what fires it, and how long it takes, in us."""

    name: str
    host: str
    cores: tuple[int, ...]
    thread: str
    worst: int
    best: int
    period: int = 0
    jitter: int = 0
    waits_for_all: bool = False
    priority: int | None = None
    pin: int | None = None
    sources: list[str] = field(default_factory=list)
    targets: list[str] = field(default_factory=list)


@dataclass
class System:
    """A drawn system, and its text."""

    steps: dict[str, Step]
    links: dict[tuple[str, str], tuple[int, int]]
    text: str
    load: float


def draw_system(  # noqa: C901, PLR0912 - one branch for each feature that is drawn
    seed: int, *, pinned: bool = False, gates: bool = False, ranked: bool = False
) -> System:
    """Draw a system by a seed."""
    dice = random.Random(seed)  # noqa: S311 - a test's dice
    hosts = {f"h{at}": dice.randint(1, 3) for at in range(dice.randint(2, 4))}
    if pinned:
        hosts = {"h0": dice.randint(2, 4), **({"h1": dice.randint(1, 2)} if dice.random() < 0.3 else {})}
    links: dict[tuple[str, str], tuple[int, int]] = {}
    for one in hosts:
        for other in hosts:
            if one < other:
                worst = dice.choice((0, 500, 1000, 3000, 8000))
                links[one, other] = links[other, one] = (dice.choice((0, worst // 4, worst)), worst)
    steps: dict[str, Step] = {}
    for at in range(dice.randint(1, 4)):
        _draw_transaction(dice, f"t{at}", hosts, steps, pinned=pinned)
    if gates:
        _draw_gates(dice, hosts, steps)
    if ranked:
        for step in steps.values():
            step.priority = dice.randint(1, 9) if dice.random() < 0.9 else None
    threads: dict[str, list[Step]] = defaultdict(list)
    for step in steps.values():
        threads[step.host].append(step)
    boxes: dict[str, str] = {}
    for host, members in threads.items():
        if len(members) > 1 and dice.random() < 0.4:
            for step in dice.sample(members, 2):
                if step.pin is None:
                    boxes[step.name] = f"box_{host}"
                    step.thread = f"box_{host}"
    _set_cores(hosts, steps)
    load = _set_times(dice, hosts, steps)
    return System(steps, links, _write(steps, hosts, links, boxes), load)


def _draw_transaction(
    dice: random.Random, name: str, hosts: dict[str, int], steps: dict[str, Step], *, pinned: bool
) -> None:
    period = dice.choice(PERIODS) * 1000
    jitter = dice.choice((0, 0, 0, period // 10, period // 2, period * 3 // 2))
    members: list[Step] = []
    for at in range(dice.randint(2, 9)):
        host = dice.choice(list(hosts))
        step = Step(f"{name}s{at}", host, (), f"{name}s{at}", 0, 0)
        step.pin = dice.randrange(hosts[host]) if pinned and dice.random() < 0.85 else None
        if members:
            source = members[-1] if dice.random() < 0.85 else dice.choice(members)
            step.sources.append(source.name)
            source.targets.append(step.name)
        else:
            step.period, step.jitter = period, jitter
        members.append(step)
        steps[step.name] = step


def _draw_gates(dice: random.Random, hosts: dict[str, int], steps: dict[str, Step]) -> None:
    roots = [step for step in steps.values() if step.period]
    for root in roots:
        root.period = roots[0].period if dice.random() < 0.7 else root.period
    for at in range(dice.randint(1, 2)):
        first, second = dice.sample(list(steps), 2)
        host = dice.choice(list(hosts))
        gate = Step(f"g{at}", host, (), f"g{at}", 0, 0, waits_for_all=True, sources=[first, second])
        behind = Step(f"g{at}b", dice.choice(list(hosts)), (), f"g{at}b", 0, 0, sources=[gate.name])
        gate.targets.append(behind.name)
        for source in (first, second):
            steps[source].targets.append(gate.name)
        steps[gate.name], steps[behind.name] = gate, behind


def _set_cores(hosts: dict[str, int], steps: dict[str, Step]) -> None:
    for host, core_count in hosts.items():
        members = [step for step in steps.values() if step.host == host]
        kept = {step.pin for step in members if step.pin is not None}
        free = tuple(core for core in range(core_count) if core not in kept) or tuple(range(core_count))
        for step in members:
            step.cores = free if step.pin is None else (step.pin,)


def _find_rate(steps: dict[str, Step], step: Step) -> float:
    if step.period:
        return 1 / step.period
    rates = [_find_rate(steps, steps[source]) for source in step.sources]
    return min(rates) if step.waits_for_all else sum(rates)


def _set_times(dice: random.Random, hosts: dict[str, int], steps: dict[str, Step]) -> float:
    """Draw execution times for a load of the fullest core, or host; return it."""
    wanted, shares = dice.uniform(0.1, 0.55), {name: dice.uniform(0.1, 1) for name in steps}
    for step in steps.values():
        places = [
            (sum(shares[each.name] * (core in each.cores) for each in steps.values() if each.host == step.host), core)
            for core in step.cores
        ]
        step.worst = max(
            int(wanted * len(step.cores) * shares[step.name] / max(places)[0] / _find_rate(steps, step)), 10
        )
        step.best = dice.choice((step.worst, step.worst // 2, 0))
    loads = []
    for host in hosts:
        members = [step for step in steps.values() if step.host == host]
        for cores in {step.cores for step in members}:
            work = sum(each.worst * _find_rate(steps, each) for each in members if each.cores == cores)
            loads.append(work / len(cores))
    return max(loads)


def _write(
    steps: dict[str, Step], hosts: dict[str, int], links: dict[tuple[str, str], tuple[int, int]], boxes: dict[str, str]
) -> str:
    nodes = {}
    for step in steps.values():
        timing = [f"wcet: {step.worst} us, bcet: {step.best} us"]
        if step.period:
            timing.append(f"behaviour: periodic, period: {step.period} us, jitter: {step.jitter} us")
        else:
            timing.append(f"behaviour: event, trigger: {'all' if step.waits_for_all else 'any'}")
        timing += [f"priority: {step.priority}"] if step.priority is not None else []
        timing += [f"core: {step.pin}"] if step.pin is not None else []
        nodes[f"{step.name} {'+' + boxes[step.name] if step.name in boxes else '@' + step.host}"] = ", ".join(timing)
    wires = " ".join(f"{source}>{step.name}" for step in steps.values() for source in step.sources)
    host_text = ", ".join(f"{host}: {{cores: {cores}}}" for host, cores in hosts.items())
    link_text = ", ".join(
        f"{one}_{other}: {{connects: [{one}, {other}], latency: {{best: {best} us, worst: {worst} us}}}}"
        for (one, other), (best, worst) in links.items()
        if one < other
    )
    box_text = ", ".join(f"{box}: {{threads: 1, host: {box[4:]}}}" for box in dict.fromkeys(boxes.values()))
    return sketch(
        nodes,
        wires,
        f"hosts: {{{host_text}}}\nlinks: {{{link_text}}}\n" + (f"containers: {{{box_text}}}\n" if boxes else ""),
    )


@dataclass(eq=False)
class _Job:
    step: Step
    fired: int
    left: int
    number: int
    trail: tuple[tuple[str, int], ...]
    """The steps of the way so far, with when each was fired; what a gate fires begins a new one."""


class Simulation:
    """One run: the longest time of each way (by its steps) and of each activation, in us."""

    def __init__(self, system: System, order: str, seed: int, until: int) -> None:
        self.system, self.order, self.until = system, order, until
        self.dice = random.Random(seed)  # noqa: S311 - a test's dice
        self.numbers, self.events = count(), list[tuple[int, int, str, object]]()
        self.queues: dict[str, list[_Job]] = defaultdict(list)
        self.running: dict[str, _Job] = {}
        self.fresh: dict[str, set[str]] = defaultdict(set)
        self.ways: dict[tuple[str, ...], int] = {}
        self.responses: dict[str, int] = {}
        self.ranks = {step.thread: self.dice.random() for step in system.steps.values()}
        self.victim = self.dice.choice(list(system.steps))
        self.is_longest = self.dice.random() < 0.5
        self.together = self.dice.random() < 0.4
        self.extreme = self.dice.random() < 0.5

    def run(self) -> Simulation:
        """Run to the end."""
        for step in self.system.steps.values():
            if step.period:
                phase = step.jitter if self.together else self.dice.randrange(step.period)
                for number, nominal in enumerate(range(phase, self.until, step.period)):
                    late = step.jitter if number == 0 and self.together else self._draw(0, step.jitter)
                    late = 0 if self.together and number else late
                    self._post(nominal + late, "fire", (step, (), ""))
        now = 0
        while self.events and now <= self.until * 2:
            now = self.events[0][0]
            while self.events and self.events[0][0] == now:
                _, _, kind, what = heapq.heappop(self.events)
                if kind == "fire":
                    self._fire(now, *what)  # type: ignore[misc]
            now = self._work(now)
        return self

    def _draw(self, least: int, most: int) -> int:
        return self.dice.choice((least, most)) if self.extreme else self.dice.randint(least, most)

    def _post(self, time: int, kind: str, what: object) -> None:
        heapq.heappush(self.events, (time, next(self.numbers), kind, what))

    def _fire(self, now: int, step: Step, trail: tuple[tuple[str, int], ...], source: str) -> None:
        if step.waits_for_all:
            self.fresh[step.name].add(source)
            if len(self.fresh[step.name]) < len(step.sources):
                return
            self.fresh[step.name].clear()
            trail = ()
        cost = step.worst if self.is_longest else self._draw(step.best, step.worst)
        self.queues[step.thread].append(_Job(step, now, cost, next(self.numbers), (*trail, (step.name, now))))

    def _rank(self, thread: str) -> tuple[float, ...]:
        job = self.running[thread]
        # A written priority preempts; without one a thread comes behind all that have one.
        urgency = -float(job.step.priority) if job.step.priority is not None else 1.0
        key: dict[str, float] = {
            "first come": job.number,
            "last come": -job.number,
            "ranks": self.ranks[thread],
            "dice": self.dice.random(),
            "starving": 2.0 * job.step.name.startswith(self.victim[:2]) + self.ranks[thread],
        }
        return (urgency, key[self.order])

    def _work(self, now: int) -> int:  # noqa: C901 - threads, cores and time in one loop
        """Let the cores work until the next event, and return when that is."""
        while True:
            for thread, queue in self.queues.items():
                if thread not in self.running and queue:
                    # Jobs of one callback begin in the order in which they came.
                    firsts = list({job.step.name: job for job in reversed(queue)}.values())
                    chosen = self.dice.choice(firsts) if self.order in {"dice", "starving"} else queue[0]
                    chosen = firsts[0] if self.order == "last come" else chosen
                    queue.remove(chosen)
                    self.running[thread] = chosen
            taken: dict[tuple[str, int], _Job] = {}
            for thread in sorted(self.running, key=self._rank):
                job = self.running[thread]
                core = next((core for core in job.step.cores if (job.step.host, core) not in taken), None)
                if core is not None:
                    taken[job.step.host, core] = job
            if not taken:
                return self.events[0][0] if self.events else now
            end = now + min(job.left for job in taken.values())
            if self.events and self.events[0][0] < end:
                for job in taken.values():
                    job.left -= self.events[0][0] - now
                return self.events[0][0]
            for job in taken.values():
                job.left -= end - now
            for job in list(taken.values()):
                if not job.left:
                    self._finish(end, job)
            now = end
            if self.events and self.events[0][0] <= now:
                return now

    def _finish(self, now: int, job: _Job) -> None:
        del self.running[job.step.thread]
        self.responses[job.step.name] = max(self.responses.get(job.step.name, 0), now - job.fired)
        names = tuple(name for name, _ in job.trail)
        self.ways[names] = max(self.ways.get(names, 0), now - job.trail[0][1])
        for target_name in job.step.targets:
            target = self.system.steps[target_name]
            link = self.system.links.get((job.step.host, target.host), (0, 0))
            wait = self._draw(*link) if target.host != job.step.host else 0
            if wait:
                self._post(now + wait, "fire", (target, job.trail, job.step.name))
            else:
                self._fire(now, target, job.trail, job.step.name)
