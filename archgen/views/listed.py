"""Rows of plain text for `archgen list`, one table for each kind of element."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from archgen.views import tables
from archgen.views.index import Index

Row = tuple[str, ...]


def listed(view: Index, sort: str) -> tuple[tuple[str, ...], list[Row]]:
    """Return the column names and rows for one kind of element (a key of `_TABLES_BY_KIND`)."""
    columns, rows = _SORTS[sort]
    return columns, list(rows(view))


def _components(view: Index) -> Iterator[Row]:
    for group in view.groups():
        for c in view.components(group):
            nodes = ", ".join(node.id for node in view.nodes_of.get(c.id, ()))
            yield (
                c.id,
                c.title,
                ", ".join(c.owners),
                c.role or "",
                str(len(c.inputs)),
                str(len(c.outputs)),
                nodes,
                str(c.at),
            )


def _nodes(view: Index) -> Iterator[Row]:
    for n in view.nodes():
        place = str(n.at) if n.written else ""
        owners = ", ".join(n.owners)
        yield (n.id, ", ".join(n.implements), owners, n.package or "", n.status or "", n.host or "", n.full_name, place)


def _groups(view: Index) -> Iterator[Row]:
    for name in view.groups():
        group = view.architecture.groups[name]
        yield (group.id, group.title, ", ".join(group.owners), str(len(group.components)), str(group.at))


def _connections(view: Index) -> Iterator[Row]:
    found = view.architecture
    for c in tables.shown_connections(view):
        outputs = [found.outputs[output] for output in c.outputs]
        types = ", ".join(dict.fromkeys(output.type or "?" for output in outputs))
        messages = ", ".join(dict.fromkeys("physical" if o.physical else found.message(o) or "?" for o in outputs))
        reader = ", ".join(found.components[found.inputs[c.input].component].owners)
        writers = ", ".join(dict.fromkeys(o for output in outputs for o in found.components[output.component].owners))
        yield (c.input, c.target, c.kind, types, messages, str(len(outputs)), writers, reader, str(c.at))


def _edges(view: Index) -> Iterator[Row]:
    found = view.architecture
    for edge in found.edges:
        output = found.outputs[edge.output]
        if view.scope.component(output.component) or view.scope.component(found.inputs[edge.input].component):
            yield (edge.output, edge.input, output.type or "?", found.message(output) or "", str(edge.at))


def _topics(view: Index) -> Iterator[Row]:
    for topic in view.architecture.topics.values():
        if any(view.scope.node(end.node) for end in (*topic.writers, *topic.readers)):
            writers = ", ".join(dict.fromkeys(end.node for end in topic.writers))
            readers = ", ".join(dict.fromkeys(end.node for end in topic.readers))
            yield (topic.name, topic.flow, ", ".join(topic.messages), writers, readers)


def _types(view: Index) -> Iterator[Row]:
    for mapped in tables.shown_types(view):
        yield (mapped.name, mapped.message or "", view.size(mapped), tables.type_remarks(mapped))


def _requirements(view: Index) -> Iterator[Row]:
    for r in tables.shown_requirements(view):
        served = ", ".join(component.id for component in view.components_for.get(r.id, ()))
        yield (r.id, r.title, ", ".join(r.use_cases), served, str(r.at))


def _chains(view: Index) -> Iterator[Row]:
    for chain in view.architecture.chains.values():
        yield (
            chain.id,
            chain.title,
            " > ".join(point.id for point in chain.through),
            str(chain.deadline or ""),
            str(chain.at),
        )


def _hosts(view: Index) -> Iterator[Row]:
    for host in view.architecture.hosts.values():
        nodes = ", ".join(node.id for node in view.nodes() if node.host == host.id)
        yield (host.id, host.title, str(host.cores or ""), nodes, str(host.at))


# The column names are the header of what `archgen list` writes, so they are visible to users.
_SORTS: dict[str, tuple[tuple[str, ...], Callable[[Index], Iterator[Row]]]] = {
    "components": (("id", "title", "owner", "role", "inputs", "outputs", "nodes", "place"), _components),
    "nodes": (("id", "implements", "owner", "package", "status", "host", "ros_name", "place"), _nodes),
    "groups": (("id", "title", "owner", "components", "place"), _groups),
    "connections": (
        ("input", "from", "kind", "types", "messages", "edges", "from_owner", "to_owner", "place"),
        _connections,
    ),
    "edges": (("output", "input", "type", "message", "place"), _edges),
    "topics": (("name", "flow", "messages", "writers", "readers"), _topics),
    "types": (("type", "message", "size", "remarks"), _types),
    "requirements": (("id", "title", "use_cases", "served_by", "place"), _requirements),
    "chains": (("id", "title", "through", "deadline", "place"), _chains),
    "hosts": (("id", "title", "cores", "nodes", "place"), _hosts),
}
