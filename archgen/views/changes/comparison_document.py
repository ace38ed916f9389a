"""The outline of a comparison: breaking changes, pictures, changes by group, chains, findings."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from archgen.compare import Change, Comparison
from archgen.diagnostics.diagnostic import Diagnostic, sort_gravest_first
from archgen.views import inline_text
from archgen.views.changes import change_wording
from archgen.views.shapes import (
    Block,
    Bullets,
    Column,
    Figure,
    Graph,
    Inlines,
    Outline,
    Paragraph,
    Section,
    Table,
    Text,
)

_MAX_ERRORS = 8


@dataclass(frozen=True, slots=True)
class ComparisonDocument:
    """A comparison with the names of its versions, the errors of reading either of them, and its pictures."""

    comparison: Comparison
    old_name: str
    new_name: str
    reading_errors: tuple[Sequence[Diagnostic], Sequence[Diagnostic]] = ((), ())
    graphs: tuple[Graph, ...] = ()


def outline_comparison(document: ComparisonDocument) -> Outline:
    """Return the outline of a comparison document."""
    comparison = document.comparison
    sections = (
        _breaking_section(comparison),
        _picture_section(document),
        _change_section(comparison),
        _chain_section(comparison),
        _new_findings_section(comparison),
        _silenced_findings_section(comparison),
        _cured_findings_section(comparison),
    )
    return Outline(
        title=comparison.after.architecture.project.title,
        subtitle=f"What changed: {document.old_name} → {document.new_name}",
        facts=tuple(_document_facts(document)),
        notices=tuple(_document_notices(document)),
        sections=tuple(section for section in sections if section),
    )


def _document_facts(document: ComparisonDocument) -> Iterator[tuple[str, Inlines]]:
    comparison = document.comparison
    yield "From", inline_text.to_inlines(Text(document.old_name, code=True))
    yield "To", inline_text.to_inlines(Text(document.new_name, code=True))
    yield (
        "Changes",
        inline_text.to_inlines("none" if comparison.is_empty else change_wording.count_differences(comparison)),
    )
    broken_partners = change_wording.broken_partners(comparison.changes)
    if broken_partners:
        yield "Breaks", inline_text.to_inlines(_partner_titles(comparison, broken_partners))
    if comparison.concerned_owners:
        yield "Concerns", inline_text.to_inlines(_partner_titles(comparison, comparison.concerned_owners))


def _partner_titles(comparison: Comparison, partner_ids: Sequence[str]) -> str:
    partners = {**comparison.before.architecture.partners, **comparison.after.architecture.partners}
    return ", ".join(partners[name].title if name in partners else name for name in partner_ids)


def _document_notices(document: ComparisonDocument) -> Iterator[Paragraph]:
    for version_name, errors in zip((document.old_name, document.new_name), document.reading_errors, strict=True):
        if errors:
            sentence = f" could not be read as a whole ({inline_text.count_noun(len(errors), 'error')}). What stands there is left out."
            error_runs = [
                run
                for error in errors[:_MAX_ERRORS]
                for run in (
                    Text(f"{error.span}: ", code=True, line_break=True),
                    *change_wording.text_runs(error.message),
                )
            ]
            surplus_note = (
                [Text(f"and {len(errors) - _MAX_ERRORS} more", line_break=True)] if len(errors) > _MAX_ERRORS else []
            )
            yield Paragraph((Text(version_name, code=True), Text(sentence), *error_runs, *surplus_note), "error")
    if document.comparison.is_empty:
        sentence = (
            "No change breaks another partner."
            if document.comparison.only_breaking
            else "No change of the architecture."
        )
        yield Paragraph(inline_text.to_inlines(sentence), "note")


def _breaking_section(comparison: Comparison) -> Section | None:
    breaking_changes = [change for change in comparison.changes if change.breaks]
    if not breaking_changes:
        return None
    blocks: list[Block] = []
    if comparison.is_refused:
        blocks.append(Paragraph(change_wording.text_runs(change_wording.REFUSAL_HELP), "error"))
    blocks.append(Bullets(tuple(_breaking_item(change, comparison) for change in breaking_changes)))
    return Section("changes:breaking", "Breaking changes", tuple(blocks))


def _breaking_item(change: Change, comparison: Comparison) -> Inlines:
    lines: list[Text] = []
    for reason, partners in change_wording.partners_by_reason(change).items():
        partner_names = ", ".join(sorted(set(partners)))
        lines += [
            Text(f"breaks {partner_names}", strong=True, line_break=True),
            Text(": "),
            *change_wording.text_runs(reason),
        ]
    acceptance = change_wording.describe_acceptance(change, comparison)
    return (*_change_runs(change), *lines, *([Text(acceptance, line_break=True)] if acceptance else []))


def _picture_section(document: ComparisonDocument) -> Section | None:
    figures = tuple(Figure(f"figure:{graph.id}", graph.id, graph.title, graph.alt) for graph in document.graphs)
    return Section("changes:pictures", "Pictures", figures) if figures else None


def _change_section(comparison: Comparison) -> Section | None:
    # Breaking changes have a section of their own and are not repeated.
    other_changes = [change for change in comparison.changes if not change.breaks]
    sections = tuple(
        Section(
            f"changes:{change_group.group_id or change_group.title}",
            change_group.title or change_group.group_id,
            (Bullets(tuple(_change_runs(change) for change in change_group.changes)),),
        )
        for change_group in change_wording.group_changes(other_changes, comparison)
    )
    title = "Other changes" if len(other_changes) < len(comparison.changes) else "Changes"
    return Section("changes:all", title, sections=sections) if sections else None


def _change_runs(change: Change) -> Inlines:
    return (change_wording.sign_text(change), Text(" "), *change_wording.text_runs(change.text))


def _chain_section(comparison: Comparison) -> Section | None:
    if not comparison.chains:
        return None
    rows = tuple(
        (
            inline_text.to_inlines(Text(chain_change.id, code=True)),
            *(
                inline_text.to_inlines(change_wording.format_bound(chain_result))
                for chain_result in (chain_change.before, chain_change.after)
            ),
            inline_text.to_inlines(change_wording.format_growth(chain_change)),
            inline_text.to_inlines(change_wording.format_deadline(chain_change)),
            inline_text.to_inlines(Text(change_wording.format_verdict(chain_change), strong=True)),
        )
        for chain_change in comparison.chains
    )
    columns = (
        Column("Chain", 1.6),
        *(Column(name, 1, "right") for name in ("Before", "After", "Difference", "Deadline")),
        Column("Verdict"),
    )
    table = Table("table:chains", "Bounds of chains", columns, rows)
    return Section("changes:chains", "Latency of chains", (table,))


def _new_findings_section(comparison: Comparison) -> Section | None:
    return _findings_section(
        "new", "New findings", "What archgen finds now, and did not before", comparison.new_findings
    )


def _silenced_findings_section(comparison: Comparison) -> Section | None:
    return _findings_section(
        "silenced",
        "Silenced findings",
        "What archgen found before, and a comment or a setting hides now",
        comparison.silenced_findings,
    )


def _cured_findings_section(comparison: Comparison) -> Section | None:
    return _findings_section(
        "cured", "Cured findings", "What archgen found before, and does not any more", comparison.cured_findings
    )


def _findings_section(name: str, title: str, caption: str, findings: Sequence[Diagnostic]) -> Section | None:
    if not findings:
        return None
    rows = tuple(
        (
            inline_text.to_inlines(str(finding.effective_severity)),
            inline_text.to_inlines(Text(finding.rule, code=True)),
            change_wording.text_runs(finding.message),
            inline_text.to_inlines(Text(str(finding.span), code=True)) if finding.span.file else (),
        )
        for finding in sort_gravest_first(findings)
    )
    columns = (Column("Severity", 0.6), Column("Rule", 1), Column("What", 3), Column("Where", 1.4))
    return Section(f"changes:{name}", title, (Table(f"table:{name}", caption, columns, rows),))
