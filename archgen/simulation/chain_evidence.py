"""What `archgen timing` finds beyond bounds: runs in which a chain is late, and the changes that would prove it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field, replace

from archgen.frozen import dataclass
from archgen.model.architecture import Architecture
from archgen.simulation.chain_witnesses import find_witnesses
from archgen.simulation.seeded_runs import LateRun
from archgen.timing.analysis import Analysis, ChainResult
from archgen.timing.search.change_trials import ChangeTrials, OverrideLayer
from archgen.timing.search.proving_changes import MAX_TRIES, ChainRemedy, find_remedies


@dataclass(frozen=True, slots=True)
class ChainEvidence:
    """The witnesses of missed chains, and what would prove those that are not proven, by chain."""

    witnesses: Mapping[str, LateRun] = field(default_factory=dict)
    remedies: Mapping[str, ChainRemedy] = field(default_factory=dict)


NO_EVIDENCE = ChainEvidence()
"""For those who only show bounds."""


def find_evidence(
    architecture: Architecture, analysis: Analysis, results: Mapping[str, ChainResult], lay_overrides: OverrideLayer
) -> ChainEvidence:
    """Look for witnesses, and for what would prove the chains that are not met: both in so many tries."""
    trials = ChangeTrials(architecture, analysis, lay_overrides, MAX_TRIES)
    remedies = find_remedies(trials, results.values())
    return ChainEvidence(find_witnesses(analysis, results.values()), {remedy.chain: remedy for remedy in remedies})


def apply_witnesses(results: Mapping[str, ChainResult], witnesses: Mapping[str, LateRun]) -> dict[str, ChainResult]:
    """Return the chains, those of which a late run was seen as missed."""
    return {key: replace(result, verdict="missed") if key in witnesses else result for key, result in results.items()}
