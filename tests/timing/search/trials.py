"""Trials of a project's changes, and what its chains are with some of them, as the command line would have it."""

from __future__ import annotations

from collections.abc import Sequence

from archgen.link.timing_overrides import apply_overrides
from archgen.model.architecture import Architecture
from archgen.timing.analysis import ChainResult
from archgen.timing.chains.chain_bounds import bound_all_chains
from archgen.timing.run_analysis import analyse_architecture
from archgen.timing.search.change_trials import ChangeTrials


def bound_with(architecture: Architecture, changes: Sequence[str] = ()) -> dict[str, ChainResult]:
    """Return all chains with some changes."""
    changed = apply_overrides(architecture, changes)
    return bound_all_chains(analyse_architecture(changed), changed)


def start_trials(architecture: Architecture, tries: int = 10_000) -> ChangeTrials:
    """Return trials that nothing was tried with yet."""
    return ChangeTrials(architecture, analyse_architecture(architecture), apply_overrides, tries)
