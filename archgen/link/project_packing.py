"""Pack a project: its merged slices as plain data, with everything from other files put in.

The packed file must give the same report as the folder (docs/decisions/0002-packed-attachments.md).
"""

from __future__ import annotations

import base64
from collections.abc import Iterable, Mapping
from dataclasses import field

from archgen.frozen import dataclass
from archgen.model.architecture import Architecture
from archgen.model.message_types import ConceptualType
from archgen.syntax.yaml_tree import IgnoreComment, MappingEntry, MappingNode, ScalarNode, SequenceNode, YamlNode

DataPath = tuple[str | int, ...]
_BARE_KEYS = frozenset(
    {"archgen", "optional", "conditional", "cores", "threads", "depth", "every", "priority", "core"},
)
"""Keys whose values are numbers or booleans; everything else outside of parameters is text."""
_RAW_KEYS = frozenset({"parameters", "calls"})
"""Keys below which values keep the kind that they were written in."""


@dataclass(slots=True)
class PackedProject:
    """A project as one mapping, and the ignore comments by the path of the value that each belongs to."""

    data: dict[str, object] = field(default_factory=dict)
    comments: dict[DataPath, str] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class PackedAttachments:
    """The contents of files other than YAML.

    The project's own interfaces by full name, its chapters by path, and the pictures in the chapters by path.
    """

    definitions: Mapping[str, str] = field(default_factory=dict)
    texts: Mapping[str, str] = field(default_factory=dict)
    pictures: Mapping[str, bytes] = field(default_factory=dict)


def pack_project(
    root: MappingNode, architecture: Architecture, ignores: Iterable[IgnoreComment], attachments: PackedAttachments
) -> PackedProject:
    """Return the packed project."""
    # Comments are found by their line and taken out of this dict as their elements are packed.
    pending_ignores = {(ignore.span.file, ignore.span.line): ignore for ignore in ignores}
    packed_project = PackedProject()
    project_data = _pack_mapping(root, (), packed_project.comments, pending_ignores, is_raw=False)
    project_identity = {"id": architecture.project.id, "title": architecture.project.title}
    project_data["archgen"] = 1
    project_data["project"] = {**project_identity, **_copy_dict(project_data.get("project"))}
    # A packed file is the whole project: nothing may send its readers to other files.
    project_data.pop("sources", None)
    ros = {key: value for key, value in _copy_dict(project_data.get("ros")).items() if key != "interfaces"}
    if attachments.definitions:
        ros["definitions"] = {**_copy_dict(ros.get("definitions")), **attachments.definitions}
    report = _copy_dict(project_data.get("report"))
    if attachments.texts:
        report["texts"] = dict(attachments.texts)
    if attachments.pictures:
        report["pictures"] = {
            path: base64.b64encode(data).decode("ascii") for path, data in attachments.pictures.items()
        }
    types = _copy_dict(project_data.get("types"))
    # Of the shipped type mapper, what the project uses: another version of archgen may map these types differently.
    types |= {
        t.name: _pack_type(t) for t in architecture.types.values() if t.origin == "shipped" and t.name not in types
    }
    optional_sections = {"ros": ros, "report": report, "types": types}
    project_data |= {key: value for key, value in optional_sections.items() if value}
    first_keys = ("archgen", "project")
    packed_project.data = {key: project_data[key] for key in first_keys} | {
        key: project_data[key] for key in project_data if key not in first_keys
    }
    return packed_project


def _copy_dict(value: object) -> dict[str, object]:
    return dict(value) if isinstance(value, dict) else {}


def _pack_type(shipped_type: ConceptualType) -> dict[str, object]:
    keys = ("message", "comment", "status", "request", "response", "feedback")
    data: dict[str, object] = {key: getattr(shipped_type, key) for key in keys if getattr(shipped_type, key)}
    return data | ({"size": str(shipped_type.size)} if shipped_type.size else {})


def _pack_value(
    node: YamlNode,
    path: DataPath,
    comments: dict[DataPath, str],
    pending_ignores: dict[tuple[str, int], IgnoreComment],
    *,
    is_raw: bool,
) -> object:
    if isinstance(node, MappingNode):
        return _pack_mapping(node, path, comments, pending_ignores, is_raw=is_raw)
    if isinstance(node, SequenceNode):
        items = []
        for number, item in enumerate(node.items):
            _attach_comment(item.span.file, item.span.line, (*path, number), comments, pending_ignores)
            items.append(_pack_value(item, (*path, number), comments, pending_ignores, is_raw=is_raw))
        return items
    return _pack_scalar(node, is_raw=is_raw)


def _pack_scalar(scalar: ScalarNode, *, is_raw: bool) -> object:
    # As text `1.10` stays `1.10`; as a number it would become 1.1.
    return scalar.value if is_raw else scalar.text


def _pack_mapping(
    mapping: MappingNode,
    path: DataPath,
    comments: dict[DataPath, str],
    pending_ignores: dict[tuple[str, int], IgnoreComment],
    *,
    is_raw: bool,
) -> dict[str, object]:
    data: dict[str, object] = {}
    # An entry before what is in it: of several values on one line the outermost gets the comment.
    for entry in mapping:
        entry_path = (*path, entry.key)
        _attach_comment(entry.key_span.file, entry.key_span.line, entry_path, comments, pending_ignores)
        data[entry.key] = _pack_value(
            entry.value, entry_path, comments, pending_ignores, is_raw=is_raw or _holds_raw_values(entry)
        )
    return data


def _holds_raw_values(entry: MappingEntry) -> bool:
    return entry.key in _RAW_KEYS or (entry.key in _BARE_KEYS and isinstance(entry.value, ScalarNode))


def _attach_comment(
    file: str,
    line: int,
    path: DataPath,
    comments: dict[DataPath, str],
    pending_ignores: dict[tuple[str, int], IgnoreComment],
) -> None:
    """Attach the ignore comment of a line to the first value on that line; it is taken out of `pending_ignores`."""
    ignore = pending_ignores.pop((file, line), None)
    if ignore is not None:
        comments[path] = f"archgen: ignore[{', '.join(ignore.rules)}] {ignore.why}".rstrip()
