"""The functional level: groups of components, their ports, requirements and performance.

What component types say to their instances, as components that say nothing of their own.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Literal

from archgen.diagnostics import NO_SPAN, Span
from archgen.frozen import dataclass, field
from archgen.model.coordinate_frames import Frame
from archgen.model.declared_timing import Timing
from archgen.model.element_annotations import NO_ANNOTATIONS, ElementAnnotations
from archgen.model.node import Node
from archgen.model.parameter import Operation, Parameter
from archgen.model.promise import Deprecation, Promise
from archgen.model.quantity import Quantity

ComponentRole = Literal["source", "filter", "sink", "reactive"]
ComponentStatus = Literal["existing", "adapted", "planned"]
DiagramDirection = Literal["left-right", "top-bottom"]


@dataclass(frozen=True, slots=True)
class DiagramLayout:
    """How the diagram of an element is drawn."""

    direction: DiagramDirection | None = None


@dataclass(frozen=True, slots=True)
class Connection:
    """One reference in an input's `from`: the source as written, and what it was resolved to.

    `target` is the complete id of a group, a component or an output; `outputs` are the ids of the outputs that it
    stands for: one edge begins at each of them.
    """

    input: str
    written: str
    kind: Literal["group", "component", "output"]
    target: str
    outputs: tuple[str, ...]
    at: Span = field(default=NO_SPAN, compare=False, repr=False)
    shell_port: str | None = None
    """The port of a composed component, or that component, that is written here: `target` is what stands behind it."""
    is_made: bool = False
    """Whether nobody wrote it: `autoconnect` joined the two."""


@dataclass(frozen=True, slots=True)
class Input:
    """An input of a component. `id` is `group.component.input`; `type` is the type that it expects, if written."""

    id: str
    name: str
    component: str
    connections: tuple[Connection, ...] = ()
    external: str | None = None
    medium: str = "ros"
    """What it travels over, as `port_media` says: the word written, else that of its sources, else the project's."""
    type: str | None = None
    optional: bool = False
    freshness: Quantity | None = None
    """How old what is read here may be at most, as the reader demands."""
    frame: str | None = None
    """The coordinate frame in which it expects what arrives, as written."""
    description: str | None = None
    from_written: bool = False
    """Whether `from` is written, resolved or not: no rule reports such an input as unfed."""
    medium_written: bool = False
    """Whether somebody says what it travels over; `digital` alone does not."""
    urls: Mapping[str, str] = field(default_factory=dict)
    """Addresses and files of the project by name: what describes its interface."""
    annotations: ElementAnnotations = NO_ANNOTATIONS
    at: Span = field(default=NO_SPAN, compare=False, repr=False)
    medium_at: Span = field(default=NO_SPAN, compare=False, repr=False)
    type_at: Span = field(default=NO_SPAN, compare=False, repr=False)
    freshness_at: Span = field(default=NO_SPAN, compare=False, repr=False)
    frame_at: Span = field(default=NO_SPAN, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Output:
    """An output of a component. `id` is `group.component.output`; `type` is a conceptual type, None while unknown."""

    id: str
    name: str
    component: str
    type: str | None = None
    external: str | None = None
    medium: str = "ros"
    """What it travels over, as `port_media` says: the word written, else the project's."""
    frame: str | None = None
    """The coordinate frame in which its data is given, as written; None: that of its type."""
    promise: Promise | None = None
    """What readers may count on; what an output that is passed on promises is kept where nothing else is written."""
    version: str | None = None
    deprecated: Deprecation | None = None
    description: str | None = None
    is_made: bool = False
    """Whether nobody wrote what this output of a composed component passes on: `autoconnect` joined the two."""
    medium_written: bool = False
    """Whether somebody says what it travels over; `digital` alone does not."""
    urls: Mapping[str, str] = field(default_factory=dict)
    """Addresses and files of the project by name: what describes its interface."""
    annotations: ElementAnnotations = NO_ANNOTATIONS
    at: Span = field(default=NO_SPAN, compare=False, repr=False)
    medium_at: Span = field(default=NO_SPAN, compare=False, repr=False)
    type_at: Span = field(default=NO_SPAN, compare=False, repr=False)
    frame_at: Span = field(default=NO_SPAN, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class PerformanceIndicator:
    """A performance indicator of a component; `execution_time` in ns."""

    id: str
    title: str
    accuracy: str | None = None
    execution_time: Quantity | None = None
    at: Span = field(default=NO_SPAN, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class RequirementUse:
    """One entry of a `requirements` list: a requirement's id (declared or not) if `is_id`, else free text."""

    text: str
    is_id: bool
    at: Span = field(default=NO_SPAN, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Component:
    """A functional component. `id` is `group.component`, with the ids of the composed components around it in between.

    `inputs_known` is False if `inputs` is not written (unknown), True for `inputs: {}` (known to be none); likewise for
    outputs and requirements. A component without owners has those of its group; `owner` is the first one.
    """

    id: str
    name: str
    group: str
    title: str
    parent: str | None = None
    """The composed component directly around it, by complete id."""
    children: tuple[str, ...] = ()
    """Of a composed component: what stands directly inside, by complete ids."""
    component_type: str | None = None
    """The component type that it is made from, with what generic names stand for: `filter<Pose>`."""
    is_reference: bool = False
    """Whether it is exactly its type, always (`same_as`)."""
    functionality: str | None = None
    description: str | None = None
    owner: str | None = None
    co_owners: tuple[str, ...] = ()
    role: ComponentRole | None = None
    requirements: tuple[RequirementUse, ...] = ()
    requirements_known: bool = False
    performance: tuple[PerformanceIndicator, ...] = ()
    inputs: Mapping[str, Input] = field(default_factory=dict)
    inputs_known: bool = False
    outputs: Mapping[str, Output] = field(default_factory=dict)
    outputs_known: bool = False
    parameters: Mapping[str, Parameter] = field(default_factory=dict)
    """What it can be set to, by dotted name."""
    open: tuple[str, ...] = ()
    """Names of sets of parameters below which any name is accepted."""
    operations: Mapping[str, Operation] = field(default_factory=dict)
    timing: Timing | None = None
    tags: tuple[str, ...] = ()
    urls: Mapping[str, str] = field(default_factory=dict)
    status: ComponentStatus | None = None
    contact: str | None = None
    """Whom to ask about it."""
    image: str | None = None
    """The path of a picture of it, in the project."""
    layout: DiagramLayout = field(default_factory=DiagramLayout)
    annotations: ElementAnnotations = NO_ANNOTATIONS
    at: Span = field(default=NO_SPAN, compare=False, repr=False)
    role_at: Span = field(default=NO_SPAN, compare=False, repr=False)

    @property
    def owners(self) -> tuple[str, ...]:
        """The ids of all owners, the main one first; empty if there is none."""
        return (self.owner, *self.co_owners) if self.owner else ()

    @property
    def ports(self) -> tuple[Input | Output, ...]:
        """Its inputs, then its outputs."""
        return (*self.inputs.values(), *self.outputs.values())

    @property
    def type_name(self) -> str:
        """The name of its component type alone: `filter` of `filter<Pose>`; empty where it is made from none."""
        return (self.component_type or "").partition("<")[0]


@dataclass(frozen=True, slots=True)
class Group:
    """A group of components, keyed by their name inside the group."""

    id: str
    title: str
    description: str | None = None
    owner: str | None = None
    co_owners: tuple[str, ...] = ()
    tags: tuple[str, ...] = ()
    urls: Mapping[str, str] = field(default_factory=dict)
    layout: DiagramLayout = field(default_factory=DiagramLayout)
    components: Mapping[str, Component] = field(default_factory=dict)
    annotations: ElementAnnotations = NO_ANNOTATIONS
    at: Span = field(default=NO_SPAN, compare=False, repr=False)

    @property
    def owners(self) -> tuple[str, ...]:
        """The ids of all owners, the main one first; empty if there is none."""
        return (self.owner, *self.co_owners) if self.owner else ()


@dataclass(frozen=True, slots=True)
class ComponentType:
    """A component without wiring, of which there may be many instances."""

    id: str
    title: str
    functionality: str | None = None
    description: str | None = None
    owner: str | None = None
    base: str | None = None
    """The type that it is made from, as written; one of a library with the library's id before it."""
    library: str | None = None
    """The library that it comes from, None for a type of the project."""
    generic: tuple[str, ...] = ()
    """The names that stand for conceptual types."""
    is_abstract: bool = False
    version: str | None = None
    deprecated: Deprecation | None = None
    inputs: Mapping[str, str | None] = field(default_factory=dict)
    """The types of its inputs by id, those of the type that it is made from included."""
    outputs: Mapping[str, str | None] = field(default_factory=dict)
    components: tuple[str, ...] = ()
    """The ids of the components inside."""
    parameters: Mapping[str, Parameter] = field(default_factory=dict)
    """What its instances can be set to, by dotted name."""
    open: tuple[str, ...] = ()
    operations: Mapping[str, Operation] = field(default_factory=dict)
    frames: tuple[Frame, ...] = ()
    """The frames of its instances, with the names as written: `$(self.prefix)laser`."""
    status: ComponentStatus | None = None
    contact: str | None = None
    image: str | None = None
    """The path of a picture of it, in the project."""
    inner_types: frozenset[str] = field(default=frozenset(), compare=False)
    """The types that the components inside name, to any depth: what is said of them is compared component by component."""
    annotations: ElementAnnotations = NO_ANNOTATIONS
    at: Span = field(default=NO_SPAN, compare=False, repr=False)

    @property
    def base_name(self) -> str:
        """The name of what it is made from alone, without what generic names stand for; empty where that is nothing."""
        return (self.base or "").partition("<")[0].strip()


def list_component_ports(component: Component) -> Iterator[Input | Output]:
    """Yield all ports of a component, inputs first."""
    yield from component.inputs.values()
    yield from component.outputs.values()


PATTERN_GROUP = "component types"
"""The group of patterns: a name that no group of a project can have."""


@dataclass(frozen=True, slots=True)
class TypePatterns:
    """Patterns by the id of their type; of what is inside of a type by the path: `arm.shoulder`."""

    components: Mapping[str, Component] = field(default_factory=dict)
    """Composed ones and leaves."""
    nodes: Mapping[str, Node] = field(default_factory=dict)
    """The nodes that components bring along, by the id of their pattern as it was linked."""

    def list_parts(self, type_id: str) -> Iterator[tuple[str, Component]]:
        """Yield what is inside of a type, to any depth, each with its path below the type."""
        # A type of a library has a dot in its id, so that the path is what follows it, not what follows the first dot.
        return self._list_parts_below(type_id, "")

    def _list_parts_below(self, type_id: str, path: str) -> Iterator[tuple[str, Component]]:
        pattern = self.components.get(f"{type_id}{path}")
        for child in pattern.children if pattern else ():
            inner_path = f"{path}.{child.rpartition('.')[2]}"
            inner_pattern = self.components.get(f"{type_id}{inner_path}")
            if inner_pattern is not None:
                yield inner_path.removeprefix("."), inner_pattern
                yield from self._list_parts_below(type_id, inner_path)
