"""Three sides of a slice, key by key: what its source said at the last import, what it says now, and what people wrote.

What people changed is theirs; elsewhere the slice follows its source. Where both changed one thing, people's value stays, and that is told.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, Literal

from archgen.diagnostics import Span
from archgen.edit.earlier_import import (
    KeyPath,
    UpdatedText,
    copy_mapping,
    read_slice_content,
    update_slice_text,
)
from archgen.frozen import NamedTuple, dataclass, field
from archgen.merge.change_transfer import to_texts
from archgen.merge.slice_merge import SliceVersions, merge_slices
from archgen.merge.tree_merge import (
    FIELD_ORDER,
    FIELD_PATHS,
    ItemList,
    ItemSet,
    MappingValue,
    MergeConflictError,
    MergedValue,
    ScalarValue,
    merge_values,
    read_merged_value,
)
from archgen.syntax.yaml_tree import MappingNode, ScalarNode, SequenceNode, YamlNode
from archgen.syntax.yaml_writer import write_yaml

ChangeKind = Literal["added", "changed", "removed", "kept", "conflict"]
_ABSENT = object()
_STRUCK_OUT = "people took it out, and it stays out"
_MAX_SHOWN = 80
_COMMON_SHOWN = 15
_NOTHING: dict[str, Any] = {}


class ImportChange(NamedTuple):
    """What became of a key. `kept`: the source does not say it any more, and what people wrote there stays; `conflict`: the source
    says otherwise than before, and so do people, whose value stays. `span` is where people's value stands.
    """

    kind: ChangeKind
    path: KeyPath
    before: str = ""
    now: str = ""
    mine: str = ""
    span: Span | None = None

    def describe(self) -> str:
        """Say it on one line."""
        name = ".".join(self.path)
        old, new = _shorten(self.before, self.now), _shorten(self.now, self.before)
        if self.kind == "kept":
            return f"not said any more, but people wrote there, which stays: {name} ({self.span})"
        if self.kind == "conflict":
            before = f"it was {old}" if old else "it was not said"
            now = f"is {new} now" if new else "is gone"
            mine = f"{_shorten(self.mine, self.now)} of the slice stays ({self.span})" if self.mine else _STRUCK_OUT
            return f"conflict: {name}: {before} and {now}; {mine}"
        if self.kind == "changed":
            return f"changed: {name}: from {old} to {new}"
        value = new if self.kind == "added" else old
        return f"{self.kind}: {name}{f': {value}' if value.startswith('`') else ''}"


def _shorten(text: str, other: str) -> str:
    """Return a value as it is told, from a little before where it differs from another one."""
    common = next((place for place, pair in enumerate(zip(text, other, strict=False)) if pair[0] != pair[1]), 0)
    start = common - _COMMON_SHOWN if common > _MAX_SHOWN // 2 else 0
    shown = f"`... {text[start:].lstrip('`')}" if start else text
    return shown if len(shown) <= _MAX_SHOWN else f"{shown[:_MAX_SHOWN]} ...`"


@dataclass(slots=True)
class SliceMerge:
    """What a slice says then, as texts in normal form, and what came of it."""

    data: dict[str, Any] = field(default_factory=dict)
    changes: list[ImportChange] = field(default_factory=list)
    theirs: list[tuple[KeyPath, object]] = field(default_factory=list)
    """What the source would have to say at some paths, in their order, so that no conflict is left."""
    emptied: list[KeyPath] = field(default_factory=list)
    """What goes with its source, and people had only taken something out of."""

    def merge_nodes(self, nodes: _Nodes, path: KeyPath = ()) -> object:
        """Return what stands at a path then, as texts, or nothing (`_ABSENT`)."""
        _, mine, now = nodes
        old, our, their = nodes.read_values(path)
        if their in (our, old):
            return _to_value(mine)
        hold_entries = all(map(_holds_entries, nodes))
        is_mapping = hold_entries and isinstance(mine, MappingNode)
        if our == old and (now is None or not is_mapping or _has_field_order(path)):
            self._tell("added" if mine is None else "removed" if now is None else "changed", path, nodes)
            return _to_value(now)
        if mine is None or now is None:
            return self._keep_mine(nodes, path, is_mapping=is_mapping)
        try:
            if hold_entries:
                return self._merge_entries(nodes, path, _merge_order(nodes, path))
            value = _write_items(merge_values(old, our, their, path), (mine, now), path)
        except MergeConflictError:
            self._settle("conflict", path, nodes)
            return _to_value(mine)
        self._tell("changed", path, nodes)
        return value

    def _keep_mine(self, nodes: _Nodes, path: KeyPath, *, is_mapping: bool) -> object:
        """Return what people wrote, or nothing, where one side took something away that the other one changed."""
        if not is_mapping:
            self._settle("conflict" if nodes.mine is None else "kept", path, nodes)
            return _to_value(nodes.mine)
        # Only what people wrote into a mapping stays of it, and it is told as one.
        told, settled = len(self.changes), len(self.theirs)
        self.theirs.append((path, {}))
        data = self._merge_entries(nodes, path, [])
        del self.changes[told:]
        if not data:
            del self.theirs[settled:]
            self.emptied.append(path)
        self._tell("kept" if data else "removed", path, nodes)
        return data or _ABSENT

    def _merge_entries(self, nodes: _Nodes, path: KeyPath, order: list[str]) -> dict[str, Any]:
        sides = [node.entries if isinstance(node, MappingNode) else {} for node in nodes]
        keys = dict.fromkeys((*order, *sides[1], *sides[2], *sides[0]))
        entries = {key: _Nodes(*(side[key].value if key in side else None for side in sides)) for key in keys}
        merged = {key: self.merge_nodes(inner, (*path, key)) for key, inner in entries.items()}
        return {key: value for key, value in merged.items() if value is not _ABSENT}

    def _settle(self, kind: ChangeKind, path: KeyPath, nodes: _Nodes) -> None:
        """Tell that people's side counts, which it does in the text where the source says what it said."""
        self._tell(kind, path, nodes)
        self.theirs.append((path, _to_value(nodes.base)))

    def _tell(self, kind: ChangeKind, path: KeyPath, nodes: _Nodes) -> None:
        span = None if nodes.mine is None else nodes.mine.span
        self.changes.append(ImportChange(kind, path, _show(nodes.base), _show(nodes.now), _show(nodes.mine), span))


