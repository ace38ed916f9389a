"""The whole architecture: both levels, the mapping between them, and what stands around them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import field
from typing import Literal

from archgen.frozen import dataclass
from archgen.model.component import Component, Connection, Group, Input, Layout, Output
from archgen.model.deployment import Container, Host, Link
from archgen.model.interfaces import Interfaces
from archgen.model.mapping import Type
from archgen.model.node import Endpoint, Node, Topic
from archgen.model.quantity import Quantity
from archgen.model.review import Review
from archgen.source import NOWHERE, Span


@dataclass(frozen=True, slots=True)
class Edge:
    """One pair of an output and an input that a connection makes, by their complete ids."""

    output: str
    input: str
    at: Span = field(default=NOWHERE, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Partner:
    """An organisation that owns a part of the architecture."""

    id: str
    title: str
    description: str | None = None
    contact: str | None = None
    reviewers: tuple[str, ...] = ()
    """Who reviews its files, as CODEOWNERS names them: `@user`, `@organisation/team`, an e-mail address."""
    at: Span = field(default=NOWHERE, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class UseCase:
    """A use case that requirements serve."""

    id: str
    title: str
    description: str | None = None
    at: Span = field(default=NOWHERE, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Requirement:
    """A declared requirement, and the ids of its use cases."""

    id: str
    title: str
    description: str | None = None
    use_cases: tuple[str, ...] = ()
    tags: tuple[str, ...] = ()
    urls: Mapping[str, str] = field(default_factory=dict)
    at: Span = field(default=NOWHERE, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Waypoint:
    """One element of a chain's `through`: complete id of a node, a component or an output."""

    kind: Literal["node", "component", "output"]
    id: str
    at: Span = field(default=NOWHERE, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Chain:
    """A chain of effect from a source to a reaction, with the deadline (ns) that it must meet."""

    id: str
    title: str
    through: tuple[Waypoint, ...] = ()
    deadline: Quantity | None = None
    requirements: tuple[str, ...] = ()
    at: Span = field(default=NOWHERE, compare=False, repr=False)
    unresolved: tuple[str, ...] = ()
    """What was written in `through` and names nothing: of such a chain nothing can be said."""


@dataclass(frozen=True, slots=True)
class View:
    """A picture that the project asks for: what a selector shows."""

    id: str
    title: str
    show: str
    colour: str | None = None
    level: Literal["functional", "implementation"] = "functional"
    layout: Layout = field(default_factory=Layout)
    at: Span = field(default=NOWHERE, compare=False, repr=False)
    show_at: Span = field(default=NOWHERE, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Policy:
    """A flow that the project forbids, as two selectors."""

    id: str
    title: str
    forbid_from: str
    forbid_to: str
    at: Span = field(default=NOWHERE, compare=False, repr=False)
    from_at: Span = field(default=NOWHERE, compare=False, repr=False)
    to_at: Span = field(default=NOWHERE, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class ProjectInfo:
    """What the project says of itself."""

    id: str
    title: str
    version: str | None = None
    description: str | None = None
    at: Span = field(default=NOWHERE, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Architecture:
    """An architecture, linked. Mappings keep the order of first appearance.

    `components`, `inputs` and `outputs` are the same objects that hang below `groups`, by complete id. `edges` are all
    pairs that the connections make, services and actions included (there the output is the server's). Low level:
    `nodes` (with the planned ones that `transform` adds), `endpoints` in order of node, `topics` by absolute name and
    flow: what `transform.derive` fills in.
    """

    project: ProjectInfo
    distro: str | None = None
    distro_at: Span = field(default=NOWHERE, compare=False, repr=False)
    shared_topics: tuple[str, ...] = ()
    layout: Layout = field(default_factory=Layout)
    partners: Mapping[str, Partner] = field(default_factory=dict)
    use_cases: Mapping[str, UseCase] = field(default_factory=dict)
    requirements: Mapping[str, Requirement] = field(default_factory=dict)
    groups: Mapping[str, Group] = field(default_factory=dict)
    components: Mapping[str, Component] = field(default_factory=dict)
    inputs: Mapping[str, Input] = field(default_factory=dict)
    outputs: Mapping[str, Output] = field(default_factory=dict)
    connections: tuple[Connection, ...] = ()
    edges: tuple[Edge, ...] = ()
    types: Mapping[str, Type] = field(default_factory=dict)
    """Every type that is declared or used, by its name; message None where it is not mapped."""
    nodes: Mapping[str, Node] = field(default_factory=dict)
    hosts: Mapping[str, Host] = field(default_factory=dict)
    containers: Mapping[str, Container] = field(default_factory=dict)
    links: Mapping[str, Link] = field(default_factory=dict)
    chains: Mapping[str, Chain] = field(default_factory=dict)
    views: Mapping[str, View] = field(default_factory=dict)
    policies: Mapping[str, Policy] = field(default_factory=dict)
    review: Review = field(default_factory=Review)
    endpoints: tuple[Endpoint, ...] = ()
    topics: Mapping[str, Topic] = field(default_factory=dict)
    interfaces: Interfaces = field(default_factory=Interfaces)
    partial: bool = False
    """A file could not be read at all: what nobody seems to use may be used there."""
    lost: frozenset[str] = frozenset()
    """The keys of what could not be read: of what they may declare no rule says that it is unknown."""
    suspects: frozenset[str] = frozenset()
    """Complete ids of what references that could not be resolved most likely meant (the guess, or the candidates). No rule
    says of these that nobody uses them: the reference is reported already."""

    def message(self, output: Output) -> str | None:
        """Give the message of an output by its type, None while unknown (physical outputs have none)."""
        if output.type is None or output.physical:
            return None
        mapped = self.types.get(output.type)
        return mapped.message if mapped else None

    def implementers(self, component: str) -> Iterator[Node]:
        """Give the nodes that implement a component, by its complete id."""
        return (node for node in self.nodes.values() if component in node.implements)
