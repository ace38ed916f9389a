"""What an earlier import of the same files left in a folder: its slices, the ids that people know, and the places."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

from archgen.edit import slice_update
from archgen.frozen import dataclass
from archgen.syntax.file_patterns import YAML_ENDINGS
from archgen.syntax.folder_files import FolderFiles
from archgen.syntax.project_files import read_text_file

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
            slices[path.name] = slice_update.read_slice_content(path.name, text).data
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
