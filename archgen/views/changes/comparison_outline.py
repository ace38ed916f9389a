"""A comparison document as the outline of a page."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from archgen.compare.edits import EditKind
from archgen.frozen import replace
from archgen.views import inline_text
from archgen.views.changes import comparison_document
from archgen.views.changes.breaking_items import BreakingChange
from archgen.views.changes.change_wording import CHANGE_SIGNS, choose_mark, text_runs
from archgen.views.changes.comparison_document import ComparisonDocument, FindingGroup, NamedVersion
from archgen.views.changes.figure_lines import ChainRow, FigureLine
from archgen.views.shapes import (
    Block,
    Bullets,
    Column,
    Figure,
    Inlines,
    Markdown,
    Outline,
    Paragraph,
    Section,
    Table,
    Text,
)

_MAX_ERRORS = 8


def write_comparison_outline(document: ComparisonDocument) -> Outline:
    """Return the outline of a comparison document."""
    figures = tuple(Figure(f"figure:{graph.id}", graph.id, graph.title, graph.alt) for graph in document.graphs)
    sections = (
        _breaking_section(document),
        Section("changes:pictures", "Pictures", figures) if figures else None,
        _change_section(document),
        _figure_section("changes:boundaries", comparison_document.BOUNDARY_HEADING, document.boundary_lines, document),
        _figure_section("changes:loads", comparison_document.LOAD_HEADING, document.load_lines, document),
        _chain_section(document.chain_rows),
        *(_findings_section(group) for group in document.finding_groups),
    )
    return Outline(
        title=f"What changed in {document.title}",
        subtitle=f"{document.before.name} → {document.after.name}",
        facts=tuple(_document_facts(document)),
        notices=tuple(_document_notices(document)),
        sections=tuple(section for section in sections if section),
    )


def _document_facts(document: ComparisonDocument) -> Iterator[tuple[str, Inlines]]:
    yield "From", inline_text.to_code(document.before.name)
    yield "To", inline_text.to_code(document.after.name)
    yield "Changes", inline_text.to_inlines("none" if document.is_empty else document.counts)
    if document.broken_partners:
        runs = text_runs(", ".join(document.broken_partners))
        yield "Breaks", tuple(replace(run, strong=True, change="removed") for run in runs)
    if document.concerned_partners:
        yield "Concerns", text_runs(", ".join(document.concerned_partners))


def _document_notices(document: ComparisonDocument) -> Iterator[Paragraph]:
    yield from (_unsound_notice(version) for version in document.versions if version.errors)
    if document.is_empty:
        yield Paragraph(text_runs(f"{document.headline}."), "note")
    if document.all_clear:
        yield Paragraph(text_runs(f"{document.all_clear[:1].upper()}{document.all_clear[1:]}."), "note")
    # Without any change the verdict is the headline.
    for line in document.verdict[1 if document.is_empty else 0 :]:
        yield Paragraph(text_runs(line), "note")


def _unsound_notice(version: NamedVersion) -> Paragraph:
    lead = f" {comparison_document.UNSOUND_LEAD} ({version.error_count}). {comparison_document.UNSOUND_SENTENCE}"
    error_runs = [
        run
        for error in version.errors[:_MAX_ERRORS]
        for run in (Text(f"{error.span}: ", code=True, line_break=True), *text_runs(error.message))
    ]
    surplus = len(version.errors) - _MAX_ERRORS
    surplus_note = [Text(f"and {surplus} more", line_break=True)] if surplus > 0 else []
    return Paragraph((Text(version.name, code=True), Text(lead), *error_runs, *surplus_note), "error")


def _breaking_section(document: ComparisonDocument) -> Section | None:
    if not document.breaking_changes:
        return None
    blocks: list[Block] = [Bullets(tuple(_breaking_item(item, document) for item in document.breaking_changes))]
    if document.refusal_help:
        blocks.append(Paragraph(text_runs(document.refusal_lead + document.refusal_help), "error"))
        blocks += [Markdown(f"```yaml\n{entries}\n```") for entries in document.missing_entries]
    return Section("changes:breaking", comparison_document.BREAKING_HEADING, tuple(blocks))


def _breaking_item(item: BreakingChange, document: ComparisonDocument) -> Inlines:
    lines: list[Text] = []
    for loss in item.losses:
        lines += [Text(f"breaks {', '.join(loss.partners)}", strong=True, line_break=True, change="removed")]
        lines += [Text(f" ({loss.category}): "), *_titled_runs(loss.reason, document)]
    for line in item.agreements:
        lines += [Text("", line_break=True), *text_runs(line)]
    return (*_sign_runs(item.change.kind), *_titled_runs(item.short_text, document), *lines)


def _change_section(document: ComparisonDocument) -> Section | None:
    sections = tuple(
        Section(
            f"changes:{change_group.group_id or change_group.title}",
            (change_group.title or change_group.group_id) + (f" ({change_group.owner})" if change_group.owner else ""),
            (
                Bullets(
                    tuple(
                        (*_sign_runs(change.kind), *_titled_runs(change.text, document))
                        for change in change_group.changes
                    )
                ),
            ),
        )
        for change_group in document.change_groups
    )
    return Section("changes:all", document.changes_heading, sections=sections) if sections else None


def _titled_runs(text: str, document: ComparisonDocument) -> Inlines:
    """Split a sentence into runs; elements are called by their titles, each a link to its page or what changed in a picture."""
    graph = document.main_graph
    figure = f"figure:{graph.id}" if graph else None
    return text_runs(text, document.element_titles, lambda name: document.element_pages.get(name) or figure)


def _sign_runs(kind: EditKind) -> Inlines:
    return Text(CHANGE_SIGNS[kind], strong=True, change=choose_mark(kind)), Text(" ")


def _figure_section(
    anchor: str, heading: str, lines: Sequence[FigureLine], document: ComparisonDocument
) -> Section | None:
    items = tuple((*_sign_runs(line.kind), *_titled_runs(line.text, document)) for line in lines)
    return Section(anchor, heading, (Bullets(items),)) if items else None


def _chain_section(chain_rows: Sequence[ChainRow]) -> Section | None:
    if not chain_rows:
        return None
    rows = tuple(
        (
            inline_text.to_code(row.id),
            *(inline_text.to_inlines(cell) for cell in (row.before, row.after, row.growth, row.deadline)),
            inline_text.to_inlines(Text(row.verdict, strong=True)),
            text_runs(row.reason),
        )
        for row in chain_rows
    )
    columns = (
        Column("Chain", 1.6),
        *(Column(name, 1, "right") for name in ("Before", "After", "Difference", "Deadline")),
        Column("Verdict"),
        Column("Because of", 2),
    )
    table = Table("table:chains", "Bounds of chains", columns, rows)
    return Section("changes:chains", comparison_document.CHAINS_HEADING, (table,))


def _findings_section(group: FindingGroup) -> Section:
    rows = tuple(
        (
            inline_text.to_inlines(str(finding.effective_severity)),
            inline_text.to_code(finding.rule),
            text_runs(finding.message),
            inline_text.to_inlines(Text(str(finding.span), code=True)) if finding.span.file else (),
        )
        for finding in group.findings
    )
    columns = (Column("Severity", 0.6), Column("Rule", 1), Column("What", 3), Column("Where", 1.4))
    table = Table(f"table:{group.kind}", group.caption, columns, rows)
    return Section(f"changes:{group.kind}", group.heading, (table,))
