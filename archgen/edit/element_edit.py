"""Plan how to add an element to a project: find its place, make the new text, prove it. Nothing is written here.

Insert an element into a file's text as the last of its mapping; every other character stays as it is.
"""

from __future__ import annotations

import codecs
import difflib
import posixpath
import re
from collections.abc import Iterator, Sequence
from itertools import accumulate

from archgen.diagnostics import Diagnostic, Span
from archgen.edit import edit_proof
from archgen.edit.edit_proof import NewElement
from archgen.edit.element_place import ElementPlace
from archgen.frozen import dataclass
from archgen.pipeline import CheckedProject
from archgen.syntax import yaml_parser
from archgen.syntax.project_files import FileRefusal
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode, YamlNode

SCHEMA_LINE_PATTERN = re.compile(r"\A\s*# yaml-language-server: \$schema=(\S+)")


class EditRefusedError(Exception):
    """The element is not added. `message` says why, `by_hand` what a person may write instead; `errors` are shown."""

    def __init__(self, message: str, by_hand: str = "", errors: tuple[Diagnostic, ...] = ()) -> None:
        super().__init__(message)
        self.message = message
        self.by_hand = by_hand
        self.errors = errors


_LINE_FEEDS = re.compile(r"[^\n]*\n|[^\n]+")


@dataclass(frozen=True, slots=True)
class FileEdit:
    """One file's bytes before (None: the file is new) and after, and the line at which the element begins.

    `renamed_nodes` are the old and new ids of nodes that components bring along, where the edit makes them longer.
    """

    file: str
    old_content: bytes | None
    new_content: bytes
    line: int
    renamed_nodes: tuple[tuple[str, str], ...] = ()

    def unified_diff(self) -> Iterator[str]:
        """Yield the lines of a unified diff, with their ends, as `git apply` takes it."""
        old_lines, new_lines = (
            _LINE_FEEDS.findall(each.decode()) for each in (self.old_content or b"", self.new_content)
        )
        name = "/dev/null" if self.old_content is None else f"a/{self.file}"
        for line in difflib.unified_diff(old_lines, new_lines, name, f"b/{self.file}"):
            yield line if line.endswith("\n") else f"{line}\n\\ No newline at end of file\n"


def plan_edit(checked_project: CheckedProject, place: ElementPlace, element: NewElement, element_id: str) -> FileEdit:
    """Return the edit that adds an element; `element_id` is its complete id. Raise EditRefusedError."""
    old_content, text = (
        (None, make_schema_line(checked_project, place))
        if place.is_new_file
        else read_editable(checked_project, place.file)
    )
    new_text = insert_element(place, element, text)
    # Two proofs: `adds_only_element` looks at the file alone, this one at the whole project with it.
    consequences = edit_proof.find_consequences(
        checked_project, place.file, new_text.removeprefix(BYTE_ORDER_MARK), element_id
    )
    if consequences.errors:
        message = "with it the project would have errors that it does not have now"
        raise EditRefusedError(message, errors=consequences.errors)
    if consequences.changed_elements:
        names = ", ".join(f"`{name}`" for name in consequences.changed_elements[:3]) + (
            " and others" if consequences.changed_elements[3:] else ""
        )
        message = f"it would change what other elements mean: {names}"
        raise EditRefusedError(message, "Choose another id, or write out the references that now lead to it.")
    line = _first_changed_line(text, new_text)
    return FileEdit(place.file, old_content, new_text.encode(), line, consequences.renamed_nodes)


BYTE_ORDER_MARK = codecs.BOM_UTF8.decode()


def read_editable(checked_project: CheckedProject, file: str) -> tuple[bytes, str]:
    """Read a file of the project again. Raise EditRefusedError, also where somebody wrote into it meanwhile."""
    data = checked_project.loaded_project.files.fetch_bytes(file)
    if isinstance(data, FileRefusal):
        raise EditRefusedError(f"{file} cannot be read: {data.message}")
    try:
        text = data.decode()
    except UnicodeDecodeError:
        raise EditRefusedError(f"{file} is not UTF-8") from None
    # Places are those of the text that was checked.
    if checked_project.sources.text_of(file) not in {None, text.removeprefix(BYTE_ORDER_MARK)}:
        raise EditRefusedError(f"{file} was changed since it was read", "run this again")
    return data, text


