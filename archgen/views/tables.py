"""Tables across the architecture: connections, types, requirements, hosts, chains, topics, findings.

Each function returns None where there would be no rows, because a `Table` without rows must not exist.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable

from archgen.diagnostic import Diagnostic, Severity
from archgen.model.architecture import Chain, Requirement
from archgen.model.component import Connection
from archgen.model.mapping import Type
from archgen.model.node import Topic
from archgen.views import words
from archgen.views.functional import first_sentence
from archgen.views.index import Index
from archgen.views.shapes import Column, Inlines, Table, Text

Rows = tuple[tuple[Inlines, ...], ...]


def groups(view: Index) -> Table | None:
    """List the shown groups with owners, size and purpose."""
    found = view.architecture
    rows = tuple(
        (
            words.text(words.group_link(found, name)),
            words.owner_links(found, found.groups[name].owners),
            words.text(str(len(found.groups[name].components))),
            words.maybe(first_sentence(found.groups[name].description)),
        )
        for name in view.groups()
    )
    columns = (Column("Group", 1.1), Column("Owner"), Column("Components", 0.6, "right"), Column("Purpose", 2.5))
    return Table("table:groups", "Groups of components", columns, rows) if rows else None


def connections(view: Index, shown: Iterable[Connection], anchor: str = "table:connections") -> Table | None:
    """List connections: input, source, type, message and number of edges."""
    found = view.architecture
    rows = tuple(
        (
            words.port_link(found, found.inputs[connection.input]),
            words.source_words(found, connection),
            _types(view, connection),
            _messages(view, connection),
            words.text(str(len(connection.outputs))),
        )
        for connection in shown
    )
    columns = (
        Column("Input", 1.6),
        Column("Comes from", 1.6),
        Column("Type", 1.2),
        Column("Message", 1.6),
        Column("Edges", 0.5, "right"),
    )
    return Table(anchor, "All connections", columns, rows, wide=True) if rows else None


def _types(view: Index, connection: Connection) -> Inlines:
    names = dict.fromkeys(view.architecture.outputs[output].type for output in connection.outputs)
    return words.joined(words.type_link(name) for name in names)


def _messages(view: Index, connection: Connection) -> Inlines:
    """Return the messages that a connection carries."""
    found = view.architecture
    outputs = [found.outputs[output] for output in connection.outputs]
    # `physical` is a remark in place of a message, hence not set as code.
    names = dict.fromkeys("physical" if o.physical else found.message(o) for o in outputs)
    return words.joined((Text(name, code=name != "physical"),) if name else words.UNKNOWN for name in names)


def shown_connections(view: Index) -> list[Connection]:
    """Return the connections with at least one end in scope."""
    found = view.architecture
    return [
        connection
        for connection in found.connections
        if view.scope.component(found.inputs[connection.input].component)
        or any(view.scope.component(found.outputs[output].component) for output in connection.outputs)
    ]


def shown_types(view: Index) -> list[Type]:
    """Return the types that shown ports use or read; without a scope all of them, used or not."""
    found = view.architecture
    if view.scope.components is None:
        return list(found.types.values())
    used = {output.type for output in found.outputs.values() if view.scope.component(output.component)}
    used |= {port.type for port in found.inputs.values() if view.scope.component(port.component)}
    for connection in shown_connections(view):
        used |= {found.outputs[output].type for output in connection.outputs}
    # In the order of the type mapping, not of the ports.
    return [mapped for mapped in found.types.values() if mapped.name in used]


def types(view: Index) -> Table | None:
    """List conceptual types with the messages that carry them."""
    rows = tuple(
        (
            words.type_link(mapped.name),
            message_of(view, mapped),
            words.text(size) if (size := view.size(mapped)) else (),
            words.text(str(len(view.outputs_of_type.get(mapped.name, ())))),
            words.text(type_remarks(mapped)),
        )
        for mapped in shown_types(view)
    )
    columns = (
        Column("Conceptual type", 1.3),
        Column("ROS message", 1.9),
        Column("Size", 0.6, "right"),
        Column("Outputs", 0.5, "right"),
        Column("Remarks", 1.6),
    )
    return Table("table:types", "Mapping of conceptual types to ROS messages", columns, rows) if rows else None


def message_of(view: Index, mapped: Type) -> Inlines:
    """Return the message of a type, or that it needs none, or that it is not known yet."""
    if mapped.message:
        return words.text(Text(mapped.message, code=True))
    return words.text(Text("none: physical", muted=True)) if mapped.name in view.physical_types else words.UNKNOWN


def type_remarks(mapped: Type) -> str:
    """Describe the rest of a type's mapping on one line: comment, status, parts of a service or action."""
    inside = [
        f"{what}: {name}"
        for what, name in (("request", mapped.request), ("response", mapped.response), ("feedback", mapped.feedback))
        if name
    ]
    planned = "message is planned" if mapped.status == "planned" else ""
    comment = " ".join((mapped.comment or "").split())
    return "; ".join(part for part in (comment, planned, *inside) if part)


