"""A system flattened to lists indexed by small integers: what the engine's inner loop can read quickly.

Threads are what a scheduler sees: each activity has one of its own, except that those of a single-threaded container
share one. Processors are what threads run on: a pinned core, the other cores of a host, or one of its own for a thread
without a host.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction

from archgen.timing.system import Arc

PERIODIC, TRIGGERED, KEPT, IDLE = range(4)
"""What starts an activity: the clock (or the world outside, by a stated period), an arrival, the start of everything (its
data are kept), nothing that is known."""
SAMPLED, ANY = -2, -1
"""Slots of wires that fire nobody, and of those that fire by themselves."""
FINEST = 1000
"""Times are counted in units of at most so many ns: phases and execution times fall between the written figures too."""


@dataclass(frozen=True, slots=True)
class Wire:
    """One arc, as the engine sees it. Times in units; `queue` is the reader's queue that a firing sample stands in.

    `slot` is the place of the input among those that all must be there, -1 for an any-of trigger, -2 where the
    sample is only kept to be read; `link` is -1 where the wire has no link of known bandwidth.
    """

    target: int
    slot: int
    best: int
    worst: int
    queue: int
    depth: int
    link: int
    transmission: int
    limit: int | None
    """What the link's declared latency promises, queueing included; None where nothing is declared."""
    request: bool
    selective: bool = False
    """Not every job of its source sends on it, and nothing is promised: a conditional output without `max_gap`, less than
    one call for each activation, an answer for one of several who ask."""


@dataclass(frozen=True, slots=True)
class Output:
    """What one output key reaches. `patience` None: published whenever it may be silent no longer than that (units)."""

    key: str
    wires: tuple[int, ...]
    conditional: bool
    patience: int | None


@dataclass(frozen=True, slots=True)
class Step:
    """One activity, as the engine sees it. Times in units; `calls` are (calls for each activation, wires)."""

    id: str
    kind: int
    period: int
    jitter: int
    bcet: int
    wcet: int
    promised: int | None
    every: int
    throttle: int
    slots: int
    kept: tuple[int, ...]
    """The slots that an output published once fills for ever."""
    captured: tuple[int, ...]
    """Wires of the inputs that must all be there: their newest samples go with a firing."""
    wires: tuple[int, ...]
    outputs: tuple[Output, ...]
    calls: tuple[tuple[Fraction, tuple[int, ...]], ...]
    thread: int
    priority: int | None
    samples: bool
    """It samples the world; where it does not, its activation is the event."""


@dataclass(frozen=True, slots=True)
class Processor:
    """Cores that share one queue of threads. `name` says which."""

    name: str
    host: str | None
    cores: int


@dataclass(frozen=True, slots=True)
class Plan:
    """Everything that the engine needs. `unit` in ns; `unknown` says which figures were taken as nothing."""

    unit: Fraction
    steps: tuple[Step, ...]
    wires: tuple[Wire, ...]
    arcs: tuple[Arc, ...]
    threads: tuple[int, ...]
    """The processor of each thread."""
    members: tuple[tuple[int, ...], ...]
    """The activities of each thread."""
    affinity: tuple[int, ...]
    """The core that a thread must have, among those of its processor; -1 for any."""
    pool_of_thread: tuple[int, ...]
    """The container whose threads it shares, -1 for none."""
    pools: tuple[int, ...]
    """How many threads each such container has."""
    processors: tuple[Processor, ...]
    links: tuple[str, ...]
    queues: tuple[tuple[str, str, str], ...]
    """The activity, input and topic of each queue."""
    cores: Mapping[str, int]
    """Of each host."""
    answers: Mapping[int, int]
    """The wire that brings the answer back, by that of the request."""
    unknown: tuple[str, ...]
