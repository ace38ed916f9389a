"""Look-ups that every view needs, built once for an architecture and its findings; what is known of each requirement among
them.
"""

from __future__ import annotations

import functools
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import TypeVar

from archgen.diagnostics import Diagnostic
from archgen.frozen import dataclass, field, replace
from archgen.grouping import group_pairs
from archgen.model.architecture import Architecture, Chain
from archgen.model.component import Component, Connection, Input, Output
from archgen.model.component_nesting import find_component, list_members, list_surrounding, list_written_connections
from archgen.model.coordinate_frames import Frame
from archgen.model.flow_graph import ComponentReach
from archgen.model.known_interfaces import InterfaceField
from archgen.model.message_types import ConceptualType
from archgen.model.node import Endpoint, Node, Topic
from archgen.model.port_media import ROS
from archgen.model.requirement import add_above, add_wholes, index_parts
from archgen.model.selector_keys import find_port_holder
from archgen.model.source_repository import SourceRepository
from archgen.model.step_connections import UseCaseSteps
from archgen.timing.system import message_sizes
from archgen.timing.system.timing_system import Activity
from archgen.views.shapes import Status
from archgen.views.timing.timing_lookup import TimingLookup
from archgen.views.type_names import TypeTexts


@dataclass(frozen=True, slots=True)
class RequirementTrace:
    """The ids of requirements by what holds of them. A requirement with parts has what all of its parts have."""

    parts: Mapping[str, list[str]] = field(default_factory=dict)
    """The direct parts of each requirement that has any."""
    served: frozenset[str] = frozenset()
    verified: frozenset[str] = frozenset()
    missed: frozenset[str] = frozenset()
    """Those that a chain serves or verifies which misses its deadline, and all that these are part of."""
    unfinished: frozenset[str] = frozenset()
    """Those of which a part is not served, or a chain is not proven to meet its deadline."""
    is_verification_told: bool = False
    """Whether the project says of any requirement what verifies it. One that says it nowhere is not asked."""

    def judge(self, requirement_id: str) -> Status:
        """Return the state of a requirement: uncovered, missed, open (nothing shows yet that it is met), or met."""
        if requirement_id not in self.served:
            return "uncovered"
        if requirement_id in self.missed:
            return "missed"
        is_unverified = self.is_verification_told and requirement_id not in self.verified
        return "open" if is_unverified or requirement_id in self.unfinished else "met"


def _trace_requirements(
    architecture: Architecture, served_ids: Iterable[str], chain_verdicts: Mapping[str, str]
) -> RequirementTrace:
    """Return what is known of all requirements.

    `served_ids` are those that a component or chain names, `chain_verdicts` the verdicts on chains (met, missed, not
    proven, open) by id, as far as timing was analysed.
    """
    requirements = architecture.requirements
    if not requirements:
        return RequirementTrace()
    parts = index_parts(requirements)
    served = add_wholes(requirements, served_ids)
    own_verified = {each.id for each in requirements.values() if each.verified_by}
    verified = add_wholes(requirements, own_verified)
    missed = set(_list_judged(architecture, chain_verdicts, {"missed"}))
    unproven = set(_list_judged(architecture, chain_verdicts, {"not proven", "open"}))
    unfinished = unproven.union(each for each in requirements if each not in served)
    return RequirementTrace(
        parts,
        served,
        verified,
        add_above(requirements, missed) | missed,
        add_above(requirements, unfinished) | unproven,
        bool(own_verified),
    )


def _list_judged(architecture: Architecture, chain_verdicts: Mapping[str, str], verdicts: set[str]) -> Iterator[str]:
    """Yield the requirements that a chain with such a verdict serves or verifies."""
    chain_ids = {
        chain
        for chain, verdict in chain_verdicts.items()
        if verdict in verdicts and architecture.chains[chain].deadline is not None
    }
    for chain in sorted(chain_ids):
        yield from (name for name in architecture.chains[chain].requirements if name in architecture.requirements)
    for requirement in architecture.requirements.values() if chain_ids else ():
        if any(each.kind == "chain" and each.text in chain_ids for each in requirement.verified_by):
            yield requirement.id


