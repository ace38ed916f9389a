"""Hold the hints of elements against what backends say of them: `hints_schema` in `backend.yaml`, the project's or a shipped one.

Nothing of a backend is run. The schema is a small part of JSON Schema, without references and patterns, so that a
stranger's costs no more time than it is long.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import NamedTuple

from archgen.diagnostics.diagnostic import Diagnostic, Label, Rule, Severity
from archgen.diagnostics.source_span import Span
from archgen.frozen import dataclass, replace
from archgen.installed_backends import InstalledBackend, list_installed_backends
from archgen.link import mapping_values
from archgen.link.hint_schemas import HintFault, list_hint_faults
from archgen.model.annotated_elements import list_annotated_elements
from archgen.model.architecture import Architecture
from archgen.model.component import Component, ComponentType
from archgen.syntax.project_files import ProjectFiles, read_text_file
from archgen.syntax.yaml_parser import parse_yaml
from archgen.syntax.yaml_tree import MappingNode

WRONG_HINT = Rule(
    "wrong-hint",
    Severity.ERROR,
    "A hint is not what the backend that it is for reads.",
)
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
        WRONG_HINT.name,
        f"`hints.{path}` of the {each.kind.replace('_', ' ')} `{each.id}` {fault.words}",
        place,
        labels=(Label(backend.at, "what the backend reads"),) if backend.at else (),
        help=fault.help,
        element=each.owner_id,
    )
