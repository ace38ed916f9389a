"""Many runs of one system, by seeds from 0 on, and what was seen in all of them together; durations in ns."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise

from archgen.simulation.engine import go
from archgen.simulation.flatten import Pauses, flatten
from archgen.simulation.plan import PERIODIC, Plan
from archgen.simulation.run import Run
from archgen.simulation.series import Series, Span, quantiles, series
from archgen.timing.system import System

_SECOND = 10**9


@dataclass(frozen=True, slots=True)
class Distribution:
    """Figures as they were distributed over all seeds."""

    least: Fraction
    median: Fraction
    most_of_it: Fraction
    """95 of 100 are no larger."""
    largest: Fraction


@dataclass(frozen=True, slots=True)
class ChainSeen:
    """A chain: None where nothing passed along all of it."""

    through: tuple[str, ...]
    reaction: Distribution | None
    age: Distribution | None
    reduced_reaction: Fraction | None
    reduced_age: Fraction | None


@dataclass(frozen=True, slots=True)
class ActivitySeen:
    """An activity: jobs done in all seeds, jobs a second, response times, largest gaps of activations and of ends."""

    jobs: int
    rate: Fraction
    best: Fraction | None
    worst: Fraction | None
    activation_gap: Fraction | None
    gap: Fraction | None
    silences: Mapping[str, Fraction]
    """The largest time between two publications of each conditional output."""


@dataclass(frozen=True, slots=True)
class HostSeen:
    """The share of a host's cores that was busy: over all seeds, and in the busiest one."""

    mean: Fraction
    largest: Fraction


@dataclass(frozen=True, slots=True)
class LinkSeen:
    """A link of known bandwidth: the longest time from sending to sent, and the share of time that it was busy."""

    wait: Fraction
    share: Fraction


@dataclass(frozen=True, slots=True)
class Result:
    """What was seen. Each largest figure is a lower bound on the worst case: no run shows the worst for certain."""

    seconds: int
    seeds: int
    events: int
    activities: Mapping[str, ActivitySeen]
    chains: Mapping[str, ChainSeen]
    hosts: Mapping[str, HostSeen]
    links: Mapping[str, LinkSeen]
    drops: Mapping[tuple[str, str, str], int]
    """Samples pushed out of a queue unread, by activity, input and topic."""
    unknown: tuple[str, ...]
    """Figures that are not written: they were taken as nothing, or what rests on them did not run."""


def simulate(
    system: System,
    seconds: int = 60,
    seeds: int = 20,
    chains: Mapping[str, Sequence[str]] | None = None,
    pauses: Pauses | None = None,
) -> Result:
    """Run a system for so many seconds from each of so many seeds.

    `chains` name activities along arcs. `pauses` see `flatten`: without them an output that has a promised largest gap
    is published at each chance.
    """
    plan = flatten(system, pauses)
    ways = {key: way for key, way in (chains or {}).items() if _arcs(plan, way) is not None}
    watched = {at for at, step in enumerate(plan.steps) if any(step.id in way for way in ways.values())}
    logged = {wire for way in ways.values() for pair in _arcs(plan, way) or () for wire in pair}
    horizon = int(seconds * _SECOND / plan.unit)
    seen = _Seen(plan, ways, chains or {})
    for seed in range(seeds):
        seen.add(go(plan, seed, horizon, watched, logged), horizon)
    return seen.result(seconds, seeds, horizon)


def _arcs(plan: Plan, way: Sequence[str]) -> list[list[int]] | None:
    """Give the wires of each step of a way; None where a step has none."""
    found = [[at for at, arc in enumerate(plan.arcs) if (arc.source, arc.target) == pair] for pair in pairwise(way)]
    return found if way and all(found) else None


