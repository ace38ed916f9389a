"""Findings for people: each with the lines concerned, marked, and a summary at the end."""

from __future__ import annotations

from typing import TYPE_CHECKING

from archgen.diagnostics.diagnostic import Severity, phrase_severity_counts
from archgen.diagnostics.safe_text import make_visible, measure_width
from archgen.emit.terminal import findings_summary
from archgen.emit.terminal.line_excerpt import ExcerptMark, quote_line

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping
    from typing import TextIO

    from archgen.diagnostics.diagnostic import Diagnostic, Label
    from archgen.diagnostics.source_span import SourceTexts, Span

DEFAULT_WIDTH = 120
"""The columns of an excerpt where the terminal's width is not known."""
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


def render_findings_text(  # noqa: PLR0913 - all but two by name
    diagnostics: Iterable[Diagnostic],
    sources: SourceTexts,
    *,
    colour: bool = False,
    width: int = DEFAULT_WIDTH,
    wraps_text: bool = False,
    is_waiting: bool = False,
) -> Iterator[str]:
    """Yield the lines of all findings (settled, in their order), a blank line after each, and the summary.

    `is_waiting` is whether rules wait until errors among them are mended.
    """
    diagnostics = tuple(diagnostics)
    for diagnostic in diagnostics:
        yield from render_finding_text(diagnostic, sources, colour=colour, width=width, wraps_text=wraps_text)
        yield ""
    table_lines = tuple(findings_summary.render_rule_table(diagnostics))
    yield from (*table_lines, "") if table_lines else ()
    if is_waiting:
        yield findings_summary.WAITING_SENTENCE
    yield format_summary(diagnostics)


def render_finding_text(
    diagnostic: Diagnostic,
    sources: SourceTexts,
    *,
    colour: bool = False,
    width: int = DEFAULT_WIDTH,
    wraps_text: bool = False,
) -> Iterator[str]:
    """Yield the lines of one finding, with excerpts that keep to a width; with `wraps_text` message and help do so too."""
    text_width = width if wraps_text else None
    severity = diagnostic.severity or Severity.ERROR
    severity_colour = _COLOUR_CODES[severity]
    name = _paint_text(f"{severity}[{diagnostic.rule}]", severity_colour, colour=colour)
    message_lines = _wrap_text(diagnostic.message, text_width, len(f"{severity}[{diagnostic.rule}]: "), "    ")
    yield f"{name}: {_paint_text(message_lines[0], '1', colour=colour)}"
    yield from (f"    {_paint_text(line, '1', colour=colour)}" for line in message_lines[1:])
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
        for text, mark in quote_line(line, marks, max(width - gutter - 6, 20)):
            margin = f"{span.line:>{gutter}}" if mark is None else " " * gutter
            painted = (
                text
                if mark is None
                else _paint_text(text, severity_colour if mark.sign == "^" else "34", colour=colour)
            )
            yield f"   {_paint_text(f'{margin} |', '34', colour=colour)} {painted}".rstrip()
    if diagnostic.help:
        help_lines = _wrap_text(diagnostic.help, text_width, len(_HELP_INDENT), _HELP_INDENT)
        yield f"   {_paint_text('=', '34', colour=colour)} {_paint_text('help:', '1', colour=colour)} {help_lines[0]}"
        yield from (f"{_HELP_INDENT}{line}" for line in help_lines[1:])


_HELP_INDENT = " " * len("   = help: ")


def _wrap_text(text: str, width: int | None, first_indent: int, indent: str) -> list[str]:
    """Return a text made visible, as lines of at most `width` columns with their indents; a longer word stays whole.

    Without a width it is one line: what goes into a pipe is searched line by line.
    """
    visible_text = make_visible(text)
    if width is None or first_indent + measure_width(visible_text) <= width:
        return [visible_text]
    lines, room = [""], width - first_indent
    for word in visible_text.split(" "):
        longer_line = f"{lines[-1]} {word}" if lines[-1] else word
        if lines[-1] and measure_width(longer_line) > room:
            lines.append(word)
            room = width - len(indent)
        else:
            lines[-1] = longer_line
    return lines


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


def _is_whole_file(span: Span) -> bool:
    return (span.line, span.column, span.end_line, span.end_column) == (1, 1, 1, 1)


def _format_place(span: Span) -> str:
    return make_visible(span.file if _is_whole_file(span) else f"{span.file}:{span.line}:{span.column}")


def _paint_text(text: str, code: str, *, colour: bool) -> str:
    return f"\x1b[{code}m{text}\x1b[0m" if colour else text
