"""Runs that show that chains can be late: as many as a few seconds of computing allow, counted in jobs."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from fractions import Fraction

from archgen.simulation.analysis_bounds import find_publish_pauses
from archgen.simulation.seeded_runs import LateRun, find_late_runs
from archgen.timing.analysis import Analysis, ChainResult

MAX_RUNS = 8
"""As many seeds in a row begin in all the ways in which runs begin."""
_MAX_JOBS = 60_000
"""How many jobs are simulated for all chains: about two seconds of computing."""
_MAX_JOBS_PER_RUN = 300_000
"""Systems that do more than that in a single run are not simulated at all."""
_LEAST_SECONDS, _DEADLINES_PER_RUN = 2, Fraction(5, 2)
_NS_PER_SECOND = 10**9


def find_witnesses(analysis: Analysis, results: Iterable[ChainResult]) -> dict[str, LateRun]:
    """Return a run for each chain of which one was found; only chains that are not proven are looked at.

    The numbers of runs and their lengths follow from the architecture, so that they are the same on each computer.
    """
    if analysis.endless:
        return {}
    groups: dict[int, dict[str, ChainResult]] = {}
    for result in results:
        if result.verdict == "not proven" and result.deadline and result.deadline.value is not None:
            length = -(-_DEADLINES_PER_RUN * result.deadline.value // _NS_PER_SECOND)
            groups.setdefault(max(_LEAST_SECONDS, int(length)), {})[result.id] = result
    return {
        key: witness
        for seconds, group in sorted(groups.items())
        for key, witness in _find_group_witnesses(analysis, group, seconds, _MAX_JOBS // len(groups)).items()
    }


def _find_group_witnesses(
    analysis: Analysis, group: Mapping[str, ChainResult], seconds: int, max_jobs: int
) -> dict[str, LateRun]:
    """Look for runs of chains that are simulated for the same time."""
    jobs = seconds * sum((pace.rate.value or Fraction(0) for pace in analysis.paces.values()), Fraction(0))
    runs = 0 if jobs > _MAX_JOBS_PER_RUN else min(MAX_RUNS, max(1, int(max_jobs / jobs))) if jobs else MAX_RUNS
    deadlines = {
        key: (result.through, result.deadline.value)
        for key, result in group.items()
        if result.deadline is not None and result.deadline.value is not None
    }
    return find_late_runs(analysis.system, deadlines, seconds=seconds, seeds=runs, pauses=find_publish_pauses(analysis))
