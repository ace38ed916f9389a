"""Insert an element into a file's text as the last of its mapping; every other character stays as it is."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

from archgen.edit.element import Element
from archgen.source import Span
from archgen.syntax import yaml
from archgen.syntax.tree import Entry, Scalar, Table, Value

_LINE = re.compile(r"[^\r\n]*(?:\r\n|\n|\r)|[^\r\n]+\Z")
_EMPTY = re.compile(r"[\"']?\s*:[ \t]*(?:#.*)?\Z")
_REST = re.compile(r"(?:\s|#[^\r\n]*)*,")
_UNIT = 2


class CannotInsertError(Exception):
    """The text has a form into which nothing is inserted by machine. The message says which."""


@dataclass(frozen=True, slots=True)
class _Text:
    """A file's text as lines with their line endings, and its tree."""

    lines: tuple[str, ...]
    root: Table

    @property
    def end_of_line(self) -> str:
        first = self.lines[0] if self.lines else "\n"
        return first[len(first.rstrip("\r\n")) :] or "\n"

    def offset(self, line: int, column: int) -> int:
        return sum(len(text) for text in self.lines[: line - 1]) + column - 1

    def begins(self, value: Value) -> str:
        """Return the text from where a value begins, behind its anchor, to the end of the line."""
        rest = self.lines[value.at.line - 1][value.at.column - 1 :] if value.at.line <= len(self.lines) else ""
        return re.sub(r"\A&\S+[ \t]*", "", rest)


def texts(file: str, text: str, path: tuple[str, ...], element: Element) -> Iterator[str]:
    """Yield texts with the element at a path of mappings, the likeliest first; the caller proves which one is right.

    Raise CannotInsertError.
    """
    document, _ = yaml.parse(file, text)
    if document is None:
        msg = f"{file} cannot be parsed: `archgen check` says where"
        raise CannotInsertError(msg)
    # YAML takes a lone carriage return for a line break and editors mostly do not: line numbers would not fit.
    if _unfolded(text):
        msg = f"{file} holds line breaks that editors and parsers see differently"
        raise CannotInsertError(msg)
    found = _Text(tuple(_LINE.findall(text)), document.root)
    holder, rest = _holder(found, path)
    entry = holder.entries.get(rest[0]) if rest else None
    if entry is not None:
        yield from _below_empty(found, holder, entry, element.below(rest[1:]))
    elif found.begins(holder).startswith("{") and holder.at != Span.of_file(file):
        yield _in_braces(found, holder, element.inline().below(rest))
    else:
        yield from _in_block(found, holder, element.below(rest))


def _unfolded(text: str) -> bool:
    """Return whether a text has line breaks that are a carriage return only."""
    return re.search(r"\r(?!\n)", text) is not None


def _holder(found: _Text, path: tuple[str, ...]) -> tuple[Table, tuple[str, ...]]:
    """Follow a path as far as its mappings are written; return the last of them and the keys that are left."""
    table = found.root
    for depth, key in enumerate(path):
        entry = table.entries.get(key)
        if entry is None or not isinstance(entry.value, Table):
            return table, path[depth:]
        # An insertion would appear wherever the anchor is used.
        if found.begins(entry.value).startswith("*"):
            msg = f"`{key}` is written once and used here by its anchor ({entry.value.at})"
            raise CannotInsertError(msg)
        table = entry.value
    return table, ()


def _below_empty(found: _Text, holder: Table, entry: Entry, element: Element) -> Iterator[str]:
    """Insert the element below a key without a value."""
    line = found.lines[entry.at.end_line - 1].rstrip("\r\n")
    empty = isinstance(entry.value, Scalar) and entry.value.value is None
    if not empty or not _EMPTY.match(line[entry.at.end_column - 1 :]) or found.begins(holder).startswith("{"):
        msg = f"`{entry.key}` is not a mapping that is written out ({entry.at})"
        raise CannotInsertError(msg)
    unit = _unit(found.root)
    indent = " " * (entry.at.column - 1 + unit)
    yield _joined(found, _end(found, entry.at.end_line, len(indent)), element.lines(indent, unit), spaced=False)


