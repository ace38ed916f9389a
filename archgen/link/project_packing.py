"""Pack a project: its merged slices as plain data, with everything from other files put in.

The packed file must give the same report as the folder (docs/decisions/0002-packed-attachments.md).
"""

from __future__ import annotations

import base64
import re
from collections import defaultdict
from collections.abc import Iterable, Mapping

from archgen.diagnostics import Diagnostic, Span
from archgen.frozen import dataclass, field
from archgen.language.key_paths import OWN_DATA, SLICE, find_inner_part
from archgen.language.language_tables import BARE_PARTS, DATA_PARTS
from archgen.link.slice_merging import keep_used_libraries, list_supported_elements
from archgen.model.architecture import Architecture
from archgen.model.message_types import ConceptualType
from archgen.syntax.yaml_tree import IgnoreComment, MappingNode, ScalarNode, SequenceNode, YamlNode

DataPath = tuple[str | int, ...]
_PROPERTIES = "properties"
"""The part of facts of people's own at any element."""
_PLAIN_NUMBER = re.compile(r"0|-?[1-9][0-9]{0,14}")


@dataclass(slots=True)
class PackedProject:
    """A project as one mapping, and the ignore comments by the path of the value that each belongs to."""

    data: dict[str, object] = field(default_factory=dict)
    comments: dict[DataPath, str] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class PackedAttachments:
    """The contents of files other than slices.

    The project's own interfaces by full name, its chapters by path, the pictures in the chapters by path, and the
    parameter files of its nodes by name.
    """

    definitions: Mapping[str, str] = field(default_factory=dict)
    texts: Mapping[str, str] = field(default_factory=dict)
    pictures: Mapping[str, bytes] = field(default_factory=dict)
    parameter_texts: Mapping[str, str] = field(default_factory=dict)


class _CommentPlacer:
    """Decides which packed value gets the ignore comment of a line: one line may become several.

    A comment silences what points at its line. `silenced_findings` say where that was, so that each rule goes to the
    value that its finding will point at again; the others (of elements that begin there) to the outermost value.
    """

    def __init__(self, ignores: Iterable[IgnoreComment], silenced_findings: Iterable[Diagnostic]) -> None:
        self._ignores = {(ignore.span.file, ignore.span.line): ignore for ignore in ignores}
        self._rules_by_place: dict[tuple[str, int, int], set[str]] = defaultdict(set)
        for finding in silenced_findings:
            self._rules_by_place[finding.span.file, finding.span.line, finding.span.column].add(finding.rule)
        self._paths_by_place: dict[tuple[str, int, int], DataPath] = {}
        self._first_paths: dict[tuple[str, int], DataPath] = {}

    def visit_value(self, path: DataPath, *spans: Span) -> None:
        """See a value, outer ones before inner ones, with the spans of its key and of itself."""
        for span in spans:
            if (span.file, span.line) in self._ignores:
                self._first_paths.setdefault((span.file, span.line), path)
                # Keys that a short form leaves out have the place of its value: the innermost one is the value.
                self._paths_by_place[span.file, span.line, span.column] = path

    def place_comments(self) -> dict[DataPath, str]:
        """Return the comments by the path of their values."""
        comments: dict[DataPath, str] = {}
        for (file, line), first_path in self._first_paths.items():
            ignore = self._ignores[file, line]
            path_of_rule: dict[str, set[DataPath]] = defaultdict(set)
            for place, path in self._paths_by_place.items():
                if place[:2] == (file, line):
                    for rule in self._rules_by_place.get(place, ()):
                        path_of_rule[rule].add(path)
            rules_at: dict[DataPath, list[str]] = defaultdict(list)
            for rule in ignore.rules:
                for path in path_of_rule.get(rule, {first_path}):
                    rules_at[path].append(rule)
            for path, rules in rules_at.items():
                comments[path] = f"archgen: ignore[{', '.join(rules)}] {ignore.why}".rstrip()
        return comments