def make_schema_line(checked_project: CheckedProject, place: ElementPlace) -> str:
    """Return the first line of a new file: the schema comment, where the project's other files have one."""
    for file in checked_project.yaml_files:
        match = SCHEMA_LINE_PATTERN.match(checked_project.sources.text_of(file) or "")
        # A relative path to the schema has to be rewritten for the new file's folder.
        if match and "://" not in match[1] and not match[1].startswith(("/", "\\")):
            schema = posixpath.join(posixpath.dirname(file), match[1])
            address = posixpath.relpath(schema, posixpath.dirname(place.file) or ".")
            return f"# yaml-language-server: $schema={address}\n"
        if match:
            return f"# yaml-language-server: $schema={match[1]}\n"
    return ""


def insert_element(place: ElementPlace, element: NewElement, text: str) -> str:
    """Return the text with the element inserted, the first proposal that proves right. Raise EditRefusedError."""
    byte_order_mark = BYTE_ORDER_MARK if text.startswith(BYTE_ORDER_MARK) else ""
    plain_text = text.removeprefix(BYTE_ORDER_MARK)
    try:
        for candidate in propose_texts(place.file, plain_text, place.path, element):
            if edit_proof.adds_only_element(plain_text, candidate, place.path, element):
                return byte_order_mark + candidate
    except CannotInsertError as error:
        raise EditRefusedError(str(error), _explain_by_hand(place, element)) from None
    message = f"the text of {place.file} is written in a way in which more than the new element would change"
    raise EditRefusedError(message, _explain_by_hand(place, element))


def _explain_by_hand(place: ElementPlace, element: NewElement) -> str:
    """Return what a person may write into the file instead."""
    lines = element.nested_below(place.path).to_block("    ", 2)
    return "\n".join((f"Write it by hand into {place.file}, or into a file of its own:", "", *lines))


def _first_changed_line(old_text: str, new_text: str) -> int:
    """Return the number of the first line that differs and is not blank."""
    old_lines, new_lines = old_text.splitlines(), new_text.splitlines()
    unchanged = next(
        (
            index
            for index, (old_line, new_line) in enumerate(zip(old_lines, new_lines, strict=False))
            if old_line != new_line
        ),
        min(len(old_lines), len(new_lines)),
    )
    return next((index + 1 for index in range(unchanged, len(new_lines)) if new_lines[index].strip()), unchanged + 1)


_LINE_PATTERN = re.compile(r"[^\r\n]*(?:\r\n|\n|\r)|[^\r\n]+\Z")
_EMPTY_VALUE = re.compile(r"[\"']?\s*:[ \t]*(?:#.*)?\Z")
# A comment is taken to the end of its line and never given back: a comma in it separates nothing.
_UNTIL_COMMA = re.compile(r"(?:\s++|#[^\r\n]*+)*+,")
_DEFAULT_INDENT = 2


class CannotInsertError(Exception):
    """The text has a form into which nothing is inserted by machine. The message says which."""


@dataclass(frozen=True, slots=True)
class ParsedText:
    """A file's text as lines with their line endings, and its tree."""

    lines: tuple[str, ...]
    root: MappingNode
    line_starts: tuple[int, ...]
    """How many characters stand before each line, and before the end."""

    @property
    def line_ending(self) -> str:
        """Return how the first line ends."""
        first = self.lines[0] if self.lines else "\n"
        return first[len(first.rstrip("\r\n")) :] or "\n"

    def offset_of(self, line: int, column: int) -> int:
        """Return how many characters stand before a place."""
        return self.line_starts[min(line, len(self.line_starts)) - 1] + column - 1

    def text_from(self, value: YamlNode) -> str:
        """Return the text from where a value begins, behind its anchor, to the end of the line."""
        remainder = (
            self.lines[value.span.line - 1][value.span.column - 1 :] if value.span.line <= len(self.lines) else ""
        )
        return re.sub(r"\A&\S+[ \t]*", "", remainder)


