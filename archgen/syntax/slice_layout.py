"""Lay out the text of a slice in one style: indents, braces, blank lines, places of comments; no character of a value.

A first walk over PyYAML's events says what stands where; a second prints it. Who writes the result proves it first
(`edit.formatted_slices`): this module only promises to name what it cannot lay out.
"""

from __future__ import annotations

import re
from bisect import bisect_left, bisect_right
from collections.abc import Iterator
from typing import Any, NoReturn

import yaml

from archgen.frozen import dataclass, field
from archgen.syntax import yaml_comments, yaml_parser

MAX_LINE = 120
"""Braces and brackets that do not fit are opened: an entry a line."""
_UNIT = 2


class UnformattableError(Exception):
    """What a text holds that is not laid out, and the line (from 1) on which."""

    def __init__(self, reason: str, line: int) -> None:
        super().__init__(reason)
        self.reason, self.line = reason, line


@dataclass(slots=True)
class _Value:
    """A value as it is written: where it begins and ends, with an anchor before it. A scalar has no `children`.

    `children` of a mapping are key, value, key, value, ...; `column` is that of a block's keys or dashes.
    """

    start: int
    end: int
    column: int
    style: str = ""
    anchor: str = ""
    is_mapping: bool = False
    is_flow: bool = False
    children: list[_Value] | None = None
    width: int = 0
    """How many characters it has in braces; of a text over several lines, more than fit."""
    is_bare: bool = False
    """Whether it is `a: b` in brackets."""

    def list_pairs(self) -> Iterator[tuple[_Value | None, _Value]]:
        """Yield the entries of a mapping or list: key (None in a list) and value."""
        children = self.children or []
        yield from zip(children[::2], children[1::2], strict=True) if self.is_mapping else ((None, c) for c in children)


@dataclass(frozen=True, slots=True)
class _Comment:
    start: int
    column: int
    is_own_line: bool
    text: str


def format_slice(text: str) -> str:
    """Return the text, which has no byte-order mark and LF at its lines' ends, laid out. Raise UnformattableError."""
    return _Layout(text).lay_out()


