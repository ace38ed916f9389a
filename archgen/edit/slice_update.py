"""Bring a slice up to date with data from elsewhere: what people wrote around it stays, comments in particular."""

from __future__ import annotations

from typing import Any

from archgen.diagnostics.diagnostic import Diagnostic, Severity
from archgen.frozen import dataclass
from archgen.merge.slice_merge import SliceVersions, merge_slices
from archgen.project.slice_parsing import parse_slice
from archgen.syntax.yaml_parser import list_comments
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode, SequenceNode, YamlNode
from archgen.syntax.yaml_writer import PlainText


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
