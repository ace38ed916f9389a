"""A proposed configuration written into the files of a project: a patch, proven by reading it and analysing it anew."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from fractions import Fraction

from archgen import pipeline
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
from archgen.model.node import Node
from archgen.pipeline import CheckedProject
from archgen.project.project_loading import load_from_files
from archgen.syntax import yaml_parser
from archgen.syntax.project_files import OverlaidFiles
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, find_value, node_to_data
from archgen.syntax.yaml_writer import format_flow, format_scalar
from archgen.timing.chains.chain_bounds import bound_all_chains
from archgen.timing.figures.figure_wording import format_duration
from archgen.timing.run_analysis import analyse_architecture
from archgen.timing.search.change_trials import TriedChange
from archgen.timing.search.proposals import TriedConfiguration
from archgen.timing.system.activity_builder import name_activities

_Path = tuple[str, ...]


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


def plan_patch(
    checked_project: CheckedProject, configuration: TriedConfiguration, variants: Sequence[str] = ()
) -> tuple[FileEdit, ...]:
    """Return the files as a configuration wants them. Raise EditRefusedError where that is not sure to be what was analysed."""
    changes_by_file: dict[str, list[ValueChange]] = {}
    planner = _PatchPlanner(checked_project)
    for change in configuration.changes:
        for file, value_change in planner.locate_change(change):
            changes_by_file.setdefault(file, []).append(value_change)
    edits = tuple(_edit_file(checked_project, file, changes) for file, changes in changes_by_file.items())
    _prove(checked_project, edits, configuration, variants)
    return edits


class _PatchPlanner:
    def __init__(self, checked_project: CheckedProject) -> None:
        self._documents = checked_project.loaded_project.documents
        self._architecture = checked_project.architecture
        self._owners = {name: key for key, name in name_activities(self._architecture).items()}

    def locate_change(self, change: TriedChange) -> Iterator[tuple[str, ValueChange]]:
        """Yield what a change is in the files. Raise EditRefusedError where it has no place."""
        if change.key == "container":
            yield self._leave_container(self._architecture.nodes[change.element])
            return
        key = change.key.removeprefix("timing.")
        value: object = change.value[1:-1].split(",") if change.value.startswith("[") else int(change.value)
        for path_choices in self._list_timing_paths(change.element):
            if key == "trigger":
                yield from self._replace_clock(path_choices, value)
            else:
                file, path = self._find_place(path_choices, key)
                yield file, ValueChange(path, key, value)

    def _leave_container(self, node: Node) -> tuple[str, ValueChange]:
        path = ("nodes", node.id)
        file, _ = self._find_place([path], "container", must_exist=True)
        if self._find_file([path], "host") or node.host is None:
            return file, ValueChange(path, "container", None)
        return file, ValueChange(path, "host", node.host, "container")

    def _replace_clock(self, path_choices: Sequence[_Path], value: object) -> Iterator[tuple[str, ValueChange]]:
        """Yield what puts a trigger in the place of a rate or a period."""
        clock_key = next((key for key in ("rate", "period") if self._find_file(path_choices, key)), "rate")
        file, path = self._find_place(path_choices, clock_key, must_exist=True)
        yield file, ValueChange(path, "trigger", value, clock_key)
        if self._find_file(path_choices, "behaviour"):
            file, path = self._find_place(path_choices, "behaviour")
            yield file, ValueChange(path, "behaviour", "event")

    def _list_timing_paths(self, element: str) -> Iterator[list[_Path]]:
        """Yield for each activity of an element the mappings in which its timing may be written, the likeliest first."""
        node = self._architecture.nodes.get(element)
        component = None if node else self._owners[element][1]
        node = node or self._architecture.nodes[self._owners[element][0]]
        node_path = ("nodes", node.id, "timing")
        if len(node.implements) <= 1 or (component is None and self._follow(node_path)):
            own_paths = [path for each in node.implements for path in _list_component_paths(each)]
            yield [node_path, *(own_paths if len(node.implements) == 1 else [])]
            return
        for each in node.implements if component is None else (component,):
            yield list(_list_component_paths(each))

    def _find_place(self, paths: Sequence[_Path], key: str, *, must_exist: bool = False) -> tuple[str, _Path]:
        """Return the file and the path at which a key is written, or else is to be. Raise EditRefusedError."""
        place = self._find_file(paths, key)
        if place is None and not must_exist:
            for ending in (0, 1):
                for path in paths:
                    file = self._follow(path[: len(path) - ending])
                    if file:
                        return file, path
        if place is None:
            message = f"no file of the project says `{key}` of `{paths[0][1]}` in a place of its own"
            raise EditRefusedError(message)
        return place

    def _find_file(self, paths: Sequence[_Path], key: str) -> tuple[str, _Path] | None:
        return next(((file, path) for path in paths if (file := self._follow((*path, key)))), None)

    def _follow(self, path: _Path) -> str | None:
        """Return the file in which something is written at a path."""
        return next((each.file for each in self._documents if find_value(each.root, *path) is not None), None)


def _list_component_paths(component: str) -> Iterator[_Path]:
    """Yield where a component's timing may be written: its path in one key, or in one mapping inside of another."""
    group, _, inner = component.partition(".")
    yield ("groups", group, "components", inner, "timing")
    if "." in inner:
        yield ("groups", group, *(key for part in inner.split(".") for key in ("components", part)), "timing")


