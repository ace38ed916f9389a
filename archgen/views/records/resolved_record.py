"""The resolved model as plain data, for other programs and code generators (`schemas/resolved.schema.json`).

Elements are keyed by their full ids, and what is not known is left out. A quantity has the text as written (`text`),
the number (`value`) and its unit (`unit`): ns, Hz, B or bit/s.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any

from archgen.language.language_tables import LASTING_SECTIONS, RECORD_KEYS, RECORD_SECTIONS
from archgen.model.architecture import PortEdge
from archgen.model.component import Component, Connection
from archgen.model.node import Topic
from archgen.views.lookup import Lookup
from archgen.views.records.record_sources import SOURCES, drop_unknown, record_property, record_quantity, to_plain
from archgen.views.shapes import Record

RECORD_VERSION = 1
"""Version of the format, written as `archgen_resolved`."""


def make_record(lookup: Lookup) -> Record:
    """Return the architecture, or the part in scope, as dicts, lists and scalars."""
    return {
        section: record
        for section in RECORD_SECTIONS
        if (record := write_section(section, lookup)) or section in LASTING_SECTIONS
    }


def write_section(section: str, lookup: Lookup) -> object:
    """Return a section of the record; empty where the architecture has nothing of it."""
    source = _SECTIONS.get(section)
    elements = source(lookup) if source else getattr(lookup.architecture, section)
    return _write_value(RECORD_SECTIONS[section], elements, lookup)


def _list_components(lookup: Lookup) -> dict[str, Component]:
    components = lookup.architecture.components.items()
    return {name: each for name, each in components if lookup.scope.shows_component(name)}


def _list_composed(lookup: Lookup) -> dict[str, Component]:
    architecture, is_shown = lookup.architecture, lookup.scope.shows_component
    return {
        name: each for name, each in architecture.shells.items() if any(map(is_shown, architecture.leaves_of(name)))
    }


def _list_connections(lookup: Lookup) -> list[Connection]:
    inputs, is_shown = lookup.architecture.inputs, lookup.scope.shows_component
    return [each for each in lookup.architecture.connections if is_shown(inputs[each.input].component)]


def _list_edges(lookup: Lookup) -> list[PortEdge]:
    architecture, is_shown = lookup.architecture, lookup.scope.shows_component
    return [
        each
        for each in architecture.edges
        if is_shown(architecture.inputs[each.input].component) or is_shown(architecture.outputs[each.output].component)
    ]


def _keep_shown(lookup: Lookup, carriers: Iterable[Topic]) -> list[Topic]:
    """Return what shown nodes use."""
    shows_node = lookup.scope.shows_node
    return [each for each in carriers if any(shows_node(end.node) for end in (*each.writers, *each.readers))]


_SECTIONS: Mapping[str, Callable[[Lookup], object]] = {
    "archgen_resolved": lambda _: RECORD_VERSION,
    "glossary": lambda lookup: {each.term: each.text for each in lookup.architecture.glossary.values()},
    # Groups, components, connections, edges, nodes and topics are cut to the scope; all else is given in full.
    "groups": lambda lookup: {name: lookup.architecture.groups[name] for name in lookup.shown_groups()},
    "components": _list_components,
    "composed": _list_composed,
    "connections": _list_connections,
    "edges": _list_edges,
    "nodes": lambda lookup: {node.id: node for node in lookup.shown_nodes()},
    "topics": lambda lookup: _keep_shown(lookup, lookup.architecture.topics.values()),
    "channels": lambda lookup: _keep_shown(lookup, lookup.architecture.channels.values()),
}
"""Sections that are not given as the architecture has them."""


_KEPT_WHERE_EMPTY = frozenset(
    {
        ("parameter", "value"),
        ("effective_parameter", "value"),
        *(("composed", key) for key in ("components", "behind")),
        *(("part_fields", part) for part in RECORD_KEYS["part_fields"]),
    }
)
"""Keys at which an empty list or mapping is a value: elsewhere nothing is written."""
_KNOWN_ENTRIES = frozenset({("node", "timing")})
"""Mappings in which only entries of which something is known are written."""


def write_record(part: str, element: Any, lookup: Lookup) -> dict[str, object]:  # noqa: ANN401  # any class of the model
    """Return what is known of an element of a kind, or of another part of the record."""
    record: dict[str, object] = {}
    for key, form in RECORD_KEYS[part].items():
        if (source := SOURCES.get((part, key))) is not None:
            value = _write_value(form, source(element, lookup), lookup)
        elif form == "annotations":
            value = _write_annotations(key, element.annotations)
        else:
            value = _write_value(form, getattr(element, key), lookup)
        if (part, key) in _KNOWN_ENTRIES and isinstance(value, dict):
            value = drop_unknown(value)
        if value is not None and (value not in ([], {}) or (part, key) in _KEPT_WHERE_EMPTY):
            record[key] = value
    return record


def _write_value(form: str, value: Any, lookup: Lookup) -> object:  # noqa: ANN401  # any value of the model
    """Return a value in a form of the tables."""
    if value is None:
        return None
    if form.endswith("{}"):
        named = value if isinstance(value, Mapping) else {_name_element(each): each for each in value}
        return {name: _write_value(form[:-2], each, lookup) for name, each in named.items()}
    if form.endswith("[]"):
        return [_write_value(form[:-2], each, lookup) for each in value]
    if form in RECORD_KEYS:
        return write_record(form, value, lookup)
    if form == "flag":
        return value or None
    return record_quantity(value, form) if form else to_plain(value)


def _name_element(element: Any) -> str:  # noqa: ANN401  # any class of the model
    return str(element.id if hasattr(element, "id") else element.name)


def _write_annotations(key: str, annotations: Any) -> object:  # noqa: ANN401  # read by the key
    """Return the properties of an element (text, number and unit, as far as they are such), or its hints as they are."""
    values: Mapping[str, object] = getattr(annotations, key)
    if key == "properties":
        return {name: record_property(str(text)) for name, text in values.items()}
    return to_plain(values)
