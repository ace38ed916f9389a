"""Bring a slice up to date with data from elsewhere: what people wrote around it stays, comments in particular."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, NamedTuple

from archgen.diagnostics.diagnostic import Diagnostic, Severity
from archgen.frozen import dataclass
from archgen.merge.slice_merge import SliceVersions, merge_slices
from archgen.project.slice_parsing import parse_slice
from archgen.syntax.yaml_parser import list_comments
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode, SequenceNode, YamlDocument, YamlNode
from archgen.syntax.yaml_writer import PlainText

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
