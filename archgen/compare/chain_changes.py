"""Find the chains whose bound or deadline changed."""

from __future__ import annotations

from collections.abc import Mapping

from archgen.compare.activity_owners import find_activity_owners
from archgen.compare.comparison import ChainChange
from archgen.compare.interface_figures import is_close_value, is_smaller
from archgen.compare.matched_ids import MatchedIds
from archgen.compare.timing_pair import TimingPair
from archgen.model.architecture import Architecture
from archgen.timing.analysis import Analysis, ChainResult
from archgen.timing.chains import chain_bounds as timing_chains


def compare_chains(
    before: Architecture, after: Architecture, matched_ids: MatchedIds, timing_pair: TimingPair | None
) -> tuple[ChainChange, ...]:
    """Return the chains that were added or removed, or have another bound or deadline, in the order of the second
    version.
    """
    if timing_pair is None:
        return ()
    new_results, old_results = _chain_results(after, timing_pair.after), _chain_results(before, timing_pair.before)
    kept_pairs = [(matched_ids.old_ids.get("chain", {}).get(name), name) for name in new_results]
    removed_pairs = [(name, None) for name in old_results if matched_ids.find_new_id("chain", name) is None]
    result_pairs = (
        (old_results.get(old_result) if old_result else None, new_results[new_result] if new_result else None)
        for old_result, new_result in (*kept_pairs, *removed_pairs)
    )

    def find_chain_owners(old_result: ChainResult | None, new_result: ChainResult | None) -> frozenset[str]:
        if _is_negligible(old_result, new_result):
            return frozenset()
        old_owners = find_activity_owners(old_result.through if old_result else (), before, timing_pair.before)
        new_owners = find_activity_owners(new_result.through if new_result else (), after, timing_pair.after)
        return new_owners | {matched_ids.common_id("partner", owner) for owner in old_owners}

    return tuple(
        ChainChange(
            chain_result.id, old_result, new_result, concerned_partners=find_chain_owners(old_result, new_result)
        )
        for old_result, new_result in result_pairs
        if (chain_result := new_result or old_result) and _results_differ(old_result, new_result)
    )


def _chain_results(architecture: Architecture, analysis: Analysis) -> Mapping[str, ChainResult]:
    return timing_chains.bound_all_chains(analysis, architecture) if architecture.chains else {}


def _results_differ(old_result: ChainResult | None, new_result: ChainResult | None) -> bool:
    if old_result is None or new_result is None:
        return True
    # The words of a bound (what it lacks, where it is from) may change without the figure: they are left out.
    bounds = [(result.bound.value, result.bound.complete, result.bound.side) for result in (old_result, new_result)]
    limits = [
        (result.deadline, *((each.share, each.limit) for each in result.shares)) for result in (old_result, new_result)
    ]
    return bounds[0] != bounds[1] or limits[0] != limits[1]


def _is_negligible(old_result: ChainResult | None, new_result: ChainResult | None) -> bool:
    """Whether two results of a chain say the same to people, or the chain is only quicker."""
    if old_result is None or new_result is None:
        return False
    verdicts = [(result.verdict, result.deadline) for result in (old_result, new_result)]
    bounds = old_result.bound, new_result.bound
    return verdicts[0] == verdicts[1] and (is_close_value(*bounds) or is_smaller(*bounds))
