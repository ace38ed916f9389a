"""A system flattened to lists indexed by small integers, which the inner loop of the simulation reads quickly.

Callbacks are what executors run: one for each clock, subscription, service or client of an activity. An executor has
threads, which are what the scheduler of a host sees. Processors are what threads run on: a pinned core, the other cores
of a host, all of them where some thread may use a set, or cores of its own for an executor without a host.
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction

from archgen.frozen import dataclass
from archgen.model.declared_timing import SchedulingOrder
from archgen.timing.system.timing_system import Arc

PERIODIC, TRIGGERED, ONCE, INACTIVE = range(4)
"""What starts an activity: the clock (or the outside world, by a stated period), an arrival, the start of the run (its
data are kept), or nothing that is known.
"""
SLOT_SAMPLED, SLOT_ANY = -2, -1
"""Slots of wires that fire nobody, and of those that fire by themselves."""
TIMER, SUBSCRIPTION, SERVICE, CLIENT = range(4)
"""Kinds of callbacks, in the order in which a wait set of rclcpp lists them."""
OUTSIDE = -1
"""In the place of a resource: the world outside, which lets nobody wait for another one."""
REENTRANT = -1
"""The group of callbacks that exclude nobody, not even themselves."""
MAX_UNIT_NS = 1000
"""The longest unit of time in ns: phases and execution times must be able to fall between the written figures."""


@dataclass(frozen=True, slots=True)
class PlannedWire:
    """One arc, as the simulation sees it. Times are in units; `queue` is the reader's queue, -1 for calls and answers.

    `slot` is the position of the input in an all-of trigger, -1 for an any-of trigger, -2 where the sample is only kept
    to be read. `link` is -1 where the wire has no link of known bandwidth.
    """

    target: int
    slot: int
    best: int
    worst: int
    queue: int
    depth: int
    link: int
    transmission: int
    declared_latency: int | None
    """The link's declared worst latency, queueing included. None where nothing is declared: then `best` (and `worst`,
    which is the same) is what a sample needs in addition to its turn on the link.
    """
    is_request: bool
    callback: int = -1
    """What a sample starts on arrival: a job, or the callback that stores it; -1 where it is stored at once, or waits for
    samples of other inputs.
    """
    is_selective: bool = False
    """Whether some jobs of its source may not send on it, without any promise: a conditional output without `max_gap`,
    less than one call for each activation, or an answer for one of several callers.
    """


@dataclass(frozen=True, slots=True)
class PlannedOutput:
    """The wires of one output key. The output may stay silent for `patience` units; None: there is no such promise."""

    key: str
    wires: tuple[int, ...]
    is_conditional: bool
    patience: int | None


@dataclass(frozen=True, slots=True)
class PlannedActivity:
    """One activity, as the simulation sees it. Times are in units; `calls` are pairs (calls for each activation,
    wires).
    """

    id: str
    kind: int
    period: int
    jitter: int
    bcet: int
    wcet: int
    declared_response: int | None
    every: int
    throttle: int
    slot_count: int
    constant_slots: tuple[int, ...]
    """The slots that an output published once fills for good."""
    captured_wires: tuple[int, ...]
    """The wires of all inputs of an all-of trigger: their newest samples go with an activation."""
    wires: tuple[int, ...]
    outputs: tuple[PlannedOutput, ...]
    calls: tuple[tuple[Fraction, tuple[int, ...]], ...]
    processor: int
    allowed_cores: tuple[int, ...]
    """The cores of its processor that it may run on; empty for any."""
    priority: int | None
    deadline: int | None
    """How long after its activation it should end, for a scheduler that looks at that."""
    samples_world: bool
    """Whether it samples the world; if not, its activation is itself the event."""
    clock_callback: int = -1
    joint_callback: int = -1
    """The callback that several inputs start together."""
    within: int | None = None
    """How far apart the stamps of samples may be that are matched; None where they are not matched by time."""
    match_depths: tuple[int, ...] = ()
    """How many samples wait for their partners, by slot."""
    keeps_dropped: bool = True
    uses: tuple[tuple[int, int, int], ...] = ()
    """The resources it uses, each by its number, and last OUTSIDE, where it waits: with the shortest and longest time."""


@dataclass(frozen=True, slots=True)
class PlannedCallback:
    """What one entity of an executor starts: a job of its activity, or the storing of a sample (`is_storing`)."""

    activity: int
    kind: int
    executor: int
    group: int
    """Callbacks of one group exclude one another; REENTRANT excludes nobody."""
    is_storing: bool
    bcet: int
    wcet: int
    depth: int = 0
    """How many samples wait to be stored; 0 for any number."""


@dataclass(frozen=True, slots=True)
class PlannedExecutor:
    """Threads that run callbacks. `order` is the order in which they take them, None for any."""

    id: str
    threads: int
    order: SchedulingOrder | None
    is_serial: bool = False
    """Whether its threads compute one at a time, as those of CPython do."""
    serves_by_kind: bool = True
    """Whether a wait set lists timers first, then subscriptions, services and clients."""


@dataclass(frozen=True, slots=True)
class PlannedResource:
    """Something that works on one use at a time, such as a GPU. `order` is None for any."""

    id: str
    order: SchedulingOrder | None


@dataclass(frozen=True, slots=True)
class Processor:
    """Cores that share one queue of threads. `host` is None for threads without a host; `order` is None for any."""

    name: str
    host: str | None
    cores: int
    order: SchedulingOrder | None = None
    turn: Fraction | None = None
    """How long a thread runs before one that was served less (ns), where cores are shared fairly."""


@dataclass(frozen=True, slots=True)
class SimulationPlan:
    """Everything that the event loop needs. `unit` is in ns; `unknown_figures` were taken as nothing."""

    unit: Fraction
    activities: tuple[PlannedActivity, ...]
    wires: tuple[PlannedWire, ...]
    wire_sources: tuple[int, ...]
    arcs: tuple[Arc, ...]
    callbacks: tuple[PlannedCallback, ...]
    executors: tuple[PlannedExecutor, ...]
    resources: tuple[PlannedResource, ...]
    processors: tuple[Processor, ...]
    links: tuple[str, ...]
    queues: tuple[tuple[str, str, str], ...]
    """The activity, input and topic of each queue."""
    cores: Mapping[str, int]
    """The number of cores, by host."""
    answers: Mapping[int, int]
    """The wire that brings back the answer, by the wire of the request."""
    unknown_figures: tuple[str, ...]