T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class DocumentScope:
    """What a document shows: full ids of components and nodes, or None for everything."""

    components: frozenset[str] | None = None
    nodes: frozenset[str] | None = None
    selector_text: str = ""
    """The selector as the user wrote it."""

    def shows_component(self, component_id: str) -> bool:
        """Whether a component is shown."""
        return self.components is None or component_id in self.components

    def shows_node(self, node_id: str) -> bool:
        """Whether a node is shown."""
        return self.nodes is None or node_id in self.nodes


@dataclass(frozen=True, slots=True)
class Lookup:
    """An architecture with its look-ups; all keys are full ids, mappings keep the order of the architecture."""

    architecture: Architecture
    findings: tuple[Diagnostic, ...] = ()
    scope: DocumentScope = field(default_factory=DocumentScope)
    readers_of: Mapping[str, tuple[Connection, ...]] = field(default_factory=dict)
    """Connections that read an output, by the output's id."""
    written_connections: tuple[tuple[Input, Connection], ...] = ()
    """All connections with their inputs, those of composed components included."""
    connection_positions: Mapping[str, tuple[int, ...]] = field(default_factory=dict)
    """Positions in `written_connections` of those at a component or inside of it, by its id; one is there twice where both
    ends are its own."""
    nodes_of: Mapping[str, tuple[Node, ...]] = field(default_factory=dict)
    """Nodes that implement a component, by the component's id."""
    awaiting: Mapping[str, tuple[Node, ...]] = field(default_factory=dict)
    """Nodes that wait for an element at the start, by its id."""
    endpoints_of: Mapping[str, tuple[Endpoint, ...]] = field(default_factory=dict)
    """Endpoints of a node, by the node's id."""
    findings_of: Mapping[str, tuple[Diagnostic, ...]] = field(default_factory=dict)
    """Findings by the element they concern; findings about a port are listed under its component."""
    components_for_requirement: Mapping[str, tuple[Component, ...]] = field(default_factory=dict)
    """Components that serve a requirement, by the requirement's id."""
    chains_for_requirement: Mapping[str, tuple[Chain, ...]] = field(default_factory=dict)
    """Chains that serve a requirement, by the requirement's id."""
    requirement_trace: RequirementTrace = field(default_factory=RequirementTrace)
    """Which requirements are served, verified and met."""
    outputs_of_type: Mapping[str, tuple[Output, ...]] = field(default_factory=dict)
    """Outputs by the name of their conceptual type."""
    other_types: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    """Types that travel over ROS nowhere, with the words for what they travel over: they need no message."""
    frames_of: Mapping[str, tuple[Frame, ...]] = field(default_factory=dict)
    """Frames that a component writes, by the component's id."""
    group_hues: Mapping[str, int] = field(default_factory=dict)
    """Position of each group in the architecture: the base of its colour."""
    # A closure over the interfaces: it has no useful equality or repr, so both leave it out.
    message_size: message_sizes.SizeQuery = field(kw_only=True, compare=False, repr=False)
    """Size of a message on the wire, by message and type."""
    repository: SourceRepository | None = None
    """Where the project's files are on the web, with the project's folder in it."""
    # Computed when somebody asks: most views show no use case.
    steps: UseCaseSteps = field(kw_only=True, compare=False, repr=False)
    """The steps of use cases, with what they run along."""
    reach: ComponentReach = field(kw_only=True, compare=False, repr=False)
    """Which components are fed by which in the end."""
    type_texts: TypeTexts = field(kw_only=True, compare=False, repr=False)
    """Where the texts of component types are."""
    timing: TimingLookup | None = None
    """Results of the timing analysis; None for the many views that need no timing."""

    def shown_groups(self) -> list[str]:
        """Return the ids of the groups with at least one shown component, in order; without a scope, of all."""
        groups = self.architecture.groups.values()
        if self.scope.components is None:
            return [group.id for group in groups]
        # A selection holds components and nodes, never groups: a group is shown as soon as one of its components is.
        return [g.id for g in groups if any(c.id in self.scope.components for c in g.components.values())]

    def shown_components(self, group_id: str) -> list[Component]:
        """Return the shown components of a group, in order."""
        group_components = self.architecture.groups[group_id].components.values()
        return [component for component in group_components if self.scope.shows_component(component.id)]

    def shown_members(self, group_id: str) -> list[Component]:
        """Return the shown components that stand directly in a group, composed ones closed."""
        return self._keep_shown(list_members(self.architecture, group_id))

    def shown_children(self, shell: Component) -> list[Component]:
        """Return the shown components that stand directly in a composed component."""
        return self._keep_shown(shell.children)

    def nested_components(self) -> Iterator[Component]:
        """Yield the shown components group by group, a composed one before what is inside."""
        pending = [c for name in reversed(self.shown_groups()) for c in reversed(self.shown_members(name))]
        while pending:
            yield (component := pending.pop())
            pending += reversed(self.shown_children(component))

    def _keep_shown(self, component_ids: Iterable[str]) -> list[Component]:
        return [find_component(self.architecture, name) for name in component_ids if self.shows_part(name)]

    def connections_at(self, component_id: str) -> list[tuple[Input, Connection]]:
        """Return the connections at a component, those of what is inside of a composed one included."""
        positions = dict.fromkeys(self.connection_positions.get(component_id, ()))
        return [self.written_connections[position] for position in positions]

    def shows_part(self, component_id: str) -> bool:
        """Whether a component is shown, of a composed one whether anything inside is."""
        if self.scope.components is None:
            return True
        return any(map(self.scope.shows_component, self.architecture.leaves_of(component_id)))

    def nodes_inside(self, component_id: str) -> tuple[Node, ...]:
        """Return the nodes that implement a component, or what is inside of a composed one."""
        leaves = self.architecture.leaves_of(component_id)
        nodes = {node.id: node for leaf in leaves for node in self.nodes_of.get(leaf, ())}
        return tuple(nodes.values())

    def shown_nodes(self) -> list[Node]:
        """Return the shown nodes, in order."""
        return [node for node in self.architecture.nodes.values() if self.scope.shows_node(node.id)]

    def format_size(self, carrier: ConceptualType | Topic) -> str:
        """Return the message size of a type or topic as text: as written, else as computed, else empty."""
        if carrier.size is not None:
            return str(carrier.size)
        messages = carrier.messages if isinstance(carrier, Topic) else (carrier.message,)
        # No single size would be right for a topic with several messages.
        return str(self.message_size(messages[0], None)) if len(messages) == 1 else ""