def propose_texts(file: str, text: str, path: tuple[str, ...], element: NewElement) -> Iterator[str]:
    """Yield texts with the element at a path of mappings, the likeliest first; the caller proves which one is right.

    Raise CannotInsertError.
    """
    parsed = parse_text(file, text)
    holder, missing_keys = find_holder(parsed, path)
    entry = holder.entries.get(missing_keys[0]) if missing_keys else None
    if entry is not None:
        yield from _insert_below_empty(parsed, holder, entry, element.nested_below(missing_keys[1:]))
    elif parsed.text_from(holder).startswith("{") and holder.span != Span.of_file(file):
        compact_element = element.without_empty_keys().nested_below(missing_keys)
        position, insertion = find_place_in_braces(parsed, holder, compact_element.to_flow())
        yield text[:position] + insertion + text[position:]
    else:
        yield from _insert_in_block(parsed, holder, element.nested_below(missing_keys))


def parse_text(file: str, text: str) -> ParsedText:
    """Return a text that can be edited by its places. Raise CannotInsertError."""
    document, _ = yaml_parser.parse_yaml(file, text)
    if document is None:
        raise CannotInsertError(f"{file} cannot be parsed: `archgen check` says where")
    # YAML takes a lone carriage return for a line break and editors mostly do not: line numbers would not fit.
    if re.search(r"\r(?!\n)", text):
        raise CannotInsertError(f"{file} holds line breaks that editors and parsers see differently")
    lines = tuple(_LINE_PATTERN.findall(text))
    return ParsedText(lines, document.root, tuple(accumulate(map(len, lines), initial=0)))


def find_holder(parsed: ParsedText, path: tuple[str, ...]) -> tuple[MappingNode, tuple[str, ...]]:
    """Follow a path as far as its mappings are written; return the last of them and the keys that are left."""
    table = parsed.root
    for depth, key in enumerate(path):
        entry = table.entries.get(key)
        if entry is None or not isinstance(entry.value, MappingNode):
            return table, path[depth:]
        # An insertion would appear wherever the anchor is used.
        if parsed.text_from(entry.value).startswith("*"):
            raise CannotInsertError(f"`{key}` is written once and used here by its anchor ({entry.value.span})")
        table = entry.value
    return table, ()


def _insert_below_empty(
    parsed: ParsedText, holder: MappingNode, entry: MappingEntry, element: NewElement
) -> Iterator[str]:
    """Insert the element below a key without a value."""
    line = parsed.lines[entry.key_span.end_line - 1].rstrip("\r\n")
    is_empty = isinstance(entry.value, ScalarNode) and entry.value.value is None
    if (
        not is_empty
        or not _EMPTY_VALUE.match(line[entry.key_span.end_column - 1 :])
        or parsed.text_from(holder).startswith("{")
    ):
        raise CannotInsertError(f"`{entry.key}` is not a mapping that is written out ({entry.key_span})")
    indent_width = _indent_width(parsed.root)
    indent = " " * (entry.key_span.column - 1 + indent_width)
    yield _join_lines(
        parsed,
        _end_of_comments(parsed, entry.key_span.end_line, len(indent)),
        element.to_block(indent, indent_width),
        is_spaced=False,
    )


