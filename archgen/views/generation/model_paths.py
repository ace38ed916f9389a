"""Where an element stands in the model, in place of where it stands in a file: generated files are versioned, and lines move.

Views say `place` as `groups/base.yaml:45:3`, so that a message can point there. Templates of a workspace get `base.guard`.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from itertools import chain
from typing import Any, Protocol

from archgen.diagnostics import NO_SPAN, Span
from archgen.model.architecture import Architecture
from archgen.model.component import Component, ComponentType

_PLACE = re.compile(r"(?s)(.*):[0-9]+:[0-9]+\Z")


def index_model_paths(architecture: Architecture) -> dict[str, str]:
    """Return the paths of elements in the model by where they are written: `base.guard`, `filter.raw` of a component type."""
    paths: dict[str, str] = {}
    for group in _list_groups(architecture):
        found: dict[str, str] = {}
        for span, path in group:
            if span != NO_SPAN:
                # What several instances have from one place is told by one of them, whatever the order of lines.
                found[str(span)] = min(found.get(str(span), path), path)
        paths = found | paths
    return paths


def _list_groups(architecture: Architecture) -> Iterator[Iterator[tuple[Span, str]]]:
    """Yield places with paths: those of component types before what instances have of them, nodes last, which stand in components."""
    types, components = architecture.component_types, architecture.components
    yield chain(_list_ids(types, architecture.types, architecture.groups), _list_parts(types.values()))
    yield chain(
        _list_ids(components, architecture.shells, architecture.inputs, architecture.outputs),
        _list_parts(components.values()),
    )
    system = (architecture.hosts, architecture.containers, architecture.resources, architecture.links)
    yield _list_ids(architecture.nodes, *system, architecture.frames)


class _Element(Protocol):
    @property
    def at(self) -> Span: ...


def _list_ids(*sections: Mapping[str, _Element]) -> Iterator[tuple[Span, str]]:
    return ((element.at, element_id) for section in sections for element_id, element in section.items())


def _list_parts(components: Iterable[Component | ComponentType]) -> Iterator[tuple[Span, str]]:
    for component in components:
        parts: tuple[Mapping[str, _Element], ...] = (component.parameters, component.operations)
        yield from ((part.at, f"{component.id}.{name}") for each in parts for name, part in each.items())


_HOLDERS = frozenset({dict, list, tuple})


def write_model_paths(data: object, paths: Mapping[str, str]) -> object:
    """Return the data of views with each `place` as a path in the model; of what has none there, the file it is written in."""
    return _write_paths(data, paths, {})


def _write_paths(data: object, paths: Mapping[str, str], written_by_id: dict[int, dict[Any, object]]) -> object:
    # Most are texts, numbers and empty lists: for these there is no call.
    if isinstance(data, dict):
        # A program stands in its package, too.
        written = written_by_id.get(id(data))
        if written is None:
            written = written_by_id[id(data)] = data.copy()
            for key, value in data.items():
                if value and type(value) in _HOLDERS:
                    written[key] = _write_paths(value, paths, written_by_id)
            place = data.get("place")
            if isinstance(place, str):
                written["place"] = _find_path(place, paths)
        return written
    if isinstance(data, list | tuple):
        return [_write_paths(each, paths, written_by_id) if each and type(each) in _HOLDERS else each for each in data]
    return data


def _find_path(place: str, paths: Mapping[str, str]) -> str:
    written = _PLACE.match(place)
    return paths.get(place) or (written[1] if written else place)
