"""How large is the architecture, and how far along? The figures of `archgen stats`."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator
from fractions import Fraction
from typing import Literal

from archgen.frozen import dataclass
from archgen.grouping import group_pairs
from archgen.model.architecture import Architecture, list_annotated_elements
from archgen.model.component import Component
from archgen.model.element_annotations import PropertyDeclaration
from archgen.model.port_media import uses_ros
from archgen.model.requirement import add_wholes


@dataclass(frozen=True, slots=True)
class ArchitectureSize:
    """Counts of elements, and means as exact fractions (0 if there is nothing to divide by).

    `connections` are references as written, `edges` the pairs of output and input that they make. A connection is mapped
    if all outputs that it carries have a message (a planned message counts); what is no ROS needs none. `nodes` are
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
    composed: int = 0
    """Components that hold others: `components` counts what is left when everything is written out."""
    component_types: int = 0
    made_connections: int = 0
    """Those among `connections` that `autoconnect` made."""
    frames: int = 0
    variants: int = 0
    steps: int = 0
    """The steps of all use cases."""
    programs: int = 0
    """Those among the nodes that are no ROS: simulators, registries, brokers."""
    promises: int = 0
    """The outputs that promise something."""
    deprecated: int = 0
    """The outputs, types and component types that are going away."""
    verified: int = 0
    """The requirements that something verifies, or all of their parts."""
    property_values: int = 0
    """How often elements have a declared property."""


