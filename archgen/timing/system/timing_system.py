"""What timing works on: activities (what a node does for one component) and the arcs along which data passes.

All durations are integers of one unit for each project (`TimingSystem.tick`, in ns): exact, and fast. None is unknown.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping
from fractions import Fraction
from typing import Literal

from archgen.diagnostics.source_span import NO_SPAN, Span
from archgen.frozen import dataclass, field
from archgen.model.declared_timing import ActivityBehaviour, SchedulingOrder
from archgen.model.node import FlowKind
from archgen.model.runtime_facts import RCLCPP, ClientLibrary


@dataclass(frozen=True, slots=True)
class StoringCallback:
    """The callback that stores a message of an input that fires nobody. Durations are in ticks, 0 where not written."""

    wcet: int = 0
    bcet: int = 0


@dataclass(frozen=True, slots=True)
class ResourceUse:
    """How long an activation uses a resource (a GPU), in ticks; `best` is 0 where it is not written."""

    worst: int
    best: int = 0


@dataclass(frozen=True, slots=True)
class Executor:
    """What runs the callbacks of a process: those of a container, or of a node outside of one.

    `threads` is None where nobody wrote how many a container has; a node outside of a container has one if nothing is
    written. `order` is the order in which a thread takes what is ready, None where nobody wrote it: bounds hold for any
    then, and what is simulated keeps to `usual_order`, that of its middleware, where it is known.
    """

    id: str
    """`container ID` or `node ID`: a container and a node may have the same id."""
    threads: int | None
    host: str | None
    order: SchedulingOrder | None = None
    library: ClientLibrary = RCLCPP
    suspends: bool = False
    """Whether something in it keeps its thread for some time without needing a core."""
    usual_order: SchedulingOrder | None = None

    @property
    def is_serial(self) -> bool:
        """Whether several threads compute one at a time."""
        return self.threads != 1 and not self.library.computes_at_once

    @property
    def parallel_threads(self) -> int | None:
        """Return how many threads may be under way at once: of those that compute one at a time and never wait, one."""
        return 1 if self.is_serial and not self.suspends else self.threads


@dataclass(frozen=True, slots=True)
class SharedResource:
    """A GPU or another accelerator: it works on one use at a time. `order` None: in any order that leaves it not idle."""

    id: str
    host: str | None
    order: SchedulingOrder | None = None
    is_order_assumed: bool = False
    """Whether nobody wrote the order."""


@dataclass(frozen=True, slots=True)
class FairShare:
    """How the threads of a host without a priority share its cores.

    While one of them waits, no other one is served more than it and `lead` (ticks): some times a `turn`, which is a slice
    and a tick. `other_load` is the share of each core that other programs take.
    """

    lead: int
    turn: int
    other_load: Fraction = Fraction(0)
    assumption: str = ""
    """What nobody wrote of it, as answers say it; empty where all is written."""
    figures: str = ""
    """What the lead is made of, as reasons say it: `5 times a slice of 3 ms and a tick of 1 ms`."""


@dataclass(frozen=True, slots=True)
class Activity:
    """One activity: a node's id, or `node.component` (the component's own name) where a node implements several.

    `behaviour` is as written or inferred (`behaviour_inferred`), None where neither is possible. `triggers` are the
    keys of the inputs that fire it (see `Arc.input`), `mode` whether any or all of them do; other inputs are sampled.
    Durations are in ticks. `wcet` and `bcet` None are unknown; `response` is a declared worst case.
    """

    id: str
    node: str
    component: str | None
    behaviour: ActivityBehaviour | None
    behaviour_inferred: bool = False
    period: int | None = None
    """As written, as a period or as a rate."""
    jitter: int = 0
    wcet: int | None = None
    bcet: int | None = None
    response: int | None = None
    mode: Literal["any", "all", "match"] = "any"
    triggers: tuple[str, ...] = ()
    within: int | None = None
    """With `match`: how far apart the times of messages may be that are matched (0: the same time)."""
    every: int = 1
    throttle: int = 0
    keeps_dropped: bool = True
    """Whether a message that `every` or `throttle` drops is stored and read by the next activation."""
    conditional: frozenset[str] = frozenset()
    """Keys of outputs that are not published at each activation."""
    max_gaps: Mapping[str, int] = field(default_factory=dict)
    """The largest gap promised for a conditional output."""
    calls: Mapping[str, Fraction] = field(default_factory=dict)
    """Calls in each activation, by input key; 1 where nothing is written."""
    priority: int | None = None
    deadline: int | None = None
    """Relative to the activation: how urgent it is under `edf`; the period where it is not written."""
    host: str | None = None
    container: str | None = None
    cores: tuple[int, ...] = ()
    """The cores to which it is pinned, in ascending order; empty where it may run on any."""
    executor: str = ""
    """Key of `TimingSystem.executors`: the process whose threads run it."""
    callback_group: str | None = None
    """Activities of one group exclude one another; None is reentrant: any number of its own callbacks run at once."""
    storing: Mapping[str, StoringCallback] = field(default_factory=dict)
    """By input key: the callbacks of inputs that are only stored. They wait for their turn in the executor."""
    separate_memories: frozenset[str] = frozenset()
    """Keys of the inputs that keep the newest message of each source, and not only the last one of each topic."""
    uses: Mapping[str, ResourceUse] = field(default_factory=dict)
    """By resource: the time of each activation beside `wcet`, which is processor time alone."""
    freshness: Mapping[str, int] = field(default_factory=dict)
    """By input key: how old what is read there may be at most, as its reader demands."""
    percentiles: Mapping[str, int] = field(default_factory=dict)
    """Measured execution times by `p50`, `p95` ...; no bound rests on them."""
    wcet_measured: bool = False
    """Whether `wcet` is the longest that was seen, and not proven."""
    inputs: tuple[str, ...] = ()
    outputs: tuple[str, ...] = ()
    # Not compared either: moving text in a file changes no figure.
    at: Span = field(default=NO_SPAN, compare=False, repr=False)
    places: Mapping[str, Span] = field(default_factory=dict, compare=False, repr=False)

    @property
    def wait(self) -> int:
        """Return how long an activation waits in its callback (for an answer, a device), in ticks: it keeps its thread, and
        leaves its core. That is what a declared response has beside the times for processor and resources.
        """
        if self.response is None or self.wcet is None or self.behaviour == "once":
            return 0
        return max(self.response - self.wcet - sum(use.worst for use in self.uses.values()), 0)

    @property
    def suspends(self) -> bool:
        """Whether an activation keeps its thread for some time without needing a core."""
        return bool(self.uses) or (self.response is not None and self.wait > 0)

    @property
    def core(self) -> int | None:
        """The core, where it is pinned to exactly one."""
        return self.cores[0] if len(self.cores) == 1 else None


@dataclass(frozen=True, slots=True)
class Arc:
    """Data from one activity's output to another's input (a topic), or between client and server (both ways).

    `output` and `input` are keys: a port's complete id, or the absolute name of an internal topic. A service or action
    has one arc from client to server (`role` request: it triggers the server) and one back (`answer`: it triggers
    nobody). `best` and `worst` are the link's latency in ticks: 0 on one host, None where unknown. `depth` is the
    reader's queue (None: unlimited), `size` the message's bytes.
    """

    source: str
    output: str
    target: str
    input: str
    topic: str
    flow: FlowKind
    role: Literal["data", "request", "answer"] = "data"
    link: str | None = None
    best: int | None = 0
    worst: int | None = 0
    depth: int | None = None
    size: int | None = None
    optional: bool = False
    depth_written: bool = False
    """Whether the reader asks for another depth than its profile has."""
    at: Span = field(default=NO_SPAN, compare=False, repr=False)
    queue_at: Span = field(default=NO_SPAN, compare=False, repr=False)
    """Where the reader's quality of service is written."""


