"""Findings for people: each with the lines concerned, marked, and a summary at the end."""

from __future__ import annotations

from typing import TYPE_CHECKING

from archgen.diagnostics.diagnostic import Severity, phrase_severity_counts
from archgen.diagnostics.safe_text import make_visible, measure_width
from archgen.diagnostics.text_columns import wrap_cell, wrap_line
from archgen.emit.terminal import findings_summary
from archgen.emit.terminal.line_excerpt import ExcerptMark, quote_line
from archgen.findings.variant_findings import phrase_absence

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping
    from typing import TextIO

    from archgen.diagnostics.diagnostic import Diagnostic, Label
    from archgen.diagnostics.source_span import SourceTexts, Span

DEFAULT_WIDTH = 120
"""The columns of an excerpt where the terminal's width is not known."""
_NARROWEST_LABEL = 24
"""Where less room is left beside a mark, its text goes below."""
_COLOUR_CODES = {Severity.ERROR: "1;31", Severity.WARNING: "1;33", Severity.NOTE: "1;36"}


def wants_colour(stream: TextIO, environment: Mapping[str, str]) -> bool:
    """Return whether to use colours: on a terminal, unless NO_COLOR is set; anywhere if FORCE_COLOR is."""
    if environment.get("NO_COLOR"):
        return False
    if environment.get("FORCE_COLOR", "") not in {"", "0"}:
        return True
    return stream.isatty() and environment.get("TERM") != "dumb"


def format_summary(diagnostics: Iterable[Diagnostic]) -> str:
    """Return how many findings there are: `2 errors, 1 warning`."""
    return ", ".join(phrase_severity_counts(diagnostics)) or "no findings"


def render_findings_text(
    diagnostics: Iterable[Diagnostic],
    sources: SourceTexts,
    *,
    colour: bool = False,
    width: int | None = None,
    is_waiting: bool = False,
) -> Iterator[str]:
    """Yield the lines of all findings (settled, in their order), a blank line after each, and the summary.

    `width` is the terminal's. Without one texts stay on one line, for grep, and excerpts have DEFAULT_WIDTH. `is_waiting`
    is whether rules wait until errors among the findings are mended.
    """
    diagnostics = tuple(diagnostics)
    for diagnostic in diagnostics:
        yield from render_finding_text(diagnostic, sources, colour=colour, width=width)
        yield ""
    table_lines = tuple(findings_summary.render_summary_tables(diagnostics, width))
    yield from (*table_lines, "") if table_lines else ()
    if is_waiting:
        yield from wrap_line(findings_summary.WAITING_SENTENCE, width)
    yield format_summary(diagnostics)


def render_finding_text(
    diagnostic: Diagnostic, sources: SourceTexts, *, colour: bool = False, width: int | None = None
) -> Iterator[str]:
    """Yield the lines of one finding."""
    severity = diagnostic.severity or Severity.ERROR
    severity_colour = _COLOUR_CODES[severity]
    name = f"{severity}[{diagnostic.rule}]"
    first, *others = wrap_line(f"{name}: {make_visible(diagnostic.message)}", width)
    message = _paint_text(first[len(name) + 2 :], "1", colour=colour)
    yield f"{_paint_text(name, severity_colour, colour=colour)}: {message}".rstrip()
    yield from (_paint_text(line, "1", colour=colour) for line in others)
    blocks = _group_by_line(diagnostic)
    gutter = max((len(str(span.line)) for span, _ in blocks), default=0)
    for number, (span, labels) in enumerate(blocks):
        yield f"  {_paint_text('-->', '34', colour=colour)} {_format_place(span)}"
        # Only the first block holds the primary span.
        marks = [] if number or not diagnostic.span.file else [_mark_of(span, "^", "")]
        marks += [_mark_of(label.span, "-", label.text) for label in labels]
        # A finding about a whole file quotes no line of it.
        line = None if _is_whole_file(span) else sources.line_of(span.file, span.line)
        if line is None:
            yield from (f"   {' ' * gutter} | {make_visible(label.text)}" for label in labels if label.text)
            continue
        # 6: the blanks and the bar around the line number.
        for text, mark in quote_line(line, marks, max((width or DEFAULT_WIDTH) - gutter - 6, 20)):
            margin = f"{span.line:>{gutter}}" if mark is None else " " * gutter
            text_colour = "" if mark is None else severity_colour if mark.sign == "^" else "34"
            # The bar goes on beside a mark's text that needs several lines.
            for part in [text] if mark is None else _wrap_mark(text, width and width - gutter - 6):
                painted = _paint_text(part, text_colour, colour=colour and bool(text_colour))
                yield f"   {_paint_text(f'{margin} |', '34', colour=colour)} {painted}".rstrip()
    absence = phrase_absence(diagnostic)
    if absence:
        yield f"   {_paint_text('=', '34', colour=colour)} {_paint_text('note:', '1', colour=colour)} {make_visible(absence)}"
    if diagnostic.help:
        # 11: what stands before the text.
        first, *others = (
            wrap_cell(make_visible(diagnostic.help), width - 11) if width else [make_visible(diagnostic.help)]
        )
        yield f"   {_paint_text('=', '34', colour=colour)} {_paint_text('help:', '1', colour=colour)} {first}"
        yield from (" " * 11 + line for line in others)


def _group_by_line(diagnostic: Diagnostic) -> list[tuple[Span, list[Label]]]:
    """Return the places to quote, each with the labels on its line: the primary one first, then the others."""
    blocks: list[tuple[Span, list[Label]]] = []
    if diagnostic.span.file:
        blocks.append((diagnostic.span, []))
    for label in diagnostic.labels:
        if not label.span.file:
            continue
        line_key = (label.span.file, label.span.line)
        for span, labels in blocks:
            if (span.file, span.line) == line_key and not _is_whole_file(span):
                labels.append(label)
                break
        else:
            blocks.append((label.span, [label]))
    return blocks


def _mark_of(span: Span, sign: str, text: str) -> ExcerptMark:
    """Return the mark of a span in its first line; one that continues below is marked to the line's end."""
    end = span.end_column - 1 if span.end_line <= span.line else 10**9
    return ExcerptMark(span.column - 1, end, sign, text)


def _wrap_mark(line: str, width: int | None) -> list[str]:
    """Wrap the text beside a mark; where there is little room it goes below."""
    if width is None or measure_width(line) <= width:
        return [line]
    text_start = len(line) - len(line.lstrip(" ").lstrip("^-").lstrip(" "))
    mark, text = line[:text_start].rstrip(), line[text_start:]
    if width - text_start >= _NARROWEST_LABEL:
        first, *others = wrap_cell(text, width - text_start)
        return [f"{mark} {first}", *(" " * text_start + other for other in others)]
    indent = min(len(mark) - len(mark.lstrip(" ")), width // 2)
    return [mark, *(" " * indent + other for other in wrap_cell(text, width - indent))]


def _is_whole_file(span: Span) -> bool:
    return (span.line, span.column, span.end_line, span.end_column) == (1, 1, 1, 1)


def _format_place(span: Span) -> str:
    return make_visible(span.file if _is_whole_file(span) else f"{span.file}:{span.line}:{span.column}")


def _paint_text(text: str, code: str, *, colour: bool) -> str:
    return f"\x1b[{code}m{text}\x1b[0m" if colour else text
