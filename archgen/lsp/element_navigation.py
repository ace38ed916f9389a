"""Which element a place in a file means, where else it stands, and what its card says; the outline of a file, and what can
be folded.

archgen counts lines and characters from 1, the protocol from 0, in units that both sides agree on.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence

from lsprotocol import types
from pygls.workspace import PositionCodec

from archgen.checking.reference_index import Element, WrittenName
from archgen.diagnostics import Span
from archgen.frozen import NamedTuple
from archgen.language.key_paths import OWN_DATA, SLICE, find_inner_part
from archgen.language.language_tables import OFFERS
from archgen.link.interface_sources import interface_name_of
from archgen.live.warm_project import EditedProject
from archgen.schema.language_schema import find_part_schema
from archgen.schema.written_names import DECLARING_PARTS
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode, SequenceNode, YamlNode
from archgen.views.elements.annotation_facts import ElementCard
from archgen.views.elements.element_card import make_card
from archgen.views.elements.element_names import elements_by_kind

FindLine = Callable[[str, int], str | None]
"""Returns a line of a file without its end, by its number from 1; None where there is none."""


def to_range(span: Span, find_line: FindLine, codec: PositionCodec) -> types.Range:
    """Return the range of a span; what is nowhere in a text is at its beginning."""
    start = _to_position(span.file, span.line, span.column, find_line, codec)
    return types.Range(start, _to_position(span.file, span.end_line, span.end_column, find_line, codec))


def _to_position(file: str, line: int, column: int, find_line: FindLine, codec: PositionCodec) -> types.Position:
    before = (find_line(file, line) or "")[: max(column - 1, 0)]
    return types.Position(max(line - 1, 0), codec.client_num_units(before))


def to_place(position: types.Position, line_text: str, codec: PositionCodec) -> tuple[int, int]:
    """Return line and column, from 1, of a position; one beyond the end of its line is at the end."""
    units = 0
    for column, character in enumerate(line_text, 1):
        if units >= position.character:
            return position.line + 1, column
        units += codec.client_num_units(character)
    return position.line + 1, len(line_text) + 1


def has_place(span: Span, line: int, column: int) -> bool:
    """Whether a place stands in a span, or right behind it."""
    return (span.line, span.column) <= (line, column) <= (span.end_line, span.end_column)


_HOLDERS = ("component", "group", "library", "use_case", "component_type")
"""What the words before the last one of a path can be, in the order in which it is looked for."""


class FoundName(NamedTuple):
    """An element that a place means, and the name that is written there: of `dvl.velocity` only the word counts."""

    kind: str
    id: str
    name: WrittenName
    word: tuple[int, int]
    """The columns at which its word begins and ends."""

    @property
    def element(self) -> Element:
        """Its kind and id."""
        return self.kind, self.id


def find_element(project: EditedProject, file: str, line: int, column: int) -> FoundName | None:
    """Return the element that is named at a place; None where nothing is."""
    names = project.index.find_at(file, line, column)
    # The shortest name: in `Pair<Angle>` that of the argument.
    for name in sorted(names, key=lambda each: (not each.is_exact, len(each.text), not each.is_declaration)):
        kind, element_id, word = _narrow(project, name, column)
        return FoundName(kind, element_id, name, word)
    return None


def _narrow(project: EditedProject, name: WrittenName, column: int) -> tuple[str, str, tuple[int, int]]:
    """Return what the word at a column of a path means: the whole path, or what holds it."""
    words, whole = name.text.split("."), (name.span.column, name.span.end_column)
    if not name.is_exact or len(words) == 1 or name.span.line != name.span.end_line:
        return name.kind, name.id, whole
    number = min(name.text[: column - name.span.column].count("."), len(words) - 1)
    start = name.span.column + sum(len(word) + 1 for word in words[:number])
    word = start, start + len(words[number])
    behind = len(words) - 1 - number
    holder_id = ".".join(name.id.split(".")[: -behind or None])
    known = (kind for kind in _HOLDERS if behind and project.index.list_names(kind, holder_id))
    kind = next(known, name.kind)
    return (kind, holder_id, word) if kind != name.kind or not behind else (name.kind, name.id, whole)


def list_declarations(project: EditedProject, element: Element) -> list[WrittenName]:
    """Return where something is said of an element: first the place that the model has for it, then further slices."""
    found = _find_model(project, element)
    at = getattr(found[2], "at", None) if found else None
    names = [name for name in project.index.list_names(*element) if name.is_declaration]
    return sorted(names, key=lambda name: at is None or name.span[:3] != at[:3])


def _find_model(project: EditedProject, element: Element) -> tuple[str, str, object] | None:
    """Return the kind of card, the id and the element of the model: the one that is meant, of a part of a component type one in
    an instance.
    """
    kind = element[0].replace("_", " ")
    elements = elements_by_kind(project.checked.architecture)
    inner = element[1].rpartition(">")[2]
    known = [each for _, each in project.index.list_ids(*element)]
    known.sort(key=lambda each: (each != element[1], not each.endswith(inner)))
    kinds = ("composed", kind) if kind == "component" else (kind,)
    return next(
        ((name, each, elements[name][each]) for name in kinds for each in known if each in elements.get(name, ())), None
    )


def list_mentions(project: EditedProject, element: Element) -> Iterator[tuple[WrittenName, Span]]:
    """Yield where an element's own word stands, also in paths of what it holds: the name, and the place of the word."""
    for name, number in project.index.list_names_through(*element):
        words = name.text.split(".")
        if name.is_exact and len(words) > 1:
            start = name.span.column + sum(len(word) + 1 for word in words[:number])
            yield name, name.span._replace(column=start, end_column=start + len(words[number]))
        else:
            yield name, name.span


