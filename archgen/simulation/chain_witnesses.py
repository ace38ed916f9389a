"""The verdicts on chains with their evidence: bounds, and runs that show that chains can be late.

Of runs there are as many as a few seconds of computing allow, counted in jobs.

The bounds of the analysis that belong beside the observed figures.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Mapping
from fractions import Fraction

from archgen.frozen import replace
from archgen.model.architecture import Architecture
from archgen.simulation.seeded_runs import find_late_runs
from archgen.timing.analysis import Analysis, ChainResult, LateRun
from archgen.timing.chains.chain_bounds import bound_all_chains, find_data_age
from archgen.timing.chains.cost_network import CostNetwork
from archgen.timing.figures.timing_values import TimingValue
from archgen.timing.system.timing_system import TimingSystem


def find_publish_pauses(analysis: Analysis) -> dict[tuple[str, str], Fraction]:
    """Return the longest time in ns between two chances to publish, by activity and conditional output, where it is
    known.
    """
    longest_pauses = {}
    for activity in analysis.system.activities.values():
        gap = upper_bound(analysis.paces[activity.id].gap) if activity.id in analysis.paces else None
        response = analysis.responses.get(activity.id)
        worst = upper_bound(response.worst) if response else None
        if gap is None or worst is None or response is None:
            continue
        for output in activity.conditional:
            # Two successive job ends are furthest apart when the first job was as quick and the second as slow as
            # possible.
            longest_pauses[activity.id, output] = gap + worst - (response.best.value or 0)
    return longest_pauses


def bound_data_ages(analysis: Analysis, chains: Mapping[str, ChainResult]) -> dict[str, TimingValue]:
    """Return the bound on the data age of each chain, by chain id.

    Where an event is the stimulus of a chain, this is larger than its reaction time.
    """
    network = CostNetwork.of_analysis(analysis)
    return {key: find_data_age(network, result) for key, result in chains.items()}


def upper_bound(value: TimingValue | None) -> Fraction | None:
    """Return a value that bounds from above; None for an incomplete sum or one that only bounds from below."""
    return value.value if value and value.complete and value.side != "at least" else None


def bound_utilisation(analysis: Analysis, host: str) -> Fraction | None:
    """Return the bound on a host's load as a share of all its cores, None where it is unknown."""
    load = analysis.hosts.get(host)
    return upper_bound(load.share_of_cores) if load else None


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
