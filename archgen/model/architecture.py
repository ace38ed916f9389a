"""The architecture: components, nodes, the mapping between them, and requirements, partners, chains and views; which
elements have annotations, and which were made by passes, from what.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Literal, Protocol

from archgen.diagnostics import NO_SPAN, Span
from archgen.frozen import NamedTuple, dataclass, field
from archgen.language.language_tables import ANNOTATED_KINDS, SECTION_KINDS
from archgen.model import port_media
from archgen.model.agreed_terms import Agreement
from archgen.model.component import Component, ComponentType, Connection, DiagramLayout, Group, Input, Output
from archgen.model.coordinate_frames import Frame
from archgen.model.deployment import Container, Host, Link, Resource
from archgen.model.element_annotations import NO_ANNOTATIONS, ElementAnnotations, PropertyDeclaration
from archgen.model.known_interfaces import Interfaces
from archgen.model.message_types import ConceptualType
from archgen.model.node import Endpoint, Node, Topic
from archgen.model.parameter import ParameterValue
from archgen.model.project_settings import ConformSettings, GenerateSettings, ReviewSettings
from archgen.model.quantity import Quantity
from archgen.model.requirement import Requirement
from archgen.model.source_repository import SourceRepository
from archgen.model.use_case_steps import Actor, Step
from archgen.model.variant import Variant

ElementPlace = tuple[str, int, int]
"""File, line and column of an element; column 0 for whatever begins on that line."""


class MadeElement(NamedTuple):
    """What an element was made from."""

    passes: tuple[str, ...]
    """The passes that made or changed it, in the order in which they ran; none where it is only known from where it is."""
    place: str
    """File, line and column of what it was made from."""

    @property
    def sentence(self) -> str:
        """Return what is said of it, without its place."""
        names = " and ".join(f"`{name}`" for name in self.passes)
        return f"made by the pass{'es' * (len(self.passes) > 1)} {names} from" if names else "from"

    def __str__(self) -> str:
        return f"{self.sentence} {self.place}"


def find_made_element(made_elements: Mapping[ElementPlace, MadeElement], place: Span) -> MadeElement | None:
    """Return what an element that is written at a place was made from, None where no pass had a hand in it."""
    if not made_elements:
        return None
    exact = made_elements.get((place.file, place.line, place.column))
    return exact or made_elements.get((place.file, place.line, 0))


# Spans (`at`, `show_at`, ...) are left out of equality throughout the model: an element that only moved within the
# files equals what it was. Where the place counts, too, it has to be compared explicitly (timing/analyse does).
@dataclass(frozen=True, slots=True)
class PortEdge:
    """A pair of output and input that a connection joins, by their complete ids."""

    output: str
    input: str
    at: Span = field(default=NO_SPAN, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Partner:
    """An organisation that owns a part of the architecture."""

    id: str
    title: str
    description: str | None = None
    contact: str | None = None
    reviewers: tuple[str, ...] = ()
    """The reviewers of its files as CODEOWNERS names them: `@user`, `@organisation/team`, an e-mail address."""
    annotations: ElementAnnotations = NO_ANNOTATIONS
    at: Span = field(default=NO_SPAN, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class UseCase:
    """A use case that requirements serve, with the steps in which it happens."""

    id: str
    title: str
    description: str | None = None
    actors: Mapping[str, Actor] = field(default_factory=dict)
    steps: tuple[Step, ...] = ()
    annotations: ElementAnnotations = NO_ANNOTATIONS
    at: Span = field(default=NO_SPAN, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Waypoint:
    """One element of a chain's `through`: the complete id of a node, a component or an output."""

    kind: Literal["node", "component", "output"]
    id: str
    at: Span = field(default=NO_SPAN, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Chain:
    """A cause-effect chain from a source to a reaction, with its deadline (ns): of all reactions, and of shares of them."""

    id: str
    title: str
    through: tuple[Waypoint, ...] = ()
    deadline: Quantity | None = None
    requirements: tuple[str, ...] = ()
    annotations: ElementAnnotations = NO_ANNOTATIONS
    at: Span = field(default=NO_SPAN, compare=False, repr=False)
    unresolved: tuple[str, ...] = ()
    """The entries of `through` that name no element: such a chain is not judged."""
    requirement_places: tuple[Span, ...] = field(default=(), compare=False, repr=False)
    """Where each of its requirements is written."""
    deadline_shares: Mapping[str, Quantity] = field(default_factory=dict)
    """How long shares of the reactions may take, by `95 %` ..., the smallest first: no bound judges them."""
    deadline_places: Mapping[str, Span] = field(default_factory=dict, compare=False, repr=False)

    @property
    def deadline_text(self) -> str:
        """Return all that is asked of its time in words: `400 ms, 95 % in 200 ms`; empty where nothing is."""
        always = [str(self.deadline)] if self.deadline else []
        return ", ".join([*always, *(f"{share} in {limit}" for share, limit in self.deadline_shares.items())])


@dataclass(frozen=True, slots=True)
class View:
    """A diagram that the project defines: the part of the architecture that a selector selects."""

    id: str
    title: str
    show: str = ""
    colour: str | None = None
    level: Literal["functional", "implementation"] = "functional"
    depth: int | None = None
    """How many levels of composed components it opens; None where it does not say."""
    layout: DiagramLayout = field(default_factory=DiagramLayout)
    annotations: ElementAnnotations = NO_ANNOTATIONS
    at: Span = field(default=NO_SPAN, compare=False, repr=False)
    show_at: Span = field(default=NO_SPAN, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Milestone:
    """A day, as YYYY-MM-DD, on which the components and nodes that a selector selects have to be there."""

    id: str
    title: str
    date: str | None = None
    needs: str | None = None
    description: str | None = None
    annotations: ElementAnnotations = NO_ANNOTATIONS
    at: Span = field(default=NO_SPAN, compare=False, repr=False)
    needs_at: Span = field(default=NO_SPAN, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class SourceDemand:
    """Who may take its inputs only from whom, as two selectors.

    An input that has the property `guarded_by` guards itself, and may take them from anywhere.
    """

    of: str
    inputs_from: str
    guarded_by: str | None = None
    of_at: Span = field(default=NO_SPAN, compare=False, repr=False)
    from_at: Span = field(default=NO_SPAN, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Policy:
    """A flow that the project forbids, from what one selector selects to what another selects; or sources that it asks for.

    `accepted` are the inputs that it lets pass all the same, by complete id, with the reasons.
    """

    id: str
    title: str
    forbid_from: str = ""
    forbid_to: str = ""
    require: SourceDemand | None = None
    accepted: Mapping[str, str] = field(default_factory=dict)
    annotations: ElementAnnotations = NO_ANNOTATIONS
    at: Span = field(default=NO_SPAN, compare=False, repr=False)
    from_at: Span = field(default=NO_SPAN, compare=False, repr=False)
    to_at: Span = field(default=NO_SPAN, compare=False, repr=False)
    accepted_places: Mapping[str, Span] = field(default_factory=dict, compare=False, repr=False)
    """Where each accepted input is written."""


@dataclass(frozen=True, slots=True)
class GlossaryTerm:
    """What a term means."""

    term: str
    text: str
    at: Span = field(default=NO_SPAN, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class ProjectInfo:
    """The project's own id, title, version and description."""

    id: str
    title: str
    version: str | None = None
    description: str | None = None
    license: str | None = None
    """The licence of its code, as SPDX calls it."""
    middleware: str = "ros"
    """What digital ports travel over where they do not say."""
    at: Span = field(default=NO_SPAN, compare=False, repr=False)


def list_leaf_ports(
    shells: Mapping[str, Component], shell_ports: Mapping[str, tuple[str, ...]], kind: str, port_id: str
) -> Iterator[str]:
    """Yield the ports of leaves behind an `input` or `output` of a composed component; nothing for that of a leaf.

    What passes an input on has behind it what feeds that from outside.
    """
    component_id = port_id.rpartition(".")[0]
    for each in shell_ports.get(f"{kind} {port_id}", ()):
        inner_id, _, name = each.rpartition(".")
        if kind == "output" and inner_id == component_id:
            yield from (
                output for connection in shells[component_id].inputs[name].connections for output in connection.outputs
            )
        else:
            yield from tuple(list_leaf_ports(shells, shell_ports, kind, each)) or (each,)


@dataclass(frozen=True, slots=True)
class Architecture:
    """An architecture with all references resolved. Mappings keep the order of first appearance.

    `components`, `inputs` and `outputs` are the same objects as below `groups`, by complete id. `edges` are all pairs
    that the connections make, services and actions included (there the output is the server's). `derivation` fills in
    the low level: planned nodes in `nodes`, `endpoints` in the order of nodes, and `topics` by absolute name (with the
    flow behind the name if a topic and a service share one).
    """

    project: ProjectInfo
    repository: SourceRepository | None = None
    """Where its files are on the web; None where the project does not say."""
    commit_day: str | None = None
    """The day of the newest commit, as YYYY-MM-DD; None where nothing ends on a day, and where git does not say."""
    made_elements: Mapping[ElementPlace, MadeElement] = field(default_factory=dict, compare=False, repr=False)
    """What elements that passes made were made from, by the places that they carry."""
    distro: str | None = None
    distro_at: Span = field(default=NO_SPAN, compare=False, repr=False)
    shared_topics: tuple[str, ...] = ()
    ros_parameters: tuple[ParameterValue, ...] = field(default=())
    """What `ros.parameters` says to every node."""
    ros_environment: tuple[ParameterValue, ...] = field(default=())
    """The variables with which `ros.environment` says that everything is started."""
    ros_discovery: str | None = None
    """How nodes of different hosts find one another: `peers` by addresses, else by multicast."""
    layout: DiagramLayout = field(default_factory=DiagramLayout)
    partners: Mapping[str, Partner] = field(default_factory=dict)
    agreements: Mapping[str, Agreement] = field(default_factory=dict)
    use_cases: Mapping[str, UseCase] = field(default_factory=dict)
    requirements: Mapping[str, Requirement] = field(default_factory=dict)
    groups: Mapping[str, Group] = field(default_factory=dict)
    components: Mapping[str, Component] = field(default_factory=dict)
    """Leaves: what does something, and sends and reads. A composed component with ports that nothing inside carries
    is among them with these ports, so that a design may go from the outside to the inside."""
    shells: Mapping[str, Component] = field(default_factory=dict)
    """Composed components, outer ones first. Their connections are those of the leaves behind their ports."""
    shell_ports: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    """What stands behind each port of a composed component, by `input ID` and `output ID`: the outputs that an output
    passes on, the ports that read an input."""
    component_types: Mapping[str, ComponentType] = field(default_factory=dict)
    inputs: Mapping[str, Input] = field(default_factory=dict)
    outputs: Mapping[str, Output] = field(default_factory=dict)
    connections: tuple[Connection, ...] = ()
    edges: tuple[PortEdge, ...] = ()
    types: Mapping[str, ConceptualType] = field(default_factory=dict)
    """Every type that is declared or used, by name; its message is None if it is not mapped."""
    nodes: Mapping[str, Node] = field(default_factory=dict)
    hosts: Mapping[str, Host] = field(default_factory=dict)
    containers: Mapping[str, Container] = field(default_factory=dict)
    resources: Mapping[str, Resource] = field(default_factory=dict)
    links: Mapping[str, Link] = field(default_factory=dict)
    frames: Mapping[str, Frame] = field(default_factory=dict)
    """Those of the project and those of its components, by name."""
    chains: Mapping[str, Chain] = field(default_factory=dict)
    views: Mapping[str, View] = field(default_factory=dict)
    milestones: Mapping[str, Milestone] = field(default_factory=dict)
    policies: Mapping[str, Policy] = field(default_factory=dict)
    variants: Mapping[str, Variant] = field(default_factory=dict)
    """The variants that the project describes; none in the project as it stands in one of them."""
    properties: Mapping[str, PropertyDeclaration] = field(default_factory=dict)
    """What the project says of properties, by id; others are free."""
    glossary: Mapping[str, GlossaryTerm] = field(default_factory=dict)
    """What terms mean, by the term as written."""
    review: ReviewSettings = field(default_factory=ReviewSettings)
    conform: ConformSettings = field(default_factory=ConformSettings)
    generate: GenerateSettings = field(default_factory=GenerateSettings)
    endpoints: tuple[Endpoint, ...] = ()
    topics: Mapping[str, Topic] = field(default_factory=dict)
    channels: Mapping[str, Topic] = field(default_factory=dict)
    """What data travels over that is no ROS, by medium and name (`mqtt fleet/pose`): as topics, with the nodes that use it."""
    interfaces: Interfaces = field(default_factory=Interfaces)
    partial: bool = False
    """Whether a file could not be read at all. Then no rule reports something as unused: that file may use it."""
    unread_keys: frozenset[str] = frozenset()
    """The keys of entries that could not be read. No rule reports a name as unknown that they may declare."""
    suspected_ids: frozenset[str] = frozenset()
    """The complete ids of the elements that unresolved references most likely mean (the guess, or the candidates). No
    rule reports these as unused: the reference is reported already."""

    untyped_components: frozenset[str] = frozenset()
    """The complete ids of the components of which the type is not known: nor is what they would have from it."""

    def message_of(self, port: Input | Output) -> str | None:
        """Return the message that a port's type is mapped to; None if unknown, or if the port is no ROS."""
        if port.type is None or not port_media.uses_ros(port):
            return None
        mapped = self.types.get(port.type)
        return mapped.message if mapped else None

    def flow_of(self, port: Input | Output) -> port_media.PortFlow:
        """Return whether a port's data is sent (`topic`) or called for, over whatever it travels."""
        return port_media.flow_of_port(port, self.types.get(port.type or ""))

    def leaves_of(self, component_id: str) -> tuple[str, ...]:
        """Return the leaves of a composed component, or the component itself, by complete ids."""
        shell = self.shells.get(component_id)
        if shell is None:
            return (component_id,)
        inner_leaves = tuple(leaf for child in shell.children for leaf in self.leaves_of(child))
        return (component_id, *inner_leaves) if component_id in self.components else inner_leaves

    def find_component(self, component_id: str) -> Component | None:
        """Return a composed component or a leaf; of what is both, with ports that nothing inside carries, the composed one."""
        return self.shells.get(component_id) or self.components.get(component_id)

    def describes_start(self) -> bool:
        """Whether a project says anything about its start-up."""
        return any(node.start is not None or node.command for node in self.nodes.values())

    def list_described_components(self) -> Iterator[Component]:
        """Yield the composed components, then the leaves; what is not designed yet of a composed one is not told twice."""
        yield from self.shells.values()
        if not self.shells:
            yield from self.components.values()
            return
        yield from (component for component in self.components.values() if component.id not in self.shells)

    def list_around(self, component: Component) -> Iterator[Component]:
        """Yield the composed components around a component, from the inside to the outside."""
        around = self.shells.get(component.parent or "")
        while around is not None:
            yield around
            around = self.shells.get(around.parent or "")

    def leaf_ports_of(self, kind: str, port_id: str) -> tuple[str, ...]:
        """Return the ports of leaves behind an `input` or `output`; that of a leaf stands for itself."""
        return tuple(list_leaf_ports(self.shells, self.shell_ports, kind, port_id)) or (port_id,)

    def list_bases(self, type_name: str) -> Iterator[ComponentType]:
        """Yield a component type and those that it is made from, one of the other; nothing for a name that is not known."""
        seen_names: set[str] = set()
        # Types that are made from themselves are reported elsewhere.
        while type_name in self.component_types and type_name not in seen_names:
            seen_names.add(type_name)
            yield self.component_types[type_name]
            type_name = self.component_types[type_name].base_name

    def list_types_of(self, component: Component) -> Iterator[str]:
        """Yield the component types that a component is an instance of, or is part of: with bindings, without, and bases."""
        for each in (component, *self.list_around(component)):
            bases = (base.base for base in self.list_bases(each.type_name))
            for type_text in dict.fromkeys(filter(None, (each.component_type, *bases))):
                yield type_text
                if "<" in type_text:
                    yield type_text.partition("<")[0]

    def list_libraries_of(self, component: Component) -> Iterator[str]:
        """Yield the libraries of the component types that a component is an instance of, or is part of, each once."""
        types = (base for each in (component, *self.list_around(component)) for base in self.list_bases(each.type_name))
        yield from dict.fromkeys(each.library for each in types if each.library is not None)

    def list_carriers(self) -> Iterator[tuple[str, Topic]]:
        """Yield what nodes exchange data over, by name: topics, services and actions, then channels of other media."""
        yield from self.topics.items()
        yield from self.channels.items()

    def find_carrier(self, name: str) -> Topic | None:
        """Return a topic, a service, an action or a channel by its name."""
        return self.channels.get(name) or self.topics.get(name)

    def list_endpoints(self) -> Iterator[Endpoint]:
        """Yield the endpoints of nodes over ROS, then those over other media."""
        yield from self.endpoints
        for channel in self.channels.values():
            yield from channel.writers
            yield from channel.readers

    def list_ports(self) -> Iterator[Input | Output]:
        """Yield all ports: outputs, then inputs."""
        yield from self.outputs.values()
        yield from self.inputs.values()

    def frame_of(self, port: Input | Output) -> str | None:
        """Return the coordinate frame of a port's data: the one it names, else that of its type; None if unknown."""
        carried_type = self.types.get(port.type or "")
        return port.frame or (carried_type.frame if carried_type else None)

    def nodes_using(self, resource_id: str) -> Iterator[Node]:
        """Yield the nodes of which an activity uses a resource."""
        return (
            node for node in self.nodes.values() if any(resource_id in timing.uses for timing in node.timing.values())
        )

    def nodes_implementing(self, component_id: str) -> Iterator[Node]:
        """Yield the nodes that implement the component with this complete id, planned ones included."""
        return (node for node in self.nodes.values() if component_id in node.implements)


_LISTED_APART = frozenset({"component_types", "nodes", "types"})
"""Sections of which some elements were not written here."""


class Annotated(Protocol):
    """An element of any kind."""

    @property
    def annotations(self) -> ElementAnnotations:
        """Its properties and hints."""

    @property
    def at(self) -> Span:
        """Where it is written."""


class AnnotatedElement(NamedTuple):
    """An element with its kind, its complete id, and the id of the element that findings about it name."""

    kind: str
    id: str
    element: Annotated
    is_expected: bool = True
    """Whether it has what is required of its kind: what holds others, and what nobody wrote, need not."""

    @property
    def owner_id(self) -> str:
        """The component of a port; of anything else its own id."""
        return self.id.rpartition(".")[0] if self.kind in {"input", "output"} else self.id

    def lacks(self, declared: PropertyDeclaration) -> bool:
        """Whether it does not have a declared property, and is of a kind that this names."""
        return self.is_expected and self.kind in declared.of and declared.id not in self.element.annotations.properties


def list_annotated_elements(architecture: Architecture) -> Iterator[AnnotatedElement]:
    """Yield every element that was written; components and ports of instances included, types of libraries not."""
    for section, kind in SECTION_KINDS.items():
        if kind in ANNOTATED_KINDS and section not in _LISTED_APART:
            elements: Mapping[str, Annotated] = getattr(architecture, section)
            yield from (AnnotatedElement(kind, id_, element) for id_, element in elements.items())
    for each in architecture.component_types.values():
        if each.library is None:
            yield AnnotatedElement("component_type", each.id, each, is_expected=not each.is_abstract)
    for component in architecture.list_described_components():
        yield AnnotatedElement("component", component.id, component, is_expected=not component.children)
        yield from (AnnotatedElement("input", port.id, port) for port in component.inputs.values())
        yield from (AnnotatedElement("output", port.id, port) for port in component.outputs.values())
    for type_ in architecture.types.values():
        if type_.origin == "project" and type_.at.file and type_.library is None:
            yield AnnotatedElement("type", type_.name, type_)
    for node in architecture.nodes.values():
        if node.written:
            yield AnnotatedElement("node", node.id, node)