@dataclass(frozen=True, slots=True)
class TimingSystem:
    """All activities and arcs of an architecture. `tick` is the unit of all durations, in ns."""

    tick: Fraction
    activities: Mapping[str, Activity]
    arcs: tuple[Arc, ...]
    arcs_into: Mapping[str, tuple[Arc, ...]]
    arcs_from: Mapping[str, tuple[Arc, ...]]
    external_inputs: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    """Keys of the inputs of each activity that are fed from outside of the architecture."""
    optional_inputs: frozenset[str] = frozenset()
    """Input keys that need not be connected: nobody waits for one that is not."""
    cores: Mapping[str, int | None] = field(default_factory=dict)
    """Cores of each host, None where not written."""
    executors: Mapping[str, Executor] = field(default_factory=dict)
    resources: Mapping[str, SharedResource] = field(default_factory=dict)
    host_orders: Mapping[str, SchedulingOrder] = field(default_factory=dict)
    """The order on the cores of a host, where one is written."""
    core_orders: Mapping[tuple[str, int], SchedulingOrder] = field(default_factory=dict)
    """The order on single cores (host, core), where it differs from the host's."""
    fair_shares: Mapping[str, FairShare] = field(default_factory=dict)
    """The hosts whose cores are shared fairly, but for single cores of another order."""
    bandwidths: Mapping[str, Fraction | None] = field(default_factory=dict)
    """Bandwidth of each link in B/s, None where not written."""
    served_outputs: frozenset[tuple[str, str]] = frozenset()
    """Outputs (activity, key) that are services or actions."""
    topic_writers: Mapping[str, tuple[tuple[str, str], ...]] = field(default_factory=dict)
    """Who publishes on each topic: activities and output keys."""
    topic_sizes: Mapping[str, int | None] = field(default_factory=dict)
    """Bytes of a message on each topic, None where unknown."""
    queued_links: frozenset[str] = frozenset()
    """Links whose latency is not written, but was computed from bandwidth and traffic."""


