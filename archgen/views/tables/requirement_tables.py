"""Tables of requirements: the tree with what serves and verifies each, and what components ask of themselves."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator

from archgen.model.requirement import Requirement, TreeRow, add_above, walk_tree
from archgen.views import inline_text, requirement_servers
from archgen.views.lookup import Lookup
from archgen.views.shapes import Column, Inlines, Table, Text, drop_empty_columns, make_columns

_INDENT = "\u2003"
_MAX_INDENT = 6
"""Deeper requirements are not indented further; their depth stands in front."""


def make_requirement_table(lookup: Lookup, selected_requirements: Iterable[Requirement]) -> Table | None:
    """List requirements with what serves and verifies them: as a tree where some are part of others."""
    selected = {requirement.id: requirement for requirement in selected_requirements}
    rows = tuple(_make_row(lookup, selected[row.id], row) for row in _order_rows(lookup, selected))
    columns = make_columns(
        ("Id", 0.5), ("Requirement", 1.8), ("Use cases", 1.0), ("Served by", 1.8), ("Verified by", 1.4), ("State", 0.7)
    )
    if not rows:
        return None
    table = Table("table:requirements", "Requirements and what serves them", columns, rows)
    # In a flat list that says nothing of verification the state is that of the column before.
    return drop_empty_columns(table)


def _order_rows(lookup: Lookup, selected: Collection[str]) -> Iterator[TreeRow]:
    """Yield the tree; where nothing is part of anything a list, in which what nobody serves comes first."""
    requirements = lookup.architecture.requirements
    kept = {name: requirement for name, requirement in requirements.items() if name in selected}
    if any(each.parents for each in kept.values()):
        return walk_tree(kept)
    flat_rows = sorted(kept.values(), key=lambda each: requirement_servers.is_served(lookup, each))
    return (TreeRow(requirement.id, 0) for requirement in flat_rows)


def _make_row(lookup: Lookup, requirement: Requirement, row: TreeRow) -> tuple[Inlines, ...]:
    link = Text(requirement.id, ref=f"requirement:{requirement.id}")
    if row.is_repeated:
        note = inline_text.to_inlines(requirement.title, Text(" (also above)", muted=True))
        return ((link,), (*_indent(row.depth), *note), (), (), (), ())
    shows_state = bool(lookup.requirement_trace.parts) or lookup.requirement_trace.is_verification_told
    words = " · ".join(word for word in (requirement.kind, requirement.priority) if word)
    indent = _INDENT * min(row.depth, _MAX_INDENT)
    return (
        (link,),
        (
            *_indent(row.depth),
            Text(requirement.title),
            *((Text(f"{indent}{words}", muted=True, line_break=True),) if words else ()),
        ),
        inline_text.join_inlines(use_case_link(lookup, name) for name in requirement.use_cases),
        _server_cell(lookup, requirement),
        _verifier_cell(lookup, requirement),
        (requirement_servers.state_chip(lookup, requirement),) if shows_state else (),
    )


def _indent(depth: int) -> Inlines:
    """Return the indentation of a requirement in the tree."""
    if not depth:
        return ()
    depth_words = f"{depth} " if depth > _MAX_INDENT else ""
    return (Text(f"{_INDENT * min(depth, _MAX_INDENT)}{depth_words}", muted=True),)


def _server_cell(lookup: Lookup, requirement: Requirement) -> Inlines:
    servers = list(requirement_servers.list_servers(lookup, requirement))
    if words := requirement_servers.describe_part_service(lookup, requirement):
        servers.append((Text(words, muted=True),))
    if servers:
        return inline_text.join_inlines(servers)
    return inline_text.to_inlines(Text("uncovered", status="uncovered"), Text(" no component yet", muted=True))


def _verifier_cell(lookup: Lookup, requirement: Requirement) -> Inlines:
    verifiers = list(requirement_servers.list_verifiers(lookup, requirement))
    if words := requirement_servers.describe_part_verification(lookup, requirement):
        verifiers.append((Text(words, muted=True),))
    return inline_text.join_inlines(verifiers)


def use_case_link(lookup: Lookup, use_case_id: str) -> Inlines:
    """Link to a use case; plain text where it is not declared."""
    declared_use_case = lookup.architecture.use_cases.get(use_case_id)
    return (
        inline_text.to_inlines(Text(use_case_id, ref=f"use_case:{use_case_id}"))
        if declared_use_case
        else inline_text.to_inlines(use_case_id)
    )


def shown_requirements(lookup: Lookup) -> list[Requirement]:
    """Return the requirements that shown components serve, and what these are part of; without a scope all of them."""
    architecture = lookup.architecture
    if lookup.scope.components is None:
        return list(architecture.requirements.values())
    served_ids = {
        requirement_id
        for requirement_id, components in lookup.components_for_requirement.items()
        if any(lookup.shows_part(component.id) for component in components)
    }
    shown_ids = served_ids | add_above(architecture.requirements, served_ids)
    return [requirement for requirement in architecture.requirements.values() if requirement.id in shown_ids]


def make_free_requirement_table(lookup: Lookup) -> Table | None:
    """List the requirements that components state in their own words instead of by id."""
    rows = tuple(
        (inline_text.to_inlines(inline_text.component_link(component)), inline_text.to_inlines(use.text))
        for group in lookup.shown_groups()
        for component in lookup.shown_components(group)
        for use in component.requirements
        if not use.is_id
    )
    columns = (Column("Component"), Column("Requirement", 2.5))
    return Table("table:own_requirements", "Requirements in the components' own words", columns, rows) if rows else None