def requirements(view: Index, shown: Iterable[Requirement]) -> Table | None:
    """List requirements with the components that serve them."""
    rows = tuple(
        (
            words.text(Text(requirement.id, ref=f"requirement:{requirement.id}")),
            words.text(requirement.title),
            words.joined(use_case(view, name) for name in requirement.use_cases),
            words.joined(
                (words.component_link(component),) for component in view.components_for.get(requirement.id, ())
            )
            or words.text(Text("no component yet", muted=True)),
        )
        for requirement in shown
    )
    columns = (
        Column("Id", 0.5),
        Column("Requirement", 1.8),
        Column("Use cases", 1.0),
        Column("Served by", 1.8),
    )
    return (
        Table("table:requirements", "Requirements and the components that serve them", columns, rows) if rows else None
    )


def use_case(view: Index, name: str) -> Inlines:
    """Link to a use case; plain text where it is not declared."""
    found = view.architecture.use_cases.get(name)
    return words.text(Text(name, ref=f"use_case:{name}")) if found else words.text(name)


def shown_requirements(view: Index) -> list[Requirement]:
    """Return the requirements that shown components serve; without a scope all of them."""
    found = view.architecture
    if view.scope.components is None:
        return list(found.requirements.values())
    return [
        requirement
        for requirement in found.requirements.values()
        if any(view.scope.component(component.id) for component in view.components_for.get(requirement.id, ()))
    ]


def free_requirements(view: Index) -> Table | None:
    """List the requirements that components state in their own words instead of by id."""
    rows = tuple(
        (words.text(words.component_link(component)), words.text(use.text))
        for group in view.groups()
        for component in view.components(group)
        for use in component.requirements
        if not use.is_id
    )
    columns = (Column("Component"), Column("Requirement", 2.5))
    return Table("table:own_requirements", "Requirements in the components' own words", columns, rows) if rows else None


def open_points(findings: Iterable[Diagnostic], anchor: str = "table:open_points") -> Table | None:
    """List findings with their help and their place."""
    rows = tuple(
        (
            words.text(Text(finding.severity or "", strong=finding.severity is Severity.ERROR)),
            words.lines(_finding(finding)),
            words.text(Text(f"{finding.span.file}:{finding.span.line}" if finding.span.file else "", code=True)),
            words.text(finding.rule),
        )
        for finding in findings
    )
    columns = (Column("Severity", 0.6), Column("Finding", 3), Column("Place", 1.3), Column("Rule", 1))
    return Table(anchor, "Open points", columns, rows) if rows else None


def _finding(finding: Diagnostic) -> list[Inlines]:
    """Return the message of a finding and, muted, its help."""
    return [words.spoken(said, muted=muted) for said, muted in ((finding.message, False), (finding.help, True)) if said]