def _in_block(found: _Text, table: Table, element: Element) -> Iterator[str]:
    """Insert the element behind the last one of a block."""
    entries = list(table)
    if not entries:
        yield _joined(found, len(found.lines), element.lines("", _UNIT), spaced=False)
        return
    last = entries[-1]
    indent = " " * (last.at.column - 1)
    unit = _unit(Table({last.key: last}, table.at), _unit(found.root))
    flow = element.inline()
    short = len(entries) > 1 or table is not found.root
    braces = short and found.begins(last.value).startswith("{") and _braced(found, entries)
    lines = [indent + flow.flow()] if braces else element.lines(indent, unit)
    # A block's span may end at the beginning of the line behind it.
    end = last.value.at.end_line - (1 if last.value.at.end_column == 1 and last.value.at.end_line > last.at.line else 0)
    spaced = _spaced(found, entries)
    trimmed = end
    while trimmed > last.at.line and not found.lines[trimmed - 1].strip():
        trimmed -= 1
    # Blank lines at the end belong to a block text (`|+`) or to the layout: the proof tells which, so both are tried.
    for place in dict.fromkeys((_end(found, trimmed, len(indent)), _end(found, end, len(indent)))):
        yield _joined(found, place, lines, spaced=spaced)


def _braced(found: _Text, entries: list[Entry]) -> bool:
    """Return whether everything in a block is written in braces or in short form, each on one line."""
    return all(
        not isinstance(entry.value, Table)
        or (found.begins(entry.value).startswith("{") and entry.value.at.end_line == entry.at.line)
        for entry in entries
    )


def _in_braces(found: _Text, table: Table, element: Element) -> str:
    """Insert the element before a closing brace, on a line of its own where the others have one."""
    whole = "".join(found.lines)
    written = element.flow()
    entries = list(table)
    if not entries:
        opening = found.offset(table.at.line, table.at.column) + whole[
            found.offset(table.at.line, table.at.column) :
        ].index("{")
        return whole[: opening + 1] + written + whole[opening + 1 :]
    last = entries[-1]
    end = found.offset(last.value.at.end_line, last.value.at.end_column)
    comma = _REST.match(whole, end)
    place = comma.end() if comma else end
    before = found.lines[last.at.line - 1][: last.at.column - 1]
    apart = f"{found.end_of_line}{before}" if not before.strip() else " "
    return whole[:place] + ("" if comma else ",") + apart + written + whole[place:]


def _end(found: _Text, line: int, column: int) -> int:
    """Return the line behind which to insert: comments that are indented as far belong to what is above them."""
    end = line
    for number in range(line, len(found.lines)):
        text = found.lines[number]
        rest = text.lstrip(" ")
        if rest.startswith("#") and len(text) - len(rest) >= column:
            if column:
                end = number + 1
        elif rest.strip():
            break
    return end


def _spaced(found: _Text, entries: list[Entry]) -> bool:
    """Return whether blank lines separate the elements of a block."""
    number = entries[-1].at.line - 1
    while number > 0 and found.lines[number - 1].lstrip().startswith("#"):
        number -= 1
    return number > 0 and not found.lines[number - 1].strip()


def _unit(table: Table, otherwise: int = _UNIT) -> int:
    """Return how many columns a file indents by: those of its first mapping that is written below its key."""
    for entry in table:
        if isinstance(entry.value, Table) and entry.value.entries:
            first = next(iter(entry.value))
            if first.at.line > entry.at.line and first.at.column > entry.at.column:
                return first.at.column - entry.at.column
    return otherwise


def _joined(found: _Text, place: int, lines: list[str], *, spaced: bool) -> str:
    """Return the text with lines inserted behind a line."""
    ending = found.end_of_line
    before, after = "".join(found.lines[:place]), "".join(found.lines[place:])
    if before and before[-1] not in "\r\n":
        before += ending
    if spaced and before and found.lines[place - 1].strip():
        before += ending
    return before + "".join(f"{line}{ending}" for line in lines) + after