@dataclass(frozen=True, slots=True)
class ProgressCounts:
    """How many of a set of components have each kind of information.

    `described`: a functionality. `typed`: at least one port, and a type for each output. `mapped`: a node written in
    the project. `timed`: a timing, on the component or on all of its nodes. `traced`: a declared requirement. `seen`: each
    of its ends was seen on a robot that ran; None where nobody looked at one.
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
    seen: int | None = None


def measure_size(architecture: Architecture) -> ArchitectureSize:
    """Count the elements of each kind."""
    # The field names are keys of `archgen stats --format json` (through `asdict`) and of views/statistics.
    arch = architecture
    components, groups = len(arch.components), len(arch.groups)
    flows = [topic.flow for topic in arch.topics.values()]
    written_nodes = sum(node.written for node in arch.nodes.values())
    return ArchitectureSize(
        groups=groups,
        components=components,
        components_per_group=_exact_mean(components, groups),
        largest_group=max((len(group.components) for group in arch.groups.values()), default=0),
        connections=len(arch.connections),
        connections_per_component=_exact_mean(len(arch.connections), components),
        mapped_connections=count_mapped_connections(arch),
        edges=len(arch.edges),
        inputs=len(arch.inputs),
        outputs=len(arch.outputs),
        inputs_per_component=_exact_mean(len(arch.inputs), components),
        outputs_per_component=_exact_mean(len(arch.outputs), components),
        nodes=written_nodes,
        planned_nodes=len(arch.nodes) - written_nodes,
        topics=flows.count("topic"),
        services=flows.count("service"),
        actions=flows.count("action"),
        types=len(arch.types),
        messages=len(_distinct_messages(arch)),
        use_cases=len(arch.use_cases),
        requirements=len(arch.requirements),
        partners=len(arch.partners),
        hosts=len(arch.hosts),
        containers=len(arch.containers),
        links=len(arch.links),
        chains=len(arch.chains),
        views=len(arch.views),
        policies=len(arch.policies),
        composed=len(arch.shells),
        component_types=len(arch.component_types),
        made_connections=sum(connection.is_made for connection in arch.connections),
        frames=len(arch.frames),
        promises=sum(output.promise is not None for output in arch.outputs.values()),
        deprecated=sum(each.deprecated is not None for each in arch.outputs.values())
        + sum(each.deprecated is not None for each in arch.types.values())
        + sum(each.deprecated is not None for each in arch.component_types.values()),
        variants=len(arch.variants),
        steps=sum(len(use_case.steps) for use_case in arch.use_cases.values()),
        programs=sum("program" in node.kinds for node in arch.nodes.values()),
        verified=len(
            add_wholes(arch.requirements, (each.id for each in arch.requirements.values() if each.verified_by))
        ),
        property_values=sum(have for _, have, _ in count_declared_properties(arch)),
    )


def count_declared_properties(architecture: Architecture) -> tuple[tuple[PropertyDeclaration, int, int], ...]:
    """Return for each declared property how many elements have it, and how many others are of a kind that it names."""
    if not architecture.properties:
        return ()
    elements = list(list_annotated_elements(architecture))
    return tuple(
        (
            declared,
            sum(declared.id in each.element.annotations.properties for each in elements),
            sum(each.lacks(declared) for each in elements),
        )
        for declared in architecture.properties.values()
    )


def count_mapped_connections(architecture: Architecture) -> int:
    """Count the connections whose outputs all have a message, from their type or from the node that publishes them."""
    named_outputs = {e.port for e in architecture.endpoints if e.message and e.use in {"publishes", "serves"}}
    named_outputs.update(o.id for o in architecture.outputs.values() if not uses_ros(o) or architecture.message_of(o))
    return sum(bool(c.outputs) and named_outputs.issuperset(c.outputs) for c in architecture.connections)


def measure_progress(
    architecture: Architecture, selected: frozenset[str] | None = None, seen: frozenset[str] | None = None
) -> tuple[ProgressCounts, ...]:
    """Count for the project, each group, each partner, and (if there are partners) the components without an owner.

    `selected` are the ids of the components that count, None for all; `seen` those that were seen on a robot, if any was.
    """
    # For each component, one entry for each of its written nodes: whether that node has a timing for it.
    nodes_of = defaultdict[str, list[bool]](list)
    for node in architecture.nodes.values():
        for component in node.implements if node.written else ():
            nodes_of[component].append(component in node.timing)
    project = architecture.project
    all_components = architecture.components.values()

    def measure_set(
        scope: Literal["project", "group", "partner"], scope_id: str, title: str, components: Iterable[Component]
    ) -> ProgressCounts:
        members = tuple(c for c in components if selected is None or c.id in selected)
        return ProgressCounts(
            scope,
            scope_id,
            title,
            components=len(members),
            described=sum(bool(c.functionality) for c in members),
            typed=sum(_is_typed(c) for c in members),
            mapped=sum(c.id in nodes_of for c in members),
            timed=sum(c.timing is not None or (c.id in nodes_of and all(nodes_of[c.id])) for c in members),
            traced=sum(any(r.is_id and r.text in architecture.requirements for r in c.requirements) for c in members),
            seen=None if seen is None else sum(c.id in seen for c in members),
        )

    owned = group_pairs((owner, each) for each in all_components for owner in dict.fromkeys(each.owners))

    def list_rows() -> Iterator[ProgressCounts]:
        yield measure_set("project", project.id, project.title, all_components)
        for group in architecture.groups.values():
            yield measure_set("group", group.id, group.title, group.components.values())
        for partner in architecture.partners.values():
            yield measure_set("partner", partner.id, partner.title, owned.get(partner.id, ()))
        if architecture.partners and any(c.owner is None for c in all_components):
            yield measure_set("partner", "", "(nobody)", (c for c in all_components if c.owner is None))

    return tuple(list_rows())


def _is_typed(component: Component) -> bool:
    outputs = component.outputs.values()
    return bool(component.inputs or outputs) and all(output.type is not None for output in outputs)


def _distinct_messages(architecture: Architecture) -> set[str]:
    """Return the full names of all messages that topics or outputs carry."""
    topic_messages = {message for topic in architecture.topics.values() for message in topic.messages}
    return topic_messages | {m for o in architecture.outputs.values() if (m := architecture.message_of(o))}


def _exact_mean(total: int, count: int) -> Fraction:
    return Fraction(total, count) if count else Fraction(0)
