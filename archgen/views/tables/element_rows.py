"""Rows of plain text for `archgen list`, one table for each kind of element."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import cast

from archgen.language.language_tables import DATA_PARTS, ENTRIES, KEYS, SECTION_KINDS
from archgen.model.architecture import Annotated
from archgen.model.component import Connection, Input, Output
from archgen.model.component_nesting import find_relied_output
from archgen.model.node import Topic
from archgen.model.parameter import describe_types
from archgen.model.parameter_values import find_effective_parameters
from archgen.model.port_media import name_on_medium, nature_of, uses_ros, word_of_medium
from archgen.views.elements import parameter_blocks, port_tables
from archgen.views.elements.annotation_facts import format_fact
from archgen.views.elements.frame_users import index_frame_ports, list_shown_frames
from archgen.views.lookup import Lookup
from archgen.views.tables import functional_tables, requirement_tables
from archgen.views.tables.start_table import START_COLUMNS, list_start_rows

TextRow = tuple[str, ...]
_Rows = Iterator[tuple[object, ...]]
_ANNOTATED_TABLES = frozenset(section for section, kind in SECTION_KINDS.items() if "properties" in KEYS[kind])
"""Tables of elements that may have properties; that of components has composed ones, too."""


def list_element_rows(lookup: Lookup, kind: str) -> tuple[tuple[str, ...], list[TextRow]]:
    """Return the column names and rows for one kind of element: a name of a table of its own, or a section."""
    if kind in _TABLES_BY_KIND:
        columns, make_rows = _TABLES_BY_KIND[kind]
        rows = [tuple(map(_write_cell, row)) for row in make_rows(lookup)]
    else:
        columns, rows = _list_plain_rows(lookup, kind)
    for name, values in (*_list_further_columns(lookup, kind), *_list_property_columns(lookup, kind, rows)):
        # A column that no row has a word in is that of a project without composition: its table stays as it was.
        if any(values):
            columns = (*columns, name)
            rows = [(*row, value) for row, value in zip(rows, values, strict=True)]
    return columns, rows


def _list_further_columns(lookup: Lookup, kind: str) -> Iterator[tuple[str, list[str]]]:
    """Yield what types and composed components add to a table, column by column."""
    if kind == "components":
        components = list(lookup.nested_components())
        leaves = (lookup.architecture.leaves_of(c.id) for c in components)
        yield "type", [c.component_type or "" for c in components]
        yield (
            "composed_of",
            [str(len(set(each) - {c.id})) if c.children else "" for c, each in zip(components, leaves, strict=True)],
        )
    if kind == "topics" and lookup.architecture.channels:
        yield "medium", [word_of_medium(carrier) for carrier in _list_shown_carriers(lookup)]
    if kind == "connections":
        connections = functional_tables.shown_connections(lookup)
        yield "through", [connection.shell_port or "" for connection in connections]
        yield "medium", list(_describe_media(lookup, connections))
        words = [_describe_words(lookup, connection) for connection in connections]
        yield from (
            (name, [each[index] for each in words]) for index, name in enumerate(("promise", "version", "deprecated"))
        )
        yield "made_by", ["autoconnect" if connection.is_made else "" for connection in connections]


def _describe_media(lookup: Lookup, connections: Iterable[Connection]) -> Iterator[str]:
    """Yield what each connection travels over; nothing in a project of ROS and of what is physical alone."""
    outputs = lookup.architecture.outputs
    has_others = any(nature_of(port) == "other" for port in lookup.architecture.list_ports())
    for connection in connections:
        ends: list[Input | Output] = [lookup.architecture.inputs[connection.input]]
        ends += (outputs[each] for each in connection.outputs)
        others = dict.fromkeys(port.medium for port in ends if nature_of(port) == "other")
        words = others or dict.fromkeys(word_of_medium(outputs[each]) for each in connection.outputs)
        yield ", ".join(words) if has_others else ""


def _describe_words(lookup: Lookup, connection: Connection) -> tuple[str, str, str]:
    """Return what the outputs that a connection names promise, their versions, and until when they may be used."""
    architecture = lookup.architecture
    leaves = (architecture.outputs[output] for output in connection.outputs)
    ports = {port.id: port for leaf in leaves for port in (find_relied_output(architecture, connection, leaf),)}
    facts = [tuple(value for _, value in port_tables.list_card_facts(port)) for port in ports.values()]
    promises, versions, deprecations = (
        ("; ".join(dict.fromkeys(filter(None, values))) for values in zip(*facts, strict=True))
        if facts
        else ("", "", "")
    )
    return promises, versions, deprecations


def _list_property_columns(lookup: Lookup, kind: str, rows: list[TextRow]) -> Iterator[tuple[str, list[str]]]:
    """Yield a column for each property that a listed element has, declared ones first. Rows begin with the id."""
    architecture = lookup.architecture
    elements_by_id: Mapping[str, Annotated] = (
        {**architecture.components, **architecture.shells}
        if kind == "components"
        else getattr(architecture, kind, {})
        if kind in _ANNOTATED_TABLES
        else {}
    )
    properties = [
        each.annotations.properties if (each := elements_by_id.get(row[0])) is not None else {} for row in rows
    ]
    names = dict.fromkeys((*architecture.properties, *(name for each in properties for name in each)))
    # Behind a word of its own: a property may be called as another column.
    yield from ((f"property:{name}", [each.get(name, "") for each in properties]) for name in names)


def _write_cell(value: object) -> str:
    """Return what is written of a value: several with commas between them, nothing for None."""
    # Quantities and places are tuples with names: each is one value.
    is_several = isinstance(value, (Mapping, tuple, list)) and not hasattr(value, "_fields")
    values: Iterable[object] = cast("Iterable[object]", value) if is_several else (value,)
    return ", ".join(str(each) for each in values if each is not None)


def _component_rows(lookup: Lookup) -> _Rows:
    for c in lookup.nested_components():
        nodes = [node.id for node in lookup.nodes_inside(c.id)]
        yield c.id, c.title, c.owners, c.role, len(c.inputs), len(c.outputs), nodes, c.at


def _node_rows(lookup: Lookup) -> _Rows:
    for n in lookup.shown_nodes():
        place = n.at if n.written else None
        yield n.id, n.implements, n.owners, n.package, n.status, n.host, n.full_name, place


def _group_rows(lookup: Lookup) -> _Rows:
    for group in map(lookup.architecture.groups.__getitem__, lookup.shown_groups()):
        yield group.id, group.title, group.owners, len(group.components), group.at


def _connection_rows(lookup: Lookup) -> _Rows:
    architecture = lookup.architecture
    for c in functional_tables.shown_connections(lookup):
        outputs = [architecture.outputs[output] for output in c.outputs]
        types = dict.fromkeys(output.type or "?" for output in outputs)
        messages = dict.fromkeys(o.medium if not uses_ros(o) else architecture.message_of(o) or "?" for o in outputs)
        readers = architecture.components[architecture.inputs[c.input].component].owners
        writers = dict.fromkeys(o for output in outputs for o in architecture.components[output.component].owners)
        yield c.input, c.target, c.kind, types, messages, len(outputs), writers, readers, c.at


def _edge_rows(lookup: Lookup) -> _Rows:
    architecture = lookup.architecture
    for edge in architecture.edges:
        output = architecture.outputs[edge.output]
        if any(map(lookup.scope.shows_component, (output.component, architecture.inputs[edge.input].component))):
            yield edge.output, edge.input, output.type or "?", architecture.message_of(output), edge.at


def _topic_rows(lookup: Lookup) -> _Rows:
    for topic in _list_shown_carriers(lookup):
        writers, readers = (dict.fromkeys(end.node for end in ends) for ends in (topic.writers, topic.readers))
        yield name_on_medium(topic), topic.flow, topic.messages, writers, readers


def _list_shown_carriers(lookup: Lookup) -> list[Topic]:
    """Return topics, services, actions and channels of other media that a shown node uses."""
    return [
        carrier
        for _, carrier in lookup.architecture.list_carriers()
        if any(lookup.scope.shows_node(endpoint.node) for endpoint in (*carrier.writers, *carrier.readers))
    ]


def _type_rows(lookup: Lookup) -> _Rows:
    for each in functional_tables.shown_types(lookup):
        yield each.name, each.message, lookup.format_size(each), functional_tables.describe_mapping(each)


def _requirement_rows(lookup: Lookup) -> _Rows:
    for r in requirement_tables.shown_requirements(lookup):
        server_ids = [component.id for component in lookup.components_for_requirement.get(r.id, ())]
        server_ids += [chain.id for chain in lookup.chains_for_requirement.get(r.id, ())]
        verifiers = [each.text for each in r.verified_by]
        relations = r.use_cases, server_ids, verifiers
        yield r.id, r.title, r.parents, r.kind, r.priority, *relations, lookup.requirement_trace.judge(r.id), r.at


def _use_case_rows(lookup: Lookup) -> _Rows:
    for use_case in lookup.architecture.use_cases.values():
        yield use_case.id, use_case.title, use_case.actors, len(use_case.steps), use_case.at


def _step_rows(lookup: Lookup) -> _Rows:
    for use_case_id, steps in lookup.steps.by_use_case.items():
        for each in steps:
            step, ports = each.step, dict.fromkeys(end.output or end.input or "" for end in each.connections)
            yield use_case_id, each.number, step.source.id, step.target.id, step.say, ports, step.at


def _chain_rows(lookup: Lookup) -> _Rows:
    for chain in lookup.architecture.chains.values():
        yield chain.id, chain.title, " > ".join(point.id for point in chain.through), chain.deadline_text, chain.at


def _host_rows(lookup: Lookup) -> _Rows:
    for host in lookup.architecture.hosts.values():
        nodes = [node.id for node in lookup.shown_nodes() if node.host == host.id]
        yield host.id, host.title, host.cores or None, nodes, host.at


def _parameter_rows(lookup: Lookup) -> _Rows:
    for node in lookup.shown_nodes():
        for name, each in find_effective_parameters(lookup.architecture, node).items():
            declaration = each.declaration
            value = "" if each.origin == "none" else parameter_blocks.describe_value_text(node, each)
            yield (
                *(name, node.id, node.implements, declaration and declaration.type, value),
                *(declaration and declaration.unit, declaration and parameter_blocks.describe_limits(declaration)),
                *(parameter_blocks.name_origin(each), each.at if each.at.file else None),
            )


def _operation_rows(lookup: Lookup) -> _Rows:
    for group in lookup.shown_groups():
        for component in lookup.shown_components(group):
            for each in component.operations.values():
                types = (describe_types(types or "") for types in (each.request, each.response))
                yield each.id, component.id, *types, each.call, each.visibility, each.at


def _frame_rows(lookup: Lookup) -> _Rows:
    ports_by_frame = index_frame_ports(lookup.architecture)
    for frame in list_shown_frames(lookup):
        rate = "static" if frame.static else frame.rate
        yield frame.id, frame.title, frame.parent, frame.by, rate, ports_by_frame.get(frame.id), frame.at


def _variant_rows(lookup: Lookup) -> _Rows:
    for each in lookup.architecture.variants.values():
        yield each.id, each.title, each.of, each.without, each.drop, len(each.changes), each.at


def _list_plain_rows(lookup: Lookup, section: str) -> tuple[tuple[str, ...], list[TextRow]]:
    """Return columns and rows of a section without a table of its own: the keys that hold words, numbers or lists of them."""
    element_keys = KEYS[SECTION_KINDS[section]]
    elements = list(getattr(lookup.architecture, section).values())
    keys = [
        key
        for key, part in element_keys.items()
        if not {part} & (KEYS.keys() | ENTRIES.keys() | DATA_PARTS | {"prose"}) and key != "title"
    ]
    keys = [key for key in keys if elements and hasattr(elements[0], key)]
    rows = [
        (each.id, each.title, *(format_fact(getattr(each, key)) for key in keys), str(each.at)) for each in elements
    ]
    return ("id", "title", *keys, "place"), rows


# The column names are the header of what `archgen list` writes, so they are visible to users.
_TABLES_BY_KIND: dict[str, tuple[tuple[str, ...], Callable[[Lookup], _Rows]]] = {
    "components": (("id", "title", "owner", "role", "inputs", "outputs", "nodes", "place"), _component_rows),
    "nodes": (("id", "implements", "owner", "package", "status", "host", "ros_name", "place"), _node_rows),
    "groups": (("id", "title", "owner", "components", "place"), _group_rows),
    "connections": (
        ("input", "from", "kind", "types", "messages", "edges", "from_owner", "to_owner", "place"),
        _connection_rows,
    ),
    "edges": (("output", "input", "type", "message", "place"), _edge_rows),
    "topics": (("name", "flow", "messages", "writers", "readers"), _topic_rows),
    "types": (("type", "message", "size", "remarks"), _type_rows),
    "requirements": (
        ("id", "title", "parent", "kind", "priority", "use_cases", "served_by", "verified_by", "state", "place"),
        _requirement_rows,
    ),
    "use_cases": (("id", "title", "actors", "steps", "place"), _use_case_rows),
    "steps": (("use_case", "number", "from", "to", "says", "along", "place"), _step_rows),
    "chains": (("id", "title", "through", "deadline", "place"), _chain_rows),
    "parameters": (
        ("parameter", "node", "components", "type", "value", "unit", "may_be", "from", "place"),
        _parameter_rows,
    ),
    "operations": (("id", "component", "request", "response", "call", "visibility", "place"), _operation_rows),
    "hosts": (("id", "title", "cores", "nodes", "place"), _host_rows),
    "start_up": (START_COLUMNS, list_start_rows),
    "frames": (("id", "title", "parent", "by", "rate", "ports", "place"), _frame_rows),
    "variants": (("id", "title", "of", "without", "drop", "changes", "place"), _variant_rows),
}
