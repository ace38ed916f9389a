"""Reaction times and data ages along a chain, read off the jobs of one run.

Each end of the chain's last activity carries data of one job of its first. A periodic first activity samples the world
when it is activated: what happens just after that waits for its next activation. A reaction is the time from an event to
the first end that carries it; a data age the time since the sampling of what the chain put out last. Both are uniform
between two figures for an event (or a look) at a random moment, hence spans. Where the activation itself is the event,
a reaction is one figure.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from itertools import accumulate, pairwise

Span = tuple[int, int]
"""Figures from the first to the second are equally likely, and as likely as they are many; or one figure, twice."""


@dataclass(frozen=True, slots=True)
class Series:
    """What one run showed of a chain, in units of time."""

    reactions: tuple[Span, ...] = ()
    ages: tuple[Span, ...] = ()
    reduced_reaction: int | None = None
    """From the sampling (not the event) to the end that first carries it, the largest."""
    reduced_age: int | None = None
    """From the sampling to an end that carries it, the largest."""
    inputs: int = 0
    """The jobs of the first activity that the figures are of."""


@dataclass(frozen=True, slots=True)
class Trace:
    """What one run left of a chain.

    `samplings` are the activations of the first activity's jobs; `logs` tell for each later activity, by its job, which
    job of the one before it its data came from (-1 for none); `ends` are when the last one's jobs ended. `samples`
    tells that the first activity samples the world; else its activation is the event. `passed` tells of each step which
    jobs sent something to the next activity, None where all do.
    """

    samplings: Sequence[int]
    logs: Sequence[Sequence[int]]
    ends: Sequence[int]
    passed: Sequence[Collection[int] | None]
    samples: bool


def series(trace: Trace, *, passing: bool = False) -> Series:
    """Read a chain's figures. What is published once is no event: there is nothing to see.

    With `passing` only those inputs count that each activity on the way sent on as soon as it had worked on them, as
    bounds assume where an output is conditional. An age is then that of a sample behind which such an input came.
    """
    samplings, ends = trace.samplings, trace.ends
    if not samplings:
        return Series()
    wanted = _passing(trace) if passing else range(len(samplings) + 1)
    carried = [(end, source) for job, end in enumerate(ends) if (source := _source(job, trace.logs)) >= 0]
    firsts = [
        (job, end) for old, new, end in _firsts(carried) if old >= 0 for job in range(old + 1, new + 1) if job in wanted
    ]
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
    """Find the first activity's jobs that were sent on by each first job that worked on them."""
    found = {job: job for job in range(len(trace.samplings))}
    for log, passed in zip(trace.logs, trace.passed, strict=True):
        newest = list(accumulate(log, max))
        readers = {job: bisect_left(newest, at) for job, at in found.items() if passed is None or at in passed}
        found = {job: at for job, at in readers.items() if at < len(newest)}
    return frozenset(found)


def _source(job: int, logs: Sequence[Sequence[int]]) -> int:
    """Follow a job of the last activity to the job of the first whose data it carries."""
    for log in reversed(logs):
        job = log[job]
        if job < 0:
            return -1
    return job


def _firsts(carried: Sequence[tuple[int, int]]) -> Sequence[tuple[int, int, int]]:
    """Give each end that carries newer data than any before it: the newest job carried before, the new one, the end."""
    found, newest = [], -1
    for end, source in carried:
        if source > newest:
            found.append((newest, source, end))
            newest = source
    return found


def quantiles(spans: Sequence[Span], shares: Sequence[float]) -> tuple[float, ...]:
    """Give quantiles of a mixture of spans, each as likely as it is long; of single figures, where all are single."""
    if all(low == high for low, high in spans):
        figures = sorted(low for low, _ in spans)
        return tuple(float(figures[min(len(figures) - 1, int(share * len(figures)))]) for share in shares)
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