_MOST_SYMBOLS = 200


def find_declared(project: EditedProject, query: str) -> list[WrittenName]:
    """Return where elements are declared in whose id the letters of a query stand in this order, the closest first."""
    letters = query.casefold()
    declared: dict[Element, WrittenName] = {}
    for name in project.index.names:
        if name.is_declaration and _has_letters(name.id.casefold(), letters):
            declared.setdefault((name.kind, name.id), name)
    ordered = sorted(declared.values(), key=lambda name: (letters not in name.id.casefold(), len(name.id), name.id))
    return ordered[:_MOST_SYMBOLS]


def _has_letters(text: str, letters: str) -> bool:
    remaining = iter(text)
    return all(letter in remaining for letter in letters)


def describe_element(project: EditedProject, element: Element, to_uri: Callable[[str], str]) -> str | None:
    """Return an element's card as Markdown, None for what has no card."""
    found = _find_model(project, element)
    return write_card(make_card(project.lookup, *found[:2]), to_uri) if found else None


def write_card(card: ElementCard, to_uri: Callable[[str], str]) -> str:
    """Write a card as Markdown."""
    title = f" - {_escape(card.title)}" if card.title != card.id else ""
    lines = [f"**{card.kind}** `{card.id}`{title}", ""]
    lines += [f"- {name}: {_escape(value)}" for name, value in card.facts]
    for name, items in card.lists:
        lines.append(f"- {name}:" + ("" if items else " none"))
        lines += [f"  - {_escape(item)}" for item in items]
    if card.span.file:
        lines += ["", f"[{_escape(str(card.span))}]({to_uri(card.span.file)}#L{card.span.line})"]
    return "\n".join(lines)


_MARKDOWN_SIGNS = str.maketrans({sign: f"\\{sign}" for sign in "\\`*_{}[]<>#|"})


def _escape(text: str) -> str:
    return " ".join(text.split()).translate(_MARKDOWN_SIGNS)


def describe_key(project: EditedProject, file: str, line: int, column: int) -> str | None:
    """Return what the language says of the key at a place; None where none of its keys is."""
    for part, text, is_key in _find_part(project, file, line, column):
        schema_part = find_part_schema(part, text) if is_key else {}
        if schema_part.get("description"):
            return f"`{text}` - {schema_part['description']}"
    return None


def describe_message(project: EditedProject, file: str, line: int, column: int) -> str | None:
    """Return the fields of the ROS message, service or action that is named at a place; None where none is."""
    interface = project.checked.architecture.interfaces.definitions.get(
        _find_message(project, file, line, column) or ""
    )
    if interface is None:
        return None
    lines = [f"**{interface.name.split('/')[1]}** `{interface.name}`", ""]
    for name, fields in zip(interface.part_names, interface.parts, strict=True):
        lines += [f"{name}:", ""] if name else []
        lines += [f"- `{each.type}{each.array} {each.name}` {_escape(each.comment)}".rstrip() for each in fields]
    return "\n".join(lines)


def find_named_file(project: EditedProject, file: str, line: int, column: int) -> str | None:
    """Return the file of the project that defines the message at a place, or that is the chapter there."""
    loaded_project = project.checked.loaded_project
    message = _find_message(project, file, line, column)
    if message is not None:
        return next((each for each in loaded_project.interface_files if interface_name_of(each) == message), None)
    for part, text, _ in _find_part(project, file, line, column):
        if "chapters" in OFFERS.get(part, ()) or part == "chapters[]":
            path = text.partition("#")[0]
            return path if path.endswith(".md") and loaded_project.files.has_path(path) else None
    return None


def _find_message(project: EditedProject, file: str, line: int, column: int) -> str | None:
    names = project.checked.architecture.interfaces
    for _, text, is_key in _find_part(project, file, line, column):
        if not is_key and "/" in text:
            return text if text in names.names else names.read_message(text)
    return None


def _find_part(project: EditedProject, file: str, line: int, column: int) -> list[tuple[str, str, bool]]:
    """Return the part of the language that stands at a place, with what is written; of a key that of its mapping."""
    root = project.warm.read_tree(file)
    return list(_list_parts_at(root, SLICE, line, column)) if root else []


def _list_parts_at(node: YamlNode, part: str, line: int, column: int) -> Iterator[tuple[str, str, bool]]:
    if isinstance(node, MappingNode):
        for entry in node:
            if has_place(entry.key_span, line, column):
                yield part, entry.key, True
            yield from _list_parts_at(entry.value, find_inner_part(part, entry.key), line, column)
    elif isinstance(node, SequenceNode):
        for number, item in enumerate(node.items):
            yield from _list_parts_at(item, find_inner_part(part, number), line, column)
    elif has_place(node.span, line, column):
        yield part, node.text, False


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