def group_arcs(pairs: Iterable[tuple[str, Arc]]) -> dict[str, tuple[Arc, ...]]:
    """Group arcs by a name, such as that of one of their ends."""
    arcs_by_name: dict[str, list[Arc]] = defaultdict(list)
    for name, arc in pairs:
        arcs_by_name[name].append(arc)
    return {name: tuple(arc_list) for name, arc_list in arcs_by_name.items()}


def name_queue(reader: Activity, arc: Arc) -> str:
    """Return a name that the arcs to an input share where one subscription gets what comes by them."""
    return f"{arc.topic} from {arc.source}" if arc.input in reader.separate_memories else arc.topic


def list_memory_rivals(system: TimingSystem, arc: Arc) -> tuple[Arc, ...]:
    """Return the arcs of other sources whose messages take the place of an arc's: they come to one memory of its reader."""
    reader = system.activities[arc.target]
    if arc.role != "data" or arc.input in reader.separate_memories:
        return ()
    return tuple(
        other
        for other in system.arcs_into.get(arc.target, ())
        if other is not arc
        and (other.role, other.input, other.topic) == ("data", arc.input, arc.topic)
        # What was sent once, at the start, takes the place of nothing later.
        and system.activities[other.source].behaviour != "once"
    )


def is_taken_answer(arc: Arc) -> bool:
    """Whether an arc brings answers to a callback that takes them, which the load of processors counts by itself."""
    return arc.role == "data" and arc.flow != "topic"


def find_request(system: TimingSystem, answer: Arc) -> Arc:
    """Return the arc of the calls that an arc answers."""
    # What takes an answer is called after its client, with a blank behind it.
    client = answer.target.partition(" ")[0]
    return next(
        each
        for each in system.arcs_into[answer.source]
        if (each.role, each.source, each.topic) == ("request", client, answer.topic)
    )


def is_selective_arc(system: TimingSystem, arc: Arc) -> bool:
    """Whether an activation of the source may send nothing on an arc, with no promise of when one does.

    That is so for a conditional output without `max_gap`, for fewer than one call per activation, and for the answers
    of a server that something other than this caller activates too.
    """
    source = system.activities[arc.source]
    if arc.role == "request":
        return source.calls.get(arc.output, 1) < 1
    if arc.role == "data":
        return arc.output in source.conditional and arc.output not in source.max_gaps
    other_arcs = (
        other_arc
        for other_arc in system.arcs_into.get(arc.source, ())
        if other_arc.role != "request" or other_arc.source != arc.target
    )
    return source.period is not None or any(
        other_arc.role == "request" or other_arc.input in source.triggers for other_arc in other_arcs
    )


def best_response(activity: Activity) -> int:
    """Return how long an activation takes at least, in ticks; what nobody wrote counts as 0.

    A declared response is taken as it is, also where it is shorter than what it holds.
    """
    shortest = (activity.bcet or 0) + sum(use.best for use in activity.uses.values())
    return shortest if activity.response is None else min(shortest, activity.response)


def calls_per_activation(caller: Activity, request: Arc) -> Fraction:
    """Return how many calls a client makes in each of its activations."""
    return caller.calls.get(request.output, Fraction(1))


def is_sampled(reader: Activity, arc: Arc) -> bool:
    """Whether a message on an arc waits in its reader's executor until a callback stores it."""
    # The client of a service gets its answer in a callback as well.
    return bool(reader.executor) if arc.role == "answer" else arc.role == "data" and arc.input in reader.storing


def samples_inputs(system: TimingSystem, activity: Activity) -> bool:
    """Whether messages to an activity wait in its executor until a callback stores them."""
    return bool(activity.storing) or any(is_sampled(activity, arc) for arc in system.arcs_into.get(activity.id, ()))
