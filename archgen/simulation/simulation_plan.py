"""A system flattened to lists indexed by small integers, which the inner loop of the simulation reads quickly.

Threads are what a scheduler sees: each activity has one of its own, except that those of a single-threaded container
share one. Processors are what threads run on: a pinned core, the other cores of a host, or one of its own for a thread
without a host.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction

from archgen.timing.system.timing_system import Arc

PERIODIC, TRIGGERED, ONCE, INACTIVE = range(4)
"""What starts an activity: the clock (or the outside world, by a stated period), an arrival, the start of the run (its
data are kept), or nothing that is known.
"""
SLOT_SAMPLED, SLOT_ANY = -2, -1
"""Slots of wires that fire nobody, and of those that fire by themselves."""
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
    thread: int
    priority: int | None
    samples_world: bool
    """Whether it samples the world; if not, its activation is itself the event."""


@dataclass(frozen=True, slots=True)
class Processor:
    """Cores that share one queue of threads. `host` is None for a thread without a host."""

    name: str
    host: str | None
    cores: int


@dataclass(frozen=True, slots=True)
class SimulationPlan:
    """Everything that the event loop needs. `unit` is in ns; `unknown_figures` were taken as nothing."""

    unit: Fraction
    activities: tuple[PlannedActivity, ...]
    wires: tuple[PlannedWire, ...]
    arcs: tuple[Arc, ...]
    threads: tuple[int, ...]
    """The processor of each thread."""
    thread_members: tuple[tuple[int, ...], ...]
    """The activities of each thread."""
    affinity: tuple[int, ...]
    """The core that each thread must have, among those of its processor; -1 for any."""
    pool_of_thread: tuple[int, ...]
    """The container whose threads it shares, -1 for none."""
    pool_sizes: tuple[int, ...]
    """The number of threads of each such container."""
    processors: tuple[Processor, ...]
    links: tuple[str, ...]
    queues: tuple[tuple[str, str, str], ...]
    """The activity, input and topic of each queue."""
    cores: Mapping[str, int]
    """The number of cores, by host."""
    answers: Mapping[int, int]
    """The wire that brings back the answer, by the wire of the request."""
    unknown_figures: tuple[str, ...]
