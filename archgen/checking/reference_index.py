"""Where each element of a checked project is declared and named: in all files, variants and component types.

The resolvers tell what paths mean; what is named by its id alone is found by its place in the language.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import chain

from archgen.checking.checked_project import CheckedProject
from archgen.diagnostics import NO_SPAN, SourceTexts, Span
from archgen.frozen import NamedTuple, dataclass, field
from archgen.grouping import group_pairs
from archgen.language.language_tables import OFFERS, SECTION_KINDS
from archgen.link.project_linking import link_type_patterns
from archgen.link.reference_resolution import HeardReferences
from archgen.model.component import PATTERN_GROUP
from archgen.model.path_resolver import PathResolver
from archgen.model.selector_evaluation import SelectorEvaluator
from archgen.model.selector_parser import SelectorAtom, parse_selector
from archgen.schema.short_forms import fold_type_name
from archgen.schema.written_names import DECLARING_PARTS, NAMING_PARTS, SPELLINGS, WrittenPlace, list_written_places

Element = tuple[str, str]
"""A kind and a complete id. What stands inside of a component type has an id for each instance, and `<type>.path`."""
INNER_KINDS: Mapping[str, tuple[str, ...]] = {
    "group": ("component", "input", "output"),
    "component": ("component", "input", "output"),
    "library": ("component_type",),
    "use_case": ("actor",),
}
"""The kinds of what an element may hold: its id is the beginning of theirs."""
_SELECTED_KINDS: Mapping[str, str] = {"owner": "partner", "is": "component_type"}
"""The keys of selectors that are not called as the kind that their values name."""
_TYPE_WORD = re.compile(r"[^<>,\[\]]+")
_PROPERTY_NAME = re.compile(r"[a-z][a-z0-9_]*")


class WrittenName(NamedTuple):
    """A name of an element as it is written: its words are the last ones of the complete `id`.

    `span` is exactly the name, without quotes; where it cannot be told (`is_exact`: an id that a short form makes, a
    text with escapes), that of the whole.
    """

    span: Span
    kind: str
    id: str
    text: str
    is_declaration: bool
    is_exact: bool = True


@dataclass(slots=True)
class ReferenceIndex:
    """All names of elements that are written in a project, by place, and which ids are one element."""

    names: tuple[WrittenName, ...]
    aliases: Mapping[Element, tuple[Element, ...]] = field(default_factory=dict)
    """The ids of what is declared in one place, by each of them: what stands in a component type has many."""
    _by_element: dict[Element, list[WrittenName]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for name in self.names:
            self._by_element.setdefault((name.kind, name.id), []).append(name)

    def list_ids(self, kind: str, element_id: str) -> tuple[Element, ...]:
        """Return all ids of an element: itself, and those of the same part of other instances."""
        return self.aliases.get((kind, element_id), ((kind, element_id),))

    def list_names(self, kind: str, element_id: str) -> list[WrittenName]:
        """Return where an element is declared and named, in all instances, in the order of files."""
        names = (name for each in self.list_ids(kind, element_id) for name in self._by_element.get(each, ()))
        return sorted({(name.span, name.is_declaration): name for name in names}.values())

    def list_names_through(self, kind: str, element_id: str) -> Iterator[tuple[WrittenName, int]]:
        """Yield the names in which an element's own word stands, with its number: also of what it holds."""
        own_ids = {each for _, each in self.list_ids(kind, element_id)}
        inner_kinds = INNER_KINDS.get(kind, ())
        for name in self.names:
            if name.kind == kind and name.id in own_ids:
                yield name, name.text.count(".") if kind in PATH_KINDS else 0
            elif name.kind in inner_kinds:
                outer_id = next((each for each in list_outer_ids(name.id) if each in own_ids), name.id)
                number = name.text.count(".") - name.id.count(".", len(outer_id))
                if outer_id != name.id and number >= 0:
                    yield name, number

    def find_at(self, file: str, line: int, column: int) -> list[WrittenName]:
        """Return the names at a place, lines and columns from 1."""
        return [
            name
            for name in self.names
            if name.span.file == file
            and (name.span.line, name.span.column) <= (line, column) <= (name.span.end_line, name.span.end_column)
        ]


def list_outer_ids(path: str) -> Iterator[str]:
    """Yield the ids of what may hold an element, by its path: the nearest first."""
    while "." in path:
        path = path.rpartition(".")[0]
        yield path


PATH_KINDS = frozenset(chain.from_iterable(INNER_KINDS.values())) | {"group"}
"""Kinds whose ids are paths."""


def index_references(checked_project: CheckedProject, heard: HeardReferences) -> ReferenceIndex:
    """Return where all elements of a project are declared and named.

    `heard` is what `PartMemory.heard` took in while the project was judged.
    """
    return _Indexer(checked_project, heard).index()


