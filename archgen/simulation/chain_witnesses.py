"""The verdicts on chains with their evidence: bounds, and runs that show that chains can be late.

Of runs there are as many as a few seconds of computing allow, counted in jobs.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable
from fractions import Fraction

from archgen.frozen import replace
from archgen.model.architecture import Architecture
from archgen.simulation.analysis_bounds import find_publish_pauses
from archgen.simulation.seeded_runs import find_late_runs
from archgen.timing.analysis import Analysis, ChainResult, LateRun
from archgen.timing.chains.chain_bounds import bound_all_chains
from archgen.timing.system.timing_system import TimingSystem

MAX_RUNS = 8
"""As many seeds in a row begin in all the ways in which runs begin."""
_MAX_JOBS = 60_000
"""How many jobs are simulated for all chains: about two seconds of computing."""
_MAX_JOBS_PER_RUN = 300_000
"""Systems that do more than that in a single run are not simulated at all."""
_LEAST_SECONDS, _DEADLINES_PER_RUN = 2, Fraction(5, 2)
_NS_PER_SECOND = 10**9
_AskedChains = dict[str, tuple[tuple[str, ...], Fraction]]
"""The activities and the deadline (ns) of chains, by chain."""
_last_searches: deque[tuple[TimingSystem, _AskedChains, dict[str, LateRun]]] = deque(maxlen=4)
"""What was found last: of two versions, and of what one of them might be."""


def judge_chains(analysis: Analysis, architecture: Architecture) -> dict[str, ChainResult]:
    """Return the chains of an architecture, in order of appearance, with the verdicts that all outputs tell: a chain that
    bounds do not prove is missed where a run shows it late, which is its `late_run`.
    """
    results = bound_all_chains(analysis, architecture)
    for key, late_run in find_witnesses(analysis, results.values()).items():
        results[key] = replace(results[key], verdict="missed", late_run=late_run)
    return results


def find_witnesses(analysis: Analysis, results: Iterable[ChainResult]) -> dict[str, LateRun]:
    """Return a run for each chain of which one was found; only chains that are not proven are looked at.

    The numbers of runs and their lengths follow from the architecture, so that they are the same on each computer.
    """
    asked: _AskedChains = {
        result.id: (result.through, result.deadline.value)
        for result in results
        if result.verdict == "not proven" and result.deadline and result.deadline.value is not None
    }
    if analysis.endless or not asked:
        return {}
    # Rules, pages and comparisons ask of the same system one after the other.
    for system, known_chains, late_runs in tuple(_last_searches):  # another thread may add to it
        if system is analysis.system and known_chains == asked:
            return late_runs
    late_runs = _search_late_runs(analysis, asked)
    _last_searches.append((analysis.system, asked, late_runs))
    return late_runs


def _search_late_runs(analysis: Analysis, asked: _AskedChains) -> dict[str, LateRun]:
    groups: dict[int, _AskedChains] = {}
    for name, (through, deadline) in asked.items():
        length = -(-_DEADLINES_PER_RUN * deadline // _NS_PER_SECOND)
        groups.setdefault(max(_LEAST_SECONDS, int(length)), {})[name] = through, deadline
    return {
        name: late_run
        for seconds, group in sorted(groups.items())
        for name, late_run in _search_group(analysis, group, seconds, _MAX_JOBS // len(groups)).items()
    }


def _search_group(analysis: Analysis, group: _AskedChains, seconds: int, max_jobs: int) -> dict[str, LateRun]:
    """Look for runs of chains that are simulated for the same time."""
    jobs = seconds * sum((pace.rate.value or Fraction(0) for pace in analysis.paces.values()), Fraction(0))
    runs = 0 if jobs > _MAX_JOBS_PER_RUN else min(MAX_RUNS, max(1, int(max_jobs / jobs))) if jobs else MAX_RUNS
    return find_late_runs(analysis.system, group, seconds=seconds, seeds=runs, pauses=find_publish_pauses(analysis))
