"""Whole entries are cut from files and put below a path in others, with the comments above them; each line is followed."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from archgen.edit.element_edit import (
    BYTE_ORDER_MARK,
    CannotInsertError,
    EditRefusedError,
    FileEdit,
    ParsedText,
    find_holder,
    has_blank_lines,
    make_schema_line,
    parse_text,
    read_editable,
)
from archgen.edit.element_place import ElementPlace
from archgen.edit.refactoring.judged_version import JudgedVersion
from archgen.frozen import NamedTuple, dataclass, field
from archgen.project import PROJECT_FILE
from archgen.syntax import file_patterns
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode, SequenceNode, find_value, list_entries
from archgen.syntax.yaml_writer import format_scalar

Place = tuple[str, int, int]
"""File, line and column, from 1."""
_INDENT = 2


class EntryMove(NamedTuple):
    """An entry of a file by its keys, and the file and the mapping that take it."""

    file: str
    path: tuple[str, ...]
    new_file: str
    new_holder: tuple[str, ...]


class _Line(NamedTuple):
    text: str
    file: str = ""
    number: int = 0
    """Where it stood, from 1; 0 for a line that is new."""
    shift: int = 0


@dataclass(slots=True)
class _File:
    """A file: its lines, those that go, and what is put before lines, by their numbers from 0."""

    parsed: ParsedText | None
    mark: str
    lines: list[str]
    end: str
    cut: set[int] = field(default_factory=set)
    insertions: dict[int, list[_Line]] = field(default_factory=dict)
    headers: dict[tuple[int, tuple[str, ...]], None] = field(default_factory=dict)


class MovedLines:
    """Moves entries between the texts of a project, as some edits left them."""

    def __init__(self, version: JudgedVersion, edits: Iterable[FileEdit]) -> None:
        self._version = version
        self._edited = {edit.file: edit for edit in edits}
        self._files: dict[str, _File] = {}
        self._lines: dict[tuple[str, int], tuple[str, int, int]] = {}

    def move_all(self, moves: Sequence[EntryMove]) -> tuple[FileEdit, ...]:
        """Return the files as they are with all moves. Raise EditRefusedError for an entry that is not a block of its own."""
        ranges: dict[str, list[tuple[int, int]]] = {}
        for move in moves:
            file = self._open(move.file)
            start, end, column = self._find_block(move.file, move.path)
            ranges.setdefault(move.file, []).append((start, end))
            block = [_Line(file.lines[number], move.file, number + 1) for number in range(start, end)]
            self._paste(move, block, column)
            file.cut.update(range(start, end))
        for name in dict.fromkeys(move.file for move in moves):
            filled = [move.new_holder for move in moves if move.new_file == name]
            self._cut_empty_holders(self._files[name], [move.path for move in moves if move.file == name], filled)
        self._read_from(list(dict.fromkeys(move.new_file for move in moves)))
        return tuple(self._finish(name) for name in sorted(self._files))

    def place(self, place: Place) -> Place:
        """Return where something stands now; nowhere where a key went with all that stood below it."""
        if place[0] not in self._files:
            return place
        file, line, shift = self._lines.get(place[:2], ("", 0, -place[2]))
        return file, line, place[2] + shift

    def _open(self, name: str) -> _File:
        if name not in self._files:
            files = self._version.project.loaded_project.files
            if name in self._edited:
                text = self._edited[name].new_content.decode()
            elif files.has_path(name):
                _, text = read_editable(self._version.project, name)
            else:
                schema_line = make_schema_line(self._version.project, ElementPlace(name, (), is_new_file=True))
                lines = [schema_line] if schema_line else []
                self._files[name] = _File(None, "", lines, "\n")
                return self._files[name]
            if files.is_behind_link(name):
                raise EditRefusedError(f"{name} is behind a link", "edit it in the folder in which it lies")
            mark = BYTE_ORDER_MARK if text.startswith(BYTE_ORDER_MARK) else ""
            try:
                parsed = parse_text(name, text.removeprefix(mark))
            except CannotInsertError as error:
                raise EditRefusedError(str(error)) from None
            lines = list(parsed.lines)
            self._files[name] = _File(parsed, mark, lines, "\r\n" if lines and lines[0].endswith("\r\n") else "\n")
        return self._files[name]

    def _find_block(self, name: str, path: Sequence[str]) -> tuple[int, int, int]:
        """Return the lines of an entry, from 0, the end exclusive, and the column of its key."""
        file = self._files[name]
        holder = find_value(file.parsed.root, *path[:-1]) if file.parsed else None
        entry = holder.entries.get(path[-1]) if isinstance(holder, MappingNode) else None
        if entry is None:
            message = f"{name} does not write `{path[-1]}` as a key of its own"
            raise EditRefusedError(message, "write it in the long form first: `ID:` with its keys below")
        start, end = _block_of(file.lines, entry)
        return start, end, entry.key_span.column - 1

    def _paste(self, move: EntryMove, block: list[_Line], column: int) -> None:
        file = self._open(move.new_file)
        position, indent, missing = _find_target(file, move.new_holder, move.path[-1])
        own = file.insertions.setdefault(position, [])
        for depth, key in enumerate(missing):
            header = (position, tuple(move.new_holder[: len(move.new_holder) - len(missing) + depth + 1]))
            if header not in file.headers:
                file.headers[header] = None
                own.append(_Line(f"{' ' * (indent + _INDENT * depth)}{format_scalar(key)}:{file.end}"))
        if (
            not missing
            and file.parsed
            and has_blank_lines(file.parsed, list_entries(file.parsed.root, *move.new_holder))
        ):
            own.append(_Line(file.end))
        shift = indent + _INDENT * len(missing) - column
        for line in block:
            bare = line.text.rstrip("\r\n")
            text = (" " * shift + bare if shift >= 0 else bare[-shift:]) if bare.strip() else ""
            own.append(_Line(text + file.end, line.file, line.number, shift))

    def _cut_empty_holders(
        self, file: _File, paths: Sequence[tuple[str, ...]], filled: Sequence[tuple[str, ...]]
    ) -> None:
        """Cut the keys below which nothing is left, from the inside to the outside, unless comments stand there."""
        gone = set(paths)
        kept = {each[:depth] for each in filled for depth in range(1, len(each) + 1)}
        outer_paths = dict.fromkeys(each[:depth] for each in paths for depth in range(1, len(each)))
        for path in sorted(outer_paths, key=len, reverse=True):
            if path in kept:
                continue
            holder = find_value(file.parsed.root, *path[:-1]) if file.parsed else None
            entry = holder.entries.get(path[-1]) if isinstance(holder, MappingNode) else None
            if entry is None or any((*path, each.key) not in gone for each in list_entries(entry.value)):
                continue
            start, end = _block_of(file.lines, entry)
            left = [number for number in range(start, end) if number not in file.cut]
            if all(number == entry.key_span.line - 1 or not file.lines[number].strip() for number in left):
                file.cut.update(left)
                gone.add(path)

    def _read_from(self, names: Sequence[str]) -> None:
        """Add new files to `sources` that no pattern there names."""
        loaded_project = self._version.project.loaded_project
        document = next((each for each in loaded_project.documents if each.file == PROJECT_FILE), None)
        listed = document.root.get("sources") if document else None
        patterns = (
            [each for each in listed.items if isinstance(each, ScalarNode)] if isinstance(listed, SequenceNode) else []
        )
        unread = [
            format_scalar(name)
            for name in names
            if not loaded_project.files.has_path(name)
            and not any(file_patterns.matches_pattern(each.text, name) for each in patterns)
        ]
        if not (patterns and unread):
            return
        file, last = self._open(PROJECT_FILE), patterns[-1].span
        line = file.lines[last.end_line - 1]
        before, after = line[: last.column - 1], line[last.end_column - 1 :]
        if before.strip() == "-":
            own = file.insertions.setdefault(last.end_line, [])
            own[:0] = [_Line(f"{before}{name}{file.end}") for name in unread]
        else:
            file.lines[last.end_line - 1] = ", ".join((line[: last.end_column - 1], *unread)) + after

    def _finish(self, name: str) -> FileEdit:
        file = self._files[name]
        lines: list[_Line] = []
        for number in range(len(file.lines) + 1):
            lines += file.insertions.get(number, ())
            if number < len(file.lines) and number not in file.cut:
                lines.append(_Line(file.lines[number], name, number + 1))
        lines = list(_join_blank_lines(lines))
        for number, line in enumerate(lines, start=1):
            if line.number:
                self._lines[line.file, line.number] = (name, number, line.shift)
        text = "".join(
            line.text if line.text.endswith(("\n", "\r")) or number == len(lines) else line.text + file.end
            for number, line in enumerate(lines, start=1)
        )
        files = self._version.project.loaded_project.files
        old_content = read_editable(self._version.project, name)[0] if files.has_path(name) else None
        first = next((number for number, line in enumerate(lines, start=1) if line.file != name), 1)
        return FileEdit(name, old_content, (file.mark + text).encode(), first)


def _find_target(file: _File, path: tuple[str, ...], key: str) -> tuple[int, int, tuple[str, ...]]:
    """Return the line before which an entry is put, its indentation, and the keys that are missing around it."""
    if file.parsed is None:
        return len(file.lines), 0, path
    try:
        holder, missing = find_holder(file.parsed, path)
    except CannotInsertError as error:
        raise EditRefusedError(str(error)) from None
    if not missing and key in holder.entries:
        message = f"{holder.entries[key].key_span}: the file says something of `{key}` already"
        raise EditRefusedError(message, "join both there by hand, or choose another file")
    if not holder.entries:
        return len(file.lines), 0, missing
    entry = holder.entries.get(missing[0]) if missing else None
    if entry is not None:
        if not (isinstance(entry.value, ScalarNode) and entry.value.value is None):
            message = f"{entry.value.span}: `{entry.key}` is written in a short form"
            raise EditRefusedError(message, "write it in the long form first")
        return _block_of(file.lines, entry)[1], entry.key_span.column - 1 + _INDENT, missing[1:]
    last = list(holder)[-1]
    return _block_of(file.lines, last)[1], last.key_span.column - 1, missing


def _join_blank_lines(lines: Iterable[_Line]) -> Iterator[_Line]:
    """Yield lines without a blank one where lines went or came and nothing, a blank line or a bare key stands before it."""
    before: _Line | None = None
    for line in lines:
        is_seam = line.number > 1 if before is None else (line.file, line.number) != (before.file, before.number + 1)
        is_first = before is None or not before.text.strip() or before.text.rstrip().endswith(":")
        if line.text.strip() or not (is_seam and is_first):
            yield line
            before = line


def _block_of(lines: Sequence[str], entry: MappingEntry) -> tuple[int, int]:
    """Return the lines of an entry with the comments right above it, from 0, the end exclusive.

    Raise EditRefusedError where something else stands in its first line.
    """
    column, first = entry.key_span.column - 1, entry.key_span.line - 1
    if lines[first][:column].strip():
        message = f"{entry.key_span}: `{entry.key}` is written in braces, or behind a key in its line"
        raise EditRefusedError(message, "write it as a block of its own first")
    start, end = first, first + 1
    while start > 0 and lines[start - 1].startswith(" " * column + "#"):
        start -= 1
    for number in range(first + 1, len(lines)):
        line = lines[number]
        indent = len(line) - len(line.lstrip(" "))
        # A list may stand in the column of its key.
        is_item = indent == column and line.startswith("- ", column) and isinstance(entry.value, SequenceNode)
        if line.strip() and indent <= column and not is_item:
            break
        if line.strip():
            end = number + 1
    return start, end