class _Indexer:
    def __init__(self, checked_project: CheckedProject, heard: HeardReferences) -> None:
        self._project = checked_project
        self._versions = (checked_project, *checked_project.variants.values())
        self._texts = checked_project.sources
        self._heard = list(heard)
        pattern_references: HeardReferences = []
        patterns = link_type_patterns(checked_project.merged_table, checked_project.architecture, pattern_references)
        self._type_names = sorted(
            dict.fromkeys(name for each in self._versions for name in each.architecture.component_types),
            key=len,
            reverse=True,
        )
        self._heard += [
            each._replace(id=type_id)
            for each in pattern_references
            if (type_id := self._name_in_type(each.id)) is not None
        ]
        self._instances: dict[str, dict[str, None]] = defaultdict(dict)
        for version in self._versions:
            architecture = version.architecture
            for component in (*architecture.components.values(), *architecture.shells.values()):
                self._add_instance(version, component.type_name, component.id)
            for name in architecture.component_types:
                self._add_instance(version, name, f"<{name}>")
        for pattern_id, pattern in patterns.components.items():
            if (type_id := self._name_in_type(f"{PATTERN_GROUP}.{pattern_id}")) is not None and pattern.type_name:
                self._add_instance(checked_project, pattern.type_name, type_id)
        self._resolvers = [SelectorEvaluator(version.architecture).resolver for version in self._versions]
        self._names: dict[WrittenName, None] = {}
        self._joined: dict[Element, Element] = {}

    def _add_instance(self, version: CheckedProject, type_name: str, element_id: str) -> None:
        for each in version.architecture.list_bases(type_name):
            self._instances[each.id][element_id] = None

    def _name_in_type(self, pattern_id: str) -> str | None:
        """Return the id of what stands in a type, `<arm>.motor`, by that of its pattern; None for anything else."""
        path = pattern_id.removeprefix(f"{PATTERN_GROUP}.")
        name = next((each for each in self._type_names if path == each or path.startswith(f"{each}.")), None)
        return f"<{name}>{path[len(name) :]}" if name is not None and path != pattern_id else None

    def index(self) -> ReferenceIndex:
        loaded_project = self._project.loaded_project
        places = [place for each in loaded_project.documents for place in list_written_places(each.root)]
        for library in loaded_project.libraries:
            if not library.is_shipped:
                path = ("libraries", library.id)
                for document in library.documents:
                    places += list_written_places(document.root, "library", path)
        self._declare(places)
        for reference in self._heard:
            self._add(reference.span, reference.kind, reference.id)
        known_ids: dict[str, set[str]] = defaultdict(set)
        for name in self._names:
            if name.is_declaration:
                known_ids[name.kind].add(name.id)
        known_ids["type"].update(
            name for version in self._versions for name in version.architecture.types if "/" not in name
        )
        for place in places:
            self._add_references(place, known_ids)
        # What names a type and is an id at once, such as an item of a list, is no id that could be another one.
        naming_types = {each.span for each in self._names if each.kind in {"type", "component_type"}}
        naming_types -= {
            each.span for each in self._names if each.kind in {"type", "component_type"} and each.is_declaration
        }
        names = sorted(
            each._replace(is_exact=each.is_exact and not (each.is_declaration and each.span in naming_types))
            for each in self._names
        )
        return ReferenceIndex(tuple(names), self._list_aliases())

    def _list_aliases(self) -> dict[Element, tuple[Element, ...]]:
        joined = group_pairs((self._find_root(element), element) for element in self._joined)
        aliases: dict[Element, tuple[Element, ...]] = {}
        for elements in joined.values():
            if len(elements) > 1:
                aliases |= dict.fromkeys(elements, tuple(elements))
        return aliases

    def _find_root(self, element: Element) -> Element:
        while (parent := self._joined.setdefault(element, element)) != element:
            self._joined[element] = self._joined[parent]
            element = parent
        return element

    def _declare(self, places: Iterable[WrittenPlace]) -> None:
        for place in places:
            kind = DECLARING_PARTS.get(place.part) if place.is_key else None
            if kind is None:
                continue
            ids = self._list_ids(kind, place)
            for element_id in ids:
                root = self._find_root((kind, ids[0]))
                self._joined[self._find_root((kind, element_id))] = root
                self._add(place.span, kind, element_id, is_declaration=True)

    def _list_ids(self, kind: str, place: WrittenPlace) -> list[str]:
        """Return the complete ids of what a key declares; for a part of a component type those in all instances."""
        path = [str(each) for each in place.path]
        if path[0] == "variants" and len(path) > 3 and path[2] == "changes":  # noqa: PLR2004
            path = path[3:]
        if kind == "actor":
            return [f"{path[1]}.{path[3]}"]
        if kind not in {"component", "input", "output", "component_type"}:
            return [path[-1]]
        library = path[1] if path[0] == "libraries" else ""
        path = path[2:] if library else path
        name = f"{library}.{path[1]}" if library else path[1]
        inner = ".".join(path[3::2])
        if path[0] == "groups":
            return [f"{name}.{inner}"]
        return [f"{each}.{inner}" for each in self._instances[name]] if inner else [name]

    def _add_references(self, place: WrittenPlace, known_ids: Mapping[str, set[str]]) -> None:
        if place.is_key:
            self._add_key(place, known_ids)
            return
        for offered in OFFERS.get(place.part, ()):
            match SPELLINGS.get(offered):
                case "plain" if place.text in known_ids[SECTION_KINDS[offered]]:
                    self._add(place.span, SECTION_KINDS[offered], place.text)
                case "type":
                    self._add_type(place, known_ids)
                case "component_type":
                    self._add_component_type(place, known_ids)
                case "selector":
                    self._add_selector(place, known_ids)
        self._add_other(place, known_ids)

    def _add_key(self, place: WrittenPlace, known_ids: Mapping[str, set[str]]) -> None:
        naming = NAMING_PARTS.get(place.part)
        # Which kind is meant where an acceptance names an id that several have, nobody knows.
        kinds = [kind for kind in known_ids if place.text in known_ids[kind]] if naming == "accepted" else []
        if len(kinds) == 1:
            self._add(place.span, kinds[0], place.text)
        elif naming == "property_declaration" and place.text in known_ids[naming]:
            self._add(place.span, naming, place.text)
        elif place.part == "types" and "<" in place.text:
            self._add_type(place, known_ids)

    def _add_other(self, place: WrittenPlace, known_ids: Mapping[str, set[str]]) -> None:
        """Add what places name that offer nothing: actors in steps, what replaces the deprecated, a guarding property."""
        match place.part:
            case "step.from" | "step.to" if place.path[0] == "use_cases":
                actor = f"{place.path[1]}.{place.text}"
                if actor in known_ids["actor"]:
                    self._add(place.span, "actor", actor)
            case "key_path":
                self._add_key_path(place, known_ids)
        if place.path[-2:] == ("deprecated", "use"):
            self._add_replacement(place, known_ids)
        if place.path[-1] == "guarded_by" and place.text in known_ids["property_declaration"]:
            self._add(place.span, "property_declaration", place.text)

    def _add_replacement(self, place: WrittenPlace, known_ids: Mapping[str, set[str]]) -> None:
        """Add what replaces what is deprecated: a type, a component type, or an output of the same component or by its path."""
        match place.path[-4]:
            case "types":
                self._add_type(place, known_ids)
            case "component_types":
                self._add_component_type(place, known_ids)
            case "outputs":
                beside = self._list_ids("output", place._replace(path=(*place.path[:-3], place.text)))
                for output in (*beside, place.text):
                    if output in known_ids["output"]:
                        self._add(place.span, "output", output)

    def _add_key_path(self, place: WrittenPlace, known_ids: Mapping[str, set[str]]) -> None:
        """Add the ids in a path of keys that a variant drops: `groups.arm.components.motor`."""
        words = place.text.split(".")
        kind = SECTION_KINDS.get(words[0])
        if kind is None or len(words) < 2 or words[1] not in known_ids[kind]:  # noqa: PLR2004
            return
        spans = self._locate(place.span, words)
        if spans is None:
            self._names[WrittenName(place.span, kind, words[1], words[1], is_declaration=False, is_exact=False)] = None
            return
        self._names[WrittenName(spans[1], kind, words[1], words[1], is_declaration=False)] = None
        ids = [words[1]]
        parts = {"components": "component", "inputs": "input", "outputs": "output"}
        for key, word, span in zip(words[2::2], words[3::2], spans[3::2], strict=False):
            if kind != "group" or key not in parts:
                break
            ids.append(word)
            self._names[WrittenName(span, parts[key], ".".join(ids), word, is_declaration=False)] = None

    def _add_type(self, place: WrittenPlace, known_ids: Mapping[str, set[str]]) -> None:
        words = [each for each in map(str.strip, _TYPE_WORD.findall(place.text)) if each]
        self._add_words(place.span, [(word, "type", fold_type_name(word)) for word in words], known_ids)

    def _add_component_type(self, place: WrittenPlace, known_ids: Mapping[str, set[str]]) -> None:
        first, *others = [each for each in map(str.strip, _TYPE_WORD.findall(place.text)) if each] or [""]
        # Types of a library see only one another.
        name = f"{place.path[1]}.{first}" if place.path[0] == "libraries" else first
        arguments = [(word, "type", fold_type_name(word)) for word in others]
        self._add_words(place.span, [(first, "component_type", name), *arguments], known_ids)

    def _add_words(self, span: Span, words: Sequence[tuple[str, str, str]], known_ids: Mapping[str, set[str]]) -> None:
        spans = self._locate(span, [text for text, _, _ in words])
        for number, (text, kind, element_id) in enumerate(words):
            library = element_id.partition(".")[0]
            if element_id in known_ids[kind] or (kind == "type" and text) or library in known_ids["library"]:
                name_span = spans[number] if spans else span
                self._names[WrittenName(name_span, kind, element_id, text, False, spans is not None)] = None  # noqa: FBT003

    def _add_selector(self, place: WrittenPlace, known_ids: Mapping[str, set[str]]) -> None:
        atoms = [
            atom
            for word in parse_selector(place.text).words
            for atom in (word.atom, word.range_end)
            if atom is not None
        ]
        spans = self._locate(place.span, [place.text[atom.start : atom.end] for atom in atoms])
        for number, atom in enumerate(atoms):
            for kind, element_id, text in self._resolve_atom(atom, known_ids):
                span, is_exact = place.span, False
                if spans is not None:
                    inner = self._locate(spans[number], [f"{atom.key}:", text] if atom.key else [text])
                    span, is_exact = (inner[-1], True) if inner else (spans[number], False)
                self._names[WrittenName(span, kind, element_id, text, False, is_exact)] = None  # noqa: FBT003

    def _resolve_atom(self, atom: SelectorAtom, known_ids: Mapping[str, set[str]]) -> Iterator[tuple[str, str, str]]:
        """Yield kind, id and text of what a path or a key's value of a selector names; a pattern names nothing."""
        value = atom.value
        if atom.key == "property":
            found = _PROPERTY_NAME.match(value)
            if found and found[0] in known_ids["property_declaration"]:
                yield "property_declaration", found[0], found[0]
        elif atom.key is not None:
            kind = _SELECTED_KINDS.get(atom.key, atom.key)
            element_id = fold_type_name(value) if kind == "type" else value
            if element_id in known_ids.get(kind, ()):
                yield kind, element_id, value
        else:
            path = value
            while path.endswith(("*", ".")):
                path = path[:-1]
            if path and "*" not in path:
                for resolver in self._resolvers:
                    target = _find_selected(resolver, path)
                    if target is not None:
                        yield *target, path

    def _add(self, span: Span, kind: str, element_id: str, *, is_declaration: bool = False) -> None:
        """Add a name that is a whole key or scalar, if it is written: what a short form stands for is not."""
        if span == NO_SPAN:
            return
        if kind in PATH_KINDS:
            written = _read_scalar(self._texts, span)
            text = (written or element_id).removeprefix("self.")
            is_ending = element_id == text or element_id.endswith(f".{text}")
            if written is not None and not is_ending:
                if is_declaration and "." not in text:
                    self._names[WrittenName(span, kind, element_id, text, True, False)] = None  # noqa: FBT003
                return
        else:
            text = element_id
        spans = self._locate(span, [text])
        name = WrittenName(spans[0] if spans else span, kind, element_id, text, is_declaration, spans is not None)
        self._names[name] = None

    def _locate(self, span: Span, words: Sequence[str]) -> list[Span] | None:
        """Return where words that follow one another stand in what is written at a place; None where they do not."""
        spans: list[Span] = []
        line_number, column = span.line, span.column
        for word in words:
            while True:
                line = self._texts.line_of(span.file, line_number)
                if line is None or line_number > span.end_line:
                    return None
                end = span.end_column - 1 if line_number == span.end_line else len(line)
                start = line.find(word, column - 1, end)
                if start >= 0:
                    break
                line_number, column = line_number + 1, 1
            column = start + 1 + len(word)
            spans.append(Span(span.file, line_number, start + 1, line_number, column))
        return spans


def _find_selected(resolver: PathResolver, path: str) -> Element | None:
    """Return the kind and id of what a path in a selector names, None where it names nothing or several."""
    for kinds in (("group", "component", "output"), ("node",), ("input",)):
        match = resolver.resolve_path(path, kinds)
        if match.count:
            return match.unique_element
    return None


def _read_scalar(texts: SourceTexts, span: Span) -> str | None:
    """Return what is written at a place of one line without its quotes, None for a text of several lines."""
    line = texts.line_of(span.file, span.line)
    if line is None or span.end_line != span.line:
        return None
    written = line[span.column - 1 : span.end_column - 1].strip()
    return written[1:-1] if len(written) > 1 and written[0] in "'\"" and written[-1] == written[0] else written
