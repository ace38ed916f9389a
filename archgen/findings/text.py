"""Findings for people: each with the lines concerned, marked, and a summary at the end."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

from archgen.diagnostic import Severity
from archgen.findings.escape import visible
from archgen.findings.excerpt import Mark, quote

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping
    from typing import TextIO

    from archgen.diagnostic import Diagnostic, Label
    from archgen.source import Sources, Span

WIDTH = 120
"""The columns of an excerpt where the terminal's width is not known."""
_COLOURS = {Severity.ERROR: "1;31", Severity.WARNING: "1;33", Severity.NOTE: "1;36"}
_PLURALS = {Severity.ERROR: "errors", Severity.WARNING: "warnings", Severity.NOTE: "notes"}


def wants_colour(stream: TextIO, environment: Mapping[str, str]) -> bool:
    """Return whether to use colours: on a terminal, unless NO_COLOR is set; anywhere if FORCE_COLOR is."""
    if environment.get("NO_COLOR"):
        return False
    if environment.get("FORCE_COLOR", "") not in {"", "0"}:
        return True
    return stream.isatty() and environment.get("TERM") != "dumb"


def severity_counts(diagnostics: Iterable[Diagnostic]) -> Mapping[Severity, int]:
    """Count settled diagnostics by severity; all three are there, errors first."""
    counts = Counter(diagnostic.severity for diagnostic in diagnostics)
    return {severity: counts[severity] for severity in (Severity.ERROR, Severity.WARNING, Severity.NOTE)}


def summary(diagnostics: Iterable[Diagnostic]) -> str:
    """Return how many findings there are: `2 errors, 1 warning`."""
    counts = severity_counts(diagnostics)
    words = [f"{n} {severity if n == 1 else _PLURALS[severity]}" for severity, n in counts.items() if n]
    return ", ".join(words) if words else "no findings"


def render(
    diagnostics: Iterable[Diagnostic], sources: Sources, *, colour: bool = False, width: int = WIDTH
) -> Iterator[str]:
    """Yield the lines of all findings (settled, in their order), a blank line after each, and the summary."""
    diagnostics = tuple(diagnostics)
    for diagnostic in diagnostics:
        yield from render_one(diagnostic, sources, colour=colour, width=width)
        yield ""
    yield summary(diagnostics)


def render_one(diagnostic: Diagnostic, sources: Sources, *, colour: bool = False, width: int = WIDTH) -> Iterator[str]:
    """Yield the lines of one finding."""
    severity = diagnostic.severity or Severity.ERROR
    strong = _COLOURS[severity]
    name = _paint(f"{severity}[{diagnostic.rule}]", strong, colour=colour)
    yield f"{name}: {_paint(visible(diagnostic.message), '1', colour=colour)}"
    blocks = _blocks(diagnostic)
    gutter = max((len(str(span.line)) for span, _ in blocks), default=0)
    for number, (span, labels) in enumerate(blocks):
        yield f"  {_paint('-->', '34', colour=colour)} {_place(span)}"
        # Only the first block holds the primary span.
        signs = [] if number or not diagnostic.span.file else [_mark(span, "^", "")]
        signs += [_mark(label.span, "-", label.text) for label in labels]
        # A finding about a whole file quotes no line of it.
        line = None if _whole_file(span) else sources.line(span.file, span.line)
        if line is None:
            yield from (f"   {' ' * gutter} | {visible(label.text)}" for label in labels if label.text)
            continue
        # 6: the blanks and the bar around the line number.
        for text, mark in quote(line, signs, max(width - gutter - 6, 20)):
            margin = f"{span.line:>{gutter}}" if mark is None else " " * gutter
            shown = text if mark is None else _paint(text, strong if mark.sign == "^" else "34", colour=colour)
            yield f"   {_paint(f'{margin} |', '34', colour=colour)} {shown}".rstrip()
    if diagnostic.help:
        yield f"   {_paint('=', '34', colour=colour)} {_paint('help:', '1', colour=colour)} {visible(diagnostic.help)}"


def _blocks(diagnostic: Diagnostic) -> list[tuple[Span, list[Label]]]:
    """Return the places to quote, each with the labels on its line: the primary one first, then the others."""
    blocks: list[tuple[Span, list[Label]]] = []
    if diagnostic.span.file:
        blocks.append((diagnostic.span, []))
    for label in diagnostic.labels:
        if not label.span.file:
            continue
        at = (label.span.file, label.span.line)
        for span, labels in blocks:
            if (span.file, span.line) == at and not _whole_file(span):
                labels.append(label)
                break
        else:
            blocks.append((label.span, [label]))
    return blocks


def _mark(span: Span, sign: str, text: str) -> Mark:
    """Return the mark of a span in its first line; one that continues below is marked to the line's end."""
    end = span.end_column - 1 if span.end_line <= span.line else 10**9
    return Mark(span.column - 1, end, sign, text)


def _whole_file(span: Span) -> bool:
    return (span.line, span.column, span.end_line, span.end_column) == (1, 1, 1, 1)


def _place(span: Span) -> str:
    return visible(span.file if _whole_file(span) else f"{span.file}:{span.line}:{span.column}")


def _paint(text: str, code: str, *, colour: bool) -> str:
    return f"\x1b[{code}m{text}\x1b[0m" if colour else text