def hosts(view: Index) -> Table | None:
    """List hosts with their containers and the shown nodes."""
    found = view.architecture
    rows = tuple(
        (
            words.text(Text(host.title, ref=f"host:{host.id}")),
            words.text(str(host.cores)) if host.cores else words.UNKNOWN,
            words.joined(
                words.text(Text(container.id, ref=f"container:{container.id}"))
                for container in found.containers.values()
                if container.host == host.id
            ),
            words.joined((words.node_link(node),) for node in view.nodes() if node.host == host.id),
        )
        for host in found.hosts.values()
    )
    columns = (Column("Host"), Column("Cores", 0.5, "right"), Column("Containers"), Column("Nodes", 3))
    return Table("table:hosts", "Hosts and what runs on them", columns, rows) if rows else None


def links(view: Index) -> Table | None:
    """List the links between hosts."""
    rows = tuple(
        (
            words.text(Text(link.title, ref=f"link:{link.id}")),
            words.joined(words.text(Text(host, ref=f"host:{host}")) for host in link.connects),
            words.maybe(str(link.bandwidth) if link.bandwidth else None),
            words.maybe(f"{link.best or '?'} to {link.worst or '?'}" if link.best or link.worst else None),
        )
        for link in view.architecture.links.values()
    )
    columns = (Column("Link"), Column("Connects", 1.5), Column("Bandwidth"), Column("Latency"))
    # Links have no page or section of their own: references to one lead to its row.
    anchors = tuple(f"link:{name}" for name in view.architecture.links)
    return Table("table:links", "Links between hosts", columns, rows, row_anchors=anchors) if rows else None


def chains(view: Index, shown: Iterable[Chain]) -> Table | None:
    """List chains of effect with their deadlines."""
    found = view.architecture
    listed = list(shown)
    rows = tuple(
        (
            words.text(Text(chain.title, ref=f"chain:{chain.id}")),
            words.joined((waypoint(view, point.kind, point.id) for point in chain.through), " → "),
            words.maybe(str(chain.deadline) if chain.deadline else None),
            words.joined(words.requirement_link(found, name)[:1] for name in chain.requirements),
        )
        for chain in listed
    )
    columns = (Column("Chain"), Column("Through", 3), Column("Deadline", 0.7, "right"), Column("Requirements", 0.8))
    # Rows take references only in this table. Where timing judged the chains, `make_bound_table` replaces it, and each
    # chain has a section with this anchor; anchors must be unique in a document.
    anchors = tuple(f"chain:{chain.id}" for chain in listed)
    return Table("table:chains", "Chains of effect and their deadlines", columns, rows, anchors) if rows else None


def waypoint(view: Index, kind: str, name: str) -> Inlines:
    """Link to one element of a chain: a node, a component or an output."""
    found = view.architecture
    if kind == "node":
        return (words.node_link(found.nodes[name]),)
    if kind == "component":
        return (words.component_link(found.components[name]),)
    return words.port_link(found, found.outputs[name])


def topics(view: Index, shown: Iterable[Topic], anchor: str, caption: str) -> Table | None:
    """List topics, services or actions with writers and readers."""
    nodes = view.architecture.nodes
    rows = tuple(
        (
            words.text(words.topic_link(topic.name)),
            words.joined((Text(message, code=True),) for message in topic.messages) or words.UNKNOWN,
            # A node may have several endpoints on a topic; it is named once.
            words.joined((words.node_link(nodes[e]),) for e in dict.fromkeys(w.node for w in topic.writers)),
            words.joined((words.node_link(nodes[e]),) for e in dict.fromkeys(r.node for r in topic.readers)),
        )
        for topic in shown
    )
    columns = (Column("Name", 1.5), Column("Message", 1.6), Column("From", 1.2), Column("To", 1.5))
    return Table(anchor, caption, columns, rows) if rows else None


def severities(findings: Iterable[Diagnostic]) -> str:
    """Count findings in words: `1 error, 2 warnings and 3 notes`, or `nothing`."""
    counts = Counter(finding.severity for finding in findings)
    names = ((Severity.ERROR, "error"), (Severity.WARNING, "warning"), (Severity.NOTE, "note"))
    said = [words.plural(counts[severity], noun) for severity, noun in names if counts[severity]]
    return " and ".join([", ".join(said[:-1]), said[-1]]) if len(said) > 1 else said[0] if said else "nothing"
