"""Run a system with many seeds: all of them, for what they show together, or until one run is late.

A seed is a number, and one run: it decides all that is drawn. Of eight seeds in a row two begin with everything at once
and always take the longest times, and three let some activity come after all its neighbours (`find_last_turn`).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction

from archgen.simulation.chain_series import find_latest_passage
from archgen.simulation.chain_tracking import ChainTrack, track_chain, unobserved_chain
from archgen.simulation.drawn_orders import list_drawn_orders
from archgen.simulation.event_loop import EventFloodError, run_plan
from archgen.simulation.plan_builder import PublishPauses, build_plan
from archgen.simulation.simulation_plan import SimulationPlan
from archgen.simulation.simulation_result import ObservedActivity, ObservedHost, ObservedLink, SimulationResult
from archgen.simulation.simulation_run import SimulationRun
from archgen.timing.analysis import LateRun
from archgen.timing.system.timing_system import TimingSystem


class RunTotals:
    """Totals over the runs so far, in units."""

    def __init__(self, plan: SimulationPlan, tracks: Mapping[str, ChainTrack]) -> None:
        self.plan = plan
        self.tracks = tracks
        count = len(plan.activities)
        self.jobs, self.worst_response, self.end_gap, self.activation_gap = ([0] * count for _ in range(4))
        self.best_response: list[int] = [-1] * count
        self.fused_age, self.fused_spread = ([-1] * count for _ in range(2))
        self.largest_age = [-1] * len(plan.wires)
        self.output_silence = [[0] * len(planned.outputs) for planned in plan.activities]
        self.drops = [0] * len(plan.queues)
        self.busy_by_run: list[list[int]] = []
        self.link_wait = [0] * len(plan.links)
        self.link_busy = [0] * len(plan.links)
        self.event_count = 0

    def add_run(self, run: SimulationRun, horizon: int) -> None:
        """Add the figures of one finished run."""
        activities = run.activities
        self.event_count += run.event_count
        self.jobs = [old + new for old, new in zip(self.jobs, activities.finished, strict=True)]
        self.worst_response = list(map(max, self.worst_response, activities.worst_response))
        # -1 means that no job has ended yet.
        self.best_response = [
            new if old < 0 or 0 <= new < old else old
            for old, new in zip(self.best_response, activities.best_response, strict=True)
        ]
        self.end_gap = list(map(max, self.end_gap, activities.end_gap))
        self.activation_gap = list(map(max, self.activation_gap, activities.activation_gap))
        self.fused_age = list(map(max, self.fused_age, activities.fused_age))
        self.fused_spread = list(map(max, self.fused_spread, activities.fused_spread))
        self.largest_age = list(map(max, self.largest_age, run.wires.largest_age))
        self.output_silence = [
            list(map(max, old, new)) for old, new in zip(self.output_silence, activities.output_silence, strict=True)
        ]
        self.drops = [old + new for old, new in zip(self.drops, run.wires.drop_count, strict=True)]
        self.busy_by_run.append(
            # A job's whole execution is counted when it starts, and may reach beyond the end of the run.
            [
                min(busy, horizon * processor.cores)
                for busy, processor in zip(run.processors.busy_time, self.plan.processors, strict=True)
            ]
        )
        self.link_wait = list(map(max, self.link_wait, run.wires.link_wait))
        self.link_busy = [old + new for old, new in zip(self.link_busy, run.wires.link_busy, strict=True)]
        for track in self.tracks.values():
            track.add_run(run)

    def to_result(
        self, seconds: int, seeds: range, horizon: int, requested_chains: Mapping[str, Sequence[str]]
    ) -> SimulationResult:
        """Return the result, with the chains that were asked for by the ids of their activities."""
        plan, unit = self.plan, self.plan.unit
        total_seconds = seconds * len(seeds)
        return SimulationResult(
            seconds,
            len(seeds),
            seeds.start,
            self.event_count,
            {
                planned.id: self._summarise_activity(index, total_seconds)
                for index, planned in enumerate(plan.activities)
            },
            {
                key: self.tracks[key].to_observed(activity_ids, unit, seeds)
                if key in self.tracks
                else unobserved_chain(activity_ids)
                for key, activity_ids in requested_chains.items()
            },
            self._summarise_hosts(horizon),
            {
                link: ObservedLink(self.link_wait[index] * unit, Fraction(self.link_busy[index], horizon * len(seeds)))
                for index, link in enumerate(plan.links)
            },
            {queue: count for queue, count in zip(plan.queues, self.drops, strict=True) if count},
            plan.unknown_figures,
        )

    def _summarise_activity(self, activity: int, total_seconds: int) -> ObservedActivity:
        unit, planned = self.plan.unit, self.plan.activities[activity]
        return ObservedActivity(
            self.jobs[activity],
            Fraction(self.jobs[activity], total_seconds),
            self.best_response[activity] * unit if self.jobs[activity] else None,
            self.worst_response[activity] * unit if self.jobs[activity] else None,
            self.activation_gap[activity] * unit if self.activation_gap[activity] else None,
            self.end_gap[activity] * unit if self.end_gap[activity] else None,
            {
                output.key: silence * unit
                for output, silence in zip(planned.outputs, self.output_silence[activity], strict=True)
                if output.is_conditional
            },
            self._read_ages(activity),
            self.fused_age[activity] * unit if self.fused_age[activity] >= 0 else None,
            self.fused_spread[activity] * unit if self.fused_spread[activity] >= 0 else None,
        )

    def _read_ages(self, activity: int) -> dict[str, Fraction]:
        """Return the largest age of what was read, by input, in ns; an input may have several wires."""
        ages: dict[str, Fraction] = {}
        for wire in self.plan.activities[activity].wires:
            if self.largest_age[wire] >= 0:
                key = self.plan.arcs[wire].input
                ages[key] = max(ages.get(key, Fraction(0)), self.largest_age[wire] * self.plan.unit)
        return ages

    def _summarise_hosts(self, horizon: int) -> dict[str, ObservedHost]:
        loads: dict[str, ObservedHost] = {}
        for host in dict.fromkeys(processor.host for processor in self.plan.processors if processor.host is not None):
            processor_indices = [
                index for index, processor in enumerate(self.plan.processors) if processor.host == host
            ]
            cores = self.plan.cores[host]
            shares = [
                Fraction(sum(busy[index] for index in processor_indices), horizon * cores) for busy in self.busy_by_run
            ]
            loads[host] = ObservedHost(sum(shares, Fraction(0)) / len(shares), max(shares))
        return loads


_SECOND = 10**9


def simulate_system(  # noqa: PLR0913 - all but the first have a default
    system: TimingSystem,
    seconds: int = 60,
    seeds: int | range = 20,
    chains: Mapping[str, Sequence[str]] | None = None,
    pauses: PublishPauses | None = None,
    *,
    progress: Callable[[int, int], None] | None = None,
) -> SimulationResult:
    """Simulate a system for `seconds` with each of `seeds`: a range, or how many from 0 on.

    `chains` give the ids of activities along arcs, by chain id. For `pauses` see `build_plan`: without them a
    conditional output with a promised largest gap is published at each chance. `progress` is told how many runs of how
    many are done.
    """
    plan = build_plan(system, pauses)
    tracks = {
        key: track
        for key, activity_ids in (chains or {}).items()
        if (track := track_chain(plan, activity_ids)) is not None
    }
    horizon = int(seconds * _SECOND / plan.unit)
    totals = RunTotals(plan, tracks)
    numbers = range(seeds) if isinstance(seeds, int) else seeds
    for done, seed in enumerate(numbers):
        if progress is not None:
            progress(done, len(numbers))
        totals.add_run(_run_recorded(plan, seed, horizon, tuple(tracks.values())), horizon)
    if progress is not None:
        progress(len(numbers), len(numbers))
    return totals.to_result(seconds, numbers, horizon, chains or {})


def find_late_runs(
    system: TimingSystem,
    deadlines: Mapping[str, tuple[Sequence[str], Fraction]],
    *,
    seconds: int = 10,
    seeds: int = 24,
    pauses: PublishPauses | None = None,
) -> dict[str, LateRun]:
    """Return for each chain the first run, by seeds from 0 on, in which it takes longer than its deadline.

    `deadlines` are by chain the ids of activities along arcs, and the deadline in ns. The data age counts where the first
    activity samples the world; where its event is the stimulus the deadline is for the reaction alone. Only inputs count
    that each activity on the way sends on as soon as it can, as in the bounds. Chains that are never late are left out,
    and all of them if the events multiply without end.
    """
    plan = build_plan(system, pauses)
    tracks = {
        key: track for key, (through, _) in deadlines.items() if (track := track_chain(plan, through)) is not None
    }
    late_runs: dict[str, LateRun] = {}
    for seed in range(seeds):
        waiting = {key: track for key, track in tracks.items() if key not in late_runs}
        if not waiting:
            break
        try:
            run = _run_recorded(plan, seed, int(seconds * _SECOND / plan.unit), tuple(waiting.values()))
        except EventFloodError:
            break
        for key, track in waiting.items():
            passage = find_latest_passage(track.trace_run(run), forwarded_only=track.is_selective)
            longest = passage.length * plan.unit if passage else Fraction(0)
            if longest > deadlines[key][1]:
                late_runs[key] = LateRun(seed, seconds, longest, list_drawn_orders(run, track.activities))
    return late_runs


def _run_recorded(plan: SimulationPlan, seed: int, horizon: int, tracks: Sequence[ChainTrack]) -> SimulationRun:
    """Run one seed; only activities and wires on a chain are recorded, for a trace grows with each job."""
    watched = {activity for track in tracks for activity in track.activities}
    logged = {wire for track in tracks for parallel_wires in track.wires for wire in parallel_wires}
    return run_plan(plan, seed, horizon, watched, logged)
