"""The outline of an open file: its elements as symbols, and what can be folded."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from lsprotocol import types
from pygls.workspace import PositionCodec

from archgen.diagnostics import Span
from archgen.language.key_paths import OWN_DATA, SLICE, find_inner_part
from archgen.live.edited_project import EditedProject
from archgen.lsp.text_positions import to_range
from archgen.schema.written_names import DECLARING_PARTS
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode, SequenceNode, YamlNode

SYMBOL_KINDS = {
    "group": types.SymbolKind.Module,
    "component": types.SymbolKind.Class,
    "component_type": types.SymbolKind.Interface,
    "input": types.SymbolKind.Field,
    "output": types.SymbolKind.Event,
    "node": types.SymbolKind.Object,
    "type": types.SymbolKind.Struct,
    "requirement": types.SymbolKind.String,
    "chain": types.SymbolKind.Function,
}
"""Kinds of elements in an editor's words; others are constants."""
_Element = tuple[MappingEntry, str, "list[_Element]"]
"""A section or an element with its kind, and what it holds."""


def list_symbols(project: EditedProject, file: str, codec: PositionCodec) -> list[types.DocumentSymbol]:
    """Return the sections of an open file with their elements."""
    root = project.warm.read_tree(file)

    def write(element: _Element) -> types.DocumentSymbol:
        entry, kind, inner = element
        title = entry.value.get("title") if isinstance(entry.value, MappingNode) else entry.value
        return types.DocumentSymbol(
            name=entry.key or " ",
            detail=title.text.partition("\n")[0] if isinstance(title, ScalarNode) else None,
            kind=SYMBOL_KINDS.get(kind, types.SymbolKind.Constant) if kind else types.SymbolKind.Namespace,
            range=to_range(_measure_entry(project, entry), project.line_of, codec),
            selection_range=to_range(entry.key_span, project.line_of, codec),
            children=list(map(write, inner)),
        )

    return list(map(write, _list_elements(root, SLICE))) if root else []


def _list_elements(node: YamlNode, part: str) -> Iterator[_Element]:
    """Yield the elements below a node; at the top the sections."""
    for entry in node if isinstance(node, MappingNode) else ():
        inner_part = find_inner_part(part, entry.key)
        inner = _list_elements(entry.value, inner_part) if inner_part != OWN_DATA else ()
        if part == SLICE or part in DECLARING_PARTS:
            yield entry, DECLARING_PARTS.get(part, ""), list(inner)
        else:
            yield from inner


def _measure_entry(project: EditedProject, entry: MappingEntry) -> Span:
    """Return the span of a key with its value, to the last line in which something of it stands."""
    start, end = entry.key_span, entry.value.span
    line, column = max((start.end_line, start.end_column), (end.end_line, end.end_column))
    while line > start.line and not (project.line_of(start.file, line) or "")[: column - 1].strip():
        line -= 1
        column = len(project.line_of(start.file, line) or "") + 1
    return Span(start.file, start.line, start.column, line, column)


def list_folds(project: EditedProject, file: str) -> list[types.FoldingRange]:
    """Return the lines that can be folded: blocks below a key, and comments of several lines."""
    root = project.warm.read_tree(file)
    spans = {_measure_entry(project, entry) for entry in _list_entries(root)} if root else set()
    folds = {(span.line, span.end_line): None for span in sorted(spans) if span.end_line > span.line}
    lines = re.split(r"\r\n|\r|\n", project.warm.text_of(file) or "")
    comments = dict.fromkeys(_list_comments(lines), types.FoldingRangeKind.Comment)
    return [types.FoldingRange(first - 1, last - 1, kind=kind) for (first, last), kind in {**folds, **comments}.items()]


def _list_entries(node: YamlNode) -> Iterator[MappingEntry]:
    for part in node if isinstance(node, MappingNode) else ():
        yield part
        yield from _list_entries(part.value)
    for item in node.items if isinstance(node, SequenceNode) else ():
        yield from _list_entries(item)


def _list_comments(lines: Sequence[str]) -> Iterator[tuple[int, int]]:
    """Yield the first and the last line of each comment of several lines."""
    first = 0
    for number, line in enumerate((*lines, ""), 1):
        is_comment = line.lstrip(" ").startswith("#")
        if is_comment and not first:
            first = number
        elif first and not is_comment:
            if number - first > 1:
                yield first, number - 1
            first = 0
