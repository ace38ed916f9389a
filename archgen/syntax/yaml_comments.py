"""Find what the YAML parser drops: ignore comments, Git's conflict markers, and comments that swallow text."""

from __future__ import annotations

import re
from bisect import bisect_right
from typing import TYPE_CHECKING

from archgen.diagnostics import Diagnostic, Label, Span, name_rule
from archgen.syntax.yaml_tree import IgnoreComment

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

# These patterns run over whole files, and none of them crosses the end of a line.
_IGNORE_COMMENT = re.compile(r"#[ \t]*archgen:[ \t]*ignore\b[ \t]*(?:\[([^\]\r\n]*)\])?([^\r\n]*)")
_COMMENT = re.compile(r"(?:\A|(?<=[ \t\r\n]))#[^\r\n]*")
# From the first to the last sign of the name: a line of blanks takes time that grows with its length alone. (Groups that
# are never taken back would say it shorter; Python 3.11.2 loses what they hold.)
_CONFLICT_MARKER = re.compile(
    r"^(<{7}|\|{7}|={7}|>{7})(?:[ \t]+([^ \t\r\n](?:[^\r\n]*[^ \t\r\n])?))?[ \t]*\r?$", re.MULTILINE
)
_HASH_BEFORE_TEXT = re.compile(r"#(?<=[ \t]#)[^\s]")
_SWALLOWED_TEXT = re.compile(r"[ \t]+#(?!\s*archgen:)[^\s][^\r\n]*")
# After an empty value only `#12` and colours such as `#ff8800` count: those are values that somebody forgot to quote.
_SWALLOWED_VALUE = re.compile(r"[ \t]*#(?:[0-9]|[0-9a-fA-F]{6}\b)[^\r\n]*")


class LineStarts:
    """The offsets at which the lines of a text begin, to turn an offset into a line and a column."""

    __slots__ = ("_starts",)

    def __init__(self, text: str) -> None:
        """Record where each line of a text begins."""
        self._starts = [0, *(line_break.end() for line_break in re.finditer(r"\r\n?|\n", text))]

    def span_between(self, file: str, start: int, end: int) -> Span:
        """Return the span between two offsets (from 0, the end exclusive)."""
        start_line, end_line = bisect_right(self._starts, start), bisect_right(self._starts, end)
        return Span(
            file, start_line, start - self._starts[start_line - 1] + 1, end_line, end - self._starts[end_line - 1] + 1
        )


def read_ignore_comments(file: str, text: str, quoted_ranges: Sequence[tuple[int, int]]) -> Iterator[IgnoreComment]:
    """Yield the comments `# archgen: ignore[rule] why`, except those inside quoted or block text.

    `quoted_ranges` are the start and end offsets of such text, in order. A comment without rules silences nothing; it
    is yielded all the same, so that it can be reported.
    """
    quoted_starts = [start for start, _ in quoted_ranges]
    line_starts: LineStarts | None = None
    for match in _IGNORE_COMMENT.finditer(text):
        preceding = bisect_right(quoted_starts, match.start()) - 1
        if preceding >= 0 and match.start() < quoted_ranges[preceding][1]:
            continue
        # YAML needs a blank before `#`: without one the characters are a part of plain text.
        if match.start() and text[match.start() - 1] not in " \t\r\n":
            continue
        line_starts = line_starts or LineStarts(text)
        rule_names = tuple(name_rule(name.strip()) for name in (match[1] or "").split(",") if name.strip())
        end = match.end() - (len(match[2]) - len(match[2].rstrip()))
        yield IgnoreComment(rule_names, match[2].strip(), line_starts.span_between(file, match.start(), end))