def pack_project(  # noqa: PLR0913, PLR0917 - all that a packed file is made of
    root: MappingNode,
    architecture: Architecture,
    ignores: Iterable[IgnoreComment],
    attachments: PackedAttachments,
    silenced_findings: Iterable[Diagnostic] = (),
    variant_architectures: Iterable[Architecture] = (),
) -> PackedProject:
    """Return the packed project. `silenced_findings` are what the comments silence; what only a variant uses of a
    library is packed, too.
    """
    placer = _CommentPlacer(ignores, silenced_findings)
    root = keep_used_libraries(root, (architecture, *variant_architectures))
    project_data = _pack_mapping(root, (), placer, SLICE, is_raw=False)
    packed_project = PackedProject(comments=placer.place_comments())
    project_identity = {"id": architecture.project.id, "title": architecture.project.title}
    _declare_elements(project_data, root, architecture)
    project_data["archgen"] = 1
    project_data["project"] = {**project_identity, **_copy_dict(project_data.get("project"))}
    # A packed file is the whole project: nothing may send its readers to other files.
    project_data.pop("sources", None)
    ros = {key: value for key, value in _copy_dict(project_data.get("ros")).items() if key != "interfaces"}
    if attachments.definitions:
        ros["definitions"] = {**_copy_dict(ros.get("definitions")), **attachments.definitions}
    if attachments.parameter_texts:
        ros["parameter_texts"] = dict(attachments.parameter_texts)
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


def has_packed_path(data: object, path: DataPath) -> bool:
    """Whether packed data hold something at a path."""
    for step in path:
        if isinstance(data, dict) and step in data:
            data = data[step]
        elif isinstance(data, list) and isinstance(step, int) and step < len(data):
            items: list[object] = data
            data = items[step]
        else:
            return False
    return True


def _copy_dict(value: object) -> dict[str, object]:
    return dict(value) if isinstance(value, dict) else {}


def _declare_elements(project_data: Mapping[str, object], root: MappingNode, architecture: Architecture) -> None:
    """Write the titles of elements that nothing in the packed file would declare.

    A file declares an element by its bare id, another adds its tags: merged, only the tags are left to see.
    """
    groups = root.get("groups")
    for group_id, *component_ids in list_supported_elements(groups) if isinstance(groups, MappingNode) else ():
        element_data = _get_dict(_get_dict(project_data, "groups"), group_id)
        for component_id in component_ids:
            element_data = _get_dict(_get_dict(element_data, "components"), component_id)
        elements = architecture.components if component_ids else architecture.groups
        if (element := elements.get(".".join((group_id, *component_ids)))) is not None:
            titled_data = {"title": element.title, **element_data}
            element_data.clear()
            element_data |= titled_data


def _get_dict(data: Mapping[str, object], key: str) -> dict[str, object]:
    value = data[key]
    if not isinstance(value, dict):
        raise TypeError(f"`{key}` holds no mapping")
    return value


def _pack_type(shipped_type: ConceptualType) -> dict[str, object]:
    keys = ("message", "comment", "status", "request", "response", "feedback")
    data: dict[str, object] = {key: getattr(shipped_type, key) for key in keys if getattr(shipped_type, key)}
    return data | ({"size": str(shipped_type.size)} if shipped_type.size else {})


def _pack_value(node: YamlNode, path: DataPath, placer: _CommentPlacer, part: str, *, is_raw: bool) -> object:
    """Pack what stands at a path, where the language has a part. `is_raw` below a part that holds other programs' data."""
    is_raw = is_raw or part in DATA_PARTS
    if isinstance(node, MappingNode):
        return _pack_mapping(node, path, placer, part, is_raw=is_raw)
    if isinstance(node, SequenceNode):
        items = []
        for number, item in enumerate(node.items):
            placer.visit_value((*path, number), item.span)
            item_part = find_inner_part(part, number)
            items.append(_pack_value(item, (*path, number), placer, item_part, is_raw=is_raw))
        return items
    # As text `1.10` stays `1.10`; as a number it would become 1.1.
    return node.value if is_raw or part in BARE_PARTS else node.text


def _pack_mapping(
    mapping: MappingNode, path: DataPath, placer: _CommentPlacer, part: str, *, is_raw: bool
) -> dict[str, object]:
    data: dict[str, object] = {}
    # An entry before what is in it: of several values on one line the outermost gets the comment.
    for entry in mapping:
        entry_path = (*path, entry.key)
        # A scalar is written behind its key, so that a comment about either stands on the line of both.
        placer.visit_value(
            entry_path, entry.key_span, *([entry.value.span] if isinstance(entry.value, ScalarNode) else [])
        )
        entry_part = OWN_DATA if is_raw else find_inner_part(part, entry.key)
        value = _pack_value(entry.value, entry_path, placer, entry_part, is_raw=is_raw)
        if entry_part == _PROPERTIES and isinstance(value, dict):
            value = {name: _write_plain(text) for name, text in value.items()}
        data[entry.key] = value
    return data


def _write_plain(text: object) -> object:
    """Return the value of a property as a number or a boolean where its text stays the same: nobody writes `trl: "5"`."""
    if isinstance(text, str) and _PLAIN_NUMBER.fullmatch(text):
        return int(text)
    return {"true": True, "false": False}.get(text, text) if isinstance(text, str) else text
