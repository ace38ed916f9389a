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

Span = tuple[int, int]
"""Values from the first to the second are equally likely, and a range weighs as much as it is long; or one value,
twice.
"""


@dataclass(frozen=True, slots=True)
class Series:
    """The figures of a chain in one run, in units."""

    reactions: tuple[Span, ...] = ()
    ages: tuple[Span, ...] = ()
    reduced_reaction: int | None = None
    """The longest time from a sampling (not from the event) to the end of the first job that carries it."""
    reduced_age: int | None = None
    """The longest time from a sampling to the end of a job that carries it."""
    inputs: int = 0
    """The number of jobs of the first activity behind the figures."""


@dataclass(frozen=True, slots=True)
class Trace:
    """What one run recorded of a chain.

    `samplings` are the activation times of the first activity's jobs. `source_logs` give, for each later activity and
    each of its jobs, the job of the previous activity whose data it read (-1 for none). `job_ends` are the end times of
    the last activity's jobs. `samples_world` says that the first activity samples the world; otherwise its activation
    is the event. `forwarded_jobs` give, for each activity but the last, the jobs that sent something to the next one;
    None where all do.
    """

    samplings: Sequence[int]
    logs: Sequence[Sequence[int]]
    ends: Sequence[int]
    passed: Sequence[Collection[int] | None]
    samples: bool


def series(trace: Trace, *, passing: bool = False) -> Series:
    """Compute a chain's figures. What is published once is no event, and yields none.

    With `forwarded_only`, only those inputs count that each activity on the way sent on as soon as it had processed
    them, as the bounds assume where an output is conditional. An age is then that of a sample followed by such an
    input.
    """
    samplings, ends = trace.samplings, trace.ends
    if not samplings:
        return Series()
    # One more than there are: the test for ages below asks for the job after the last source.
    wanted = _passing(trace) if passing else range(len(samplings) + 1)
    carried = [(end, source) for job, end in enumerate(ends) if (source := _source(job, trace.logs)) >= 0]
    # A job that carries new data is also the first reaction to every input that was overwritten in between. The very
    # first one is left out: what came before it is not known.
    firsts = [
        (job, end) for old, new, end in _firsts(carried) if old >= 0 for job in range(old + 1, new + 1) if job in wanted
    ]
    # The oldest event that a sampling catches happened just after the sampling before it.
    back = 1 if trace.samples else 0
    ages = tuple(
        (end - samplings[source], then - samplings[source])
        for (end, source), (then, _) in pairwise(carried)
        if source + 1 in wanted
    )
    return Series(
        tuple((end - samplings[job], end - samplings[job - back]) for job, end in firsts),
        ages,
        max((end - samplings[job] for job, end in firsts), default=None),
        max((low for low, _ in ages), default=None),
        len(firsts),
    )


def _passing(trace: Trace) -> frozenset[int]:
    """Return the jobs of the first activity that each later activity sent on with its first job that read them."""
    found = {job: job for job in range(len(trace.samplings))}
    for log, passed in zip(trace.logs, trace.passed, strict=True):
        # Running maxima are sorted, so that the first job with data at least this new is found by bisection.
        newest = list(accumulate(log, max))
        readers = {job: bisect_left(newest, at) for job, at in found.items() if passed is None or at in passed}
        found = {job: at for job, at in readers.items() if at < len(newest)}
    return frozenset(found)


def _source(job: int, logs: Sequence[Sequence[int]]) -> int:
    """Return the job of the first activity whose data a job of the last one carries; -1 for none."""
    for log in reversed(logs):
        job = log[job]
        if job < 0:
            return -1
    return job


def _firsts(carried: Sequence[tuple[int, int]]) -> Sequence[tuple[int, int, int]]:
    """Return (newest source before, new source, end) for each job that carries newer data than all before it."""
    found, newest = [], -1
    for end, source in carried:
        if source > newest:
            found.append((newest, source, end))
            newest = source
    return found


def quantiles(spans: Sequence[Span], shares: Sequence[float]) -> tuple[float, ...]:
    """Return quantiles of a mixture of ranges, each weighted by its length; of the values where all ranges are single
    values.
    """
    if all(low == high for low, high in spans):
        figures = sorted(low for low, _ in spans)
        return tuple(float(figures[min(len(figures) - 1, int(share * len(figures)))]) for share in shares)
    # A sweep over the ends of the ranges: `depth` of them overlap, so the distribution grows by `depth` for each unit.
    edges = sorted([(low, 1) for low, _ in spans] + [(high, -1) for _, high in spans])
    total = sum(high - low for low, high in spans)
    found: list[float] = []
    passed, depth, last = 0, 0, edges[0][0]
    wanted = [share * total for share in shares]
    for edge, change in edges:
        grown = passed + depth * (edge - last)
        while len(found) < len(wanted) and grown >= wanted[len(found)] and depth:
            found.append(last + (wanted[len(found)] - passed) / depth)
        passed, depth, last = grown, depth + change, edge
    return tuple(found + [float(last)] * (len(wanted) - len(found)))
