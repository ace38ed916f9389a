"""Carry the changes between two versions of a slice over to a third text: values replaced, entries added and removed.

What is proposed here is proved by the caller, so that a form of YAML which is not foreseen costs only the proposal.
"""

from __future__ import annotations

import re
import textwrap
from collections.abc import Callable, Iterable, Iterator
from functools import lru_cache
from typing import Any

from archgen import schema
from archgen.frozen import dataclass, field
from archgen.merge.tree_merge import ItemSet, KeyRename, merge_values, read_merged_value
from archgen.syntax import yaml_parser
from archgen.syntax.yaml_parser import list_comments
from archgen.syntax.yaml_tree import (
    MappingEntry,
    MappingNode,
    ScalarNode,
    SequenceNode,
    YamlNode,
    find_value,
    node_to_data,
)
from archgen.syntax.yaml_writer import PlainText, format_flow, format_scalar

TreeReader = Callable[[str], MappingNode | None]
"""Reads a text as a whole; None where that cannot be done."""


# As many as are compared at a time in `merge-check`; nobody changes a tree that is read here.
@lru_cache(maxsize=32)
def read_tree(text: str) -> MappingNode | None:
    """Return what a text says as it is written, None where it cannot be read as a whole."""
    document, diagnostics = yaml_parser.parse_yaml("slice", text)
    # A duplicate key costs only itself, so that a document alone does not mean that everything was read.
    if document is None or any(diagnostic.rule != "swallowed-text" for diagnostic in diagnostics):
        return None
    return document.root


def read_normal_tree(text: str) -> MappingNode | None:
    """Return what a text says in normal form, None where it cannot be read as a whole or breaks the schema."""
    document, diagnostics = yaml_parser.parse_yaml("slice", text)
    if document is None or any(diagnostic.rule != "swallowed-text" for diagnostic in diagnostics):
        return None
    if schema.validate_document(document) or schema.normalise_document(document):
        return None
    return document.root


def convert_lines(text: str, line_end: str) -> str:
    """Return a text with other line ends."""
    return text.replace("\r\n", "\n").replace("\n", line_end)


def find_line_end(text: str) -> str:
    """Return how the lines of a text end."""
    return "\r\n" if "\r\n" in text else "\n"