class _Nodes(NamedTuple):
    """What three sides say at one place, None for nothing."""

    base: YamlNode | None
    mine: YamlNode | None
    now: YamlNode | None

    def read_values(self, path: KeyPath) -> tuple[MergedValue | None, MergedValue | None, MergedValue | None]:
        base, mine, now = (None if node is None else read_merged_value(node, path) for node in self)
        return base, mine, now


def _holds_entries(node: YamlNode | None) -> bool:
    """Whether a node is a mapping, or nothing that one could begin with."""
    return node is None or isinstance(node, MappingNode) or (isinstance(node, ScalarNode) and node.value is None)


def _has_field_order(path: KeyPath) -> bool:
    return path[:1] == ("types",) and path[2:] in FIELD_PATHS


def _merge_order(nodes: _Nodes, path: KeyPath) -> list[str]:
    """Return the fields of a message in the order that all sides say together, nothing elsewhere. Raise MergeConflictError."""
    merged = merge_values(*nodes.read_values(path), path) if _has_field_order(path) else None
    entries = dict(merged.items) if isinstance(merged, MappingValue) else {}
    order = entries.get(FIELD_ORDER)
    return [each.text for each in order.items if isinstance(each, ScalarValue)] if isinstance(order, ItemList) else []


def _to_value(node: YamlNode | None) -> object:
    return _ABSENT if node is None else to_texts(node)


def _write_items(merged: MergedValue | None, nodes: Iterable[YamlNode], path: KeyPath) -> object:
    """Return a merged list as texts, in the order of the nodes where order says nothing."""
    values = {
        read_merged_value(item, path): to_texts(item)
        for node in nodes
        for item in (node.items if isinstance(node, SequenceNode) else [node])
    }
    if isinstance(merged, ItemSet):
        return [value for item, value in values.items() for _ in range(merged.items.count(item))]
    return [values[item] for item in merged.items] if isinstance(merged, ItemList) else _ABSENT


def _show(node: YamlNode | None) -> str:
    """Return a value as it is told; empty where there is none."""
    if node is None:
        return ""
    if isinstance(node, MappingNode):
        return "what stands there"
    words = ", ".join(map(str, to_texts(node))) if isinstance(node, SequenceNode) else node.text
    return f"`{words}`"


@dataclass(frozen=True, slots=True)
class ImportSides:
    """The three sides of a slice as texts, and what its source says now as data, from which `now` was written."""

    base: str
    mine: str
    now: str
    data: Mapping[str, Any]
    comments: Mapping[tuple[str | int, ...], str] = field(default_factory=dict)
    header: str = ""


def merge_import(file: str, sides: ImportSides) -> tuple[SliceMerge, UpdatedText]:
    """Return what a slice says once its source is merged into it, and its text. `file` is its name."""
    contents = [read_slice_content(file, text) for text in (sides.base, sides.mine, sides.now)]
    merge = SliceMerge()
    data = merge.merge_nodes(_Nodes(*(content.root for content in contents)))
    merge.data = data if isinstance(data, dict) else {}
    return merge, _write_merged(sides, merge, contents[1].data, contents[2].data)


def _write_merged(
    sides: ImportSides, merge: SliceMerge, mine: Mapping[str, Any], now: Mapping[str, Any]
) -> UpdatedText:
    wanted = _read_meaning(write_yaml(merge.data))
    if _read_meaning(sides.mine) == wanted:
        return UpdatedText(sides.mine)
    if sides.mine == sides.base:
        return UpdatedText(sides.now)
    their_data = sides.data
    for path, value in merge.theirs:
        their_data = _lay_value(their_data, now, path, value)
    theirs = sides.header + write_yaml(their_data, sides.comments) if merge.theirs else sides.now
    # No merge of texts takes away what one side took away and the other one changed.
    our_data = mine
    for path in merge.emptied:
        our_data = _lay_value(our_data, mine, path, _ABSENT)
    ours = update_slice_text(sides.mine, write_yaml(mine), write_yaml(our_data)).text
    merged = merge_slices(SliceVersions(sides.base, ours, theirs))
    if isinstance(merged, str) and _read_meaning(merged) == wanted:
        return UpdatedText(merged)
    return update_slice_text(sides.mine, write_yaml(mine), write_yaml(merge.data))


def _read_meaning(text: str) -> MergedValue:
    return read_merged_value(read_slice_content("slice", text).root)


def _lay_value(data: Mapping[str, Any], normal: Mapping[str, Any], path: KeyPath, value: object) -> Mapping[str, Any]:
    """Return data with another value at a path. `normal` is the data in normal form: what is short there is written out."""
    if not path:
        return data
    changed = copy_mapping(data, data)
    key, *rest = path
    if rest:
        inner, normal_inner = data.get(key), normal.get(key)
        normal_inner = normal_inner if isinstance(normal_inner, Mapping) else _NOTHING
        inner = inner if isinstance(inner, Mapping) else normal_inner
        changed[key] = _lay_value(inner, normal_inner, tuple(rest), value)
    elif value is _ABSENT:
        changed.pop(key, None)
    else:
        changed[key] = value
    return changed
