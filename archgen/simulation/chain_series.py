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
from itertools import accumulate, pairwise

from archgen.frozen import NamedTuple, dataclass

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


class Passage(NamedTuple):
    """Data of a chain from `begin` (the event, or the sampling) to `end` (the reaction, or the next output); in units.

    `sent` is when the last activity sent them: its job `last_job`. `first_job` is the one of the first activity that sampled.
    """

    begin: int
    sampled: int
    sent: int
    end: int
    first_job: int
    last_job: int

    @property
    def length(self) -> int:
        """How long it takes."""
        return self.end - self.begin


def measure_chain(trace: ChainTrace, *, forwarded_only: bool = False) -> ChainSeries:
    """Compute a chain's figures. What is published once is no event, and yields none. See `list_passages`."""
    reactions, ages = list_passages(trace, forwarded_only=forwarded_only)
    return ChainSeries(
        tuple((each.end - each.sampled, each.length) for each in reactions),
        tuple((each.sent - each.begin, each.length) for each in ages),
        max((each.end - each.sampled for each in reactions), default=None),
        max((each.sent - each.begin for each in ages), default=None),
        len(reactions),
    )


def find_latest_passage(trace: ChainTrace, *, forwarded_only: bool) -> Passage | None:
    """Return what is held against the deadline: the longest reaction, or the oldest age where the chain samples the world."""
    reactions, ages = list_passages(trace, forwarded_only=forwarded_only)
    return max((*reactions, *(ages if trace.samples_world else ())), key=lambda each: each.length, default=None)


def list_passages(trace: ChainTrace, *, forwarded_only: bool = False) -> tuple[list[Passage], list[Passage]]:
    """Return the reactions and the ages of a chain.

    With `forwarded_only`, only those inputs count that each activity on the way sent on as soon as it had processed
    them, as the bounds assume where an output is conditional. An age is then that of a sample followed by such an
    input.
    """
    samplings = trace.samplings
    if not samplings:
        return [], []
    # One more than there are: the test for ages below asks for the job after the last source.
    counted_jobs = _find_forwarded_jobs(trace) if forwarded_only else range(len(samplings) + 1)
    # In the order in which they are put out: a job that began earlier may end later where several run at once.
    carried_jobs = sorted(
        (end, source, job)
        for job, end in enumerate(trace.job_ends)
        if end >= 0 and (source := list_read_jobs(job, trace.source_logs)[0]) >= 0
    )
    # A job that carries new data is also the first reaction to every input that was overwritten in between. The very
    # first one is left out: what came before it is not known. The oldest event that a sampling catches happened just
    # after the sampling before it.
    event_offset = 1 if trace.samples_world else 0
    reactions = [
        Passage(samplings[job - event_offset], samplings[job], end, end, job, last_job)
        for previous_source, new_source, end, last_job in _first_carriers(carried_jobs)
        if previous_source >= 0
        for job in range(previous_source + 1, new_source + 1)
        if job in counted_jobs
    ]
    ages = [
        Passage(samplings[source], samplings[source], end, next_end, source, last_job)
        for (end, source, last_job), (next_end, _, _) in pairwise(carried_jobs)
        if source + 1 in counted_jobs
    ]
    return reactions, ages


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


def list_read_jobs(job: int, logs: Sequence[Sequence[int]]) -> list[int]:
    """Return the jobs of all activities whose data a job of the last one carries, first to last; -1 in front for none."""
    jobs = [job]
    for log in reversed(logs):
        job = log[job] if job >= 0 else -1
        jobs.append(job)
    return jobs[::-1]


def list_passed_jobs(trace: ChainTrace, passage: Passage) -> list[int]:
    """Return the jobs by which a passage went, first to last: at each activity the first that read data at least as new.

    Where results overtook one another that may lead elsewhere: then those whose data its end carries.
    """
    jobs = [passage.first_job]
    for log in trace.source_logs:
        newest = list(accumulate(log, max))
        jobs.append(bisect_left(newest, jobs[-1]))
    return jobs if jobs[-1] == passage.last_job else list_read_jobs(passage.last_job, trace.source_logs)


def _first_carriers(carried_jobs: Sequence[tuple[int, int, int]]) -> Sequence[tuple[int, int, int, int]]:
    """Return (newest source before, new source, end, job) for each job that carries newer data than all before it."""
    carriers, newest = [], -1
    for end, source, job in carried_jobs:
        if source > newest:
            carriers.append((newest, source, end, job))
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
