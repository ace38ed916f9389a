"""What `archgen timing` prints: the summary, one chain, reasons, ways, what decides, a budget; as text or as JSON."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterable
from typing import NoReturn

import click

from archgen.cli import command_support
from archgen.cli.shared_options import find_asked_variants
from archgen.diagnostics import did_you_mean, format_json, join_first, make_visible
from archgen.diagnostics.text_columns import find_width, wrap_line
from archgen.emit.data import timing_json
from archgen.emit.terminal import chain_remedies, chain_text, timing_text
from archgen.emit.terminal.findings_text import wants_colour
from archgen.emit.terminal.state_paint import paint_states
from archgen.frozen import dataclass
from archgen.link.timing_overrides import apply_overrides
from archgen.model.architecture import Architecture
from archgen.pipeline import CheckedProject
from archgen.simulation.chain_witnesses import judge_chains
from archgen.timing.analysis import Analysis, ChainResult
from archgen.timing.chains import chain_bounds, duerr_bounds, element_index
from archgen.timing.chains.chain_sensitivity import find_sensitivity
from archgen.timing.chains.cost_network import CostNetwork
from archgen.timing.chains.figure_explanations import explain_word
from archgen.timing.chains.loop_rounds import find_loop_rounds
from archgen.timing.chains.missing_figures import describe_gaps
from archgen.timing.run_analysis import analyse_architecture, analyse_for_chains
from archgen.timing.search import chain_budgets, proposals
from archgen.timing.search.change_trials import ChangeTrials


@dataclass(frozen=True, slots=True)
class TimingRequest:
    """What one call asks for."""

    checked_project: CheckedProject
    architecture: Architecture
    """The architecture with the figures of `--set`."""
    as_json: bool
    overrides: tuple[str, ...] = ()
    shows_all: bool = False
    """Whether a terminal shows all of the summary, too."""


def print_timing_summary(request: TimingRequest) -> None:
    """Print all of the timing: chains, hosts, links and what is missing; with `--set` before and after."""
    present = _analyse_chains(request.checked_project.architecture)
    if not request.overrides:
        analysis, chains = present
        proposal = proposals.find_short_proposal(request.architecture, analysis, chains, apply_overrides)
        if request.as_json:
            _print_json(timing_json.timing_to_json(analysis, chains, proposal))
        else:
            loops = find_loop_rounds(CostNetwork.of_analysis(analysis))
            is_short = sys.stdout.isatty() and not request.shows_all
            width = find_width(sys.stdout)
            _print_lines(timing_text.format_timing(analysis, chains, loops, width, proposal, is_short=is_short))
        return
    changed = _analyse_chains(request.architecture)
    if request.as_json:
        documents = {"present": timing_json.timing_to_json(*present), "changed": timing_json.timing_to_json(*changed)}
        _print_json({"version": timing_json.VERSION, "set": list(request.overrides), **documents})
    else:
        _print_lines(chain_text.format_timing_changes(present, changed, request.overrides, find_width(sys.stdout)))


def print_chain(request: TimingRequest, chain_id: str) -> None:
    """Print one chain term by term (`--chain`)."""
    analysis, chains = _analyse_chains(request.architecture)
    result = _find_chain(chains, chain_id)
    is_late = result.verdict in {"missed", "not proven"} and not request.overrides
    proposal = (
        proposals.find_short_proposal(request.architecture, analysis, chains, apply_overrides) if is_late else None
    )
    # Without terms the chain is open: its elements may be components that no activity stands for.
    published = duerr_bounds.bound_periodic_chain(analysis, result.through) if result.terms else None
    if request.as_json:
        _print_json({"version": timing_json.VERSION, "chain": chain_id, **timing_json.chain_to_json(result, proposal)})
    else:
        age = chain_bounds.find_data_age(CostNetwork.of_analysis(analysis), result)
        _print_lines(chain_text.format_chain(result, analysis, age, published, find_width(sys.stdout), proposal))


def print_reasons(request: TimingRequest, word: str) -> None:
    """Print why a figure is what it is (`--why`)."""
    analysis, chains = _analyse_chains(request.architecture)
    names = [word]
    # Chains, hosts and links explain themselves; a node or component stands for its activities.
    if not explain_word(analysis, chains, word):
        try:
            names = list(element_index.resolve_activities(request.architecture, analysis.system, word))
        except element_index.UnknownNameError as error:
            raise_usage_error(str(error))
    steps = [line for name in names for line in explain_word(analysis, chains, name)]
    if request.as_json:
        _print_json(chain_text.reasoning_to_json(word, steps))
    else:
        _print_lines(chain_text.format_reasoning(steps))


def print_paths(request: TimingRequest, source: str, target: str, path_count: int) -> None:
    """Print the ways between two elements (`--from`, `--to`)."""
    analysis = analyse_architecture(request.architecture)
    network = CostNetwork.of_analysis(analysis)
    try:
        start, end = (
            element_index.resolve_waypoint(request.architecture, analysis.system, word) for word in (source, target)
        )
    except element_index.UnknownNameError as error:
        raise_usage_error(str(error))
    worst = chain_bounds.find_paths_between(network, request.architecture, start, end)
    best = chain_bounds.find_paths_between(network, request.architecture, start, end, "best")
    listed_paths = [
        tuple(chain_bounds.list_bounded_paths(network, w, k)) if w else () for w, k in ((worst, path_count), (best, 1))
    ]
    count = worst.path_count if worst else 0
    if request.as_json:
        _print_json(timing_json.ways_to_json(start.id, end.id, count, *listed_paths))
    else:
        _print_lines(chain_text.format_ways(start.id, end.id, count, *listed_paths))


def print_sensitivity(request: TimingRequest, chain_id: str) -> None:
    """Print what decides a chain, the most decisive first (`--sensitivity`)."""
    analysis, chains = _analyse_chains(request.architecture)
    result = _find_chain(chains, chain_id)
    ranking = find_sensitivity(request.architecture, request.architecture.chains[chain_id], analyse_for_chains, chains)
    if request.as_json:
        _print_json(chain_text.sensitivity_to_json(result, ranking))
    else:
        _print_lines(chain_text.format_sensitivity(result, analysis, ranking, find_width(sys.stdout)))


def print_budget(request: TimingRequest, chain_id: str) -> None:
    """Print how long what a chain rests on may take until it misses its deadline (`--budget`)."""
    architecture = request.architecture
    analysis, chains = _analyse_chains(architecture)
    result = _find_chain(chains, chain_id)
    try:
        budget = chain_budgets.find_chain_budget(
            ChangeTrials(architecture, analysis, apply_overrides, chain_budgets.MAX_TRIES), result
        )
    except chain_budgets.UnknownBudgetError as error:
        gaps_text = describe_gaps(result, analysis) if result.deadline else ""
        raise_usage_error(
            f"`{chain_id}` has no budget: {error}{f' ({gaps_text})' if gaps_text else ''}"
            + ("" if result.deadline else f"; write `deadline` at `chains: {chain_id}`")
        )
    if request.as_json:
        _print_json(chain_text.budget_to_json(result, budget))
    else:
        titles = {partner.id: partner.title for partner in architecture.partners.values()}
        _print_lines(chain_text.format_budget(result, budget, titles, find_width(sys.stdout)))


def print_proposal(request: TimingRequest, *, keep_triggers: bool, applies: bool) -> None:
    """Print a configuration in which chains are less late (`--propose`), with its patch; or write it (`--apply`)."""
    from archgen.edit.configuration_patch import plan_patch
    from archgen.edit.element_edit import EditRefusedError, FileEdit

    architecture = request.architecture
    analysis, chains = _analyse_chains(architecture)
    trials = ChangeTrials(architecture, analysis, apply_overrides, proposals.MAX_TRIES)
    proposal = proposals.find_proposal(trials, chains, keep_triggers=keep_triggers)
    edits: tuple[FileEdit, ...] = ()
    refusal: str | None = None
    try:
        if proposal.best.changes:
            edits = plan_patch(request.checked_project, proposal.best, find_asked_variants())
    except EditRefusedError as error:
        command_support.print_findings(error.errors, request.checked_project, sys.stderr)
        refusal = error.message
    patch = "".join(line for edit in edits for line in edit.unified_diff())
    if request.as_json:
        _print_json(chain_remedies.proposal_to_json(proposal, patch or None, refusal))
    else:
        _print_lines(chain_remedies.format_proposal(proposal, find_width(sys.stdout), shows_tried=not applies))
    if refusal is not None:
        options = " ".join(f"--set {change}" for change in proposal.best.changes)
        raise click.ClickException(make_visible(f"no patch: {refusal}; to be written by hand: {options}"))
    if applies:
        for edit in edits:
            command_support.write_edit(request.checked_project.root, edit, "as proposed")
    elif patch and not request.as_json:
        click.echo("\nPatch, for `git apply` in this project's folder (`--apply` writes it):\n")
        # What is piped into `git apply` has to be exact.
        shown_lines = map(make_visible, patch.split("\n")) if sys.stdout.isatty() else patch.split("\n")
        click.echo("\n".join(shown_lines), nl=False)


def _analyse_chains(architecture: Architecture) -> tuple[Analysis, dict[str, ChainResult]]:
    analysis = analyse_architecture(architecture)
    return analysis, judge_chains(analysis, architecture)


def _find_chain(chain_results: dict[str, ChainResult], chain_id: str) -> ChainResult:
    if chain_id not in chain_results:
        existing = (
            f"there are: {join_first(tuple(chain_results), 12)}"
            if chain_results
            else "the project has none: write it under `chains`"
        )
        raise_usage_error(f"there is no chain `{chain_id}`; {did_you_mean(chain_id, chain_results) or existing}")
    return chain_results[chain_id]


def raise_usage_error(text: str) -> NoReturn:
    """Raise the error for wrong usage with a text that may hold anything."""
    raise click.UsageError(make_visible(text))


def _print_json(document: object) -> None:
    click.echo(format_json(document), nl=False)


def _print_lines(lines: Iterable[str]) -> None:
    width = find_width(sys.stdout)
    wrapped = (part for line in lines for part in wrap_line(make_visible(line), width))
    for line in paint_states(wrapped) if wants_colour(sys.stdout, os.environ) else wrapped:
        click.echo(line)
