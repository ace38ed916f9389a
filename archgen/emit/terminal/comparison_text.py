"""A comparison document for the terminal."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from archgen.compare.edits import Edit, EditKind
from archgen.diagnostics import Severity, SourceTexts, defuse_command, make_visible
from archgen.emit.terminal import findings_text
from archgen.views.changes import comparison_document
from archgen.views.changes.comparison_document import ComparisonDocument
from archgen.views.changes.figure_lines import MINUS_SIGN, ChainRow, FigureLine

# Plain ASCII, as terminals of build servers show it.
_TERMINAL_SIGNS = {
    **dict.fromkeys(("renamed", "moved", "split", "merged"), ">"),
    "added": "+",
    "copied": "+",
    "removed": "-",
    "changed": "~",
}
_SIGN_COLOURS = {">": "36", "+": "32", "-": "31", "~": "33"}
_SEVERITY_COLOURS = {Severity.ERROR: "1;31", Severity.WARNING: "1;33", Severity.NOTE: "1;36"}


def write_comparison_lines(
    document: ComparisonDocument, sources: tuple[SourceTexts, SourceTexts], *, colour: bool = False
) -> Iterator[str]:
    """Yield the lines of a comparison. `sources` are the files of both versions, which errors of reading quote."""
    for version, source_texts in zip(document.versions, sources, strict=True):
        if version.errors:
            yield make_visible(
                f"{version.name} {comparison_document.UNSOUND_LEAD} ({version.error_count}). {comparison_document.UNSOUND_SENTENCE}"
            )
            yield ""
            yield from findings_text.render_findings_text(version.errors, source_texts, colour=colour)
            yield ""
    yield from _breaking_lines(document, colour=colour)
    if document.only_breaking:
        yield from map(make_visible, document.verdict[:1])
        if document.refusal_help:
            yield make_visible(f"  = help: {document.refusal_help}")
            yield from _entry_lines(document)
        yield from map(make_visible, document.verdict[1:])
        return
    if document.is_empty:
        yield make_visible(document.obstacle) or f"no changes{document.caveat}"
        return
    for change_group in document.change_groups:
        yield _paint_text(make_visible(change_group.heading), "1", colour=colour)
        for change in change_group.changes:
            yield _change_line(change, colour=colour)
        yield ""
    yield from _figure_lines(comparison_document.BOUNDARY_HEADING, document.boundary_lines, colour=colour)
    yield from _figure_lines(comparison_document.LOAD_HEADING, document.load_lines, colour=colour)
    yield from _chain_lines(document.chain_rows, colour=colour)
    for finding_group in document.finding_groups:
        yield _paint_text(finding_group.heading, "1", colour=colour)
        for finding in finding_group.findings:
            severity = finding.effective_severity
            place_note = f" ({finding.span})" if finding.span.file else ""
            rule = _paint_text(f"{severity}[{finding.rule}]", _SEVERITY_COLOURS[severity], colour=colour)
            yield f"  {rule}: {make_visible(finding.message + place_note)}"
        yield ""
    yield make_visible(document.summary + (f"; {document.obstacle}" if document.obstacle else ""))


def _breaking_lines(document: ComparisonDocument, *, colour: bool) -> Iterator[str]:
    if not document.breaking_changes:
        return
    yield _paint_text(comparison_document.BREAKING_HEADING, "1", colour=colour)
    # One cause often breaks several changes: its reason is written once, then "as above".
    told_reasons = set[str]()
    for item in document.breaking_changes:
        partners = make_visible(", ".join(item.partners))
        yield _change_line(
            item.change, _paint_text(f"breaks {partners} ({item.categories}): ", "1;31", colour=colour), colour=colour
        )
        reasons = dict.fromkeys(loss.reason for loss in item.losses).keys()
        yield from (make_visible(f"      {reason}") for reason in reasons if reason not in told_reasons)
        if not told_reasons.isdisjoint(reasons):
            yield "      as above" if told_reasons.issuperset(reasons) else "      and as above"
        told_reasons |= reasons
        yield from (make_visible(f"      {line}") for line in item.agreements)
    if document.refusal_help and not document.only_breaking:
        yield make_visible(f"  {document.refusal_lead}{document.refusal_help}")
        yield from _entry_lines(document)
    yield ""


def _entry_lines(document: ComparisonDocument) -> Iterator[str]:
    for entries in document.missing_entries:
        yield from (make_visible(f"      {line}") for line in entries.splitlines())


def _change_line(change: Edit, note: str = "", *, colour: bool) -> str:
    return f"  {_paint_sign(change.kind, colour=colour)} {note}{make_visible(change.text)}"


def _paint_sign(kind: EditKind, *, colour: bool) -> str:
    plain_sign = _TERMINAL_SIGNS[kind]
    return _paint_text(plain_sign, _SIGN_COLOURS[plain_sign], colour=colour)


def _figure_lines(heading: str, lines: Sequence[FigureLine], *, colour: bool) -> Iterator[str]:
    if not lines:
        return
    yield _paint_text(heading, "1", colour=colour)
    yield from (f"  {_paint_sign(line.kind, colour=colour)} {make_visible(line.text)}" for line in lines)
    yield ""


def _chain_lines(chain_rows: Sequence[ChainRow], *, colour: bool) -> Iterator[str]:
    if not chain_rows:
        return
    yield _paint_text(comparison_document.CHAINS_HEADING, "1", colour=colour)
    for row in chain_rows:
        growth = f" ({row.growth.replace(MINUS_SIGN, '-')})" if row.growth else ""
        verdict = f": {row.verdict}" if row.verdict else ""
        deadline = f", deadline {row.deadline}{verdict}" if row.deadline else ""
        yield make_visible(f"  {row.id}: {row.before} → {row.after}{growth}{deadline}")
        if row.reason:
            yield make_visible(f"      because of {row.reason}")
    yield ""


def _paint_text(text: str, code: str, *, colour: bool) -> str:
    return f"\x1b[{code}m{text}\x1b[0m" if colour else defuse_command(text)
