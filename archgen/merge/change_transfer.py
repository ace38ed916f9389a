"""Carry the changes between two versions of a slice over to a third text: values replaced, entries added and removed.

What is proposed here is proved by the caller, so that a form of YAML which is not foreseen costs only the proposal.
"""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterator
from dataclasses import dataclass, field

from archgen.merge.tree_merge import ItemSet, merge_values, read_value
from archgen.syntax import yaml_parser
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, SequenceNode, YamlNode, node_to_data
from archgen.syntax.yaml_writer import format_flow, format_scalar

_LINE_BREAK = re.compile(r"\r\n?|\n")
_REST_OF_LINE = re.compile(r"[ \t]*(?:#[^\r\n]*)?(?:\r\n?|\n|\Z)")
_COMMA_BEHIND = re.compile(r"\s*,[ \t]*")
_COMMA_BEFORE = re.compile(r",\s*\Z")


class _PlacedText:
    """A text with its tree; places of the tree become offsets."""

    def __init__(self, text: str, root: MappingNode) -> None:
        self.text = text
        self.root = root
        self._starts = [0, *(line_break.end() for line_break in _LINE_BREAK.finditer(text))]

    def offset_of(self, line: int, column: int) -> int:
        return self._starts[line - 1] + column - 1 if line <= len(self._starts) else len(self.text)

    def line_start(self, offset: int) -> int:
        return self.text.rfind("\n", 0, offset) + 1

    def value_range(self, node: YamlNode) -> tuple[int, int]:
        """Return where a value begins and ends, without blank lines and comments behind it."""
        start = self.offset_of(node.span.line, node.span.column)
        end = self.offset_of(node.span.end_line, node.span.end_column)
        last_value = _last_value(node)
        if last_value is not node and not self.is_flow(node):
            return start, self.value_range(last_value)[1]
        return start, start + len(self.text[start:end].rstrip())

    def entry_range(self, entry: MappingEntry) -> tuple[int, int]:
        start = self.offset_of(entry.key_span.line, entry.key_span.column)
        key_end = self.offset_of(entry.key_span.end_line, entry.key_span.end_column)
        # An empty value stands nowhere: its entry ends with the colon.
        colon = self.text.find(":", key_end) + 1
        return start, max(colon, self.value_range(entry.value)[1])

    def is_flow(self, node: YamlNode) -> bool:
        return self.text.startswith(("{", "["), self.offset_of(node.span.line, node.span.column))

    def entry_lines(self, entry: MappingEntry, *, with_comments: bool) -> tuple[int, int] | None:
        """Return the range of the lines that an entry of a block fills, None where it shares a line with others."""
        start, end = self.entry_range(entry)
        first = self.line_start(start)
        rest = _REST_OF_LINE.match(self.text, end)
        if self.text[first:start].strip() or rest is None:
            return None
        while with_comments and first and self.text[self.line_start(first - 1) : first].lstrip().startswith("#"):
            first = self.line_start(first - 1)
        return first, rest.end()


def _last_value(node: YamlNode) -> YamlNode:
    if isinstance(node, MappingNode) and node.entries:
        return next(reversed(node.entries.values())).value
    return node.items[-1] if isinstance(node, SequenceNode) and node.items else node