def make_lookup(
    architecture: Architecture,
    findings: Iterable[Diagnostic] = (),
    scope: DocumentScope | None = None,
    timing_lookup: TimingLookup | None = None,
) -> Lookup:
    """Build all look-ups, each in one pass over the architecture."""
    all_findings = tuple(findings)
    nodes = architecture.nodes.values()
    written_connections = tuple(list_written_connections(architecture))
    components_for_requirement = group_values(
        (use.text, c) for c in architecture.list_described_components() for use in c.requirements if use.is_id
    )
    chains_for_requirement = group_values(
        (r, chain) for chain in architecture.chains.values() for r in chain.requirements
    )
    ports: tuple[Input | Output, ...] = (*architecture.inputs.values(), *architecture.outputs.values())
    media: dict[str, dict[str, None]] = {}
    for port in ports:
        if port.type:
            media.setdefault(port.type, {})[port.medium] = None
    return Lookup(
        architecture,
        all_findings,
        scope or DocumentScope(),
        readers_of=group_values((o, connection) for connection in architecture.connections for o in connection.outputs),
        written_connections=written_connections,
        connection_positions=group_values(_list_ends(architecture, written_connections)),
        nodes_of=group_values((component, node) for node in nodes for component in node.implements),
        awaiting=group_values((each, node) for node in nodes if node.start for each in node.start.list_awaited()),
        endpoints_of=group_values((endpoint.node, endpoint) for endpoint in architecture.list_endpoints()),
        findings_of=group_values((find_port_holder(architecture, f.element), f) for f in all_findings if f.element),
        components_for_requirement=components_for_requirement,
        chains_for_requirement=chains_for_requirement,
        requirement_trace=_trace_requirements(
            architecture, (*components_for_requirement, *chains_for_requirement), _list_chain_verdicts(timing_lookup)
        ),
        outputs_of_type=group_values((o.type, o) for o in architecture.outputs.values() if o.type),
        other_types={name: tuple(words) for name, words in media.items() if ROS not in words},
        frames_of=group_values(
            (frame.by, frame)
            for frame in architecture.frames.values()
            if frame.by and frame.by_kind == "component" and frame.parent is not None
        ),
        group_hues={group: hue for hue, group in enumerate(architecture.groups)},
        message_size=message_sizes.make_size_query(architecture),
        steps=UseCaseSteps(architecture),
        reach=ComponentReach(architecture),
        type_texts=TypeTexts(architecture),
        timing=timing_lookup,
    )


