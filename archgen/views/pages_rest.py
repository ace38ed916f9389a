"""The site's pages around components and nodes: topics, types, requirements, use cases, hosts, partners."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator

from archgen.model.architecture import Partner, Requirement
from archgen.model.component import Component
from archgen.model.deployment import Host
from archgen.model.mapping import Type, flow_of
from archgen.model.node import Endpoint, Node, Topic
from archgen.views import tables, timing_of, words
from archgen.views.functional import component_table
from archgen.views.index import Index
from archgen.views.shapes import (
    Block,
    Bullets,
    Column,
    Facts,
    Inlines,
    Markdown,
    Page,
    Paragraph,
    Section,
    Table,
    Text,
    without_empty_columns,
)

Drawn = Callable[[Iterable[Block]], tuple[Block, ...]]
"""Drops the figures that were not drawn."""
_HOME = ("Overview", "page:index")
_FLOWS = {"topic": "Topic", "service": "Service", "action": "Action"}


def pages(view: Index, drawn: Drawn) -> Iterator[Page]:
    """Make a page for each type, requirement, use case, host, container and partner."""
    for mapped in tables.shown_types(view):
        yield _type(view, mapped)
    for requirement in tables.shown_requirements(view):
        yield _requirement(view, requirement)
    for name in view.architecture.use_cases:
        yield _use_case(view, name)
    for host in view.architecture.hosts.values():
        yield _host(view, host, drawn)
    for name in view.architecture.containers:
        yield _container(view, name)
    for partner in view.architecture.partners.values():
        yield _partner(view, partner, drawn)


def _page(section: Section, folder: str, crumb: tuple[str, str] | None, lead: str) -> Page:
    """Make a page below a folder; its name is the anchor without the kind before the colon."""
    crumbs = (_HOME, crumb) if crumb else (_HOME,)
    path = f"{folder}/{slug(section.anchor.partition(':')[2])}.html"
    return Page(path, section.anchor, section.title, folder, section, crumbs, lead)


def slug(name: str) -> str:
    """Turn a name into a file name that every system takes: lower case, words joined by hyphens."""
    # Different names may give the same slug; `_make_paths_distinct` numbers such pages.
    return re.sub(r"[^a-z0-9._-]+", "-", name.lower()).strip("-.") or "-"


def topics(view: Index) -> Iterator[Page]:
    """Make a page for each topic, service and action that a shown node uses."""
    for topic in _shown(view):
        yield _topic(view, topic)


def _shown(view: Index) -> list[Topic]:
    return [
        topic
        for topic in view.architecture.topics.values()
        if any(view.scope.node(endpoint.node) for endpoint in (*topic.writers, *topic.readers))
    ]


def topic_tables(view: Index) -> Iterator[Table]:
    """List topics, services and actions, each kind in a table of its own."""
    for flow, title in (("topic", "Topics"), ("service", "Services"), ("action", "Actions")):
        shown = [topic for topic in _shown(view) if topic.flow == flow]
        table = tables.topics(view, shown, f"table:{flow}s", title)
        if table:
            yield table


def _topic(view: Index, topic: Topic) -> Page:
    facts: list[tuple[str, Inlines]] = [
        ("Message", words.joined((Text(message, code=True),) for message in topic.messages) or words.UNKNOWN),
        ("Type", words.joined(words.type_link(name) for name in topic.types)),
        ("Size", words.text(size) if (size := view.size(topic)) else ()),
        *timing_of.topic_facts(view, topic.name),
    ]
    blocks: list[Block] = [Facts(tuple((name, value) for name, value in facts if value))]
    writer, reader = ("Server", "Client") if topic.flow != "topic" else ("Publisher", "Subscriber")
    blocks += _ends(view, topic, topic.writers, writer) + _ends(view, topic, topic.readers, reader)
    crumb = ("Topics, services and actions", "page:topics")
    return _page(Section(f"topic:{topic.name}", topic.name, tuple(blocks)), f"{topic.flow}s", crumb, _FLOWS[topic.flow])


def _ends(view: Index, topic: Topic, ends: tuple[Endpoint, ...], what: str) -> list[Block]:
    if not ends:
        return [Paragraph(words.text(Text(f"{what}s. ", strong=True), Text("None.", muted=True)))]
    rows = tuple(
        (
            words.text(words.node_link(view.architecture.nodes[end.node])),
            _component(view, end.component),
            # Ports by their own names: the component is in the column before.
            words.text(Text(end.port.rsplit(".", 1)[-1], code=True)) if end.port else (),
            words.qos_cell(end.qos) if topic.flow == "topic" else (),
        )
        for end in ends
    )
    columns = (Column(what), Column("Component", 1.3), Column("Port"), Column("QoS", 1.5))
    return [Table(f"table:{what.lower()}s/{topic.name}", f"{what}s", columns, rows)]


def _component(view: Index, component: str | None) -> Inlines:
    return words.text(words.component_link(view.architecture.components[component])) if component else ()


def node_table(view: Index, nodes: list[Node], component: Component | None = None) -> list[Block]:
    """List nodes with what they implement, package, status, host and timing; empty for no nodes.

    On the page of a `component`, that component itself is left out of the list of implemented ones.
    """
    if not nodes:
        return []
    found, own = view.architecture, component.id if component else None
    rows = tuple(
        (
            words.text(words.node_link(node)),
            words.joined((words.component_link(found.components[c]),) for c in node.implements if c != own),
            words.maybe(node.package),
            words.maybe(node.status),
            words.text(Text(node.host, ref=f"host:{node.host}")) if node.host else words.UNKNOWN,
            _timing(node),
        )
        for node in nodes
    )
    columns = (
        Column("Node", 1.2),
        Column("Implements too" if component else "Implements", 1.5),
        Column("Package", 1.3),
        Column("Status", 0.7),
        Column("Host", 0.8),
        Column("Timing"),
    )
    name, caption = (component.id, f"Nodes of {component.title}") if component else ("all", "Nodes")
    return [without_empty_columns(Table(f"table:nodes/{name}", caption, columns, rows))]


def _timing(node: Node) -> Inlines:
    """Return the timing of all components that a node implements, in short."""
    said = "; ".join(short for timing in node.timing.values() if (short := words.short_timing(timing)))
    return words.text(said) if said else ()


def _type(view: Index, mapped: Type) -> Page:
    facts = [
        ("Message", tables.message_of(view, mapped)),
        ("Size", _size(view, mapped)),
        ("Remarks", words.text(tables.type_remarks(mapped))),
    ]
    # An empty remark is not an empty tuple: it is one run of empty text, so the text is looked at, too.
    blocks: list[Block] = [Facts(tuple((name, value) for name, value in facts if value and value[0].text))]
    found = view.architecture
    produced = view.outputs_of_type.get(mapped.name, ())
    if produced:
        blocks += [
            Paragraph(words.text(Text("Produced by", strong=True))),
            Bullets(tuple(words.port_link(found, output) for output in produced)),
        ]
    readers = dict.fromkeys(c.input for output in produced for c in view.readers.get(output.id, ()))
    if readers:
        blocks += [
            Paragraph(words.text(Text("Read by", strong=True))),
            Bullets(tuple(words.port_link(found, found.inputs[name]) for name in readers)),
        ]
    section = Section(f"type:{mapped.name}", mapped.name, tuple(blocks))
    return _page(section, "types", ("Types", "page:types"), "Conceptual type")


def _size(view: Index, mapped: Type) -> Inlines:
    """Return the message size of a type, or why it is not known."""
    if size := view.size(mapped):
        return words.text(size)
    # Services and actions have no single size, and without a message the row above already says so.
    if mapped.message is None or flow_of(mapped.message) != "topic":
        return ()
    return words.text(Text(f"unknown: {view.message_size(mapped.message, None).why.replace('`', '')}", muted=True))


def _requirement(view: Index, requirement: Requirement) -> Page:
    facts = [
        ("Use cases", words.joined(tables.use_case(view, name) for name in requirement.use_cases)),
        ("Tags", words.text(", ".join(requirement.tags)) if requirement.tags else ()),
        ("Links", words.urls(requirement.urls.items())),
    ]
    blocks: list[Block] = [Paragraph(words.text(requirement.title))]
    blocks += [Facts(shown)] if (shown := tuple((name, value) for name, value in facts if value)) else []
    blocks += [Markdown(requirement.description)] if requirement.description else []
    serving = list(view.components_for.get(requirement.id, ()))
    if serving:
        blocks.append(component_table(view, f"table:serving/{requirement.id}", "Components that serve it", serving))
    else:
        blocks.append(Paragraph(words.text("No component serves this requirement yet."), "warning"))
    crumb = ("Requirements", "page:requirements")
    section = Section(f"requirement:{requirement.id}", requirement.id, tuple(blocks))
    return _page(section, "requirements", crumb, "Requirement")


def _use_case(view: Index, name: str) -> Page:
    use_case = view.architecture.use_cases[name]
    serving = [r for r in view.architecture.requirements.values() if name in r.use_cases]
    table = tables.requirements(view, serving)
    blocks: list[Block] = [Paragraph(words.text(use_case.title))]
    blocks += [Markdown(use_case.description)] if use_case.description else []
    blocks += [table] if table else []
    crumb = ("Requirements", "page:requirements")
    return _page(Section(f"use_case:{name}", name, tuple(blocks)), "use_cases", crumb, "Use case")


def _host(view: Index, host: Host, drawn: Drawn) -> Page:
    found = view.architecture
    facts = [
        ("Cores", words.text(str(host.cores)) if host.cores else words.UNKNOWN),
        ("Tags", words.text(", ".join(host.tags)) if host.tags else ()),
        (
            "Links",
            words.joined(
                words.text(Text(link.title, ref=f"link:{link.id}"))
                for link in found.links.values()
                if host.id in link.connects
            ),
        ),
        (
            "Containers",
            words.joined(
                words.text(Text(container.id, ref=f"container:{container.id}"))
                for container in found.containers.values()
                if container.host == host.id
            ),
        ),
    ]
    blocks: list[Block] = [Facts(tuple((name, value) for name, value in facts if value))]
    blocks += [Markdown(host.description)] if host.description else []
    blocks += drawn(timing_of.host_blocks(view, host.id))
    blocks += node_table(view, [node for node in view.nodes() if node.host == host.id])
    return _page(Section(f"host:{host.id}", host.title, tuple(blocks)), "hosts", ("Hosts", "page:hosts"), "Host")


def _container(view: Index, name: str) -> Page:
    container = view.architecture.containers[name]
    facts = [
        ("Host", words.text(Text(container.host, ref=f"host:{container.host}")) if container.host else words.UNKNOWN),
        ("Threads", words.text(str(container.threads)) if container.threads else words.UNKNOWN),
    ]
    nodes = node_table(view, [node for node in view.nodes() if node.container == name])
    crumb = ("Hosts", "page:hosts")
    section = Section(f"container:{name}", container.title, (Facts(tuple(facts)), *nodes))
    return _page(section, "containers", crumb, "Container")


def _partner(view: Index, partner: Partner, drawn: Drawn) -> Page:
    """Make a partner's page: contact, components, and the nodes that it owns or that implement its components."""
    blocks: list[Block] = [Markdown(partner.description)] if partner.description else []
    if partner.contact:
        blocks.append(Facts((("Contact", words.text(partner.contact)),)))
    owned = [c for c in view.architecture.components.values() if partner.id in c.owners and view.scope.component(c.id)]
    if owned:
        caption = f"Components of {partner.title}"
        blocks.append(component_table(view, f"table:owned/{partner.id}", caption, owned))
    mine = {component.id for component in owned}
    ids = {node.id for node in view.nodes() if partner.id in node.owners or mine & set(node.implements)}
    blocks += node_table(view, [node for node in view.nodes() if node.id in ids])
    if not blocks:
        blocks.append(Paragraph(words.text(Text("This partner owns nothing yet.", muted=True))))
    return _page(Section(f"partner:{partner.id}", partner.title, drawn(blocks)), "partners", None, "Partner")
