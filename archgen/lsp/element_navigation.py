"""Which element a place in a file means, where else it stands, and what its card says."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from archgen.checking.reference_index import Element, WrittenName
from archgen.diagnostics import Span
from archgen.frozen import NamedTuple
from archgen.language.key_paths import SLICE, find_inner_part
from archgen.language.language_tables import OFFERS
from archgen.link.interface_sources import interface_name_of
from archgen.live.edited_project import EditedProject
from archgen.lsp.text_positions import has_place
from archgen.schema.language_schema import find_part_schema
from archgen.syntax.yaml_tree import MappingNode, SequenceNode, YamlNode
from archgen.views.elements.annotation_facts import ElementCard
from archgen.views.elements.element_card import make_card
from archgen.views.elements.element_names import elements_by_kind

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
