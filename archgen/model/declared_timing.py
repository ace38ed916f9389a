"""Timing as it is written. What follows from it is computed in `archgen.timing`."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import Literal

from archgen.diagnostics import NO_SPAN, Span
from archgen.diagnostics.rule_options import format_percentage
from archgen.frozen import dataclass, field
from archgen.model.quantity import Quantity

ActivityBehaviour = Literal["periodic", "event", "on_demand", "once"]
SchedulingOrder = Literal["fair", "fixed_priority", "non_preemptive", "fifo", "round_robin", "ros2_executor", "edf"]
"""In which order the cores of a host, or the threads of a container, take what is ready."""

HOST_ORDERS: tuple[SchedulingOrder, ...] = ("fair", "fixed_priority", "non_preemptive", "fifo", "round_robin", "edf")
"""The orders of a host's cores."""
EXECUTOR_ORDERS: tuple[SchedulingOrder, ...] = ("ros2_executor", "fifo", "non_preemptive", "round_robin", "edf")
"""The orders of callbacks: those of one thread never preempt one another."""
RESOURCE_ORDERS: tuple[SchedulingOrder, ...] = ("fifo", "fixed_priority")
"""The orders of a resource's uses."""
DroppedMessages = Literal["kept", "forgotten"]
"""Whether a message that `every` or `throttle` drops is stored, and read by the next activation."""
InputMemory = Literal["each_source"]
"""Whose messages an input keeps, where it is not the last one of each topic."""
PERCENTILES = ("p50", "p90", "p95", "p99")
"""The percentiles of execution times that can be written, the lowest first."""


@dataclass(frozen=True, slots=True)
class FairScheduling:
    """What is written of how Linux shares cores among threads without a real-time priority; None is assumed.

    The names are the keys of the YAML; `slice` and `tick` are durations (ns), `other_load` is a share of each core.
    """

    slice: Quantity | None = None
    tick: Quantity | None = None
    lead: int | None = None
    other_load: Fraction | None = None
    at: Span = field(default=NO_SPAN, compare=False, repr=False)


ASSUMED_SLICE, ASSUMED_TICK = Quantity(Fraction(3 * 10**6), "3 ms"), Quantity(Fraction(10**6), "1 ms")
ASSUMED_LEAD = 5
"""What is assumed of a fair order where it is not written: the lead of EEVDF, which keeps the lag of who sleeps."""


def list_fair_figures(fair: FairScheduling | None) -> list[tuple[str, str]]:
    """Return the figures of a fair order that are written, as text by their keys."""
    if fair is None:
        return []
    share = None if fair.other_load is None else format_percentage(fair.other_load)
    figures = {"slice": fair.slice, "tick": fair.tick, "lead": fair.lead, "other_load": share}
    return [(name, str(figure)) for name, figure in figures.items() if figure is not None]


@dataclass(frozen=True, slots=True)
class Trigger:
    """What triggers an activity: any of the inputs, all of them, or messages of all that match by time.

    Inputs are complete ids of input ports (`group.component.input`); `inputs` None means every input. With `match`,
    `within` (ns) is how far apart the times of messages may be that are matched.
    """

    mode: Literal["any", "all", "match"]
    inputs: tuple[str, ...] | None = None
    within: Quantity | None = None
    at: Span = field(default=NO_SPAN, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class OutputTiming:
    """When an output is published, if not at each activation; `max_gap` (ns) is the most between two messages."""

    conditional: bool = False
    max_gap: Quantity | None = None
    at: Span = field(default=NO_SPAN, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class InputTiming:
    """How long the callback computes that only stores the messages of an input, or takes an answer.

    With `stored_at_once` there is none: what has arrived can be read at once, as from a memory that is shared. `memory`
    is None where nothing is written: `runtime_facts` say what is kept then.
    """

    wcet: Quantity | None = None
    bcet: Quantity | None = None
    stored_at_once: bool = False
    memory: InputMemory | None = None
    at: Span = field(default=NO_SPAN, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class ResourceTime:
    """How long one activation uses a resource (a GPU), beside its processor time."""

    max: Quantity
    min: Quantity | None = None
    at: Span = field(default=NO_SPAN, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class MeasuredTimes:
    """What a mapping below `wcet` says of measurements: percentiles by `p50`, `p95` ..., and where `max` is from."""

    percentiles: Mapping[str, Quantity] = field(default_factory=dict)
    is_measured: bool = False
    """Whether `wcet` is the longest time that was seen, and not proven."""


@dataclass(frozen=True, slots=True)
class Timing:
    """A `timing` mapping. Durations are in ns, rates in Hz, both exact; None is not written, and hence unknown.

    `outputs` is keyed by the output's complete id; `inputs` and `calls` by the input's, the values of `calls` are calls
    per activation; `uses` by the resource. The names of attributes are the keys of the YAML (`measured_times` is a part
    of `wcet`): linker, rules and `timing/sensitivity` read them with `getattr`.
    """

    behaviour: ActivityBehaviour | None = None
    period: Quantity | None = None
    rate: Quantity | None = None
    jitter: Quantity | None = None
    wcet: Quantity | None = None
    measured_times: MeasuredTimes | None = None
    bcet: Quantity | None = None
    trigger: Trigger | None = None
    every: int | None = None
    throttle: Quantity | None = None
    dropped: DroppedMessages | None = None
    inputs: Mapping[str, InputTiming] = field(default_factory=dict)
    outputs: Mapping[str, OutputTiming] = field(default_factory=dict)
    calls: Mapping[str, Fraction] = field(default_factory=dict)
    uses: Mapping[str, ResourceTime] = field(default_factory=dict)
    priority: int | None = None
    deadline: Quantity | None = None
    core: int | None = None
    cores: tuple[int, ...] | None = None
    """A set of cores in ascending order, each once."""
    response: Quantity | None = None
    places: Mapping[str, Span] = field(default_factory=dict, compare=False, repr=False)
    """The span of each key's value by the key's name, and of each entry of `calls` by `calls PORT`,
    of `uses` by `uses RESOURCE`."""
    at: Span = field(default=NO_SPAN, compare=False, repr=False)
