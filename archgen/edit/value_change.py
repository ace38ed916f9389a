"""Values in a file of a project put, replaced or taken out, proven to leave all else that it says as it is."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from archgen.edit.element_edit import (
    BYTE_ORDER_MARK,
    CannotInsertError,
    EditRefusedError,
    FileEdit,
    ParsedText,
    find_holder,
    find_place_in_braces,
    parse_text,
    read_editable,
)
from archgen.frozen import dataclass
from archgen.pipeline import CheckedProject
from archgen.syntax import yaml_parser
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, node_to_data
from archgen.syntax.yaml_writer import format_flow, format_scalar


@dataclass(frozen=True, slots=True)
class ValueChange:
    """A key of the mapping at a path, and its new value; None takes it out. `replaced_key` is the one in whose place it goes."""

    path: tuple[str, ...]
    key: str
    value: object
    replaced_key: str | None = None

    def apply_to(self, data: object) -> object:
        """Return what a file says with the change, as plain data."""
        return _change_data(data, self.path, self)


def edit_file(checked_project: CheckedProject, file: str, changes: Sequence[ValueChange]) -> FileEdit:
    """Return a file of the project with some values changed. Raise EditRefusedError."""
    content, text = read_editable(checked_project, file)
    plain_text = text.removeprefix(BYTE_ORDER_MARK)
    try:
        new_text = text[: len(text) - len(plain_text)] + change_values(file, plain_text, changes)
    except CannotInsertError as error:
        raise EditRefusedError(str(error)) from None
    return FileEdit(file, content, new_text.encode(), 0)


_Splice = tuple[int, int, str]
"""What stands from one position to another in a text is replaced."""


def change_values(file: str, text: str, changes: Sequence[ValueChange]) -> str:
    """Return a text with some values changed, proven to say nothing else. Raise CannotInsertError."""
    parsed = parse_text(file, text)
    expected = node_to_data(parsed.root)
    for change in changes:
        expected = change.apply_to(expected)
    pieces, last_end = [], 0
    for start, end, replacement in sorted(_list_splices(parsed, changes)):
        pieces += [text[last_end:start], replacement]
        last_end = end
    new_text = "".join((*pieces, text[last_end:]))
    document, _ = yaml_parser.parse_yaml(file, new_text)
    if document is None or node_to_data(document.root) != expected:
        raise CannotInsertError(f"{file} is written in a way in which more than these values would change")
    return new_text


def _change_data(data: object, path: Sequence[str], change: ValueChange) -> object:
    mapping = data if isinstance(data, dict) else {}
    if path:
        return {**mapping, path[0]: _change_data(mapping.get(path[0]), path[1:], change)}
    kept = {key: value for key, value in mapping.items() if key not in {change.key, change.replaced_key}}
    return kept if change.value is None else {**kept, change.key: change.value}


def _list_splices(parsed: ParsedText, changes: Iterable[ValueChange]) -> Iterator[_Splice]:
    insertions: dict[tuple[str, ...], dict[str, object]] = {}
    for change in changes:
        holder, missing_keys = find_holder(parsed, change.path)
        old_entry = None if missing_keys else holder.entries.get(change.replaced_key or change.key)
        if old_entry is None:
            insertions.setdefault(change.path, {})[change.key] = change.value
        elif change.value is None:
            yield _find_removal(parsed, holder, old_entry)
        else:
            yield _find_replacement(parsed, old_entry, change)
    for path, values in insertions.items():
        holder, missing_keys = find_holder(parsed, path)
        if missing_keys and missing_keys[0] in holder.entries:
            raise CannotInsertError(
                f"`{missing_keys[0]}` is not a mapping that is written out ({holder.entries[missing_keys[0]].key_span})"
            )
        new_values = values
        for key in reversed(missing_keys):
            new_values = {key: new_values}
        yield _find_insertion(parsed, holder, [f"{format_scalar(k)}: {format_flow(v)}" for k, v in new_values.items()])


def _find_replacement(parsed: ParsedText, entry: MappingEntry, change: ValueChange) -> _Splice:
    span = entry.value.span
    if parsed.text_from(entry.value).startswith("*") or span.end_line != span.line:
        raise CannotInsertError(f"`{entry.key}` is not written as a plain value on one line ({entry.key_span})")
    value_text = format_flow(change.value)
    end = parsed.offset_of(span.end_line, span.end_column)
    if change.replaced_key is None:
        return parsed.offset_of(span.line, span.column), end, value_text
    return parsed.offset_of(entry.key_span.line, entry.key_span.column), end, f"{change.key}: {value_text}"


def _find_removal(parsed: ParsedText, holder: MappingNode, entry: MappingEntry) -> _Splice:
    """Return an entry with what separates it from the next one, or with its line."""
    if not parsed.text_from(holder).startswith("{"):
        if entry.value.span.end_line != entry.key_span.line:
            raise CannotInsertError(f"`{entry.key}` is written on several lines ({entry.key_span})")
        line = entry.key_span.line
        return parsed.offset_of(line, 1), parsed.offset_of(line, 1) + len(parsed.lines[line - 1]), ""
    entries = list(holder)
    place = next(number for number, each in enumerate(entries) if each.key == entry.key)
    start = parsed.offset_of(entry.key_span.line, entry.key_span.column)
    end = parsed.offset_of(entry.value.span.end_line, entry.value.span.end_column)
    if place + 1 < len(entries):
        next_key = entries[place + 1].key_span
        return start, parsed.offset_of(next_key.line, next_key.column), ""
    if place:
        before = entries[place - 1].value.span
        return parsed.offset_of(before.end_line, before.end_column), end, ""
    return start, end, ""


def _find_insertion(parsed: ParsedText, holder: MappingNode, entry_texts: Sequence[str]) -> _Splice:
    """Return where new entries go: behind the last one that stands on a line of its own, or in the braces."""
    if parsed.text_from(holder).startswith("{"):
        position, insertion = find_place_in_braces(parsed, holder, ", ".join(entry_texts))
        return position, position, insertion
    entries = list(holder)
    short_entries = [
        entry for entry in entries if entry.value.span.end_line == entry.key_span.line == entry.value.span.line
    ]
    if not entries:
        raise CannotInsertError(f"nothing stands there yet ({holder.span})")
    anchor = short_entries[-1] if short_entries else entries[0]
    line = anchor.key_span.line + (1 if short_entries else 0)
    position = parsed.offset_of(line, 1)
    indent = " " * (anchor.key_span.column - 1)
    inserted = "".join(f"{indent}{entry}{parsed.line_ending}" for entry in entry_texts)
    is_at_open_end = position == parsed.line_starts[-1] and not parsed.lines[-1].endswith(("\n", "\r"))
    return position, position, (parsed.line_ending + inserted.rstrip("\r\n")) if is_at_open_end else inserted
