"""How large is the architecture, and how far along? The figures of `archgen stats`."""

from __future__ import annotations

from collections import defaultdict
from fractions import Fraction
from typing import TYPE_CHECKING, Literal

from archgen.frozen import dataclass

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from archgen.model.architecture import Architecture
    from archgen.model.component import Component


@dataclass(frozen=True, slots=True)
class Size:
    """Counts of elements, and means as exact fractions (0 if there is nothing to divide by).

    `connections` are references as written, `edges` the pairs of output and input that they make. A connection is mapped
    if all outputs that it carries have a message (a planned message counts); physical outputs need none. `nodes` are
    those written in the project, `planned_nodes` those that archgen adds. `messages` are distinct names.
    """

    groups: int
    components: int
    components_per_group: Fraction
    largest_group: int
    connections: int
    connections_per_component: Fraction
    mapped_connections: int
    edges: int
    inputs: int
    outputs: int
    inputs_per_component: Fraction
    outputs_per_component: Fraction
    nodes: int
    planned_nodes: int
    topics: int
    services: int
    actions: int
    types: int
    messages: int
    use_cases: int
    requirements: int
    partners: int
    hosts: int
    containers: int
    links: int
    chains: int
    views: int
    policies: int


@dataclass(frozen=True, slots=True)
class Progress:
    """How many of a set of components have each kind of information.

    `described`: a functionality. `typed`: at least one port, and a type for each output. `mapped`: a node written in
    the project. `timed`: a timing, on the component or on all of its nodes. `traced`: a declared requirement.
    """

    scope: Literal["project", "group", "partner"]
    id: str
    """The id of the project, group or partner; empty for the components without an owner."""
    title: str
    components: int
    described: int
    typed: int
    mapped: int
    timed: int
    traced: int


def size(architecture: Architecture) -> Size:
    """Count the elements of each kind."""
    # The field names are keys of `archgen stats --format json` (through `asdict`) and of views/statistics.
    a = architecture
    components, groups = len(a.components), len(a.groups)
    flows = [topic.flow for topic in a.topics.values()]
    written = sum(node.written for node in a.nodes.values())
    return Size(
        groups=groups,
        components=components,
        components_per_group=_mean(components, groups),
        largest_group=max((len(group.components) for group in a.groups.values()), default=0),
        connections=len(a.connections),
        connections_per_component=_mean(len(a.connections), components),
        mapped_connections=mapped_connections(a),
        edges=len(a.edges),
        inputs=len(a.inputs),
        outputs=len(a.outputs),
        inputs_per_component=_mean(len(a.inputs), components),
        outputs_per_component=_mean(len(a.outputs), components),
        nodes=written,
        planned_nodes=len(a.nodes) - written,
        topics=flows.count("topic"),
        services=flows.count("service"),
        actions=flows.count("action"),
        types=len(a.types),
        messages=len(_messages(a)),
        use_cases=len(a.use_cases),
        requirements=len(a.requirements),
        partners=len(a.partners),
        hosts=len(a.hosts),
        containers=len(a.containers),
        links=len(a.links),
        chains=len(a.chains),
        views=len(a.views),
        policies=len(a.policies),
    )


def mapped_connections(architecture: Architecture) -> int:
    """Count the connections whose outputs all have a message, from their type or from the node that publishes them."""
    named = {e.port for e in architecture.endpoints if e.message and e.use in {"publishes", "serves"}}
    named.update(o.id for o in architecture.outputs.values() if o.physical or architecture.message(o))
    return sum(bool(c.outputs) and named.issuperset(c.outputs) for c in architecture.connections)


def progress(architecture: Architecture) -> tuple[Progress, ...]:
    """Count for the project, each group, each partner, and (if there are partners) the components without an owner."""
    # For each component, one entry for each of its written nodes: whether that node has a timing for it.
    nodes_of = defaultdict[str, list[bool]](list)
    for node in architecture.nodes.values():
        for component in node.implements if node.written else ():
            nodes_of[component].append(component in node.timing)
    project = architecture.project
    every = architecture.components.values()

    def measure(
        scope: Literal["project", "group", "partner"], name: str, title: str, components: Iterable[Component]
    ) -> Progress:
        of = tuple(components)
        return Progress(
            scope,
            name,
            title,
            components=len(of),
            described=sum(bool(c.functionality) for c in of),
            typed=sum(_typed(c) for c in of),
            mapped=sum(c.id in nodes_of for c in of),
            timed=sum(c.timing is not None or (c.id in nodes_of and all(nodes_of[c.id])) for c in of),
            traced=sum(any(r.is_id and r.text in architecture.requirements for r in c.requirements) for c in of),
        )

    def rows() -> Iterator[Progress]:
        yield measure("project", project.id, project.title, every)
        for group in architecture.groups.values():
            yield measure("group", group.id, group.title, group.components.values())
        for partner in architecture.partners.values():
            yield measure("partner", partner.id, partner.title, (c for c in every if partner.id in c.owners))
        if architecture.partners and any(c.owner is None for c in every):
            yield measure("partner", "", "(nobody)", (c for c in every if c.owner is None))

    return tuple(rows())


def _typed(component: Component) -> bool:
    outputs = component.outputs.values()
    return bool(component.inputs or outputs) and all(output.type is not None for output in outputs)


def _messages(architecture: Architecture) -> set[str]:
    """Return the full names of all messages that topics or outputs carry."""
    used = {message for topic in architecture.topics.values() for message in topic.messages}
    return used | {m for o in architecture.outputs.values() if (m := architecture.message(o))}


def _mean(total: int, parts: int) -> Fraction:
    return Fraction(total, parts) if parts else Fraction(0)
