"""Hold the hints of elements against what backends say of them: `hints_schema` in `backend.yaml`, the project's or a shipped one.

Nothing of a backend is run. The schema is a small part of JSON Schema, without references and patterns, so that a
stranger's costs no more time than it is long.

Judge data by the schema of a backend: types, choices, keys, items and ranges, each in words for who wrote the data.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from decimal import Decimal

from archgen.diagnostics import Diagnostic, Label, Span, did_you_mean, join_words
from archgen.frozen import NamedTuple, dataclass, replace
from archgen.installed_backends import InstalledBackend, list_installed_backends
from archgen.link import mapping_values
from archgen.model.architecture import Architecture, list_annotated_elements
from archgen.model.component import Component, ComponentType
from archgen.model.element_annotations import shorten_value
from archgen.syntax.project_files import ProjectFiles, read_text_file
from archgen.syntax.yaml_parser import parse_yaml
from archgen.syntax.yaml_tree import MappingNode, ScalarNode

_MAX_MANIFEST_LETTERS = 65_536
_ANY_KIND = "any"
"""The key of the schema for kinds of elements that have none of their own."""


class _HintedPart(NamedTuple):
    """What may have hints: an element, or a parameter of one."""

    kind: str
    id: str
    owner_id: str
    """The element that findings about it name."""
    hints: Mapping[str, object]
    places: Mapping[tuple[str | int, ...], Span]
    at: Span


@dataclass(frozen=True, slots=True)
class _BackendHints:
    """What a backend says of its hints: schemas by kind of element, and where."""

    id: str
    schemas: MappingNode
    at: Span | None
    """None for a backend that is installed."""


def find_wrong_hints(architecture: Architecture, files: ProjectFiles) -> Iterator[Diagnostic]:
    """Report hints that a backend, of the project or shipped, does not read as they are written."""
    _, folders, _ = next(iter(files.walk_folders("backends")), ("", [], []))
    own_backends = frozenset(folders)
    hinted_parts = tuple(_list_hinted(architecture))
    # Looked for where there are hints at all: most projects have none.
    installed_backends = list_installed_backends() if hinted_parts else {}
    read_backends: dict[str, _BackendHints | None] = {}
    judged_places: set[tuple[Span, str]] = set()
    for each in hinted_parts:
        for program, value in each.hints.items():
            if program not in read_backends:
                if program in own_backends:
                    read_backends[program] = _read_backend(files, program)
                else:
                    read_backends[program] = _read_installed_backend(program, installed_backends.get(program))
            backend = read_backends[program]
            if backend is not None:
                for fault in _judge_hints(backend, each.kind, value):
                    place = _find_place(each.places, (program, *fault.path), each.at)
                    # What instances have of their type is one slip.
                    if (place, fault.words) not in judged_places:
                        judged_places.add((place, fault.words))
                        yield _report_fault(backend, each, fault, place)


def _list_hinted(architecture: Architecture) -> Iterator[_HintedPart]:
    """Yield all elements with hints, and then all parameters."""
    for each in list_annotated_elements(architecture):
        annotations = each.element.annotations
        if annotations.hints:
            yield _HintedPart(
                each.kind, each.id, each.owner_id, annotations.hints, annotations.hint_places, each.element.at
            )
    types = [each for each in architecture.component_types.values() if each.library is None]
    holders: tuple[ComponentType | Component, ...] = (*types, *architecture.list_described_components())
    for holder in holders:
        for parameter in holder.parameters.values():
            if parameter.hints:
                id_ = f"{holder.id}.{parameter.name}"
                yield _HintedPart("parameter", id_, holder.id, parameter.hints, parameter.hint_places, parameter.at)


def _read_backend(files: ProjectFiles, program: str) -> _BackendHints | None:
    """Return what a backend says of its hints; None where it says nothing, or `archgen build` refuses the manifest."""
    path = f"backends/{program}/backend.yaml"
    manifest = read_text_file(files, path) if files.has_path(path) else None
    if manifest is None or manifest.problem or len(manifest.text) > _MAX_MANIFEST_LETTERS:
        return None
    return _parse_manifest(program, path, manifest.text)


def _read_installed_backend(program: str, installed: InstalledBackend | None) -> _BackendHints | None:
    if installed is None:
        return None
    path = installed.folder / "backend.yaml"
    backend = _parse_manifest(program, str(path), path.read_text("utf-8", "replace"))
    return replace(backend, at=None) if backend else None


def _parse_manifest(program: str, path: str, text: str) -> _BackendHints | None:
    document, _ = parse_yaml(path, text)
    entry = document.root.entries.get("hints_schema") if document else None
    if entry is None or not isinstance(entry.value, MappingNode):
        return None
    return _BackendHints(program, entry.value, entry.key_span)


def _judge_hints(backend: _BackendHints, kind: str, value: object) -> Iterator[HintFault]:
    schemas = mapping_values.get_mapping(backend.schemas, kind if kind in backend.schemas.entries else _ANY_KIND)
    if kind in backend.schemas.entries or _ANY_KIND in backend.schemas.entries:
        yield from list_hint_faults(schemas, value)
    else:
        kinds = ", ".join(f"`{each}`" for each in backend.schemas.entries)
        yield HintFault((), f"is not read: the backend reads hints of {kinds or 'no element'}")


def _find_place(places: Mapping[tuple[str | int, ...], Span], path: tuple[str | int, ...], whole: Span) -> Span:
    """Return where a value is written, or the nearest one around it."""
    return next((places[path[:end]] for end in range(len(path), 0, -1) if path[:end] in places), whole)


def _report_fault(backend: _BackendHints, each: _HintedPart, fault: HintFault, place: Span) -> Diagnostic:
    path = ".".join(map(str, (backend.id, *fault.path)))
    return Diagnostic(
        "wrong-hint",
        f"`hints.{path}` of the {each.kind.replace('_', ' ')} `{each.id}` {fault.words}",
        place,
        labels=(Label(backend.at, "what the backend reads"),) if backend.at else (),
        help=fault.help,
        element=each.owner_id,
    )


_TYPE_WORDS: Mapping[str, str] = {
    "object": "a mapping",
    "array": "a list",
    "string": "text",
    "number": "a number",
    "integer": "a whole number",
    "boolean": "`true` or `false`",
}
_IS_OF_TYPE: Mapping[str, Callable[[object], bool]] = {
    "object": lambda value: isinstance(value, Mapping),
    "array": lambda value: isinstance(value, (list, tuple)),
    "string": lambda value: isinstance(value, str),
    "number": lambda value: isinstance(value, (int, float)) and not isinstance(value, bool),
    "integer": lambda value: isinstance(value, int) and not isinstance(value, bool),
    "boolean": lambda value: isinstance(value, bool),
}


class HintFault(NamedTuple):
    """What is wrong with a part of the data: the keys and positions that lead to it, words behind its name, and help."""

    path: tuple[str | int, ...]
    words: str
    help: str | None = None


def list_hint_faults(schema: MappingNode, value: object, path: tuple[str | int, ...] = ()) -> Iterator[HintFault]:
    """Yield what a schema refuses. The data is walked once, the schema beside it; both are of limited depth."""
    types = [word for word in mapping_values.get_texts(schema, "type") if word in _TYPE_WORDS]
    if types and not any(_IS_OF_TYPE[word](value) for word in types):
        yield HintFault(
            path, f"is {_name_value(value)}, but must be {join_words([_TYPE_WORDS[t] for t in types], 'or')}"
        )
        return
    yield from _judge_choice(schema, value, path)
    if isinstance(value, Mapping):
        yield from _judge_keys(schema, value, path)
    elif isinstance(value, (list, tuple)):
        items = schema.get("items")
        if isinstance(items, MappingNode):
            for number, item in enumerate(value):
                yield from list_hint_faults(items, item, (*path, number))
    elif isinstance(value, (int, float)) and not isinstance(value, bool):
        yield from _judge_size(schema, value, path)


def _judge_choice(schema: MappingNode, value: object, path: tuple[str | int, ...]) -> Iterator[HintFault]:
    choices = mapping_values.get_texts(schema, "enum")
    if choices and _write_value(value) not in choices:
        quoted = join_words([f"`{each}`" for each in choices], "or")
        guess = did_you_mean(value, choices) if isinstance(value, str) else None
        yield HintFault(path, f"is {_name_value(value)}, but must be {quoted}", guess)


def _judge_keys(
    schema: MappingNode, value: Mapping[object, object], path: tuple[str | int, ...]
) -> Iterator[HintFault]:
    properties = mapping_values.get_mapping(schema, "properties")
    further = schema.get("additionalProperties")
    is_closed = isinstance(further, ScalarNode) and further.text == "false"
    for key, inner in value.items():
        name = str(key)
        inner_schema = properties.get(name)
        if isinstance(inner_schema, MappingNode):
            yield from list_hint_faults(inner_schema, inner, (*path, name))
        elif name not in properties.entries and is_closed:
            names = tuple(properties.entries)
            help_line = did_you_mean(name, names) or (
                f"it reads {join_words([f'`{n}`' for n in names])}" if names else None
            )
            yield HintFault((*path, name), "is no key that the backend reads", help_line)
        elif name not in properties.entries and isinstance(further, MappingNode):
            yield from list_hint_faults(further, inner, (*path, name))
    for name in mapping_values.get_texts(schema, "required"):
        if name not in value:
            yield HintFault(path, f"lacks `{name}`")


def _judge_size(schema: MappingNode, value: float, path: tuple[str | int, ...]) -> Iterator[HintFault]:
    for key, word in (("minimum", "least"), ("maximum", "most")):
        limit = mapping_values.get_scalar(schema, key)
        if limit is None or not _IS_OF_TYPE["number"](limit.value):
            continue
        number, end = Decimal(value), Decimal(limit.value)  # type: ignore[arg-type]
        if end.is_nan():
            continue
        # What is no number at all is neither below nor above.
        if number.is_nan() or not (number >= end if key == "minimum" else number <= end):
            yield HintFault(path, f"is {_name_value(value)}, but must be at {word} {limit.text}")


def _name_value(value: object) -> str:
    if value is None:
        return "empty"
    if isinstance(value, Mapping):
        return "a mapping"
    return "a list" if isinstance(value, (list, tuple)) else f"`{shorten_value(_write_value(value))}`"


def _write_value(value: object) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    # Python writes no whole number of more than 4,300 digits.
    return str(Decimal(value)) if isinstance(value, int) else str(value)