def to_texts(node: YamlNode) -> Any:  # noqa: ANN401 - any value of the language
    """Return a value as it is written: `1.10` is not 1.1."""
    if isinstance(node, MappingNode):
        return {entry.key: to_texts(entry.value) for entry in node}
    if isinstance(node, SequenceNode):
        return [to_texts(item) for item in node.items]
    if not isinstance(node, ScalarNode) or node.value is None:
        return None
    return node.text if isinstance(node.value, str) else PlainText(node.text)


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

    def item_lines(self, item: YamlNode) -> tuple[int, int] | None:
        """Return the range of the lines that an item of a block fills, None within brackets."""
        start, end = self.value_range(item)
        first = self.line_start(start)
        rest = _REST_OF_LINE.match(self.text, end)
        if self.text[first:start].strip() != "-" or rest is None:
            return None
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
            elif target_value is not None:
                # What both sides begin to write begins as nothing: a key that only one of them has, or a blank.
                if _is_empty(old_value) and not _is_empty(target_value):
                    old_value = _make_empty(entry.value)
                if old_value is not None:
                    self._collect_from_value(old_value, entry.value, target_value, (*path, entry.key))
                predecessor = target.entries[entry.key]
        for entry in base:
            if entry.key not in changed.entries and entry.key in target.entries:
                self._delete_entry(target.entries[entry.key])

    def _collect_from_value(self, base: YamlNode, changed: YamlNode, target: YamlNode, path: tuple[str, ...]) -> None:
        if read_merged_value(base, path) == read_merged_value(changed, path):
            return
        if isinstance(base, MappingNode) and isinstance(changed, MappingNode) and isinstance(target, MappingNode):
            self.collect_from_mapping(base, changed, target, path)
            return
        if (
            isinstance(changed, SequenceNode)
            and isinstance(target, SequenceNode)
            and target.items
            and isinstance(read_merged_value(target, path), ItemSet)
        ):
            self._collect_items(_items_of(base), changed.items, target, path)
            return
        start, end = self.target.value_range(target)
        new_text = self._write_value(base, changed, target, path)
        if new_text is not None:
            self.replacements.append((start, end, new_text))

    def _collect_items(
        self, base: list[YamlNode], changed: list[YamlNode], target: SequenceNode, path: tuple[str, ...]
    ) -> None:
        """Collect what came into a list in which order says nothing, and what left it."""
        old_items, new_items = ({read_merged_value(item, path) for item in items} for items in (base, changed))
        target_items = {read_merged_value(item, path) for item in target.items}
        for item in target.items:
            if read_merged_value(item, path) in old_items - new_items:
                self._delete_range(self.target.value_range(item), self.target.item_lines(item))
        for item in changed:
            if read_merged_value(item, path) not in old_items | target_items:
                self._append_item(item, target.items[-1])

    def _append_item(self, item: YamlNode, last_item: YamlNode) -> None:
        source_lines, target_lines = self.changed.item_lines(item), self.target.item_lines(last_item)
        item_text = self.changed.text[slice(*self.changed.value_range(item))]
        if target_lines is None:
            end = self.target.value_range(last_item)[1]
            self.replacements.append((end, end, f", {item_text}"))
            return
        # With the comment behind it.
        line = self.changed.text[slice(*source_lines)].strip() if source_lines else f"- {item_text}"
        self._insert_lines(target_lines[1], line, _count_blanks(self.target.text[slice(*target_lines)]))

    def _write_value(self, base: YamlNode, changed: YamlNode, target: YamlNode, path: tuple[str, ...]) -> str | None:
        """Return the text of a new value: as it is written in the changed version, if it stands on one line there."""
        merged_value = merge_values(
            read_merged_value(base, path), read_merged_value(target, path), read_merged_value(changed, path), path
        )
        if isinstance(merged_value, ItemSet):
            items = {
                read_merged_value(item): node_to_data(item) for node in (target, changed) for item in _items_of(node)
            }
            merged_items = frozenset(merged_value.items)
            return format_flow([data for value, data in items.items() if value in merged_items])
        start, end = self.changed.value_range(changed)
        text = self.changed.text[start:end]
        if isinstance(changed, ScalarNode) and "\n" in text:
            head, _, lines = text.partition("\n")
            indented = textwrap.indent(textwrap.dedent(lines), " " * self._inner_indent(target))
            return self._adopt_lines(f"{head}\n{indented}")
        if "\n" not in text or self.changed.is_flow(changed):
            return text
        return self._write_block_list(changed, target)

    def _write_block_list(self, changed: YamlNode, target: YamlNode) -> str | None:
        """Return a list that is written line by line, as the target writes its own one; None for anything else."""
        if not (isinstance(changed, SequenceNode) and isinstance(target, SequenceNode)):
            return None
        if self.target.is_flow(target):
            return format_flow(node_to_data(changed))
        start, end = self.changed.value_range(changed)
        block_text = textwrap.dedent(self.changed.text[self.changed.line_start(start) : end])
        return self._adopt_lines(textwrap.indent(block_text, " " * (target.span.column - 1)).lstrip(" "))

    def _inner_indent(self, target: YamlNode) -> int:
        """Return by how much further lines of a text are indented: as they are, else two more than its key."""
        start, end = self.target.value_range(target)
        key_line, *lines = self.target.text[self.target.line_start(start) : end].splitlines()
        written_lines = [line for line in lines if line.strip()]
        return min(map(_count_blanks, written_lines)) if written_lines else _count_blanks(key_line) + 2

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
        self._insert_lines(neighbour_lines[1], block_text, neighbour.key_span.column - 1)

    def _insert_lines(self, offset: int, block_text: str, indent: int) -> None:
        indented = textwrap.indent(block_text, " " * indent).rstrip("\r\n") + "\n"
        before = "" if self.target.text[:offset].endswith(("\n", "\r")) else "\n"
        self.replacements.append((offset, offset, self._adopt_lines(before + indented)))

    def _adopt_lines(self, text: str) -> str:
        """Return a text with the line ends of the target, which the changed text need not share."""
        return convert_lines(text, find_line_end(self.target.text))

    def _delete_entry(self, entry: MappingEntry) -> None:
        lines = self.target.entry_lines(entry, with_comments=self.with_comments)
        self._delete_range(self.target.entry_range(entry), lines)

    def _delete_range(self, value_range: tuple[int, int], lines: tuple[int, int] | None) -> None:
        """Delete whole lines, but for comments that the base does not have, else a part of a line with a comma beside it."""
        if lines is not None:
            deleted = self.target.text[slice(*lines)]
            comments = [each for each in list_comments(deleted) if each not in self.base.text]
            indent = " " * _count_blanks(deleted)
            self.replacements.append(
                (*lines, self._adopt_lines("".join(f"{indent}{comment}\n" for comment in comments)))
            )
            return
        start, end = value_range
        comma = _COMMA_BEHIND.match(self.target.text, end)
        if comma is not None:
            self.replacements.append((start, comma.end(), ""))
        else:
            comma_before = _COMMA_BEFORE.search(self.target.text, 0, start)
            self.replacements.append((comma_before.start() if comma_before else start, end, ""))


def _is_empty(node: YamlNode | None) -> bool:
    return node is None or (isinstance(node, ScalarNode) and node.value is None)


def _make_empty(node: YamlNode) -> YamlNode | None:
    """Return what a node was before anything was written into it, None for a scalar."""
    if isinstance(node, ScalarNode):
        return None
    return MappingNode({}, node.span) if isinstance(node, MappingNode) else SequenceNode([], node.span)


def _count_blanks(line: str) -> int:
    return len(line) - len(line.lstrip(" "))


def _items_of(node: YamlNode) -> list[YamlNode]:
    return node.items if isinstance(node, SequenceNode) else []


def rename_keys(text: str, root: MappingNode, renames: Iterable[KeyRename]) -> str:
    """Return a text with other keys; those that it does not have stay out."""
    placed = _PlacedText(text, root)
    replacements = []
    for rename in renames:
        mapping = find_value(root, *rename.path)
        entry = mapping.entries.get(rename.old_key) if isinstance(mapping, MappingNode) else None
        if entry is not None:
            start = placed.offset_of(entry.key_span.line, entry.key_span.column)
            end = placed.offset_of(entry.key_span.end_line, entry.key_span.end_column)
            replacements.append((start, end, format_scalar(rename.new_key)))
    for start, end, new_text in sorted(replacements, reverse=True):
        text = text[:start] + new_text + text[end:]
    return text


def transfer_changes(base: str, changed: str, target: str, read: TreeReader) -> Iterator[str]:
    """Yield the target's text with what changed between the other two, with and without the comments above entries.

    Nothing is yielded where one of the texts cannot be read.
    """
    texts = (base, changed, target)
    placed = [_PlacedText(text, root) for text in texts if (root := read(text)) is not None]
    if len(placed) < len(texts):
        return
    for with_comments in (True, False):
        edits = _TextEdits(placed[0], placed[1], placed[2], with_comments)
        edits.collect_from_mapping(placed[0].root, placed[1].root, placed[2].root, ())
        yield edits.apply()
