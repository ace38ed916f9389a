"""Reaction times and data ages along a chain, read off the jobs of one run.

Each job of the chain's last activity carries data of one job of its first. A periodic first activity samples the world
when it is activated: an event just after that waits for the next activation. A reaction is the time from an event to
the end of the first job that carries it; a data age is the time since the sampling of what the chain put out last. For
an event (or a look) at a random moment both are uniformly distributed between two values, hence ranges. Where the
activation is itself the event, a reaction is a single value.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from itertools import accumulate, pairwise

TimeRange = tuple[int, int]
"""Values from the first to the second are equally likely, and a range weighs as much as it is long; or one value,
twice.
"""


@dataclass(frozen=True, slots=True)
class ChainSeries:
    """The figures of a chain in one run, in units."""

    reactions: tuple[TimeRange, ...] = ()
    ages: tuple[TimeRange, ...] = ()
    reduced_reaction: int | None = None
    """The longest time from a sampling (not from the event) to the end of the first job that carries it."""
    reduced_age: int | None = None
    """The longest time from a sampling to the end of a job that carries it."""
    input_count: int = 0
    """The number of jobs of the first activity behind the figures."""


@dataclass(frozen=True, slots=True)
class ChainTrace:
    """What one run recorded of a chain.

    `samplings` are the activation times of the first activity's jobs. `source_logs` give, for each later activity and
    each of its jobs, the job of the previous activity whose data it read (-1 for none). `job_ends` are the end times of
    the last activity's jobs (-1 for one that has not ended). `samples_world` says that the first activity samples the world; otherwise its activation
    is the event. `forwarded_jobs` give, for each activity but the last, the jobs that sent something to the next one;
    None where all do.
    """

    samplings: Sequence[int]
    source_logs: Sequence[Sequence[int]]
    job_ends: Sequence[int]
    forwarded_jobs: Sequence[Collection[int] | None]
    samples_world: bool


def measure_chain(trace: ChainTrace, *, forwarded_only: bool = False) -> ChainSeries:
    """Compute a chain's figures. What is published once is no event, and yields none.

    With `forwarded_only`, only those inputs count that each activity on the way sent on as soon as it had processed
    them, as the bounds assume where an output is conditional. An age is then that of a sample followed by such an
    input.
    """
    samplings, job_ends = trace.samplings, trace.job_ends
    if not samplings:
        return ChainSeries()
    # One more than there are: the test for ages below asks for the job after the last source.
    counted_jobs = _find_forwarded_jobs(trace) if forwarded_only else range(len(samplings) + 1)
    # In the order in which they are put out: a job that began earlier may end later where several run at once.
    carried_jobs = sorted(
        (end, source)
        for job, end in enumerate(job_ends)
        if end >= 0 and (source := _source_job(job, trace.source_logs)) >= 0
    )
    # A job that carries new data is also the first reaction to every input that was overwritten in between. The very
    # first one is left out: what came before it is not known.
    reactions = [
        (job, end)
        for previous_source, new_source, end in _first_carriers(carried_jobs)
        if previous_source >= 0
        for job in range(previous_source + 1, new_source + 1)
        if job in counted_jobs
    ]
    # The oldest event that a sampling catches happened just after the sampling before it.
    event_offset = 1 if trace.samples_world else 0
    ages = tuple(
        (end - samplings[source], next_end - samplings[source])
        for (end, source), (next_end, _) in pairwise(carried_jobs)
        if source + 1 in counted_jobs
    )
    return ChainSeries(
        tuple((end - samplings[job], end - samplings[job - event_offset]) for job, end in reactions),
        ages,
        max((end - samplings[job] for job, end in reactions), default=None),
        max((low for low, _ in ages), default=None),
        len(reactions),
    )


def _find_forwarded_jobs(trace: ChainTrace) -> frozenset[int]:
    """Return the jobs of the first activity that each later activity sent on with its first job that read them."""
    job_positions = {job: job for job in range(len(trace.samplings))}
    for log, forwarded in zip(trace.source_logs, trace.forwarded_jobs, strict=True):
        # Running maxima are sorted, so that the first job with data at least this new is found by bisection.
        newest = list(accumulate(log, max))
        readers = {
            job: bisect_left(newest, position)
            for job, position in job_positions.items()
            if forwarded is None or position in forwarded
        }
        job_positions = {job: position for job, position in readers.items() if position < len(newest)}
    return frozenset(job_positions)


def _source_job(job: int, logs: Sequence[Sequence[int]]) -> int:
    """Return the job of the first activity whose data a job of the last one carries; -1 for none."""
    for log in reversed(logs):
        job = log[job]
        if job < 0:
            return -1
    return job


def _first_carriers(carried_jobs: Sequence[tuple[int, int]]) -> Sequence[tuple[int, int, int]]:
    """Return (newest source before, new source, end) for each job that carries newer data than all before it."""
    carriers, newest = [], -1
    for end, source in carried_jobs:
        if source > newest:
            carriers.append((newest, source, end))
            newest = source
    return carriers


def compute_quantiles(ranges: Sequence[TimeRange], shares: Sequence[float]) -> tuple[float, ...]:
    """Return quantiles of a mixture of ranges, each weighted by its length; of the values where all ranges are single
    values.
    """
    if all(low == high for low, high in ranges):
        figures = sorted(low for low, _ in ranges)
        return tuple(float(figures[min(len(figures) - 1, int(share * len(figures)))]) for share in shares)
    # A sweep over the ends of the ranges: `depth` of them overlap, so the distribution grows by `depth` for each unit.
    edges = sorted([(low, 1) for low, _ in ranges] + [(high, -1) for _, high in ranges])
    total = sum(high - low for low, high in ranges)
    results: list[float] = []
    covered, depth, last_edge = 0, 0, edges[0][0]
    targets = [share * total for share in shares]
    for edge, change in edges:
        new_covered = covered + depth * (edge - last_edge)
        while len(results) < len(targets) and new_covered >= targets[len(results)] and depth:
            results.append(last_edge + (targets[len(results)] - covered) / depth)
        covered, depth, last_edge = new_covered, depth + change, edge
    return tuple(results + [float(last_edge)] * (len(targets) - len(results)))