@dataclass(slots=True)
class _Layout:
    text: str
    line_starts: list[int] = field(default_factory=list)
    comments: list[_Comment] = field(default_factory=list)
    lines: list[str] = field(default_factory=list)
    printed: set[int] = field(default_factory=set)
    """The comments that are printed, by their number; the first `printed_count` of them all are."""
    printed_count: int = 0

    def lay_out(self) -> str:
        quoted_ranges: list[tuple[int, int]] = []
        self.line_starts = [0, *(match.end() for match in re.finditer("\n", self.text))]
        begin, root = self._read(quoted_ranges)
        self.comments = [self._place_comment(*each) for each in yaml_comments.find_comments(self.text, quoted_ranges)]
        if begin is not None:
            self._print_own_lines(0, begin)
            self.lines.append("---")
            self._print_line_comment(self._end_of_line(begin))
        if root is not None and not root.children:
            return self.text
        if root is not None:
            self._print_entries(root, 0, len(self.text) + 1)
        self._print_own_lines(0, len(self.text) + 1)
        return "".join(f"{line}\n" for line in self.lines)

    # Reading

    def _read(self, quoted_ranges: list[tuple[int, int]]) -> tuple[int | None, _Value | None]:
        """Return where `---` stands, and the root. `quoted_ranges` is filled with where no comment can begin."""
        begin, root = None, None
        stack: list[_Value] = []
        for event, start, end in yaml_parser.list_events(self.text):
            if isinstance(event, yaml.DocumentStartEvent) and event.explicit:
                begin = self._read_begin(event)
            elif isinstance(event, yaml.DocumentEndEvent) and event.explicit:
                self._refuse("the end of a document (`...`)", start)
            elif isinstance(event, (yaml.MappingEndEvent, yaml.SequenceEndEvent)):
                self._close(stack.pop(), end)
            elif isinstance(event, yaml.NodeEvent):
                value = self._read_value(event)
                if stack:
                    self._add_child(stack[-1], value)
                else:
                    root = value
                if value.children is not None:
                    stack.append(value)
                elif value.style:
                    quoted_ranges.append((value.start, value.end))
        return begin, root

    def _read_begin(self, event: Any) -> int:  # noqa: ANN401 - PyYAML has no types for its events
        begin: int = event.start_mark.index
        if event.version or event.tags:
            self._refuse("a directive", begin)
        return begin

    def _close(self, value: _Value, end: int) -> None:
        """Set what is known of a mapping or list at its end."""
        children = value.children or []
        is_closed = value.is_flow and self.text[end - 1 : end] in ("}", "]")
        value.end = end if is_closed or not children else children[-1].end
        value.width = len(value.anchor) + sum(child.width + 2 for child in children) + 2 * (not children)
        if value.is_mapping and value.is_flow and not value.anchor and self.text[value.start] != "{":
            value.is_bare, value.width = True, value.width - 2

    def _read_value(self, event: Any) -> _Value:  # noqa: ANN401 - the same
        start, end = event.start_mark, event.end_mark
        if isinstance(event, (yaml.ScalarEvent, yaml.AliasEvent)):
            value = _Value(start.index, end.index, start.column, getattr(event, "style", "") or "")
            value.width = end.index - start.index + MAX_LINE * (end.line > start.line)
            return value
        anchor = f"&{event.anchor}" if event.anchor else ""
        is_mapping = isinstance(event, yaml.MappingStartEvent)
        column = start.column
        if anchor:
            position = self._skip_blanks(start.index + len(anchor))
            column = position - self._start_of_line(position)
        return _Value(start.index, end.index, column, "", anchor, is_mapping, bool(event.flow_style), [])

    def _add_child(self, parent: _Value, value: _Value) -> None:
        children = parent.children if parent.children is not None else []
        if parent.is_mapping and len(children) % 2 == 0:
            before = value.start - 1
            while before >= 0 and self.text[before] in " \t\n":
                before -= 1
            if before >= 0 and self.text[before] == "?":
                self._refuse("a key that is written with `?`", value.start)
        if value.children is not None and not value.is_flow and value.column == parent.column:
            value.column += 1  # dashes below their key: a comment that stands as they do is about what follows
        children.append(value)

    def _skip_blanks(self, position: int) -> int:
        """Return where blanks, line ends and comments end."""
        match = _BLANKS_AND_COMMENTS.match(self.text, position)
        return match.end() if match else position

    def _place_comment(self, start: int, text: str) -> _Comment:
        line_start = self._start_of_line(start)
        return _Comment(start, start - line_start, self._begins_line(line_start, start), text)

    def _start_of_line(self, position: int) -> int:
        return self.line_starts[bisect_right(self.line_starts, position) - 1]

    def _begins_line(self, line_start: int, position: int) -> bool:
        match = _BLANKS.match(self.text, line_start)
        return match is not None and match.end() >= position

    def _end_of_line(self, position: int) -> int:
        line = bisect_right(self.line_starts, position)
        return self.line_starts[line] - 1 if line < len(self.line_starts) else len(self.text) + 1

    def _refuse(self, reason: str, position: int) -> NoReturn:
        raise UnformattableError(reason, self.text.count("\n", 0, position) + 1)

    # Comments and blank lines

    def _next_comment(self, end: int) -> int | None:
        """Return the number of the next comment that is not printed and begins before `end`."""
        while self.printed_count in self.printed:
            self.printed_count += 1
        number = self.printed_count
        return number if number < len(self.comments) and self.comments[number].start < end else None

    def _has_comment(self, start: int, end: int) -> bool:
        """Whether a comment begins between two places."""
        number = bisect_left(self.comments, start, key=lambda comment: comment.start)
        return number < len(self.comments) and self.comments[number].start < end

    def _print_own_lines(self, indent: int, end: int, least_column: int = 0) -> None:
        """Print the comments before `end`, each on a line of its own, up to one that begins left of `least_column`."""
        while (number := self._next_comment(end)) is not None:
            comment = self.comments[number]
            if comment.is_own_line and comment.column < least_column:
                return
            self._keep_blank_line(comment.start)
            self.lines.append(" " * indent + comment.text)
            self.printed.add(number)

    def _print_line_comment(self, end: int) -> bool:
        """Put the next comment before `end`, if it stands behind something, behind the last line."""
        number = self._next_comment(end)
        if number is None or self.comments[number].is_own_line:
            return False
        self._put_behind(number, -1)
        return True

    def _put_behind(self, number: int, line: int) -> None:
        self.lines[line] = f"{self.lines[line]}  {self.comments[number].text}"
        self.printed.add(number)

    def _print_closing_comment(self, value: _Value, line: int) -> None:
        """Put a comment behind braces that are opened to their head: it is about the element, not about its last entry."""
        number = bisect_left(self.comments, value.end, key=lambda comment: comment.start)
        start = self.comments[number].start if number < len(self.comments) else len(self.text)
        if start < self._end_of_line(value.end) and not self.text[value.end : start].strip(" \t,"):
            self._put_behind(number, line)

    def _keep_blank_line(self, start: int) -> None:
        """Print a blank line where one stands above what begins at `start`, the first on its line."""
        line = bisect_right(self.line_starts, start) - 1
        if line and self.lines and self.lines[-1] and self._begins_line(self.line_starts[line], start):
            match = _BLANKS.match(self.text, self.line_starts[line - 1])
            if match is not None and match.end() == self.line_starts[line] - 1:
                self.lines.append("")

    # Printing

    def _print_entries(self, holder: _Value, indent: int, end: int, *, on_dash_line: bool = False) -> None:
        """Print the entries of a mapping or list, one a line, with the comments before and behind them.

        What follows the holder begins at `end`.
        """
        pairs = list(holder.list_pairs())
        starts = [*self._list_starts(holder), holder.end - 1 if holder.is_flow else end]
        line_count = len(self.lines)
        for (key, value), start, next_start in zip(pairs, starts, starts[1:], strict=False):
            self._print_own_lines(indent, start)
            if len(self.lines) > line_count or not on_dash_line:
                self._keep_blank_line(start)
            if key:
                self.lines.append(f"{' ' * indent}{self._slice(key)}:")
                self._print_value(value, indent, key.end, next_start)
            else:
                self._print_item(value, indent, start, next_start)
            if value.style not in _BLOCK_STYLES and (value.children is None or value.is_flow):
                self._print_line_comment(next_start if holder.is_flow else self._end_of_line(value.end))
        self._print_own_lines(indent, starts[-1], 0 if holder.is_flow else holder.column)

    def _list_starts(self, holder: _Value) -> Iterator[int]:
        """Yield where each entry begins: at its key, in a list line by line at its dash."""
        position = holder.start + len(holder.anchor)
        for key, value in holder.list_pairs():
            is_dashed = not holder.is_mapping and not holder.is_flow
            yield key.start if key else self._skip_blanks(position) if is_dashed else value.start
            position = value.end

    def _print_item(self, value: _Value, indent: int, dash: int, next_start: int) -> None:
        first_start = value.children[0].start if value.children else value.start
        if value.anchor or self._has_comment(dash, first_start) or self._fits(value, indent + _UNIT):
            self.lines.append(f"{' ' * indent}-")
            self._print_value(value, indent, dash + 1, next_start)
            return
        # A mapping or list in a list begins on the line of its dash.
        first = len(self.lines)
        self._print_entries(value, indent + _UNIT, next_start, on_dash_line=True)
        self.lines[first] = f"{' ' * indent}- {self.lines[first].lstrip(' ')}"
        if value.is_flow:
            self._print_closing_comment(value, first)

    def _print_value(self, value: _Value, indent: int, head_end: int, next_start: int) -> None:
        """Print a value behind its head, the last line: a key or a dash that stands at `indent`."""
        if value.anchor:
            self.lines[-1] = f"{self.lines[-1]} {value.anchor}"
        inner = indent + _UNIT
        is_apart = self._has_comment(head_end, value.start)
        if is_apart:
            self._print_line_comment(self._end_of_line(head_end))
            self._print_own_lines(inner, value.start)
        if value.children is None:
            self._print_scalar(value, inner, head_end, is_apart=is_apart)
        elif self._fits(value, inner if is_apart else len(self.lines[-1]) + 1):
            self._put(self._to_flow(value), inner, is_apart=is_apart)
        else:
            is_told = is_apart or self._print_line_comment(next(self._list_starts(value)))
            if value.is_flow and not is_told:
                self._print_closing_comment(value, -1)
            self._print_entries(value, inner, next_start)

    def _put(self, text: str, indent: int, *, is_apart: bool) -> None:
        if is_apart:
            self.lines.append(" " * indent + text)
        else:
            self.lines[-1] = f"{self.lines[-1]} {text}"

    def _print_scalar(self, value: _Value, indent: int, head_end: int, *, is_apart: bool) -> None:
        first, *others = self._slice(value).split("\n")
        if value.style in _BLOCK_STYLES:
            self._put(first.rstrip(), indent, is_apart=is_apart)
            self.lines += self._indent_block(first, others, indent, value.start)
        elif first or others:
            # A text that breaks its lines keeps its breaks, also the one before it; a word goes back to its key.
            if "\n" in self.text[head_end : value.start]:
                is_apart = is_apart or bool(others) or len(self.lines[-1]) + 1 + len(first) > MAX_LINE
            self._put(first, indent, is_apart=is_apart)
            self.lines += [" " * indent + line.lstrip(" \t") if line.strip(" \t") else "" for line in others]

    def _indent_block(self, head: str, lines: list[str], indent: int, start: int) -> list[str]:
        """Return the lines of a `|` or `>` with another indentation."""
        signs = head.partition(" #")[0].split()[-1]
        if any(sign.isdigit() for sign in signs):
            self._refuse("a block of text with its indentation written out", start)
        while lines and not lines[-1].strip(" "):
            lines.pop()  # what stands behind the last line's end; with `+` no more than that
            if "+" in signs:
                break
        width = min((len(line) - len(line.lstrip(" ")) for line in lines if line.strip(" ")), default=0)
        if any(len(line) > width and not line.strip(" ") for line in lines):
            self._refuse("a block of text with a line of blanks", start)
        return [" " * indent + line[width:] if line.strip(" ") else "" for line in lines]

    def _fits(self, value: _Value, column: int) -> bool:
        """Whether a value stays on one line: what is in braces or brackets, without a comment or a broken text in it."""
        if not value.children:
            return True
        width = value.width - len(value.anchor)
        return value.is_flow and column + width <= MAX_LINE and not self._has_comment(value.start, value.end)

    def _to_flow(self, value: _Value) -> str:
        """Write a value in braces or brackets, without the anchor before it."""
        if value.children is None:
            return self._slice(value)
        begin, end = ("", "") if value.is_bare else ("{", "}") if value.is_mapping else ("[", "]")
        entries = (
            (f"{self._slice(key)}: " if key else "")
            + (f"{child.anchor} " if child.anchor else "")
            + self._to_flow(child)
            for key, child in value.list_pairs()
        )
        return f"{begin}{', '.join(entries)}{end}"

    def _slice(self, value: _Value) -> str:
        return self.text[value.start : value.end]


_BLOCK_STYLES = ("|", ">")
_BLANKS = re.compile(r"[ \t]*")
_BLANKS_AND_COMMENTS = re.compile(r"(?:[ \t\n]|(?:(?<=[ \t\n])|\A)#[^\n]*)*")
