"""Find what the YAML parser drops: ignore comments, Git's conflict markers, and comments that swallow text."""

from __future__ import annotations

import re
from bisect import bisect_right
from typing import TYPE_CHECKING

from archgen.diagnostic import Diagnostic, Label
from archgen.source import Span
from archgen.syntax.tree import Ignore

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

# These patterns run over whole files, and none of them crosses the end of a line.
_IGNORE = re.compile(r"#[ \t]*archgen:[ \t]*ignore\b[ \t]*(?:\[([^\]\r\n]*)\])?([^\r\n]*)")
_CONFLICT = re.compile(r"^(<{7}|\|{7}|={7}|>{7})(?:[ \t]+([^\r\n]*?))?[ \t]*\r?$", re.MULTILINE)
_HASH = re.compile(r"#(?<=[ \t]#)[^\s]")
_SWALLOWED = re.compile(r"[ \t]+#(?!\s*archgen:)[^\s][^\r\n]*")
# After an empty value only `#12` and colours such as `#ff8800` count: those are values that somebody forgot to quote.
_SWALLOWED_WHOLE = re.compile(r"[ \t]*#(?:[0-9]|[0-9a-fA-F]{6}\b)[^\r\n]*")


class Lines:
    """The offsets at which the lines of a text begin, to turn an offset into a line and a column."""

    __slots__ = ("_starts",)

    def __init__(self, text: str) -> None:
        """Record where each line of a text begins."""
        self._starts = [0, *(found.end() for found in re.finditer(r"\r\n?|\n", text))]

    def span(self, file: str, start: int, end: int) -> Span:
        """Return the span between two offsets (from 0, the end exclusive)."""
        line, last = bisect_right(self._starts, start), bisect_right(self._starts, end)
        return Span(file, line, start - self._starts[line - 1] + 1, last, end - self._starts[last - 1] + 1)


def ignores(file: str, text: str, quoted: Sequence[tuple[int, int]]) -> Iterator[Ignore]:
    """Yield the comments `# archgen: ignore[rule] why`, except those inside quoted or block text.

    `quoted_ranges` are the start and end offsets of such text, in order. A comment without rules silences nothing; it
    is yielded all the same, so that it can be reported.
    """
    starts = [start for start, _ in quoted]
    lines: Lines | None = None
    for match in _IGNORE.finditer(text):
        before = bisect_right(starts, match.start()) - 1
        if before >= 0 and match.start() < quoted[before][1]:
            continue
        # YAML needs a blank before `#`: without one the characters are a part of plain text.
        if match.start() and text[match.start() - 1] not in " \t\r\n":
            continue
        lines = lines or Lines(text)
        names = tuple(name.strip() for name in (match[1] or "").split(",") if name.strip())
        end = match.end() - (len(match[2]) - len(match[2].rstrip()))
        yield Ignore(names, match[2].strip(), lines.span(file, match.start(), end))


def may_hold_ignores(text: str) -> bool:
    """Whether a text may hold ignore comments; a cheap test that decides if quoted ranges are recorded at all."""
    return "archgen:" in text and _IGNORE.search(text) is not None


def conflicts(file: str, text: str) -> tuple[Diagnostic, ...]:
    """Find Git's conflict markers; one diagnostic for each conflict, labelled with both of its sides."""
    # Two substring searches are much cheaper than the regular expression, and nearly every file ends here.
    if "<<<<<<<" not in text and ">>>>>>>" not in text:
        return ()
    return tuple(_conflicts(file, text))


def _conflicts(file: str, text: str) -> Iterator[Diagnostic]:
    lines = Lines(text)
    ours: re.Match[str] | None = None
    # A line of seven `=` alone is also a legal Markdown underline in a block of text: markers count only in their order
    # `<`, `=`, `>`. The marker `|` of the diff3 style needs no action, it lies between the first two.
    middle: re.Match[str] | None = None
    for match in _CONFLICT.finditer(text):
        if match[1][0] == "<":
            ours, middle = match, None
        elif match[1][0] == "=" and ours:
            middle = match
        elif match[1][0] == ">" and ours and middle:
            labels = (
                Label(lines.span(file, *middle.span(1)), "the other side begins here"),
                Label(lines.span(file, match.start(), match.end(2 if match[2] else 1)), "and ends here"),
            )
            span = lines.span(file, ours.start(), ours.end(2 if ours[2] else 1))
            yield Diagnostic("merge-conflict", _both(ours[2], match[2]), span, labels=labels, help=_KEEP)
            ours = middle = None


_KEEP = "keep what is right of both sides and delete the lines with the markers"


def _both(ours: str | None, theirs: str | None) -> str:
    return f"Git could not merge `{ours or 'this side'}` with `{theirs or 'the other side'}` here"


def lines_with_hashes(text: str) -> frozenset[int]:
    """Return the lines (from 0) on which ` #` is followed by a non-blank: a comment may have swallowed text there."""
    if "#" not in text or _HASH.search(text) is None:
        return frozenset()
    lines = re.split(r"\r\n|\r|\n", text)
    return frozenset(number for number, line in enumerate(lines) if "#" in line and _HASH.search(line))


def swallowed(source: str, at: Span, offset: int, *, empty: bool) -> Iterator[Diagnostic]:
    """Report a comment right after a plain value, which ends at `end_offset`, that looks like a part of the value.

    After an empty value only a comment that looks like a number or a colour counts: other comments are common there.
    """
    match = (_SWALLOWED_WHOLE if empty else _SWALLOWED).match(source, offset)
    if match is None:
        return
    comment = match[0]
    start = at.end_column + len(comment) - len(comment.lstrip())
    span = Span(at.file, at.end_line, start, at.end_line, at.end_column + len(comment))
    message = f"`{comment.strip()}` is a comment, not part of the text"
    help_line = "quote the whole text if it belongs to it; write `# ` with a blank if it is a comment"
    yield Diagnostic("swallowed-text", message, span, help=help_line)
