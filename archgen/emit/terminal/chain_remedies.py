"""What is said of chains beyond their bounds: the run in which one is late, and what would prove it."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

from archgen.diagnostics.text_columns import TextRow
from archgen.simulation.chain_witnesses import ChainWitness
from archgen.timing.analysis import ChainResult
from archgen.timing.figures import figure_wording
from archgen.timing.search.proposals import Proposal

REMEDY_TITLE = "What would prove them, found by trying"


def describe_slack(result: ChainResult) -> str:
    """Return how much of its deadline a chain's bound leaves, or by how much it is above it: `252.1 ms left`."""
    if result.slack is None:
        return ""
    text = figure_wording.format_duration(abs(result.slack))
    return f"{text} left" if result.slack >= 0 else f"{text} above it"


def describe_witness(chain_id: str, witness: ChainWitness | None) -> str:
    """Return how to see a chain late, empty where no run is known."""
    if witness is None:
        return ""
    command = f"archgen simulate --seed {witness.seed} --chain {chain_id} --seconds {witness.seconds}"
    return f"seen in `{command}`: {figure_wording.format_duration(witness.longest)}"


def list_remedy_rows(proposal: Proposal | None) -> Iterator[TextRow]:
    """Yield for each chain that is not met what it takes in the best configuration that was tried."""
    if proposal is None:
        return
    if proposal.best.changes:
        yield (f"{proposal.best.words} (`archgen timing --propose`)",)
    for name in proposal.tried[0].late:
        yield name, describe_remedy(proposal, name)


def describe_remedy(proposal: Proposal, chain_id: str) -> str:
    """Return what a chain takes in the best configuration, or that nothing helps of what was tried."""
    best = proposal.best
    figure = f"then at most {write_bound(best.bounds[chain_id])}"
    if chain_id in best.late:
        is_better = best.changes and best.bounds[chain_id] != proposal.tried[0].bounds[chain_id]
        count = len(proposal.tried) - 1
        tried = f"nothing of what was tried ({count} configuration{'s' if count != 1 else ''})"
        figure = f"{figure}, which is not enough" if is_better else tried if count else ""
    return "; ".join(filter(None, (describe_floor(proposal, chain_id), figure)))


def describe_floor(proposal: Proposal, chain_id: str) -> str:
    """Say that a chain's floor is above its deadline; empty where it is not."""
    floor = proposal.hopeless.get(chain_id)
    if floor is None:
        return ""
    return (
        f"with nobody in its way it takes {figure_wording.format_duration(floor)}: "
        f"nothing but other rates, triggers or execution times can prove it (`archgen timing --budget {chain_id}`)"
    )


def write_bound(bound: Fraction | None) -> str:
    """Return the bound of a chain in a configuration; None is none."""
    return "no bound" if bound is None else figure_wording.format_duration(bound)