def add_timing(lookup: Lookup, timing_lookup: TimingLookup) -> Lookup:
    """Return look-ups with the results of the timing analysis: a requirement whose chain misses its deadline is missed."""
    trace = _trace_requirements(
        lookup.architecture,
        (*lookup.components_for_requirement, *lookup.chains_for_requirement),
        _list_chain_verdicts(timing_lookup),
    )
    return replace(lookup, timing=timing_lookup, requirement_trace=trace)


def _list_chain_verdicts(timing_lookup: TimingLookup | None) -> dict[str, str]:
    return {result.id: result.verdict for result in (timing_lookup.chains if timing_lookup else ())}


def _list_ends(
    architecture: Architecture, connections: Iterable[tuple[Input, Connection]]
) -> Iterable[tuple[str, int]]:
    """Yield the components at and around each end of each connection, with the connection's position."""
    for position, (port, connection) in enumerate(connections):
        outputs = (architecture.outputs[name] for name in connection.outputs if name in architecture.outputs)
        for component_id in (port.component, *(output.component for output in outputs)):
            yield component_id, position
            yield from ((shell, position) for shell in list_surrounding(architecture, component_id))


def group_values(pairs: Iterable[tuple[str, T]]) -> dict[str, tuple[T, ...]]:
    """Collect values by key; keys and values keep the order in which they come."""
    lists_by_key = group_pairs(pairs)
    return {key: tuple(items) for key, items in lists_by_key.items()}


def collect_messages(
    architecture: Architecture, types: Iterable[ConceptualType], topics: Iterable[Topic]
) -> dict[str, tuple[str, ...]]:
    """Return the messages that these types and topics use, and those inside of them, with the anchors of who uses each."""
    users: defaultdict[str, list[str]] = defaultdict(list)
    for conceptual_type in types:
        if conceptual_type.message:
            users[conceptual_type.message].append(f"type:{conceptual_type.name}")
    for topic in topics:
        for message in topic.messages:
            users[message].append(f"topic:{topic.name}")
    # A message that another one contains is used where that one is. The list grows while it is walked.
    pending = list(users)
    for message in pending:
        for part in list_fields(architecture, message):
            if "/" in part.type and part.type not in users:
                users[part.type] = list(users[message])
                pending.append(part.type)
    return {message: tuple(anchors) for message, anchors in users.items()}


def list_fields(architecture: Architecture, message: str) -> tuple[InterfaceField, ...]:
    """Return the fields of all parts of a message; none where its definition is not at hand."""
    definition = architecture.interfaces.definitions.get(message)
    return tuple(each for part in definition.parts for each in part) if definition else ()


def remember_views(
    make: Callable[[Lookup, Sequence[Activity]], T],
) -> Callable[[Lookup, Sequence[Activity]], T]:
    """Return a function that makes what it shows of activities once: the pages of a component and of its node both show it."""

    @functools.wraps(make)
    def recall_or_make(lookup: Lookup, activities: Sequence[Activity]) -> T:
        if lookup.timing is None:
            return make(lookup, activities)
        key = make.__name__, tuple(each.id for each in activities)
        if key not in lookup.timing.remembered:
            lookup.timing.remembered[key] = make(lookup, activities)
        views: T = lookup.timing.remembered[key]
        return views

    return recall_or_make
