"""The tree of a YAML file: mappings, sequences and scalars, each with its span. Built by `yaml_parser` in one walk.

Nodes are mutable: validation takes wrong values out of the tree, and short forms are replaced in place.

Resolve unquoted scalars by YAML 1.2's core schema, so that `no`, `on` and `1:30` are text.

PyYAML's own resolver follows YAML 1.1, where these are False, True and 90.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator, Mapping, Sequence

from archgen.diagnostics import Span
from archgen.frozen import dataclass

PlainValue = str | int | float | bool | None


@dataclass(slots=True)
class ScalarNode:
    """A scalar. `text` is what was written, with quotes and blocks resolved.

    `value` is what YAML 1.2's core schema makes of it: quoted and block scalars are text; an empty plain scalar, `~`
    and `null` are None. `is_plain` is whether it was written without quotes and not as a block.
    """

    value: PlainValue
    text: str
    span: Span
    is_plain: bool = True


@dataclass(slots=True)
class SequenceNode:
    """A sequence of nodes, in brackets or line by line."""

    items: list[YamlNode]
    span: Span


@dataclass(slots=True)
class MappingEntry:
    """One key of a mapping with its value. `key_span` is the span of the key alone."""

    key: str
    key_span: Span
    value: YamlNode

    def with_value(self, value: YamlNode) -> MappingEntry:
        """Return the key, where it is written, with another value."""
        return MappingEntry(self.key, self.key_span, value)

    def with_entries(self, entries: dict[str, MappingEntry]) -> MappingEntry:
        """Return the key, where it is written, with a mapping of other entries in the place of its value."""
        return self.with_value(MappingNode(entries, self.value.span))

    def change_each(self, change: EntryChange) -> MappingEntry:
        """Return the key with a mapping whose entries are changed; itself where none is, or where it has none."""
        changed = self.value.change_each(change) if isinstance(self.value, MappingNode) else self.value
        return self if changed is self.value else self.with_value(changed)

    def change_keys(self, changes: Mapping[str, EntryChange]) -> MappingEntry:
        """Return the key with a mapping in which what stands at some keys is changed."""
        return self.change_each(lambda entry: changes.get(entry.key, _keep)(entry))

    def keep_items(self, is_kept: Callable[[YamlNode], bool]) -> MappingEntry | None:
        """Return the key with what stays of its list, or of its only item; None where nothing does."""
        items = self.value.items if isinstance(self.value, SequenceNode) else [self.value]
        kept = [item for item in items if is_kept(item)]
        if len(kept) == len(items):
            return self
        return self.with_value(SequenceNode(kept, self.value.span)) if kept else None


EntryChange = Callable[[MappingEntry], MappingEntry | None]
"""Makes of an entry another; of one that goes, None."""


def _keep(entry: MappingEntry) -> MappingEntry:
    return entry


@dataclass(slots=True)
class MappingNode:
    """A mapping: its entries by key, in the order in which they were written."""

    entries: dict[str, MappingEntry]
    span: Span
    declares: bool = True
    """Whether it may declare the element that it is about: what a path with dots leads to is declared elsewhere."""

    def get(self, key: str) -> YamlNode | None:
        """Return the value at a key, or None."""
        entry = self.entries.get(key)
        return entry.value if entry else None

    def with_entries(self, entries: dict[str, MappingEntry]) -> MappingNode:
        """Return the mapping, where it is written, with other entries."""
        return MappingNode(entries, self.span, self.declares)

    def without(self, *keys: str) -> MappingNode:
        """Return the mapping without some keys."""
        return MappingNode({key: entry for key, entry in self.entries.items() if key not in keys}, self.span)

    def change_each(self, change: EntryChange) -> MappingNode:
        """Return the mapping with its entries changed, itself where none is; the mapping itself is not changed."""
        kept = {entry.key: new for entry in self if (new := change(entry)) is not None}
        is_same = len(kept) == len(self.entries) and all(kept[entry.key] is entry for entry in self)
        return self if is_same else self.with_entries(kept)

    def change_keys(self, changes: Mapping[str, EntryChange]) -> MappingNode:
        """Return the mapping with what stands at some keys changed."""
        return self.change_each(lambda entry: changes.get(entry.key, _keep)(entry))

    def __iter__(self) -> Iterator[MappingEntry]:
        """Iterate over the entries (not the keys), in order."""
        return iter(self.entries.values())


YamlNode = ScalarNode | SequenceNode | MappingNode


@dataclass(frozen=True, slots=True)
class IgnoreComment:
    """A comment `# archgen: ignore[rule, other] why` with the rules that it names."""

    rules: tuple[str, ...]
    why: str
    span: Span


@dataclass(slots=True)
class YamlDocument:
    """One parsed file."""

    file: str
    root: MappingNode
    ignores: tuple[IgnoreComment, ...] = ()


def list_spans(node: YamlNode) -> Iterator[Span]:
    """Yield the spans of all keys and scalars in a tree."""
    if isinstance(node, MappingNode):
        for entry in node:
            yield entry.key_span
            yield from list_spans(entry.value)
    elif isinstance(node, SequenceNode):
        for item in node.items:
            yield from list_spans(item)
    else:
        yield node.span


def find_value(node: YamlNode | None, *path: str) -> YamlNode | None:
    """Return what stands in a tree at a path of keys, None where it leads nowhere."""
    for key in path:
        if not isinstance(node, MappingNode):
            return None
        node = node.get(key)
    return node


def list_entries(node: YamlNode | None, *path: str) -> tuple[MappingEntry, ...]:
    """Return the entries of the mapping that stands in a tree at a path of keys; of anything else none."""
    found = find_value(node, *path)
    return tuple(found) if isinstance(found, MappingNode) else ()


def change_at(node: YamlNode, path: Sequence[str], change: Callable[[YamlNode], YamlNode]) -> YamlNode:
    """Return a tree with what stands at a path of keys changed; `*` stands for each key. The tree itself is not changed."""
    if not path:
        return change(node)
    if not isinstance(node, MappingNode):
        return node
    changed = {
        entry.key: entry.with_value(value)
        for entry in node
        if path[0] in {"*", entry.key} and (value := change_at(entry.value, path[1:], change)) is not entry.value
    }
    return node.with_entries({**node.entries, **changed}) if changed else node


def node_to_data(node: YamlNode) -> object:
    """Turn a tree into dicts, lists and plain values as the core schema reads them."""
    if isinstance(node, MappingNode):
        return {entry.key: node_to_data(entry.value) for entry in node}
    if isinstance(node, SequenceNode):
        return [node_to_data(item) for item in node.items]
    return node.value


def copy_node(node: YamlNode, span: Span) -> YamlNode:
    """Copy a node for an alias. Later stages change trees in place, so two places must never share a node."""
    if isinstance(node, ScalarNode):
        return ScalarNode(node.value, node.text, span, node.is_plain)
    if isinstance(node, SequenceNode):
        return SequenceNode([copy_node(item, item.span) for item in node.items], span)
    return MappingNode({e.key: MappingEntry(e.key, e.key_span, copy_node(e.value, e.value.span)) for e in node}, span)


MAX_DIGITS = 30
"""Longer integers stay text: no element needs them, and converting them takes time that grows with their square."""
NON_TEXT_STARTS = frozenset("0123456789+-.~nNtTfF")
"""The characters that a scalar other than text can begin with; `resolve_scalar` is not called for any other."""
_SPECIAL_WORDS: dict[str, PlainValue] = {
    "~": None,
    **dict.fromkeys(("null", "Null", "NULL"), None),
    **dict.fromkeys(("true", "True", "TRUE"), True),
    **dict.fromkeys(("false", "False", "FALSE"), False),
    **dict.fromkeys((".inf", ".Inf", ".INF", "+.inf", "+.Inf", "+.INF"), math.inf),
    **dict.fromkeys(("-.inf", "-.Inf", "-.INF"), -math.inf),
    **dict.fromkeys((".nan", ".NaN", ".NAN"), math.nan),
}
_NUMBER_PATTERN = re.compile(
    r"(?P<int>[-+]?[0-9]+)|0o(?P<oct>[0-7]+)|0x(?P<hex>[0-9a-fA-F]+)"
    r"|(?P<float>[-+]?(?:\.[0-9]+|[0-9]+(?:\.[0-9]*)?)(?:[eE][-+]?[0-9]+)?)"
)
_NUMBER_BASES = {"int": 10, "oct": 8, "hex": 16}


def resolve_scalar(text: str) -> PlainValue:
    """Return the value of a plain scalar, which must not be empty."""
    if text in _SPECIAL_WORDS:
        return _SPECIAL_WORDS[text]
    match = _NUMBER_PATTERN.fullmatch(text)
    if match is None:
        return text
    if match.lastgroup == "float":
        number = float(text)
        # 1e999 would be infinite though nobody wrote .inf: it stays text, and the schema then refuses it.
        return number if math.isfinite(number) else text
    base = _NUMBER_BASES[match.lastgroup or "int"]
    return int(match[match.lastgroup or "int"], base) if len(text) <= MAX_DIGITS else text