@dataclass(slots=True)
class _TextEdits:
    """Replacements in a text, collected while its tree is walked: start, end (exclusive) and the new text."""

    base: _PlacedText
    changed: _PlacedText
    target: _PlacedText
    with_comments: bool
    replacements: list[tuple[int, int, str]] = field(default_factory=list)

    def apply(self) -> str:
        """Return the target's text with all replacements made."""
        text = self.target.text
        # From the end, so that offsets stay right; of insertions at one place the first one collected comes first.
        numbered = sorted(enumerate(self.replacements), key=lambda each: (each[1][0], each[0]), reverse=True)
        for _, (start, end, new_text) in numbered:
            text = text[:start] + new_text + text[end:]
        return text

    def collect_from_mapping(
        self, base: MappingNode, changed: MappingNode, target: MappingNode, path: tuple[str, ...]
    ) -> None:
        """Collect what happened between `base` and `changed`, as replacements in `target`."""
        predecessor = None
        for entry in changed:
            old_value, target_value = base.get(entry.key), target.get(entry.key)
            if old_value is None and target_value is None:
                self._insert_entry(entry, target, predecessor)
            elif old_value is not None and target_value is not None:
                self._collect_from_value(old_value, entry.value, target_value, (*path, entry.key))
            elif target_value is not None and isinstance(entry.value, MappingNode):
                self._collect_from_value(MappingNode({}, entry.key_span), entry.value, target_value, (*path, entry.key))
            if target_value is not None:
                predecessor = target.entries[entry.key]
        for entry in base:
            if entry.key not in changed.entries and entry.key in target.entries:
                self._delete_entry(target.entries[entry.key])

    def _collect_from_value(self, base: YamlNode, changed: YamlNode, target: YamlNode, path: tuple[str, ...]) -> None:
        if read_value(base, path) == read_value(changed, path):
            return
        if isinstance(base, MappingNode) and isinstance(changed, MappingNode) and isinstance(target, MappingNode):
            self.collect_from_mapping(base, changed, target, path)
            return
        start, end = self.target.value_range(target)
        new_text = self._write_value(base, changed, target, path)
        if new_text is not None:
            self.replacements.append((start, end, new_text))

    def _write_value(self, base: YamlNode, changed: YamlNode, target: YamlNode, path: tuple[str, ...]) -> str | None:
        """Return the text of a new value: as it is written in the changed version, if it stands on one line there."""
        merged_value = merge_values(read_value(base, path), read_value(target, path), read_value(changed, path), path)
        if isinstance(merged_value, ItemSet):
            items = {read_value(item): node_to_data(item) for node in (target, changed) for item in _items_of(node)}
            merged_items = frozenset(merged_value.items)
            return format_flow([data for value, data in items.items() if value in merged_items])
        start, end = self.changed.value_range(changed)
        text = self.changed.text[start:end]
        return text if "\n" not in text or self.changed.is_flow(changed) else None

    def _insert_entry(self, entry: MappingEntry, target: MappingNode, predecessor: MappingEntry | None) -> None:
        flow_text = f"{format_scalar(entry.key)}: {format_flow(node_to_data(entry.value))}"
        start, end = self.changed.entry_range(entry)
        source_lines = self.changed.entry_lines(entry, with_comments=self.with_comments)
        if source_lines is None:
            flow_text = self.changed.text[start:end]
        if not target.entries:
            start, end = self.target.value_range(target)
            self.replacements.append((start, end, f"{{{flow_text}}}"))
            return
        neighbour = predecessor or next(reversed(target.entries.values()))
        neighbour_lines = self.target.entry_lines(neighbour, with_comments=False)
        _, neighbour_end = self.target.entry_range(neighbour)
        if neighbour_lines is None or self.target.is_flow(target):
            self.replacements.append((neighbour_end, neighbour_end, f", {flow_text}"))
            return
        block_text = flow_text
        if source_lines is not None:
            block_text = textwrap.dedent(self.changed.text[slice(*source_lines)])
        indented = textwrap.indent(block_text, " " * (neighbour.key_span.column - 1)).rstrip("\r\n") + "\n"
        before = "" if self.target.text[: neighbour_lines[1]].endswith(("\n", "\r")) else "\n"
        self.replacements.append((neighbour_lines[1], neighbour_lines[1], before + indented))

    def _delete_entry(self, entry: MappingEntry) -> None:
        lines = self.target.entry_lines(entry, with_comments=self.with_comments)
        if lines is not None:
            self.replacements.append((*lines, ""))
            return
        start, end = self.target.entry_range(entry)
        comma = _COMMA_BEHIND.match(self.target.text, end)
        if comma is not None:
            self.replacements.append((start, comma.end(), ""))
        else:
            comma_before = _COMMA_BEFORE.search(self.target.text, 0, start)
            self.replacements.append((comma_before.start() if comma_before else start, end, ""))


def _items_of(node: YamlNode) -> list[YamlNode]:
    return node.items if isinstance(node, SequenceNode) else []


def transfer_changes(base: str, changed: str, target: str) -> Iterator[str]:
    """Yield the target's text with what changed between the other two, with and without the comments above entries.

    Nothing is yielded where one of the texts cannot be parsed.
    """
    documents = [yaml_parser.parse_yaml("slice", text)[0] for text in (base, changed, target)]
    placed = [
        _PlacedText(text, document.root)
        for text, document in zip((base, changed, target), documents, strict=True)
        if document
    ]
    if len(placed) < len(documents):
        return
    for with_comments in (True, False):
        edits = _TextEdits(placed[0], placed[1], placed[2], with_comments)
        edits.collect_from_mapping(placed[0].root, placed[1].root, placed[2].root, ())
        yield edits.apply()
