"""The page of what changed since the last version: what breaks whom first, then the first change of each group."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator

from archgen.diagnostics import join_words
from archgen.model.architecture import Architecture
from archgen.views import inline_text
from archgen.views.changes.comparison_outline import write_comparison_outline
from archgen.views.changes.site_changes import SiteChanges
from archgen.views.inline_text import count_noun
from archgen.views.shapes import Block, Bullets, Paragraph, Section, Table, Text


def tell_changes(architecture: Architecture, changes: SiteChanges | None) -> Iterator[Section]:
    """Yield the page of what changed since the last version, where that is compared."""
    if changes is None:
        return
    document = changes.document
    blocks: list[Block] = [Paragraph(inline_text.message_to_inlines(f"{document.headline}."))]
    blocks += [
        Paragraph(inline_text.message_to_inlines(f"It breaks {join_words(document.broken_partners)}."), "warning")
        for _ in document.broken_partners[:1]
    ]
    outline = write_comparison_outline(document)
    shown = {"changes:breaking", "changes:boundaries", "changes:loads", "changes:chains"}
    sections = [_name_chains(architecture, print_plainly(each)) for each in outline.sections if each.anchor in shown]
    counts = [
        (
            Text(group.title or group.group_id, strong=True),
            Text(f": {count_noun(len(group.changes), 'change')}, first: "),
            *inline_text.message_to_inlines(group.changes[0].text),
        )
        for group in document.change_groups
        if group.changes
    ]
    if counts:
        sections.append(Section("changes:all", document.changes_heading, (Bullets(tuple(counts)),)))
    if document.concerned_partners:
        asked = Paragraph(inline_text.to_inlines(f"It concerns {join_words(document.concerned_partners)}."))
        sections.append(Section("changes:asked", "What it asks of whom", (asked,)))
    title = f"What changed since {changes.since}"
    yield Section("page:changes", title, tuple(blocks), tuple(sections), page_break=True)


def _name_chains(architecture: Architecture, section: Section) -> Section:
    """Return a section of a comparison with chains by their titles, in tables without numbers."""
    chains = architecture.chains
    blocks = [
        dataclasses.replace(
            block,
            numbered=False,
            dense=True,
            rows=tuple(
                tuple((Text(chains[cell[0].text].title),) if cell and cell[0].text in chains else cell for cell in row)
                for row in block.rows
            ),
        )
        if isinstance(block, Table)
        else block
        for block in section.blocks
    ]
    return dataclasses.replace(section, blocks=tuple(blocks))


def print_plainly(section: Section) -> Section:
    """Return a section with tables that stay on upright paper."""
    blocks = tuple(
        dataclasses.replace(block, wide=False) if isinstance(block, Table) else block for block in section.blocks
    )
    return dataclasses.replace(section, blocks=blocks, sections=tuple(map(print_plainly, section.sections)))