def _insert_in_block(parsed: ParsedText, table: MappingNode, element: NewElement) -> Iterator[str]:
    """Insert the element behind the last one of a block."""
    entries = list(table)
    if not entries:
        yield _join_lines(parsed, len(parsed.lines), element.to_block("", _DEFAULT_INDENT), is_spaced=False)
        return
    last_entry = entries[-1]
    indent = " " * (last_entry.key_span.column - 1)
    indent_width = _indent_width(MappingNode({last_entry.key: last_entry}, table.span), _indent_width(parsed.root))
    compact_element = element.without_empty_keys()
    may_be_short = len(entries) > 1 or table is not parsed.root
    in_braces = may_be_short and parsed.text_from(last_entry.value).startswith("{") and _is_all_braces(parsed, entries)
    lines = [indent + compact_element.to_flow()] if in_braces else element.to_block(indent, indent_width)
    # A block's span may end at the beginning of the line behind it.
    end = last_entry.value.span.end_line - (
        1 if last_entry.value.span.end_column == 1 and last_entry.value.span.end_line > last_entry.key_span.line else 0
    )
    is_spaced = has_blank_lines(parsed, entries)
    trimmed = end
    while trimmed > last_entry.key_span.line and not parsed.lines[trimmed - 1].strip():
        trimmed -= 1
    # Blank lines at the end belong to a block text (`|+`) or to the layout: the proof tells which, so both are tried.
    for line in dict.fromkeys(
        (_end_of_comments(parsed, trimmed, len(indent)), _end_of_comments(parsed, end, len(indent)))
    ):
        yield _join_lines(parsed, line, lines, is_spaced=is_spaced)


def _is_all_braces(parsed: ParsedText, entries: list[MappingEntry]) -> bool:
    """Return whether everything in a block is written in braces or in short form, each on one line."""
    return all(
        not isinstance(entry.value, MappingNode)
        or (parsed.text_from(entry.value).startswith("{") and entry.value.span.end_line == entry.key_span.line)
        for entry in entries
    )


def find_place_in_braces(parsed: ParsedText, table: MappingNode, element_text: str) -> tuple[int, str]:
    """Return where an element goes before a closing brace, and its text, on a line of its own where the others have one."""
    text = "".join(parsed.lines)
    entries = list(table)
    if not entries:
        opening = parsed.offset_of(table.span.line, table.span.column)
        return text.index("{", opening) + 1, element_text
    last_entry = entries[-1]
    end = parsed.offset_of(last_entry.value.span.end_line, last_entry.value.span.end_column)
    comma = _UNTIL_COMMA.match(text, end)
    position = comma.end() if comma else end
    indentation = parsed.lines[last_entry.key_span.line - 1][: last_entry.key_span.column - 1]
    separator = f"{parsed.line_ending}{indentation}" if not indentation.strip() else " "
    return position, ("" if comma else ",") + separator + element_text


def _end_of_comments(parsed: ParsedText, line: int, column: int) -> int:
    """Return the line behind which to insert: comments that are indented as far belong to what is above them."""
    end = line
    for number in range(line, len(parsed.lines)):
        text = parsed.lines[number]
        stripped = text.lstrip(" ")
        if stripped.startswith("#") and len(text) - len(stripped) >= column:
            if column:
                end = number + 1
        elif stripped.strip():
            break
    return end


def has_blank_lines(parsed: ParsedText, entries: Sequence[MappingEntry]) -> bool:
    """Return whether blank lines separate the elements of a block."""
    number = entries[-1].key_span.line - 1
    while number > 0 and parsed.lines[number - 1].lstrip().startswith("#"):
        number -= 1
    return number > 0 and not parsed.lines[number - 1].strip()


def _indent_width(table: MappingNode, default_width: int = _DEFAULT_INDENT) -> int:
    """Return how many columns a file indents by: those of its first mapping that is written below its key."""
    for entry in table:
        if isinstance(entry.value, MappingNode) and entry.value.entries:
            first_entry = next(iter(entry.value))
            if first_entry.key_span.line > entry.key_span.line and first_entry.key_span.column > entry.key_span.column:
                return first_entry.key_span.column - entry.key_span.column
    return default_width


def _join_lines(parsed: ParsedText, line_count: int, lines: list[str], *, is_spaced: bool) -> str:
    """Return the text with lines inserted behind a line."""
    ending = parsed.line_ending
    before, after = "".join(parsed.lines[:line_count]), "".join(parsed.lines[line_count:])
    if before and before[-1] not in "\r\n":
        before += ending
    if is_spaced and before and parsed.lines[line_count - 1].strip():
        before += ending
    return before + "".join(f"{line}{ending}" for line in lines) + after