def _edit_file(checked_project: CheckedProject, file: str, changes: Sequence[ValueChange]) -> FileEdit:
    content, text = read_editable(checked_project, file)
    plain_text = text.removeprefix(BYTE_ORDER_MARK)
    try:
        new_text = text[: len(text) - len(plain_text)] + change_values(file, plain_text, changes)
    except CannotInsertError as error:
        raise EditRefusedError(str(error)) from None
    return FileEdit(file, content, new_text.encode(), 0)


def _prove(
    checked_project: CheckedProject,
    edits: Sequence[FileEdit],
    configuration: TriedConfiguration,
    variants: Sequence[str],
) -> None:
    """Read the project with the edits, and hold its chains against what was analysed. Raise EditRefusedError."""
    files = checked_project.loaded_project.files
    overlaid = OverlaidFiles(files.root, {edit.file: edit.new_content for edit in edits}, files)
    changed = pipeline.judge_project(load_from_files(overlaid, first_file_of(checked_project)))
    errors = tuple(list_new_errors(checked_project, changed))
    if errors:
        message = "with it the project would have errors that it does not have now"
        raise EditRefusedError(message, errors=errors)
    architecture = pipeline.stand_in_variants(changed, variants).architecture if variants else changed.architecture
    chains = bound_all_chains(analyse_architecture(architecture), architecture)
    for name, bound in configuration.bounds.items():
        slack, deadline = chains[name].slack, chains[name].deadline
        found = None if slack is None or deadline is None or deadline.value is None else deadline.value - slack
        if found != bound:
            message = f"what is written decides otherwise: `{name}` would take {_write(found)}, not {_write(bound)}"
            raise EditRefusedError(message)


def _write(bound: Fraction | None) -> str:
    return "no bound" if bound is None else format_duration(bound)


_Splice = tuple[int, int, str]
"""What stands from one position to another in a text is replaced."""


def change_values(file: str, text: str, changes: Sequence[ValueChange]) -> str:
    """Return a text with some values changed, proven to say nothing else. Raise CannotInsertError."""
    parsed = parse_text(file, text)
    expected = node_to_data(parsed.root)
    for change in changes:
        expected = change.apply_to(expected)
    new_text = text
    for start, end, replacement in sorted(_list_splices(parsed, changes), reverse=True):
        new_text = new_text[:start] + replacement + new_text[end:]
    document, _ = yaml_parser.parse_yaml(file, new_text)
    if document is None or node_to_data(document.root) != expected:
        msg = f"{file} is written in a way in which more than these values would change"
        raise CannotInsertError(msg)
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
            msg = (
                f"`{missing_keys[0]}` is not a mapping that is written out ({holder.entries[missing_keys[0]].key_span})"
            )
            raise CannotInsertError(msg)
        new_values = values
        for key in reversed(missing_keys):
            new_values = {key: new_values}
        yield _find_insertion(parsed, holder, [f"{format_scalar(k)}: {format_flow(v)}" for k, v in new_values.items()])


def _find_replacement(parsed: ParsedText, entry: MappingEntry, change: ValueChange) -> _Splice:
    span = entry.value.span
    if parsed.text_from(entry.value).startswith("*") or span.end_line != span.line:
        msg = f"`{entry.key}` is not written as a plain value on one line ({entry.key_span})"
        raise CannotInsertError(msg)
    value_text = format_flow(change.value)
    end = parsed.offset_of(span.end_line, span.end_column)
    if change.replaced_key is None:
        return parsed.offset_of(span.line, span.column), end, value_text
    return parsed.offset_of(entry.key_span.line, entry.key_span.column), end, f"{change.key}: {value_text}"


def _find_removal(parsed: ParsedText, holder: MappingNode, entry: MappingEntry) -> _Splice:
    """Return an entry with what separates it from the next one, or with its line."""
    if not parsed.text_from(holder).startswith("{"):
        if entry.value.span.end_line != entry.key_span.line:
            msg = f"`{entry.key}` is written on several lines ({entry.key_span})"
            raise CannotInsertError(msg)
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
        msg = f"nothing stands there yet ({holder.span})"
        raise CannotInsertError(msg)
    anchor = short_entries[-1] if short_entries else entries[0]
    line = anchor.key_span.line + (1 if short_entries else 0)
    position = sum(map(len, parsed.lines[: line - 1]))
    indent = " " * (anchor.key_span.column - 1)
    inserted = "".join(f"{indent}{entry}{parsed.line_ending}" for entry in entry_texts)
    is_at_open_end = position == sum(map(len, parsed.lines)) and not parsed.lines[-1].endswith(("\n", "\r"))
    return position, position, (parsed.line_ending + inserted.rstrip("\r\n")) if is_at_open_end else inserted
