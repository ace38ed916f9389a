"""The implementation level: ROS nodes, the endpoints through which they use topics, services and actions, and how a node
starts.

The QoS profiles of ROS 2's middleware interface, and their values.

Source: rmw/include/rmw/qos_profiles.h,
https://docs.ros.org/en/jazzy/Concepts/Intermediate/About-Quality-of-Service-Settings.html
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal, get_args

from archgen.diagnostics import NO_SPAN, Span
from archgen.frozen import dataclass, field, replace
from archgen.model.declared_timing import SchedulingOrder, Timing
from archgen.model.element_annotations import NO_ANNOTATIONS, ElementAnnotations
from archgen.model.parameter import FileRemark, ParameterValue
from archgen.model.quantity import Quantity

StartPhase = Literal["network", "simulators", "core", "components"]
LifecycleState = Literal["unconfigured", "inactive", "active"]
PHASES: tuple[StartPhase, ...] = get_args(StartPhase)
"""The parts of a start-up, one after the other."""
DEFAULT_PHASE: StartPhase = "components"


@dataclass(frozen=True, slots=True)
class StartTarget:
    """A node, or a component with all of its nodes, that a start-up names: its complete id."""

    kind: Literal["node", "component"]
    id: str
    at: Span = field(default=NO_SPAN, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class ReadyConditions:
    """How one sees that something is up: all that is known must hold. `within` is the longest that it may take (ns)."""

    port: int | None = None
    file: str | None = None
    topic: str | None = None
    """The name as written."""
    service: str | None = None
    """The name of a service or an action as written."""
    log: str | None = None
    """Words of its output."""
    wait: Quantity | None = None
    """How long to wait in any case (ns)."""
    within: Quantity | None = None
    places: Mapping[str, Span] = field(default_factory=dict, compare=False, repr=False)
    """The spans of the values, by key."""

    @property
    def has_sign(self) -> bool:
        """Whether anything is waited for, and be it only some time."""
        return any(getattr(self, key) is not None for key in SIGN_KEYS)


SIGN_KEYS = ("port", "file", "topic", "service", "log", "wait")
"""What can be waited for."""


@dataclass(frozen=True, slots=True)
class StartUp:
    """What a node says of its start-up; None and empty for what is left out. `respawn_delay` in ns."""

    phase: StartPhase | None = None
    after: tuple[StartTarget, ...] = ()
    ready: ReadyConditions = field(default_factory=ReadyConditions)
    respawn: bool = False
    respawn_delay: Quantity | None = None
    environment: Mapping[str, str] = field(default_factory=dict)
    directory: str | None = None
    user: str | None = None
    once: bool = False
    state: LifecycleState | None = None
    by: StartTarget | None = None
    """What brings a lifecycle node into its state."""
    by_written: bool = False
    """Whether `by` is written, resolved or not."""
    places: Mapping[str, Span] = field(default_factory=dict, compare=False, repr=False)
    """The spans of the values, by key."""

    def list_awaited(self) -> tuple[str, ...]:
        """Return the ids of what is to be there before it, and of what brings it into its state."""
        return tuple(target.id for target in (*self.after, *filter(None, (self.by,))))

    @property
    def wanted_state(self) -> LifecycleState | None:
        """The state that a lifecycle node is brought into; None where nobody says so."""
        return self.state or ("active" if self.by_written else None)


NO_START = StartUp()
"""What counts where nothing is written."""


NodeKind = Literal["node", "lifecycle", "composable", "driver", "nodelet", "program"]
NodeStatus = Literal["existing", "adapted", "planned"]
UseKind = Literal["publishes", "subscribes", "serves", "calls"]
FlowKind = Literal["topic", "service", "action"]
CodeLanguage = Literal["python", "cpp"]
EvidenceKind = Literal["written", "library", "observed", "generated", "default", "unknown"]
Clock = Literal["system", "simulated"]
RunState = Literal["active", "inactive", "off", "planned"]
OverrideEffect = Literal["obeyed", "ignored", "unknown"]


@dataclass(frozen=True, slots=True)
class Qos:
    """Effective quality of service: the values of the profile, overridden by those that are written.

    Durations are in ns; None is unlimited (deadline, lifespan, lease duration) or the middleware's choice (depth).
    `written` is False if no `qos` is written: then the profile `default` counts, and a mismatch is only a warning.
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
    at: Span = field(default=NO_SPAN, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class PortUse:
    """An entry below `publishes`, `subscribes`, `serves` or `calls` as written, with its port resolved.

    `port` is the complete id of the component's output or input; None below `internal`, where `key` is only a name.
    `topics` are the names as written (several only for topics), empty if left out; `topic_places` are their spans.
    """

    use: UseKind
    key: str
    port: str | None
    topics: tuple[str, ...] = ()
    own_name: str | None = None
    """What the program itself calls it, as written, where that is another name."""
    named_by: str | None = None
    """The parameter that holds the name in the program, as written: with `*` and `{LIST}` for several."""
    when: Mapping[str, object] = field(default_factory=dict)
    """The values of parameters with which the program has the port, by their names."""
    is_open: bool = True
    """Whether the program has the port with the values that its parameters have, as far as these are known."""
    message: str | None = None
    qos: Qos | None = None
    internal: bool = False
    at: Span = field(default=NO_SPAN, compare=False, repr=False)
    message_at: Span = field(default=NO_SPAN, compare=False, repr=False)
    topic_places: tuple[Span, ...] = field(default=(), compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Node:
    """A ROS node, or a program that is none. `implements` holds complete component ids; `written` is False for planned nodes that archgen adds.

    `uses` are the entries as written; what the node exposes in the end are the architecture's endpoints.
    """

    id: str
    title: str
    implements: tuple[str, ...] = ()
    wholes: tuple[str, ...] = ()
    """Composed components that it is one process of: their leaves are among `implements`."""
    description: str | None = None
    owner: str | None = None
    co_owners: tuple[str, ...] = ()
    """Further owners: as written, else all further owners of its components."""
    name: str = ""
    own_name: str | None = None
    """What the program calls its node where nobody names it."""
    inner_nodes: Mapping[str, str] = field(default_factory=dict)
    """Names of further nodes that its program makes, by the set of parameters that theirs count as."""
    namespace: str = "/"
    kinds: tuple[NodeKind, ...] = ("node",)
    package: str | None = None
    executable: str | None = None
    plugin: str | None = None
    language: CodeLanguage | None = None
    """The language in which code is generated for it, where it says so."""
    command: tuple[str, ...] = ()
    """The words of the command that starts it, where it is no executable of a package."""
    arguments: tuple[str, ...] = ()
    """What the program gets on its command line, before the arguments of ROS."""
    remaps: Mapping[str, str] = field(default_factory=dict)
    """New names by those that the program uses."""
    container: str | None = None
    host: str | None = None
    """The node's own host, else its container's."""
    threads: int | None = None
    scheduling: SchedulingOrder | None = None
    """The order in which its threads take callbacks. As `threads`, it counts where no container runs the node."""
    callback_groups: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    """Components of the node by group; those of one group exclude one another."""
    reentrant: bool = False
    """Whether all of its callbacks may run at once."""
    status: NodeStatus | None = None
    observed: bool = False
    """Whether the names in `uses` were seen on the running robot: they are those after all remaps."""
    uses: tuple[PortUse, ...] = ()
    timing: Mapping[str, Timing] = field(default_factory=dict)
    """By component id (one entry for each activity), or by "" for a node that implements no component."""
    parameters: Mapping[str, object] = field(default_factory=dict)
    parameter_files: tuple[str, ...] = ()
    parameter_commands: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    """The words of the commands whose output is the value of a parameter, by its name."""
    start: StartUp | None = None
    """What it says of its start-up; None where it says nothing."""
    tags: tuple[str, ...] = ()
    urls: Mapping[str, str] = field(default_factory=dict)
    written: bool = True
    implements_written: bool = False
    annotations: ElementAnnotations = NO_ANNOTATIONS
    at: Span = field(default=NO_SPAN, compare=False, repr=False)
    name_at: Span = field(default=NO_SPAN, compare=False, repr=False)
    kind_at: Span = field(default=NO_SPAN, compare=False, repr=False)
    container_at: Span = field(default=NO_SPAN, compare=False, repr=False)
    command_at: Span = field(default=NO_SPAN, compare=False, repr=False)
    remap_places: Mapping[str, Span] = field(default_factory=dict, compare=False, repr=False)
    argument_places: tuple[Span, ...] = field(default=(), compare=False, repr=False)
    executor_places: Mapping[str, Span] = field(default_factory=dict, compare=False, repr=False)
    """The spans of `threads`, `scheduling`, `callback_groups` and `reentrant`, where they are written."""
    own_values: tuple[ParameterValue, ...] = field(default=(), compare=False, repr=False)
    """What `parameters` and `parameter_commands` say, each with its place; of a command the value is None."""
    file_values: tuple[ParameterValue, ...] = field(default=(), compare=False, repr=False)
    """What its parameter files say to it, as far as they lie in the project; of one name the last one counts."""
    unread_files: tuple[str, ...] = field(default=(), compare=False, repr=False)
    """The parameter files that could not be read: whatever they set is unknown."""
    file_remarks: tuple[FileRemark, ...] = field(default=(), compare=False, repr=False)
    """What is odd about its parameter files."""

    @property
    def is_program(self) -> bool:
        """Whether it is no node of ROS: it has no node name, no parameters and no life cycle there."""
        return "program" in self.kinds

    @property
    def is_generated(self) -> bool:
        """Whether generators make its program: nobody says that it exists, and nothing else starts it."""
        return self.status in {None, "planned"} and not (self.is_program or self.command)

    @property
    def full_name(self) -> str:
        """The namespace and name as ROS shows them: `/perception/object_recognizer`."""
        return f"{self.namespace.rstrip('/')}/{self.name}"

    @property
    def owners(self) -> tuple[str, ...]:
        """The ids of all owners, the main one first; empty if there is none."""
        return (self.owner, *self.co_owners) if self.owner else ()


@dataclass(frozen=True, slots=True)
class Evidence:
    """Why a field of an endpoint is what it is: who says so, by which rule (`/safety:=/safety_raw`), and where."""

    kind: EvidenceKind
    rule: str = ""
    at: Span = field(default=NO_SPAN, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Endpoint:
    """The use of one topic, service or action by one node, written or derived.

    `name` is absolute (`/camera/rgbd`), as it is on the wire; None where nobody says it. `port` is the complete id of the component's port, None for internal endpoints.
    `message` is the full name (`pkg/msg/Name`), None if unknown. `written`: the node itself names the port;
    `name_written`: also the topic. `sources` (for subscribes and calls) are the ids of the outputs that arrive here.
    An internal one that is not written follows from the frames that the node writes.
    """

    node: str
    use: UseKind
    name: str | None
    flow: FlowKind
    port: str | None
    component: str | None
    message: str | None = None
    type: str | None = None
    qos: Qos = field(default_factory=Qos)
    internal: bool = False
    own_name: str | None = None
    """What the program itself calls it, as written; None where it calls it by its name."""
    written: bool = False
    name_written: bool = False
    sources: tuple[str, ...] = ()
    medium: str = "ros"
    """What it travels over; of anything but `ros` the name is free text behind the medium's word."""
    program_name: str | None = None
    """What the program says, made absolute, before remaps; None where that is unknown."""
    qos_override: OverrideEffect | None = None
    """What parameters named `qos_overrides` do to its `qos`; None where there are none for it."""
    qos_if_ignored: Qos | None = None
    """Where it is unknown whether its program takes overrides: what counts if it does not, beside `qos`."""
    domain: int | None = None
    """Its `ROS_DOMAIN_ID`, where something sets one; None is the usual one, the same for all."""
    clock: Clock | None = "system"
    """The clock of its node; None where that is unknown."""
    runs: RunState | None = "active"
    """Whether its node runs it once the robot is up; None where that is unknown."""
    evidence: Mapping[str, Evidence] = field(default_factory=dict)
    """By the names of the fields above: where each that is no default comes from. `qos.depth` names a policy."""
    at: Span = field(default=NO_SPAN, compare=False, repr=False)
    message_at: Span = field(default=NO_SPAN, compare=False, repr=False)

    @property
    def is_moved(self) -> bool:
        """Whether a launch moves it away from where the model puts it; the rule of its own port (`own_name`) puts it there."""
        reason = self.evidence.get("name")
        return reason is not None and reason.kind == "written" and reason.at != self.at

    @property
    def label(self) -> str:
        """The name, else words that say that it is not known: the same ones at all ends of one output's connections."""
        return self.name or f"{self.sources[0] if self.sources else self.port or self.node} (name not known)"


@dataclass(frozen=True, slots=True)
class Topic:
    """A topic, service or action, and the endpoints that use it; `size` in B. `name` is their label."""

    name: str
    flow: FlowKind
    messages: tuple[str, ...]
    """Distinct full names in order of appearance; more than one is a conflict."""
    types: tuple[str, ...]
    writers: tuple[Endpoint, ...]
    """Publishers, or servers."""
    readers: tuple[Endpoint, ...]
    """Subscribers, or clients."""
    size: Quantity | None = None
    medium: str = "ros"
    """What it travels over; anything but `ros` stands in the architecture's `channels`."""
    shared: bool = False
    """Whether all nodes share it: /tf and the like, and the project's `ros.shared_topics`."""

    @property
    def label(self) -> str:
        """What people call it, as of an endpoint."""
        return self.name

    @property
    def is_known(self) -> bool:
        """Whether its name is known: else it stands for connections of the model alone."""
        return any(each.name is not None for each in (*self.writers, *self.readers))


# What a profile does not set has the default of `Qos`, which is that of `default`.
QOS_PROFILES: Mapping[str, Qos] = {
    "default": Qos("default"),
    "sensor_data": Qos("sensor_data", reliability="best_effort", depth=5),
    "services": Qos("services"),
    "parameters": Qos("parameters", depth=1000),
    "parameter_events": Qos("parameter_events", depth=1000),
    "system_default": Qos("system_default", depth=None),
}


def qos_profile(name: str, use: UseKind) -> Qos:
    """Return the values of a profile for one side. An unknown profile counts as `default`.

    `system_default` is the middleware's choice: DDS defaults to reliable for writers and best effort for readers.
    """
    qos = QOS_PROFILES.get(name, QOS_PROFILES["default"])
    if name == "system_default" and use == "subscribes":
        return replace(qos, reliability="best_effort")
    return qos
