"""Findings for people: each with the lines concerned, marked, and a summary at the end."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TextIO

from archgen.diagnostics import (
    Diagnostic,
    Label,
    Severity,
    SourceTexts,
    Span,
    make_visible,
    measure_width,
    order_naturally,
    phrase_severity_counts,
)
from archgen.diagnostics.text_columns import wrap_cell, wrap_line
from archgen.findings.variant_findings import phrase_absence
from archgen.frozen import NamedTuple

_TAB_WIDTH = 4
_CUT_SIGN = "…"
_MAX_CHARACTERS = 4000
"""The characters of a line that are looked at on each side of a mark: no screen is wider."""


class ExcerptMark(NamedTuple):
    """Characters `start` to `end` (from 0, exclusive) of a line to point at, with which sign, and what to say."""

    start: int
    end: int
    sign: str
    text: str = ""


def _quote_line(line: str, marks: Iterable[ExcerptMark], limit: int) -> Iterator[tuple[str, ExcerptMark | None]]:
    """Yield the line, then a line for each mark, at most `limit` columns wide apart from the marks' texts.

    A mark that ends beyond the line points at its end; an empty one is one sign wide.
    """
    marks = tuple(marks)
    # Cut before anything is measured: a line may be megabytes long.
    first_character = max(0, min((mark.start for mark in marks), default=0) - _MAX_CHARACTERS)
    line = line[first_character : first_character + 2 * _MAX_CHARACTERS + limit]
    cells, columns = _printed_cells(line)
    placed_marks = [(mark, *_mark_columns(mark, first_character, columns)) for mark in marks]
    # The window follows the first mark, which is the primary one.
    left, right = _choose_window(
        columns[-1], placed_marks[0][1] if placed_marks else 0, placed_marks[0][2] if placed_marks else 0, limit
    )
    begin, end = bisect_left(columns, left), bisect_right(columns, right) - 1
    cut_before = _CUT_SIGN if begin > 0 or first_character else ""
    cut_after = _CUT_SIGN if end < len(cells) else ""
    yield (cut_before + "".join(cells[begin:end]) + cut_after).rstrip(), None
    for mark, start, stop in placed_marks:
        mark_start = min(max(start, columns[begin]), columns[end])
        mark_end = min(stop, columns[end])
        blank = " " * (mark_start - columns[begin] + len(cut_before))
        yield (
            f"{blank}{mark.sign * max(1, mark_end - mark_start)}{' ' + make_visible(mark.text) if mark.text else ''}",
            mark,
        )


def _printed_cells(line: str) -> tuple[Sequence[str], Sequence[int]]:
    """Return what each character of the line prints as, and the columns where they begin; last, where the line ends."""
    if line.isascii() and line.isprintable():  # nearly always
        return line, range(len(line) + 1)
    cells, columns = [], [0]
    for character in line:
        cell = " " * (_TAB_WIDTH - columns[-1] % _TAB_WIDTH) if character == "\t" else make_visible(character)
        cells.append(cell)
        columns.append(columns[-1] + measure_width(cell))
    return cells, columns


def _mark_columns(mark: ExcerptMark, base: int, columns: Sequence[int]) -> tuple[int, int]:
    """Return the first column of a mark and the one behind it."""
    last = len(columns) - 1
    # At least one column wide, so that an empty mark is seen.
    start = columns[min(max(mark.start - base, 0), last)]
    return start, max(columns[min(max(mark.end - base, 0), last)], start + 1)


def _choose_window(total: int, start: int, stop: int, limit: int) -> tuple[int, int]:
    """Choose the columns to show: all if they fit, else a window with the mark in it and room for both cut signs."""
    if total <= limit:
        return 0, total
    room = max(limit - 2, 1)
    if stop <= room:
        return 0, room
    # A long mark shows its beginning, a short one is centred.
    left = start - room // 4 if stop - start > room * 3 // 4 else min((start + stop) // 2 - room // 2, total - room)
    return max(left, 0), max(left, 0) + room


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
    table_lines = tuple(render_summary_tables(diagnostics, width))
    yield from (*table_lines, "") if table_lines else ()
    if is_waiting:
        yield from wrap_line(WAITING_SENTENCE, width)
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
        for text, mark in _quote_line(line, marks, max((width or DEFAULT_WIDTH) - gutter - 6, 20)):
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


LONG_LIST = 8
"""Beyond so many findings, about a screen, tables say how many there are of each rule and in each file."""
_MAX_FILES = 20
WAITING_SENTENCE = "timing, views and unused elements are judged once these errors are gone"
_SEVERITIES = (Severity.ERROR, Severity.WARNING, Severity.NOTE)


def render_summary_tables(findings: Sequence[Diagnostic], width: int | None = None) -> Iterator[str]:
    """Yield the lines of tables of the rules and the files of many findings, the worst first; few yield none."""
    if len(findings) <= LONG_LIST:
        return
    yield from _render_rule_table(findings, width)
    yield ""
    yield from _render_file_table(findings, width)
    yield "`archgen explain RULE` says what a rule asks for, and why"


def _render_rule_table(findings: Sequence[Diagnostic], width: int | None) -> Iterator[str]:
    from archgen.emit.terminal.list_formats import format_columns

    # Rules that a project or a finding gives several severities have a row for each of them.
    counts = Counter((finding.rule, finding.effective_severity) for finding in findings)
    ordered_counts = sorted(counts.items(), key=lambda item: (-item[0][1].rank, -item[1], item[0][0]))
    rows = [(rule, str(severity), str(count)) for (rule, severity), count in ordered_counts]
    yield from format_columns(("rule", "severity", "findings"), rows, width).splitlines()


def _render_file_table(findings: Sequence[Diagnostic], width: int | None) -> Iterator[str]:
    """Yield the lines of the table of files, and a blank one; none where all findings are in one file."""
    from archgen.emit.terminal.list_formats import format_columns

    counts: defaultdict[str, Counter[Severity]] = defaultdict(Counter)
    for finding in findings:
        if finding.span.file:
            counts[finding.span.file][finding.effective_severity] += 1
    if len(counts) < 2:  # noqa: PLR2004 - the excerpts name the only file
        return
    files = sorted(
        counts, key=lambda file: (*(-counts[file][severity] for severity in _SEVERITIES), order_naturally(file))
    )
    rows = [(file, *(str(counts[file][severity] or "") for severity in _SEVERITIES)) for file in files]
    yield from format_columns(("file", "errors", "warnings", "notes"), rows[:_MAX_FILES], width).splitlines()
    if len(rows) > _MAX_FILES:
        yield f"and {len(rows) - _MAX_FILES} more files"
    yield ""
