"""The site's page of a requirement: what it is part of, its parts, what serves it, what verifies it."""

from __future__ import annotations

from collections.abc import Iterator

from archgen.model.requirement import Requirement
from archgen.views import inline_text, requirement_servers
from archgen.views.elements.annotation_facts import list_annotation_facts
from archgen.views.elements.functional_level import make_component_table
from archgen.views.lookup import Lookup
from archgen.views.pages.context_pages import make_page
from archgen.views.shapes import Block, Bullets, Column, Facts, Inlines, Markdown, Page, Paragraph, Section, Table, Text
from archgen.views.tables import requirement_tables


def make_requirement_pages(lookup: Lookup) -> Iterator[Page]:
    """Make a page for each requirement that is shown."""
    for requirement in requirement_tables.shown_requirements(lookup):
        yield _requirement_page(lookup, requirement)


def _requirement_page(lookup: Lookup, requirement: Requirement) -> Page:
    blocks: list[Block] = [Paragraph(inline_text.to_inlines(requirement.title))]
    facts = tuple((name, value) for name, value in _list_facts(lookup, requirement) if value)
    blocks += [Facts(facts)] if facts else []
    blocks += [Markdown(requirement.description)] if requirement.description else []
    if requirement.rationale:
        blocks += [_make_heading("Rationale"), Markdown(requirement.rationale)]
    blocks += _make_part_blocks(lookup, requirement)
    blocks += _make_server_blocks(lookup, requirement)
    blocks += _make_verifier_blocks(lookup, requirement)
    crumb = ("Requirements and use cases", "page:requirements")
    section = Section(f"requirement:{requirement.id}", requirement.id, tuple(blocks))
    return make_page(section, "requirements", crumb, "Requirement")


def _make_heading(title: str) -> Paragraph:
    return Paragraph(inline_text.to_inlines(Text(title, strong=True)))


def _list_facts(lookup: Lookup, requirement: Requirement) -> Iterator[tuple[str, Inlines]]:
    trace = lookup.requirement_trace
    if trace.parts or trace.is_verification_told or trace.missed:
        yield "State", (requirement_servers.state_chip(lookup, requirement),)
    parents = (inline_text.requirement_link(lookup.architecture, parent) for parent in requirement.parents)
    yield "Part of", inline_text.join_lines(parents)
    for name, words in (("Kind", requirement.kind), ("Priority", requirement.priority), ("Source", requirement.source)):
        yield name, inline_text.to_inlines(words)
    use_cases = (requirement_tables.use_case_link(lookup, name) for name in requirement.use_cases)
    yield "Use cases", inline_text.join_inlines(use_cases)
    yield "Tags", inline_text.to_inlines(", ".join(requirement.tags))
    yield "Links", inline_text.link_urls(requirement.urls.items(), lookup.repository)
    yield from list_annotation_facts(lookup, requirement)


def _make_part_blocks(lookup: Lookup, requirement: Requirement) -> Iterator[Block]:
    """Yield the table of what is directly part of a requirement."""
    parts = [lookup.architecture.requirements[part] for part in lookup.requirement_trace.parts.get(requirement.id, ())]
    rows = tuple(
        (
            (Text(part.id, ref=f"requirement:{part.id}"),),
            inline_text.to_inlines(part.title),
            (requirement_servers.state_chip(lookup, part),),
        )
        for part in parts
    )
    columns = (Column("Id", 0.5), Column("Requirement", 2.5), Column("State", 0.5))
    if rows:
        yield Table(f"table:parts/{requirement.id}", "Its parts", columns, rows)


def _make_server_blocks(lookup: Lookup, requirement: Requirement) -> Iterator[Block]:
    serving_components = list(lookup.components_for_requirement.get(requirement.id, ()))
    if serving_components:
        title = "Components that serve it"
        yield make_component_table(lookup, f"table:serving/{requirement.id}", title, serving_components)
    serving_chains = lookup.chains_for_requirement.get(requirement.id, ())
    if serving_chains:
        yield _make_heading("Chains that serve it")
        yield Bullets(tuple(requirement_servers.chain_link(lookup, chain) for chain in serving_chains))
    if serving_components or serving_chains:
        return
    words = requirement_servers.describe_part_service(lookup, requirement)
    line = f"No component serves it as a whole: {words}." if words else "No component serves this requirement yet."
    is_served = requirement_servers.is_served(lookup, requirement)
    yield Paragraph(inline_text.to_inlines(line), "text" if is_served else "warning")


def _make_verifier_blocks(lookup: Lookup, requirement: Requirement) -> Iterator[Block]:
    """Yield what verifies a requirement; that nothing does only where the project says of any what does."""
    verifiers = tuple(requirement_servers.list_verifiers(lookup, requirement))
    words = requirement_servers.describe_part_verification(lookup, requirement)
    if verifiers:
        yield _make_heading("Verified by")
        yield Bullets(verifiers)
    elif words:
        yield Paragraph(inline_text.to_inlines(f"Nothing verifies it as a whole: {words}."))
    elif lookup.requirement_trace.is_verification_told:
        yield Paragraph(inline_text.to_inlines("Nothing verifies this requirement yet."), "warning")
