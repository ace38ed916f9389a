"""What an earlier import of the same files left in a folder: its slices, the ids that people know, and the places.

Bring a slice up to date with data from elsewhere: what people wrote around it stays, comments in particular.

What an import brings that the project says already: nothing stands in two files, and what differs is told.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

from archgen.diagnostics.diagnostic import Diagnostic, Severity
from archgen.frozen import NamedTuple, dataclass
from archgen.merge.slice_merge import SliceVersions, merge_slices
from archgen.project.slice_parsing import parse_slice
from archgen.syntax.file_patterns import YAML_ENDINGS
from archgen.syntax.folder_files import FolderFiles
from archgen.syntax.project_files import read_text_file
from archgen.syntax.yaml_parser import list_comments
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode, SequenceNode, YamlDocument, YamlNode
from archgen.syntax.yaml_writer import PlainText

_PLACE_KEYS = frozenset({"from", "implements", "connects"})
"""Keys whose values name components by their groups."""
_TOOLS = {"xmi": "uml"}
"""What `hints` call the tools whose ids an import leaves there, by format where it has another name."""


@dataclass(frozen=True, slots=True)
class ImportOrigin:
    """Where slices come from: the format, and the names of the files, as a comment at the top of each slice says."""

    format_name: str
    file_names: tuple[str, ...]
    arguments: tuple[str, ...] = ()
    """Launch arguments as they were given, `NAME:=VALUE`: with others the same file is another model."""

    @property
    def tool(self) -> str:
        """Return what `hints` call the tool."""
        return _TOOLS.get(self.format_name, self.format_name)

    @property
    def header(self) -> str:
        """Return the first line of each slice."""
        names = " ".join(" ".join(word.split()) for word in (*self.file_names, *self.arguments))
        return f"# From {names} by `archgen import {self.format_name}`; with --merge it is brought up to date.\n"

    def is_of(self, text: str) -> bool:
        """Whether a slice says that it comes from these files, in any order, among the comments at its top."""
        wanted = sorted(self.header.split())
        for line in text.splitlines():
            if line.strip() and not line.startswith("#"):
                return False
            if sorted(line.split()) == wanted:
                return True
        return False


def read_earlier_import(folder: Path, origin: ImportOrigin) -> dict[str, Mapping[str, Any]]:
    """Return the slices in a folder that come from these files, by their names. What cannot be read is left out."""
    if not folder.is_dir():
        return {}
    files = FolderFiles(folder)
    slices: dict[str, Mapping[str, Any]] = {}
    for path in sorted(path for ending in YAML_ENDINGS for path in folder.glob(f"*{ending}")):
        text = read_text_file(files, path.name).text if path.is_file() else ""
        if origin.is_of(text):
            slices[path.name] = read_slice_content(path.name, text).data
    return slices


def list_known_ids(slices: Mapping[str, Mapping[str, Any]], tool: str) -> dict[str, str]:
    """Return the ids of elements by those that they have in another tool (`hints: {uml: {id: ...}}`)."""
    known: dict[str, str] = {}
    for data in slices.values():
        for element_id, tool_id in _walk_hints(data, tool):
            known.setdefault(tool_id, element_id)
    return known


def _walk_hints(data: Mapping[str, Any], tool: str) -> Iterator[tuple[str, str]]:
    """Yield the id of each element with that in another tool."""
    for key, value in data.items():
        if isinstance(value, Mapping):
            if tool_id := read_tool_id(value, tool):
                yield key, tool_id
            yield from _walk_hints(value, tool)


def read_tool_id(body: Mapping[str, Any], tool: str) -> str:
    """Return the id that an element has in another tool; empty where nothing says it."""
    hints = body.get("hints")
    own = hints.get(tool) if isinstance(hints, Mapping) else None
    tool_id = own.get("id") if isinstance(own, Mapping) else None
    return tool_id if isinstance(tool_id, str) else ""


def keep_places(
    old: Mapping[str, Mapping[str, Any]], new: Mapping[str, Mapping[str, Any]], tool: str
) -> tuple[dict[str, Mapping[str, Any]], dict[str, str]]:
    """Return new slices whose components stand in the groups where they stand now, and the moves that this undoes.

    The groups are the project's: others refer to components by them, and people may have sorted them anew.
    """
    old_places = _list_places(old.values(), tool)
    # Where another component of the model stands by now, none can stay.
    taken = {f"{group}.{name}" for data in new.values() for group, name, _ in _list_components(data)}
    moves = {
        place: old_places[tool_id]
        for tool_id, place in _list_places(new.values(), tool).items()
        if old_places.get(tool_id, place) not in taken
    }
    if not moves:
        return dict(new), {}
    slices = {name: _rename_places(data, moves) for name, data in new.items()}
    for data in slices.values():
        groups = data.get("groups")
        if isinstance(groups, dict):
            for place, old_place in moves.items():
                _move_component(groups, place, old_place)
    return slices, moves


def _list_places(slices: Iterable[Mapping[str, Any]], tool: str) -> dict[str, str]:
    """Return group and id of each component that stands directly in a group, by its id in another tool."""
    places: dict[str, str] = {}
    for data in slices:
        for group_id, name, body in _list_components(data):
            if tool_id := read_tool_id(body, tool):
                places.setdefault(tool_id, f"{group_id}.{name}")
    return places


def _list_components(data: Mapping[str, Any]) -> Iterator[tuple[str, str, Mapping[str, Any]]]:
    """Yield group, id and body of each component that stands directly in a group."""
    for group_id, group in _read_mapping(data.get("groups")).items():
        for name, body in _read_mapping(_read_mapping(group).get("components")).items():
            yield group_id, name, _read_mapping(body)


def _read_mapping(value: object) -> Mapping[str, Any]:
    return value if isinstance(value, Mapping) else {}


def _move_component(groups: dict[str, Any], place: str, old_place: str) -> None:
    group_id, _, name = place.partition(".")
    old_group, _, old_name = old_place.partition(".")
    components = groups[group_id]["components"]
    groups.setdefault(old_group, {}).setdefault("components", {})[old_name] = components.pop(name)
    if not components:
        del groups[group_id]


def _rename_places(value: Any, moves: Mapping[str, str], *, names_places: bool = False) -> Any:  # noqa: ANN401 - plain data
    """Return plain data in which what names components names them where they stand."""
    if isinstance(value, Mapping):
        return {key: _rename_places(each, moves, names_places=key in _PLACE_KEYS) for key, each in value.items()}
    if isinstance(value, list):
        return [_rename_places(each, moves, names_places=names_places) for each in value]
    if names_places and isinstance(value, str):
        words = value.split(".")
        place = ".".join(words[:2])
        return ".".join((moves[place], *words[2:])) if place in moves else value
    return value


@dataclass(frozen=True, slots=True)
class SliceContent:
    """What a slice says, as texts in normal form, and why it cannot be read: then it says nothing."""

    data: dict[str, Any]
    diagnostics: tuple[Diagnostic, ...] = ()
    entries: tuple[MappingEntry, ...] = ()
    """Its sections as they are written."""


def read_slice_content(file: str, text: str) -> SliceContent:
    """Return what the text of a slice says."""
    if not text.strip():
        return SliceContent({})
    parsed_slice = parse_slice(file, text)
    document = parsed_slice.document
    diagnostics = (*parsed_slice.diagnostics, *parsed_slice.validate_once().diagnostics)
    if document is None or any(each.severity in {None, Severity.ERROR} for each in diagnostics):
        return SliceContent({}, diagnostics)
    return SliceContent({entry.key: to_texts(entry.value) for entry in document.root}, (), tuple(document.root))


def to_texts(node: YamlNode) -> Any:  # noqa: ANN401 - any value of the language
    """Return a value as it is written: `1.10` is not 1.1."""
    if isinstance(node, MappingNode):
        return {entry.key: to_texts(entry.value) for entry in node}
    if isinstance(node, SequenceNode):
        return [to_texts(item) for item in node.items]
    if not isinstance(node, ScalarNode) or node.value is None:
        return None
    return node.text if isinstance(node.value, str) else PlainText(node.text)


@dataclass(frozen=True, slots=True)
class UpdatedText:
    """The new text of a slice. `is_rewritten`: comments could not stay in their places, and stand at its beginning."""

    text: str
    is_rewritten: bool = False


def update_slice_text(old_text: str, base: str, new: str) -> UpdatedText:
    """Return a slice with what is new in it. `base` and `new` are its content before and now, as archgen writes it."""
    if base == new:
        return UpdatedText(old_text)
    merged = merge_slices(SliceVersions(base, ours=old_text, theirs=new))
    if isinstance(merged, str):
        return UpdatedText(merged)
    return UpdatedText("".join(f"{comment}\n" for comment in list_comments(old_text)) + new, is_rewritten=True)


KeyPath = tuple[str, ...]


class SaidValue(NamedTuple):
    """A value of the project, and the file that says it."""

    value: object
    file: str


class LeftOut(NamedTuple):
    """A slice without what other files say: equal values are gone, `differences` are told, one line each."""

    data: dict[str, Any]
    differences: list[str]


def list_said_values(documents: Iterable[YamlDocument], own_files: frozenset[str]) -> dict[KeyPath, SaidValue]:
    """Return the values of a project by their paths, but for those of some files."""
    return {
        path: SaidValue(value, entry.key_span.file)
        for document in documents
        for entry in document.root
        if entry.key_span.file not in own_files
        for path, value in _list_leaves(to_texts(entry.value), (entry.key,))
    }


def leave_out_said(
    data: Mapping[str, Any], normal_data: Mapping[str, Any], said: Mapping[KeyPath, SaidValue]
) -> LeftOut:
    """Return a slice without the values that other files say. `normal_data` is what it says in normal form."""
    leaves_below: dict[KeyPath, list[tuple[KeyPath, object]]] = defaultdict(list)
    for path, value in _list_leaves(normal_data, ()):
        for end in range(1, len(path) + 1):
            leaves_below[path[:end]].append((path, value))
    differences: list[str] = []

    def leave_out(part: Mapping[str, Any], place: KeyPath) -> dict[str, Any]:
        kept: dict[str, Any] = {}
        for key, value in part.items():
            path = (*place, key)
            leaves = leaves_below[path]
            if isinstance(value, Mapping) and value:
                if inner := leave_out(value, path):
                    kept[key] = inner
            elif not leaves or any(leaf not in said for leaf, _ in leaves):
                kept[key] = value
            else:
                differences.extend(_describe_differences(leaves, said))
        return kept

    return LeftOut(leave_out(data, ()), differences)


def _describe_differences(leaves: Iterable[tuple[KeyPath, object]], said: Mapping[KeyPath, SaidValue]) -> Iterator[str]:
    for path, value in leaves:
        if str(said[path].value) != str(value):
            yield f"{'.'.join(path)}: `{said[path].value}` in {said[path].file}, `{value}` here"


def _list_leaves(value: object, path: KeyPath) -> Iterator[tuple[KeyPath, object]]:
    """Yield what is written once in a project: all that is no mapping, or an empty one."""
    if isinstance(value, Mapping) and value:
        for key, inner in value.items():
            yield from _list_leaves(inner, (*path, key))
    elif value is not None:
        yield path, value
