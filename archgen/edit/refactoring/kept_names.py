"""Names that follow from ids, written out so that they stay when the ids change: titles, messages, nodes, topics."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product

from archgen.checking.reference_index import Element
from archgen.diagnostics import Span
from archgen.edit import edit_proof
from archgen.edit.edit_proof import NewElement
from archgen.edit.element_edit import (
    BYTE_ORDER_MARK,
    CannotInsertError,
    EditRefusedError,
    FileEdit,
    propose_texts,
    read_editable,
)
from archgen.edit.refactoring.judged_version import JudgedVersion, judge_edited
from archgen.edit.refactoring.model_proof import RenamedIds, find_followers
from archgen.frozen import NamedTuple
from archgen.model.architecture import Architecture
from archgen.model.node import Endpoint
from archgen.syntax import yaml_parser
from archgen.syntax.yaml_tree import MappingNode, YamlNode

_TOPIC_KEYS = {"publishes": "topic", "subscribes": "topic", "serves": "name", "calls": "name"}
"""The key of a port at a node that says what it is called on the wire."""


class KeptNames(NamedTuple):
    """Which names stay as they are."""

    topics: bool = False
    message: bool = False
    title: bool = False
    chapters: bool = False
    owner: bool = False


KEEP_NONE = KeptNames()


class _Insertion(NamedTuple):
    """A key to be written: below which element, by further keys, and its value."""

    element: Element
    path: tuple[str, ...]
    key: str
    value: str | tuple[str, ...]


def keep_names(
    version: JudgedVersion, edited: JudgedVersion, edits: tuple[FileEdit, ...], renamed: RenamedIds, kept: KeptNames
) -> tuple[FileEdit, ...]:
    """Return the edits with the names that are kept written out. Raise EditRefusedError where one cannot be."""
    insertions = list(dict.fromkeys(_list_insertions(version, edited, renamed, kept)))
    edits_by_file = {edit.file: edit for edit in edits}
    for insertion in insertions:
        # Each makes another text: places are looked up anew.
        edit = _insert(version, edited, edits_by_file, insertion)
        edits_by_file[edit.file] = edit
        edited = judge_edited(version, {each.file: each.new_content for each in edits_by_file.values()})
    followers = find_followers(version.project.architecture, edited.project.architecture, renamed)
    left = (
        *(followers.nodes + followers.carriers if kept.topics else ()),
        *(followers.messages if kept.message else ()),
    )
    if left or edited.project.reading_errors:
        message = f"`{left[0][0]}` cannot be kept" if left else edited.project.reading_errors[0].message
        raise EditRefusedError(message, "write the name out first, then rename")
    return tuple(edits_by_file[file] for file in sorted(edits_by_file))


def _list_insertions(
    version: JudgedVersion, edited: JudgedVersion, renamed: RenamedIds, kept: KeptNames
) -> Iterator[_Insertion]:
    old, new = version.project.architecture, edited.project.architecture
    for (kind, old_id), element in renamed.pairs.items():
        if kept.owner and kind == "component":
            was_owners, new_owners = (
                _find_owners(each, name) for each, name in ((version, old_id), (edited, element[1]))
            )
            if was_owners and was_owners != new_owners:
                yield _Insertion(element, (), "owner", was_owners[0] if len(was_owners) == 1 else was_owners)
        if kept.title and not old_id.startswith("<"):
            was, is_now = find_title(version, kind, old_id), find_title(edited, *element)
            if was is not None and was != is_now:
                yield _Insertion(element, (), "title", was)
        if kept.message and kind == "type":
            was_type, new_type = old.types.get(old_id), new.types.get(element[1])
            if was_type and new_type and was_type.message and was_type.message != new_type.message:
                yield _Insertion(element, (), "message", was_type.message)
    if kept.topics:
        yield from _list_wire_names(old, new, renamed)


def _list_wire_names(old: Architecture, new: Architecture, renamed: RenamedIds) -> Iterator[_Insertion]:
    followers = find_followers(old, new, renamed)
    old_names = {after: before for before, after in followers.nodes}
    old_topics = {after: before for before, after in followers.carriers}
    for node in new.nodes.values():
        if node.full_name in old_names:
            yield _Insertion(("node", node.id), (), "name", old_names[node.full_name].rpartition("/")[2])
    for endpoint in new.endpoints:
        # Who reads takes the name from who writes.
        if endpoint.name in old_topics and endpoint.port and not (endpoint.name_written or endpoint.sources):
            path = (endpoint.use, _name_port(endpoint, len(new.nodes[endpoint.node].implements)))
            yield _Insertion(("node", endpoint.node), path, _TOPIC_KEYS[endpoint.use], old_topics[endpoint.name])


def _name_port(endpoint: Endpoint, component_count: int) -> str:
    """Return the key of a port at its node: with its component where there are several."""
    words = (endpoint.port or "").split(".")
    return ".".join(words[-1:] if component_count == 1 else words[-2:])


def _find_owners(version: JudgedVersion, component_id: str) -> tuple[str, ...]:
    architecture = version.project.architecture
    component = architecture.components.get(component_id) or architecture.shells.get(component_id)
    return component.owners if component else ()


def find_title(version: JudgedVersion, kind: str, element_id: str) -> str | None:
    """Return the title of an element, None for kinds that have none."""
    architecture = version.project.architecture
    sections = (
        (architecture.components, architecture.shells)
        if kind == "component"
        else (getattr(architecture, f"{kind}s", {}),)
    )
    return next((getattr(each[element_id], "title", None) for each in sections if element_id in each), None)


def _insert(
    version: JudgedVersion, edited: JudgedVersion, edits_by_file: dict[str, FileEdit], insertion: _Insertion
) -> FileEdit:
    """Return the edit of a file with a key written below an element. Raise EditRefusedError."""
    kind, element_id = insertion.element
    by_hand = f"write `{insertion.key}: {insertion.value}` at the {kind.replace('_', ' ')} first, then rename"
    names = edited.index.list_names(kind, element_id)
    # What a variant says counts there alone: the project itself goes before.
    for in_variant, name in product((False, True), names):
        file = name.span.file
        known = edits_by_file.get(file)
        old_content, text = (
            (known.old_content, known.new_content.decode()) if known else read_editable(version.project, file)
        )
        mark = BYTE_ORDER_MARK if text.startswith(BYTE_ORDER_MARK) else ""
        plain_text = text.removeprefix(mark)
        document, _ = yaml_parser.parse_yaml(file, plain_text)
        path = _find_path(document.root, name.span) if document and name.is_declaration and name.is_exact else None
        if path is None or (path[0] == "variants") != in_variant:
            continue
        *outer, last = (*path, *insertion.path, insertion.key)
        element = NewElement(last, insertion.value)
        try:
            for candidate in propose_texts(file, plain_text, tuple(outer), element):
                if edit_proof.adds_only_element(plain_text, candidate, tuple(outer), element):
                    line = known.line if known else name.span.line
                    return FileEdit(file, old_content, (mark + candidate).encode(), line)
        except CannotInsertError:
            continue
    message = f"`{insertion.value}` cannot be kept: `{element_id}` is written in a form that takes no further key"
    raise EditRefusedError(message, by_hand)


def _find_path(node: YamlNode, span: Span) -> tuple[str, ...] | None:
    """Return the keys that lead to one that is written at a place; None where there is none."""
    for entry in node if isinstance(node, MappingNode) else ():
        if entry.key_span[:2] == span[:2] and entry.key_span.column <= span.column < entry.key_span.end_column:
            return (entry.key,)
        inner = _find_path(entry.value, span)
        if inner is not None:
            return (entry.key, *inner)
    return None
