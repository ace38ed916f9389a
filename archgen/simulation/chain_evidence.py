"""What `archgen timing` finds beyond bounds: runs in which a chain is late, and how it would have to be run to be proven."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from archgen.frozen import dataclass, field, replace
from archgen.model.architecture import Architecture
from archgen.simulation.chain_witnesses import find_witnesses
from archgen.simulation.seeded_runs import LateRun
from archgen.timing.analysis import Analysis, ChainResult

if TYPE_CHECKING:
    from archgen.timing.search.change_trials import OverrideLayer
    from archgen.timing.search.proposals import Proposal

_SMALL_SIZE, _LEAST_TRIES = 150, 12
"""So many activities make a small project; and so many configurations are tried of the largest one."""


@dataclass(frozen=True, slots=True)
class ChainEvidence:
    """The witnesses of missed chains, by chain, and the configurations that were tried; None where all chains are met."""

    witnesses: Mapping[str, LateRun] = field(default_factory=dict)
    proposal: Proposal | None = None


NO_EVIDENCE = ChainEvidence()
"""For those who only show bounds."""


def find_evidence(
    architecture: Architecture,
    analysis: Analysis,
    results: Mapping[str, ChainResult],
    lay_overrides: OverrideLayer,
    asked: str | None = None,
) -> ChainEvidence:
    """Look for witnesses, and for a configuration in which the chains are met: of all chains, or for one that is asked for."""
    asked_results = [result for name, result in results.items() if asked in {None, name}]
    proposal = None
    if any(result.deadline and result.verdict in {"missed", "not proven"} for result in asked_results):
        # Of all who show bounds only a terminal asks for this.
        from archgen.timing.search.change_trials import ChangeTrials
        from archgen.timing.search.proposals import MAX_TRIES, find_proposal

        # Of a large project fewer are tried, since nobody asked for it: `--propose` tries them all.
        tries = max(_LEAST_TRIES, MAX_TRIES * _SMALL_SIZE // max(_SMALL_SIZE, len(analysis.system.activities)))
        proposal = find_proposal(ChangeTrials(architecture, analysis, lay_overrides, tries), results)
    return ChainEvidence(find_witnesses(analysis, asked_results), proposal)


def apply_witnesses(results: Mapping[str, ChainResult], witnesses: Mapping[str, LateRun]) -> dict[str, ChainResult]:
    """Return the chains, those of which a late run was seen as missed."""
    return {key: replace(result, verdict="missed") if key in witnesses else result for key, result in results.items()}