class _Seen:
    """What the runs so far showed, in units."""

    def __init__(self, plan: Plan, ways: Mapping[str, Sequence[str]], asked: Mapping[str, Sequence[str]]) -> None:
        self.plan = plan
        self.asked = asked
        self.ways = {key: [_number(plan, name) for name in way] for key, way in ways.items()}
        self.wires = {key: _arcs(plan, way) or [] for key, way in ways.items()}
        self.found: dict[str, list[Series]] = {key: [] for key in ways}
        self.runs: list[Run] = []
        count = len(plan.steps)
        self.jobs, self.worst, self.gap, self.firing_gap = ([0] * count for _ in range(4))
        self.best: list[int] = [-1] * count
        self.silence = [[0] * len(step.outputs) for step in plan.steps]
        self.drops = [0] * len(plan.queues)
        self.busy: list[list[int]] = []
        self.link_wait = [0] * len(plan.links)
        self.link_busy = [0] * len(plan.links)
        self.events = 0

    def add(self, run: Run, horizon: int) -> None:
        steps = run.steps
        self.events += run.events
        self.jobs = [a + b for a, b in zip(self.jobs, steps.finished, strict=True)]
        self.worst = list(map(max, self.worst, steps.worst))
        self.best = [b if a < 0 or 0 <= b < a else a for a, b in zip(self.best, steps.best, strict=True)]
        self.gap = list(map(max, self.gap, steps.gap))
        self.firing_gap = list(map(max, self.firing_gap, steps.firing_gap))
        self.silence = [list(map(max, a, b)) for a, b in zip(self.silence, steps.silence, strict=True)]
        self.drops = [a + b for a, b in zip(self.drops, run.wires.drops, strict=True)]
        self.busy.append(
            [min(busy, horizon * p.cores) for busy, p in zip(run.threads.busy, self.plan.processors, strict=True)]
        )
        self.link_wait = list(map(max, self.link_wait, run.wires.link_wait))
        self.link_busy = [a + b for a, b in zip(self.link_busy, run.wires.link_busy, strict=True)]
        for key, way in self.ways.items():
            self.found[key].append(self._series(run, key, way))

    def _series(self, run: Run, key: str, way: Sequence[int]) -> Series:
        logs = [_stalest(run, wires) for wires in self.wires[key]]
        first = way[0]
        samples = self.plan.steps[first].kind == PERIODIC
        return series(run.steps.firings[first], logs, run.steps.ends[way[-1]], samples=samples)

    def result(self, seconds: int, seeds: int, horizon: int) -> Result:
        plan, unit = self.plan, self.plan.unit
        whole = seconds * seeds
        return Result(
            seconds,
            seeds,
            self.events,
            {step.id: self._activity(at, whole) for at, step in enumerate(plan.steps)},
            {key: self._chain(key) for key in self.asked},
            self._hosts(horizon),
            {
                link: LinkSeen(self.link_wait[at] * unit, Fraction(self.link_busy[at], horizon * seeds))
                for at, link in enumerate(plan.links)
            },
            {queue: count for queue, count in zip(plan.queues, self.drops, strict=True) if count},
            plan.unknown,
        )

    def _activity(self, at: int, whole: int) -> ActivitySeen:
        unit, step = self.plan.unit, self.plan.steps[at]
        return ActivitySeen(
            self.jobs[at],
            Fraction(self.jobs[at], whole),
            self.best[at] * unit if self.jobs[at] else None,
            self.worst[at] * unit if self.jobs[at] else None,
            self.firing_gap[at] * unit if self.firing_gap[at] else None,
            self.gap[at] * unit if self.gap[at] else None,
            {o.key: s * unit for o, s in zip(step.outputs, self.silence[at], strict=True) if o.conditional},
        )

    def _chain(self, key: str) -> ChainSeen:
        found, unit = self.found.get(key, []), self.plan.unit
        reactions = [span for one in found for span in one.reactions]
        ages = [span for one in found for span in one.ages]
        reduced = [one.reduced_reaction for one in found if one.reduced_reaction is not None]
        reduced_ages = [one.reduced_age for one in found if one.reduced_age is not None]
        return ChainSeen(
            tuple(self.asked[key]),
            _distribution(reactions, unit),
            _distribution(ages, unit),
            max(reduced) * unit if reduced else None,
            max(reduced_ages) * unit if reduced_ages else None,
        )

    def _hosts(self, horizon: int) -> dict[str, HostSeen]:
        loads: dict[str, HostSeen] = {}
        for host in dict.fromkeys(p.host for p in self.plan.processors if p.host is not None):
            mine = [at for at, p in enumerate(self.plan.processors) if p.host == host]
            cores = self.plan.cores[host]
            shares = [Fraction(sum(run[at] for at in mine), horizon * cores) for run in self.busy]
            loads[host] = HostSeen(sum(shares, Fraction(0)) / len(shares), max(shares))
        return loads


def _number(plan: Plan, name: str) -> int:
    return next(at for at, step in enumerate(plan.steps) if step.id == name)


def _stalest(run: Run, wires: Sequence[int]) -> list[int]:
    """Tell for each job of an activity which job of the one before it has reached it by all of several arcs."""
    return list(map(min, *(run.wires.log[wire] for wire in wires))) if len(wires) > 1 else run.wires.log[wires[0]]


def _distribution(spans: Sequence[Span], unit: Fraction) -> Distribution | None:
    if not spans:
        return None
    median, most = quantiles(spans, (0.5, 0.95))
    return Distribution(
        min(low for low, _ in spans) * unit,
        Fraction(median).limit_denominator(1000) * unit,
        Fraction(most).limit_denominator(1000) * unit,
        max(high for _, high in spans) * unit,
    )
