"""The resolved model as plain data, for other programs and code generators (`schemas/resolved.schema.json`).

Elements are keyed by their full ids, and what is not known is left out. A quantity has the text as written (`text`),
the number (`value`) and its unit (`unit`): ns, Hz, B or bit/s.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping

from archgen.language.record_tables import LASTING_SECTIONS, RECORD_SECTIONS
from archgen.model.architecture import PortEdge
from archgen.model.component import Component, Connection
from archgen.model.node import Topic
from archgen.views.lookup import Lookup
from archgen.views.records.element_record import write_value
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
    return write_value(RECORD_SECTIONS[section], elements, lookup)


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
