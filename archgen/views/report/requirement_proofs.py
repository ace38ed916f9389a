"""The chapter of requirements in the deliverable: who serves each, and what proves it."""

from __future__ import annotations

from collections.abc import Iterator

from archgen.diagnostics import join_first
from archgen.model.requirement import Requirement
from archgen.views import inline_text, requirement_servers
from archgen.views.lookup import Lookup
from archgen.views.shapes import Inlines, Paragraph, Section, Table, Text, drop_empty_columns, make_columns
from archgen.views.tables import requirement_tables
from archgen.views.timing import chain_status, timing_tables

_MAX_REQUIREMENTS = 100
"""Of more requirements those are listed that are not met."""
_STATE_RANKS = {"uncovered": 0, "missed": 1, "not proven": 2, "open": 3, "met": 4}


def make_requirements(lookup: Lookup) -> Iterator[Section]:
    """Yield the chapter of requirements with what proves each, first what nobody serves."""
    requirements = requirement_tables.shown_requirements(lookup)
    if not requirements:
        return
    # What a chain proves comes before what a trial has to show.
    ranked = sorted(
        requirements,
        key=lambda each: (_STATE_RANKS[_judge(lookup, each)], not _list_proofs(lookup, each)),
    )
    shown = ranked if len(ranked) <= _MAX_REQUIREMENTS else [each for each in ranked if _judge(lookup, each) != "met"]
    shown = shown[:_MAX_REQUIREMENTS]
    served = [each for each in requirements if requirement_servers.is_served(lookup, each)]
    lead = f"{len(served)} of {len(requirements)} are served. Those that nobody serves stand first, then those without proof."
    if not shown:
        lead = f"All {len(requirements)} are served and met. The workbook says what proves each."
    elif len(shown) < len(ranked):
        lead += f" The other {len(ranked) - len(shown)} stand in the workbook."
    rows = tuple(_trace_requirement(lookup, each) for each in shown)
    columns = make_columns(
        ("Id", 0.5), ("Requirement", 2.6), ("By, components", 1.4), ("Use cases", 0.9), ("Proof", 1.7)
    )
    table = Table("table:requirements", "Requirements", columns, rows, numbered=False, dense=True)
    blocks = (Paragraph(inline_text.to_inlines(lead)), *((drop_empty_columns(table),) if rows else ()))
    yield Section("page:requirements", "Requirements, and what proves them", blocks, page_break=bool(rows))


def _judge(lookup: Lookup, requirement: Requirement) -> str:
    """Return the state of a requirement; of one that only a trial can show, that it is open."""
    state = lookup.requirement_trace.judge(requirement.id)
    chains = lookup.chains_for_requirement.get(requirement.id, ())
    verdicts = [requirement_servers.describe_chain_state(lookup, each) for each in chains]
    if state == "met" and not (_list_proofs(lookup, requirement) or _list_trials(lookup, requirement)):
        return "open"
    return "not proven" if state == "open" and "not proven" in verdicts else state


def _trace_requirement(lookup: Lookup, requirement: Requirement) -> tuple[Inlines, ...]:
    servers = list(lookup.components_for_requirement.get(requirement.id, ()))
    owners = dict.fromkeys(owner for component in servers for owner in component.owners)
    by = (
        (*inline_text.owner_links(lookup.architecture, owners), Text(f" {len(servers)}", muted=True)) if servers else ()
    )
    return (
        inline_text.to_inlines(Text(requirement.id, strong=True)),
        inline_text.to_inlines(requirement.title),
        by,
        inline_text.join_inlines(requirement_tables.use_case_link(lookup, name) for name in requirement.use_cases),
        _prove(lookup, requirement),
    )


def _prove(lookup: Lookup, requirement: Requirement) -> Inlines:
    """Return what proves a requirement: the verdict of a chain, what verifies it, else the figures of a trial."""
    if not requirement_servers.is_served(lookup, requirement):
        return (Text("nobody serves it", status="uncovered"),)
    if lines := _list_proofs(lookup, requirement):
        return inline_text.join_lines(lines)
    told = _list_trials(lookup, requirement)
    words = f"to be tried: {join_first(told, 1)}" if told else "nothing says what shows it"
    return (Text(words, muted=True),)


def _list_proofs(lookup: Lookup, requirement: Requirement) -> list[Inlines]:
    """Return the verdicts of the chains that serve a requirement, and what verifies it."""
    results = {result.id: result for result in (lookup.timing.chains if lookup.timing else ())}
    lines: list[Inlines] = []
    for chain in lookup.chains_for_requirement.get(requirement.id, ()):
        if (result := results.get(chain.id)) and result.deadline:
            figures = (*timing_tables.duration_cell(result.bound), Text(" of "), *timing_tables.deadline_cell(result))
            lines.append((*chain_status.verdict_chip(result), Text(" "), *figures))
    return [*lines, *requirement_servers.list_verifiers(lookup, requirement)]


def _list_trials(lookup: Lookup, requirement: Requirement) -> list[str]:
    """Return how good the components that serve a requirement are to be: figures that a trial shows."""
    servers = lookup.components_for_requirement.get(requirement.id, ())
    return [each.accuracy for component in servers for each in component.performance if each.accuracy]
