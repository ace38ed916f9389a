"""What would prove chains that are late: in short beside each of them, and all that was tried with the best of it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from fractions import Fraction
from typing import Any

from archgen.diagnostics import join_words
from archgen.diagnostics.text_columns import TextRow, align_rows, format_section
from archgen.emit.data import timing_json
from archgen.timing.figures import figure_wording
from archgen.timing.search.proposals import Proposal, TriedConfiguration

REMEDY_TITLE = "What would prove them, found by trying"
_MAX_COLUMNS = 5
"""So many chains have a column of their own in the table of what was tried: those that are not met as written."""
_MS = 10**6


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


def format_proposal(proposal: Proposal, width: int | None = None, *, shows_tried: bool = True) -> Iterator[str]:
    """Yield the floors that no configuration undercuts, all that was tried, and the best of it."""
    if not proposal.tried[0].late:
        yield _say_that_none_is_late(proposal)
        return
    rows = [
        (name, f"deadline {write_bound(proposal.deadlines[name])}", describe_floor(proposal, name))
        for name in proposal.hopeless
    ]
    yield from format_section("Chains that are late in any order, process, thread or core", rows, width)
    if shows_tried:
        yield "What was tried, each analysed: what chains take at most, and how far they are above their deadlines together"
        yield from align_rows(_tried_rows(proposal), width)
        if proposal.is_cut:
            yield "  more could be tried: as many configurations as are allowed were analysed"
        yield ""
    best = proposal.best
    if not best.changes:
        yield "Nothing of what was tried is better than what is written."
        unbounded = [
            name for name in proposal.tried[0].late if all(tried.bounds[name] is None for tried in proposal.tried)
        ]
        if unbounded:
            yield (
                f"No bound in any of them: {join_words(unbounded)}. `archgen timing` says which figures are missing, "
                "or what has more work than it can do."
            )
        return
    yield f"Proposed: {best.words}."
    yield f"  {_describe_result(proposal, best)}"
    kept = proposal.kept_triggers
    if best.changes_triggers and kept.changes:
        yield f"  Without another trigger, the best is: {kept.words}. {_describe_result(proposal, kept)}"
        yield "  `--propose settings` proposes that."
    yield from (f"  {line}" for line in _list_demands(best))


def _say_that_none_is_late(proposal: Proposal) -> str:
    if proposal.unjudged:
        count = len(proposal.deadlines)
        others = {0: "no other has a deadline", 1: "the other one is met"}.get(count, f"the other {count} are met")
        names = join_words(proposal.unjudged)
        return f"Nothing can be proposed for {names}: figures are missing, which `archgen timing` names; {others}."
    return "Each chain with a deadline is met." if proposal.deadlines else "No chain has a deadline."


def _tried_rows(proposal: Proposal) -> Iterator[TextRow]:
    names = proposal.tried[0].late[:_MAX_COLUMNS]
    yield "", "changes", "met", *names, "above", "configuration"
    for tried in proposal.tried:
        mark = "->" if tried is proposal.best and tried.changes else ""
        met_count = len(proposal.deadlines) - len(tried.late)
        bounds = [f"{write_bound(tried.bounds[name])}{'' if name in tried.late else ' ok'}" for name in names]
        above = figure_wording.format_share(tried.lateness)
        yield mark, str(len(tried.changes)), f"{met_count} of {len(proposal.deadlines)}", *bounds, above, tried.words


def _describe_result(proposal: Proposal, tried: TriedConfiguration) -> str:
    if not tried.late:
        count = len(proposal.deadlines)
        subject = {1: "The chain is", 2: "Both chains are"}.get(count, f"All {count} chains are")
        return f"{subject} proven."
    phrases = [
        f"{name} {write_bound(bound)}"
        + (f", {figure_wording.format_duration(bound - proposal.deadlines[name])} above its deadline" if bound else "")
        for name in tried.late
        for bound in (tried.bounds[name],)
    ]
    return f"Not proven then: {'; '.join(phrases)}."


def _list_demands(configuration: TriedConfiguration) -> Iterator[str]:
    """Yield what a configuration asks for besides the files."""
    kinds = {change.kind for change in configuration.changes}
    if "priority" in kinds:
        yield (
            "Priorities are those of processes under SCHED_FIFO: launch files, scripts, units and compose files of "
            "`archgen generate` start each with its own, which needs CAP_SYS_NICE, or `rtprio 99` in /etc/security/limits.d."
        )
    if "core" in kinds:
        yield "Launch files, scripts, units and compose files of `archgen generate` hold each process to its core (`taskset`)."
    if "container" in kinds:
        yield "What leaves a container is started as a process of its own, and no message passes inside of one any more."
    if "trigger" in kinds:
        yield (
            "A trigger changes the program: it computes when its message comes (each n-th one: `every`), without a timer; "
            "the bound rests on no message being lost."
        )


def proposal_to_json(proposal: Proposal, patch: str | None, refusal: str | None) -> dict[str, Any]:
    """Return all that was tried as plain data; durations in ms. `patch` is None where there is nothing to write."""
    return {
        "version": timing_json.VERSION,
        "propose": {
            "deadlines": _durations_to_json(proposal.deadlines),
            "floors": _durations_to_json(proposal.hopeless),
            "tried": [_tried_to_json(tried) for tried in proposal.tried],
            "best": proposal.tried.index(proposal.best),
            "kept_triggers": proposal.tried.index(proposal.kept_triggers),
            "cut": proposal.is_cut,
            "patch": patch,
            "refused": refusal,
        },
    }


def _tried_to_json(tried: TriedConfiguration) -> dict[str, Any]:
    return {
        "configuration": tried.words,
        "set": list(map(str, tried.changes)),
        "bounds": _durations_to_json(tried.bounds),
        "late": list(tried.late),
        "lateness": float(tried.lateness),
    }


def _durations_to_json(durations: Mapping[str, Fraction | None]) -> dict[str, float | None]:
    return {name: None if duration is None else float(duration / _MS) for name, duration in durations.items()}
