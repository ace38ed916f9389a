"""Remedies of a comparison with a robot written into the project: each proven to leave all else as it is, by comparing it
anew.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

from archgen import pipeline
from archgen.conformance.endpoint_comparison import ModelRemedy
from archgen.diagnostics import NO_SPAN, Span
from archgen.edit.edit_proof import first_file_of, list_new_errors
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
from archgen.project.project_loading import load_from_files
from archgen.syntax import yaml_parser
from archgen.syntax.project_files import OverlaidFiles
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode, YamlNode, find_value, node_to_data
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


FindingNames = frozenset[tuple[str, str]]
"""Rules and messages of what a comparison finds."""
_Path = tuple[str, ...]
_LocatedRemedy = tuple[ModelRemedy, str, tuple[ValueChange, ...]]
"""A remedy with its file, and what changes in it."""


@dataclass(frozen=True, slots=True)
class Adoption:
    """The files as the robot wants them, the remedies that are in them now, and those that are not, with the reason."""

    edits: tuple[FileEdit, ...] = ()
    adopted: tuple[ModelRemedy, ...] = ()
    left_out: tuple[tuple[ModelRemedy, str], ...] = ()


def plan_adoption(
    checked_project: CheckedProject, remedies: Iterable[ModelRemedy], compare: Callable[[CheckedProject], FindingNames]
) -> Adoption:
    """Plan all remedies together, else as many as stand the proof; `compare` finds in what a project differs from the robot.

    Proven is: the project has no error that it did not have, the finding of each remedy is gone, and no other one came.
    """
    trees = dict(_parse_own_files(checked_project))
    written_paths: dict[Span, _Path] = {}
    for tree in trees.values():
        for at, path in _list_written(tree):
            written_paths.setdefault(at, path)
    # Several robots may ask for the same.
    distinct = {(each.node, each.path, repr(each.values)): each for each in remedies}
    located: list[_LocatedRemedy] = []
    left_out: list[tuple[ModelRemedy, str]] = []
    for remedy in distinct.values():
        place = _locate_remedy(trees, written_paths, remedy)
        if place is None:
            left_out.append((remedy, f"no file of the project says `{remedy.node}` below `nodes`"))
        else:
            located.append((remedy, *place))
    prover = _Prover(checked_project, compare)
    edits: tuple[FileEdit, ...] = ()
    adopted: list[_LocatedRemedy] = []
    # All together; where one of them is wrong, half as many, and twice as many again behind it.
    count = len(located)
    while located:
        batch, others = located[:count], located[count:]
        tried_edits, refusal = prover.try_remedies([*adopted, *batch])
        if not refusal:
            edits, adopted, located, count = tried_edits, [*adopted, *batch], others, count * 2
        elif len(batch) == 1:
            left_out.append((batch[0][0], refusal))
            located = others
        else:
            count = len(batch) // 2
    return Adoption(edits, tuple(each[0] for each in adopted), tuple(left_out))


class _Prover:
    """Reads, checks and compares the project with remedies in it."""

    def __init__(self, checked_project: CheckedProject, compare: Callable[[CheckedProject], FindingNames]) -> None:
        self._project = checked_project
        self._compare = compare
        self._before = compare(checked_project)

    def try_remedies(self, located: Sequence[_LocatedRemedy]) -> tuple[tuple[FileEdit, ...], str]:
        """Return the files with the remedies in them, or none and why not."""
        changes: dict[str, list[ValueChange]] = {}
        for _, file, file_changes in located:
            changes.setdefault(file, []).extend(file_changes)
        try:
            edits = tuple(edit_file(self._project, file, each) for file, each in changes.items())
        except EditRefusedError as error:
            return (), error.message
        files = self._project.loaded_project.files
        overlaid = OverlaidFiles(files.root, {each.file: each.new_content for each in edits}, files)
        changed = pipeline.judge_project(load_from_files(overlaid, first_file_of(self._project)))
        if errors := list(list_new_errors(self._project, changed)):
            return (), f"with it `archgen check` would say: {errors[0].message}"
        found = self._compare(changed)
        if new := sorted(found - self._before):
            return (), f"with it the robot would differ otherwise: {new[0][1]}"
        if any((each.rule, each.message) in found for each, _, _ in located if each.rule):
            return (), "what is written elsewhere decides: it would change nothing"
        return edits, ""


def _parse_own_files(checked_project: CheckedProject) -> Iterator[tuple[str, MappingNode]]:
    """Yield the trees of the project's own files as they are written: those of a checked project have no short forms."""
    for file in checked_project.yaml_files:
        text = checked_project.sources.text_of(file)
        if text is not None and file not in checked_project.loaded_project.library_files:
            document, _ = yaml_parser.parse_yaml(file, text)
            if document is not None:
                yield file, document.root


def _locate_remedy(
    trees: Mapping[str, MappingNode], written_paths: Mapping[Span, _Path], remedy: ModelRemedy
) -> tuple[str, tuple[ValueChange, ...]] | None:
    """Return in which file a remedy is written, and what changes there; None where no file has its node."""
    written = written_paths.get(remedy.at) if remedy.at != NO_SPAN else None
    if written is not None:
        (value,) = remedy.values.values()
        return remedy.at.file, (ValueChange(written[:-1], written[-1], value),)
    path = ("nodes", remedy.node, *remedy.path)
    depths = {file: _count_written(root, path) for file, root in trees.items()}
    file = max(depths, key=lambda each: depths[each], default="")
    if not file or depths[file] < len(("nodes", remedy.node)):
        return None
    return file, tuple(_list_changes(trees[file], path, remedy))


def _list_changes(root: MappingNode, path: _Path, remedy: ModelRemedy) -> Iterator[ValueChange]:
    """Yield what a remedy puts at a path, where an entry may stand in short form."""
    old = find_value(root, *path)
    values = dict(remedy.values)
    if remedy.short_key and not isinstance(old, MappingNode):
        old_value = node_to_data(old) if old is not None else None
        entry = {**({} if old_value is None else {remedy.short_key: old_value}), **values}
        yield ValueChange(path[:-1], path[-1], entry[remedy.short_key] if entry.keys() == {remedy.short_key} else entry)
        return
    for key, value in values.items():
        inner = find_value(root, *path, key)
        if not isinstance(value, dict):
            yield ValueChange(path, key, value)
        elif isinstance(inner, MappingNode):
            yield from (ValueChange((*path, key), name, each) for name, each in value.items())
        else:  # a quality of service in short form is its profile
            profile = node_to_data(inner) if inner is not None else None
            yield ValueChange(path, key, {**({} if profile is None else {"profile": profile}), **value})


def _count_written(node: YamlNode, path: _Path) -> int:
    """Return how far a path is written as mappings."""
    for depth, key in enumerate(path):
        if not isinstance(node, MappingNode) or key not in node.entries:
            return depth
        node = node.entries[key].value
    return len(path)


def _list_written(root: MappingNode) -> Iterator[tuple[Span, _Path]]:
    """Yield the places of plain values, and of the keys before them, with their paths."""
    pending: list[tuple[_Path, MappingNode]] = [((), root)]
    while pending:
        path, mapping = pending.pop()
        for entry in mapping:
            if isinstance(entry.value, MappingNode):
                pending.append(((*path, entry.key), entry.value))
            elif isinstance(entry.value, ScalarNode):
                yield entry.value.span, (*path, entry.key)
                yield entry.key_span, (*path, entry.key)
