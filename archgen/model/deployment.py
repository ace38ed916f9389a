"""Where nodes run: hosts, containers (one process each), what they share, and the links between hosts."""

from __future__ import annotations

from collections.abc import Mapping

from archgen.diagnostics import NO_SPAN, Span
from archgen.frozen import dataclass, field
from archgen.model.declared_timing import FairScheduling, SchedulingOrder
from archgen.model.element_annotations import NO_ANNOTATIONS, ElementAnnotations
from archgen.model.quantity import Quantity


@dataclass(frozen=True, slots=True)
class Host:
    """A computer. `cores` is None if unknown.

    `scheduling` is the order in which its cores take what is ready, None where nothing is written; `core_scheduling` is
    that of single cores.
    """

    id: str
    title: str
    cores: int | None = None
    scheduling: SchedulingOrder | None = None
    core_scheduling: Mapping[int, SchedulingOrder] = field(default_factory=dict)
    fair: FairScheduling | None = None
    """The figures of `scheduling: fair`, where some are written."""
    description: str | None = None
    address: str | None = None
    """Its name or number in the network, None where its id is its name."""
    discovery_server: int | None = None
    """The port of the discovery server that runs on it."""
    environment: Mapping[str, str] = field(default_factory=dict)
    """Variables with which all processes on it are started."""
    tags: tuple[str, ...] = ()
    annotations: ElementAnnotations = NO_ANNOTATIONS
    at: Span = field(default=NO_SPAN, compare=False, repr=False)
    core_places: Mapping[int, Span] = field(default_factory=dict, compare=False, repr=False)
    """Where the scheduling of single cores is written."""
    environment_places: Mapping[str, Span] = field(default_factory=dict, compare=False, repr=False)

    @property
    def network_name(self) -> str:
        """Under which name or number other hosts find it."""
        return self.address or self.id


@dataclass(frozen=True, slots=True)
class Container:
    """A process that loads several nodes. `threads` as written: `find_container_threads` says what runs."""

    id: str
    title: str
    host: str | None = None
    threads: int | None = None
    scheduling: SchedulingOrder | None = None
    """The order in which its threads take callbacks, None where nothing is written."""
    namespace: str = "/"
    name: str | None = None
    """The name of its own node in ROS, None where nothing is written."""
    package: str | None = None
    """The package of its program, None for ROS's own container."""
    executable: str | None = None
    parameters: Mapping[str, object] = field(default_factory=dict)
    name_at: Span = field(default=NO_SPAN, compare=False, repr=False)
    annotations: ElementAnnotations = NO_ANNOTATIONS
    at: Span = field(default=NO_SPAN, compare=False, repr=False)

    @property
    def full_name(self) -> str:
        """The namespace and name of its own node as ROS shows them."""
        return f"{self.namespace.rstrip('/')}/{self.name or self.id}"


@dataclass(frozen=True, slots=True)
class Resource:
    """A GPU or another accelerator on a host, which works on one use at a time."""

    id: str
    title: str
    host: str | None = None
    scheduling: SchedulingOrder | None = None
    annotations: ElementAnnotations = NO_ANNOTATIONS
    at: Span = field(default=NO_SPAN, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Link:
    """A network or cable between hosts and devices. `bandwidth` in bit/s; `best` and `worst` are latencies in ns."""

    id: str
    title: str
    connects: tuple[str, ...] = ()
    """The hosts, by id."""
    bandwidth: Quantity | None = None
    best: Quantity | None = None
    worst: Quantity | None = None
    devices: tuple[str, ...] = ()
    """The components that are devices on it, by complete id."""
    protocol: str | None = None
    """What is spoken on it, as a medium's word."""
    owner: str | None = None
    annotations: ElementAnnotations = NO_ANNOTATIONS
    at: Span = field(default=NO_SPAN, compare=False, repr=False)
    protocol_at: Span = field(default=NO_SPAN, compare=False, repr=False)
    connects_at: Span = field(default=NO_SPAN, compare=False, repr=False)
    unresolved: tuple[str, ...] = ()
    """The entries of `connects` that name neither a host nor a component."""

    @property
    def owners(self) -> tuple[str, ...]:
        """Return the partner who answers for it, where one does."""
        return (self.owner,) if self.owner else ()
