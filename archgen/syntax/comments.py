"""What stands in a file beside its data: ignore comments, Git's conflict markers, and comments that swallow text."""

from __future__ import annotations

import re
from bisect import bisect_right
from typing import TYPE_CHECKING

from archgen.diagnostic import Diagnostic, Label
from archgen.source import Span
from archgen.syntax.tree import Ignore

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

_IGNORE = re.compile(r"#[ \t]*archgen:[ \t]*ignore\b[ \t]*(?:\[([^\]\r\n]*)\])?([^\r\n]*)")
_CONFLICT = re.compile(r"^(<{7}|\|{7}|={7}|>{7})(?:[ \t]+([^\r\n]*?))?[ \t]*\r?$", re.MULTILINE)
_HASH = re.compile(r"#(?<=[ \t]#)[^\s]")
_SWALLOWED = re.compile(r"[ \t]+#(?!\s*archgen:)[^\s][^\r\n]*")
_SWALLOWED_WHOLE = re.compile(r"[ \t]*#(?:[0-9]|[0-9a-fA-F]{6}\b)[^\r\n]*")


class Lines:
    """Finds the line and column of an offset in a text."""

    __slots__ = ("_starts",)

    def __init__(self, text: str) -> None:
        """Note where each line begins."""
        self._starts = [0, *(found.end() for found in re.finditer(r"\r\n?|\n", text))]

    def span(self, file: str, start: int, end: int) -> Span:
        """Give the place of a stretch of text."""
        line, last = bisect_right(self._starts, start), bisect_right(self._starts, end)
        return Span(file, line, start - self._starts[line - 1] + 1, last, end - self._starts[last - 1] + 1)


def ignores(file: str, text: str, quoted: Sequence[tuple[int, int]]) -> Iterator[Ignore]:
    """Give the comments `# archgen: ignore[rule] why`, but for what stands inside quoted or block text.

    `quoted` holds the offsets of such text, in order. A comment that names no rule has no rules: it silences nothing.
    """
    starts = [start for start, _ in quoted]
    lines: Lines | None = None
    for match in _IGNORE.finditer(text):
        before = bisect_right(starts, match.start()) - 1
        if before >= 0 and match.start() < quoted[before][1]:
            continue
        if match.start() and text[match.start() - 1] not in " \t\r\n":
            continue
        lines = lines or Lines(text)
        names = tuple(name.strip() for name in (match[1] or "").split(",") if name.strip())
        end = match.end() - (len(match[2]) - len(match[2].rstrip()))
        yield Ignore(names, match[2].strip(), lines.span(file, match.start(), end))


def may_hold_ignores(text: str) -> bool:
    """Say cheaply whether it is worth noting where quoted text stands."""
    return "archgen:" in text and _IGNORE.search(text) is not None


def conflicts(file: str, text: str) -> tuple[Diagnostic, ...]:
    """Find Git's conflict markers, each conflict with both of its sides."""
    if "<<<<<<<" not in text and ">>>>>>>" not in text:
        return ()
    return tuple(_conflicts(file, text))


def _conflicts(file: str, text: str) -> Iterator[Diagnostic]:
    lines = Lines(text)
    ours: re.Match[str] | None = None
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
    """Give the lines (from 0) on which a comment could have swallowed text."""
    if "#" not in text or _HASH.search(text) is None:
        return frozenset()
    lines = re.split(r"\r\n|\r|\n", text)
    return frozenset(number for number, line in enumerate(lines) if "#" in line and _HASH.search(line))


def swallowed(source: str, at: Span, offset: int, *, empty: bool) -> Iterator[Diagnostic]:
    """Say where a comment right after plain text, which ends at `offset`, looks like a part of it.

    After an empty value only what looks like a number or a colour counts: comments are common there.
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