def find_comments(text: str, quoted_ranges: Sequence[tuple[int, int]]) -> Iterator[tuple[int, str]]:
    """Yield where each comment begins, and it without the blanks at its end; `quoted_ranges` as `read_ignore_comments`."""
    quoted_starts = [start for start, _ in quoted_ranges]
    position = 0
    while match := _COMMENT.search(text, position):
        preceding = bisect_right(quoted_starts, match.start()) - 1
        is_quoted = preceding >= 0 and match.start() < quoted_ranges[preceding][1]
        # Behind a quoted `#` there may be a comment on the same line.
        position = max(match.start() + 1, quoted_ranges[preceding][1]) if is_quoted else match.end()
        if not is_quoted:
            yield match.start(), match[0].rstrip()


def may_hold_ignore_comments(text: str) -> bool:
    """Whether a text may hold ignore comments; a cheap test that decides if quoted ranges are recorded at all."""
    return "archgen:" in text and _IGNORE_COMMENT.search(text) is not None


def find_merge_conflicts(file: str, text: str) -> tuple[Diagnostic, ...]:
    """Find Git's conflict markers; one diagnostic for each conflict, labelled with both of its sides."""
    # Two substring searches are much cheaper than the regular expression, and nearly every file ends here.
    if "<<<<<<<" not in text and ">>>>>>>" not in text:
        return ()
    return tuple(_pair_conflict_markers(file, text))


def _pair_conflict_markers(file: str, text: str) -> Iterator[Diagnostic]:
    line_starts = LineStarts(text)
    ours_marker: re.Match[str] | None = None
    # A line of seven `=` alone is also a legal Markdown underline in a block of text: markers count only in their order
    # `<`, `=`, `>`. The marker `|` of the diff3 style needs no action, it lies between the first two.
    middle_marker: re.Match[str] | None = None
    for match in _CONFLICT_MARKER.finditer(text):
        if match[1][0] == "<":
            ours_marker, middle_marker = match, None
        elif match[1][0] == "=" and ours_marker:
            middle_marker = match
        elif match[1][0] == ">" and ours_marker and middle_marker:
            labels = (
                Label(line_starts.span_between(file, *middle_marker.span(1)), "the other side begins here"),
                Label(line_starts.span_between(file, match.start(), match.end(2 if match[2] else 1)), "and ends here"),
            )
            span = line_starts.span_between(file, ours_marker.start(), ours_marker.end(2 if ours_marker[2] else 1))
            yield Diagnostic(
                "merge-conflict", _conflict_message(ours_marker[2], match[2]), span, labels=labels, help=_CONFLICT_HELP
            )
            ours_marker = middle_marker = None


_CONFLICT_HELP = "keep what is right of both sides and delete the lines with the markers"


def _conflict_message(ours: str | None, theirs: str | None) -> str:
    return f"Git could not merge `{ours or 'this side'}` with `{theirs or 'the other side'}` here"


def find_lines_with_hashes(text: str) -> frozenset[int]:
    """Return the lines (from 0) on which ` #` is followed by a non-blank: a comment may have swallowed text there."""
    if "#" not in text or _HASH_BEFORE_TEXT.search(text) is None:
        return frozenset()
    lines = re.split(r"\r\n|\r|\n", text)
    return frozenset(number for number, line in enumerate(lines) if "#" in line and _HASH_BEFORE_TEXT.search(line))


def find_swallowed_text(source: str, value_span: Span, end_offset: int, *, is_empty: bool) -> Iterator[Diagnostic]:
    """Report a comment right after a plain value, which ends at `end_offset`, that looks like a part of the value.

    After an empty value only a comment that looks like a number or a colour counts: other comments are common there.
    """
    match = (_SWALLOWED_VALUE if is_empty else _SWALLOWED_TEXT).match(source, end_offset)
    if match is None:
        return
    comment = match[0]
    start_column = value_span.end_column + len(comment) - len(comment.lstrip())
    span = Span(
        value_span.file, value_span.end_line, start_column, value_span.end_line, value_span.end_column + len(comment)
    )
    message = f"`{comment.strip()}` is a comment, not part of the text"
    help_line = "quote the whole text if it belongs to it; write `# ` with a blank if it is a comment"
    yield Diagnostic("swallowed-text", message, span, help=help_line)
