"""The low level: ROS nodes and the endpoints with which they use topics, services and actions."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from typing import Literal

from archgen.frozen import dataclass
from archgen.model.quantity import Quantity
from archgen.model.timing import Timing
from archgen.source import NOWHERE, Span

NodeKind = Literal["node", "lifecycle", "composable", "driver", "nodelet"]
NodeStatus = Literal["existing", "adapted", "planned"]
Use = Literal["publishes", "subscribes", "serves", "calls"]
Flow = Literal["topic", "service", "action"]


@dataclass(frozen=True, slots=True)
class Qos:
    """Quality of service as it counts: the profile's values with the written ones laid over.

    Durations are in ns; None is unlimited (deadline, lifespan, lease duration) or the profile's own (depth).
    `written` is False where nobody wrote `qos`: the profile `default` counts, and a mismatch is a warning only.
    """

    profile: str = "default"
    reliability: Literal["reliable", "best_effort"] = "reliable"
    durability: Literal["volatile", "transient_local"] = "volatile"
    history: Literal["keep_last", "keep_all"] = "keep_last"
    depth: int | None = 10
    deadline: Quantity | None = None
    lifespan: Quantity | None = None
    liveliness: Literal["automatic", "manual_by_topic"] = "automatic"
    lease_duration: Quantity | None = None
    written: bool = False
    at: Span = field(default=NOWHERE, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class PortUse:
    """An entry below `publishes`, `subscribes`, `serves` or `calls` as it was written, its port resolved.

    `port` is the complete id of the component's output or input; None below `internal` (then `key` is just a name).
    `topics` are the names as written (several only for topics), empty where left out.
    """

    use: Use
    key: str
    port: str | None
    topics: tuple[str, ...] = ()
    message: str | None = None
    qos: Qos | None = None
    internal: bool = False
    at: Span = field(default=NOWHERE, compare=False, repr=False)
    message_at: Span = field(default=NOWHERE, compare=False, repr=False)
    topic_places: tuple[Span, ...] = field(default=(), compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Node:
    """A ROS node. `implements` holds complete component ids; `written` is False for the planned node that a component
    without nodes gets.

    `uses` is what was written; what the node really exposes are the architecture's endpoints.
    """

    id: str
    title: str
    implements: tuple[str, ...] = ()
    description: str | None = None
    owner: str | None = None
    co_owners: tuple[str, ...] = ()
    """Who else answers for it: as written, else all further owners of its components."""
    name: str = ""
    namespace: str = "/"
    kinds: tuple[NodeKind, ...] = ("node",)
    package: str | None = None
    executable: str | None = None
    plugin: str | None = None
    container: str | None = None
    host: str | None = None
    """Its own, or its container's."""
    status: NodeStatus | None = None
    uses: tuple[PortUse, ...] = ()
    uses_known: tuple[Use, ...] = ()
    """Which of publishes, subscribes, serves, calls somebody wrote (`{}` counts)."""
    timing: Mapping[str, Timing] = field(default_factory=dict)
    """By component id (one entry for each activity), or by "" for a node that implements nothing."""
    parameters: Mapping[str, object] = field(default_factory=dict)
    parameter_files: tuple[str, ...] = ()
    tags: tuple[str, ...] = ()
    urls: Mapping[str, str] = field(default_factory=dict)
    written: bool = True
    implements_written: bool = False
    at: Span = field(default=NOWHERE, compare=False, repr=False)
    name_at: Span = field(default=NOWHERE, compare=False, repr=False)

    @property
    def full_name(self) -> str:
        """Namespace and name as ROS shows them: `/perception/object_recognizer`."""
        return f"{self.namespace.rstrip('/')}/{self.name}"

    @property
    def owners(self) -> tuple[str, ...]:
        """Give all partners who answer for it, the first one first."""
        return (self.owner, *self.co_owners) if self.owner else ()


@dataclass(frozen=True, slots=True)
class Endpoint:
    """One use of one topic, service or action by one node, derived or written.

    `name` is absolute (`/camera/rgbd`). `port` is the complete id of the component's port, None for internal ones.
    `message` is the full message (`pkg/msg/Name`), None while nobody named it. `written` says whether the node itself
    names the port. `sources` (for subscribes and calls) are the outputs whose messages arrive here.
    """

    node: str
    use: Use
    name: str
    flow: Flow
    port: str | None
    component: str | None
    message: str | None = None
    type: str | None = None
    qos: Qos = field(default_factory=Qos)
    internal: bool = False
    written: bool = False
    name_written: bool = False
    sources: tuple[str, ...] = ()
    at: Span = field(default=NOWHERE, compare=False, repr=False)
    message_at: Span = field(default=NOWHERE, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Topic:
    """A topic, service or action by its absolute name, with all who use it (indices into nothing: the endpoints)."""

    name: str
    flow: Flow
    messages: tuple[str, ...]
    """Distinct full names, in order of appearance; more than one is a conflict."""
    types: tuple[str, ...]
    writers: tuple[Endpoint, ...]
    """Publishers, or servers."""
    readers: tuple[Endpoint, ...]
    """Subscribers, or clients."""
    size: Quantity | None = None
    shared: bool = False
    """/tf and its like, and the project's `ros.shared_topics`."""
