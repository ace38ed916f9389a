"""The high level: groups of functional components, their ports, requirements and performance."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from typing import Literal

from archgen.frozen import dataclass
from archgen.model.quantity import Quantity
from archgen.model.timing import Timing
from archgen.source import NOWHERE, Span

Role = Literal["source", "filter", "sink", "reactive"]
Direction = Literal["left-right", "top-bottom"]


@dataclass(frozen=True, slots=True)
class Layout:
    """How an element's diagram is drawn."""

    direction: Direction | None = None


@dataclass(frozen=True, slots=True)
class Connection:
    """One reference in an input's `from`: the source as written and what it was resolved to.

    `target` is the complete id of a group, a component or an output; `outputs` the ids of the outputs that it stands
    for (all edges of this connection begin there).
    """

    input: str
    written: str
    kind: Literal["group", "component", "output"]
    target: str
    outputs: tuple[str, ...]
    at: Span = field(default=NOWHERE, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Input:
    """An input of a component. `id` is `group.component.input`; `type` is the type that it expects, if it says so."""

    id: str
    name: str
    component: str
    connections: tuple[Connection, ...] = ()
    external: str | None = None
    physical: bool = False
    type: str | None = None
    optional: bool = False
    description: str | None = None
    from_written: bool = False
    """Something stands in `from`, whether or not it could be resolved: no rule calls such an input unfed."""
    at: Span = field(default=NOWHERE, compare=False, repr=False)
    type_at: Span = field(default=NOWHERE, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Output:
    """An output of a component. `id` is `group.component.output`; `type` is a conceptual type, None while unknown."""

    id: str
    name: str
    component: str
    type: str | None = None
    external: str | None = None
    physical: bool = False
    description: str | None = None
    at: Span = field(default=NOWHERE, compare=False, repr=False)
    type_at: Span = field(default=NOWHERE, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Indicator:
    """One performance indicator of a component."""

    id: str
    title: str
    accuracy: str | None = None
    execution_time: Quantity | None = None
    at: Span = field(default=NOWHERE, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class RequirementUse:
    """One entry of a `requirements` list: an id (`known` says whether it is declared), or free text."""

    text: str
    is_id: bool
    at: Span = field(default=NOWHERE, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Component:
    """A functional component. `id` is `group.component`.

    `inputs_known` is False while nobody has written `inputs` (unknown), True for `{}` (known to be none); the same for
    outputs and requirements. Owners are the group's where the component has
    none; `owner` is the first of them.
    """

    id: str
    name: str
    group: str
    title: str
    functionality: str | None = None
    description: str | None = None
    owner: str | None = None
    co_owners: tuple[str, ...] = ()
    role: Role | None = None
    requirements: tuple[RequirementUse, ...] = ()
    requirements_known: bool = False
    performance: tuple[Indicator, ...] = ()
    inputs: Mapping[str, Input] = field(default_factory=dict)
    inputs_known: bool = False
    outputs: Mapping[str, Output] = field(default_factory=dict)
    outputs_known: bool = False
    timing: Timing | None = None
    tags: tuple[str, ...] = ()
    urls: Mapping[str, str] = field(default_factory=dict)
    layout: Layout = field(default_factory=Layout)
    title_written: bool = False
    at: Span = field(default=NOWHERE, compare=False, repr=False)
    role_at: Span = field(default=NOWHERE, compare=False, repr=False)

    @property
    def owners(self) -> tuple[str, ...]:
        """Give all partners who answer for it, the first one first."""
        return (self.owner, *self.co_owners) if self.owner else ()


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
    layout: Layout = field(default_factory=Layout)
    components: Mapping[str, Component] = field(default_factory=dict)
    at: Span = field(default=NOWHERE, compare=False, repr=False)

    @property
    def owners(self) -> tuple[str, ...]:
        """Give all partners who answer for it, the first one first."""
        return (self.owner, *self.co_owners) if self.owner else ()
