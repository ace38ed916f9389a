"""The chains that a simulation follows: their activities and wires, and what all runs together showed of each."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from itertools import pairwise

from archgen.frozen import dataclass, field
from archgen.simulation.chain_series import ChainSeries, ChainTrace, TimeRange, compute_quantiles, measure_chain
from archgen.simulation.job_activation import list_samplings
from archgen.simulation.simulation_plan import SimulationPlan
from archgen.simulation.simulation_result import ChainFigures, DurationDistribution, ObservedChain
from archgen.simulation.simulation_run import SimulationRun

_REPLACED = 1 << 61
"""More than the number of any job."""


@dataclass(frozen=True, slots=True)
class ChainTrack:
    """A chain by numbers: its activities, the parallel wires between each two of them, and the figures of each run."""

    activities: tuple[int, ...]
    wires: tuple[tuple[int, ...], ...]
    samples_world: bool
    is_selective: bool
    """Whether an output on the way may leave inputs out."""
    all_series: list[ChainSeries] = field(default_factory=list)
    forwarded_series: list[ChainSeries] = field(default_factory=list)

    def add_run(self, run: SimulationRun) -> None:
        """Add the figures of one run."""
        trace = self.trace_run(run)
        self.all_series.append(measure_chain(trace))
        if self.is_selective:
            self.forwarded_series.append(measure_chain(trace, forwarded_only=True))

    def trace_run(self, run: SimulationRun) -> ChainTrace:
        """Return what one run recorded of the chain."""
        return ChainTrace(
            list_samplings(run, self.activities[0]),
            [_stalest_sources(run, wires) for wires in self.wires],
            run.activities.job_ends[self.activities[-1]],
            [_jointly_forwarded(run, wires) for wires in self.wires],
            self.samples_world,
        )

    def to_observed(self, through: Sequence[str], unit: Fraction, seeds: Sequence[int]) -> ObservedChain:
        """Summarise all runs, which had these seeds. `through` are the ids of the activities, `unit` is in ns."""
        forwarded = _summarise_series(self.forwarded_series, unit) if self.is_selective else None
        held_series = self.forwarded_series if self.is_selective else self.all_series
        lengths = [
            max((high for _, high in (*each.reactions, *(each.ages if self.samples_world else ()))), default=-1)
            for each in held_series
        ]
        longest = max(lengths, default=-1)
        latest_seed = seeds[lengths.index(longest)] if longest >= 0 else None
        return ObservedChain(tuple(through), _summarise_series(self.all_series, unit), forwarded, latest_seed)


def unobserved_chain(through: Sequence[str]) -> ObservedChain:
    """Return the empty result of a chain along which nothing can pass."""
    return ObservedChain(tuple(through), _summarise_series((), Fraction(1)), None)


def track_chain(plan: SimulationPlan, activity_ids: Sequence[str]) -> ChainTrack | None:
    """Find the wires along a list of activities; None where two neighbours have no wire."""
    activity_numbers = {planned.id: index for index, planned in enumerate(plan.activities)}
    wires = tuple(
        tuple(index for index, arc in enumerate(plan.arcs) if (arc.source, arc.target) == ends)
        for ends in pairwise(activity_ids)
    )
    # Of one element alone that is not simulated there is no wire to be missing.
    if not activity_ids or activity_ids[0] not in activity_numbers or not all(wires):
        return None
    activities = tuple(activity_numbers[activity_id] for activity_id in activity_ids)
    selective = any(plan.wires[index].is_selective for ends in wires for index in ends)
    return ChainTrack(activities, wires, plan.activities[activities[0]].samples_world, selective)


def _stalest_sources(run: SimulationRun, wires: Sequence[int]) -> list[int]:
    """Return for each job of an activity the oldest job of the one before it whose data it read on any of several
    wires. A wire brought nothing where the message of a rival lay in its memory.
    """
    if len(wires) == 1:
        return run.wires.source_log[wires[0]]
    logs = (
        [job if job >= 0 else _REPLACED for job in run.wires.source_log[wire]]
        if run.wires.rivals[wire]
        else run.wires.source_log[wire]
        for wire in wires
    )
    return [-1 if job == _REPLACED else job for job in map(min, *logs)]


def _jointly_forwarded(run: SimulationRun, wires: Sequence[int]) -> frozenset[int] | None:
    """Return the jobs that sent something on all of several wires; None where every job does."""
    forwarded = [frozenset(run.wires.forwarded_jobs[wire]) for wire in wires if run.wires.is_noted[wire]]
    return frozenset.intersection(*forwarded) if forwarded else None


def _summarise_series(all_series: Sequence[ChainSeries], unit: Fraction) -> ChainFigures:
    """Summarise the figures of all runs, converted to ns."""
    reduced = [run_series.reduced_reaction for run_series in all_series if run_series.reduced_reaction is not None]
    reduced_ages = [run_series.reduced_age for run_series in all_series if run_series.reduced_age is not None]
    return ChainFigures(
        _summarise_ranges([span for run_series in all_series for span in run_series.reactions], unit),
        _summarise_ranges([span for run_series in all_series for span in run_series.ages], unit),
        max(reduced) * unit if reduced else None,
        max(reduced_ages) * unit if reduced_ages else None,
        sum(run_series.input_count for run_series in all_series),
    )


def _summarise_ranges(ranges: Sequence[TimeRange], unit: Fraction) -> DurationDistribution | None:
    """Summarise ranges as a distribution in ns; None where there are none."""
    if not ranges:
        return None
    median, percentile_95 = compute_quantiles(ranges, (0.5, 0.95))
    return DurationDistribution(
        min(low for low, _ in ranges) * unit,
        # `compute_quantiles` works in floats; the rounded fraction keeps the result exact from here on.
        Fraction(median).limit_denominator(1000) * unit,
        Fraction(percentile_95).limit_denominator(1000) * unit,
        max(high for _, high in ranges) * unit,
        ranges,
        unit,
    )
