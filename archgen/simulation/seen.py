"""Add up what the runs of a plan showed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction

from archgen.simulation.plan import Plan
from archgen.simulation.result import ActivitySeen, HostSeen, LinkSeen, Result
from archgen.simulation.run import Run
from archgen.simulation.tracks import Track, nothing


class Seen:
    """Totals over the runs so far, in units."""

    def __init__(self, plan: Plan, tracks: Mapping[str, Track]) -> None:
        self.plan = plan
        self.tracks = tracks
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
        """Add the figures of one finished run."""
        steps = run.steps
        self.events += run.events
        self.jobs = [a + b for a, b in zip(self.jobs, steps.finished, strict=True)]
        self.worst = list(map(max, self.worst, steps.worst))
        # -1 means that no job has ended yet.
        self.best = [b if a < 0 or 0 <= b < a else a for a, b in zip(self.best, steps.best, strict=True)]
        self.gap = list(map(max, self.gap, steps.gap))
        self.firing_gap = list(map(max, self.firing_gap, steps.firing_gap))
        self.silence = [list(map(max, a, b)) for a, b in zip(self.silence, steps.silence, strict=True)]
        self.drops = [a + b for a, b in zip(self.drops, run.wires.drops, strict=True)]
        self.busy.append(
            # A job's whole execution is counted when it starts, and may reach beyond the end of the run.
            [min(busy, horizon * p.cores) for busy, p in zip(run.threads.busy, self.plan.processors, strict=True)]
        )
        self.link_wait = list(map(max, self.link_wait, run.wires.link_wait))
        self.link_busy = [a + b for a, b in zip(self.link_busy, run.wires.link_busy, strict=True)]
        for track in self.tracks.values():
            track.add(run)

    def result(self, seconds: int, seeds: int, horizon: int, asked: Mapping[str, Sequence[str]]) -> Result:
        """Return the result, with the chains that were asked for by the ids of their activities."""
        plan, unit = self.plan, self.plan.unit
        whole = seconds * seeds
        return Result(
            seconds,
            seeds,
            self.events,
            {step.id: self._activity(at, whole) for at, step in enumerate(plan.steps)},
            {
                key: self.tracks[key].seen(way, unit) if key in self.tracks else nothing(way)
                for key, way in asked.items()
            },
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

    def _hosts(self, horizon: int) -> dict[str, HostSeen]:
        loads: dict[str, HostSeen] = {}
        for host in dict.fromkeys(p.host for p in self.plan.processors if p.host is not None):
            mine = [at for at, p in enumerate(self.plan.processors) if p.host == host]
            cores = self.plan.cores[host]
            shares = [Fraction(sum(run[at] for at in mine), horizon * cores) for run in self.busy]
            loads[host] = HostSeen(sum(shares, Fraction(0)) / len(shares), max(shares))
        return loads
