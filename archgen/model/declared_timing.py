"""Timing as it is written. What follows from it is computed in `archgen.timing`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from fractions import Fraction
from typing import Literal

from archgen.diagnostics.source_span import NO_SPAN, Span
from archgen.frozen import dataclass
from archgen.model.quantity import Quantity

ActivityBehaviour = Literal["periodic", "event", "on_demand", "once"]
SchedulingOrder = Literal["fixed_priority", "non_preemptive", "fifo", "round_robin", "ros2_executor", "edf"]
"""In which order the cores of a host, or the threads of a container, take what is ready."""


@dataclass(frozen=True, slots=True)
class Trigger:
    """What triggers an activity: any of the inputs, or all of them; `inputs` None means every input.

    Inputs are complete ids of input ports (`group.component.input`).
    """

    mode: Literal["any", "all"]
    inputs: tuple[str, ...] | None = None
    at: Span = field(default=NO_SPAN, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class OutputTiming:
    """When an output is published, if not at each activation; `max_gap` (ns) is the most between two messages."""

    conditional: bool = False
    max_gap: Quantity | None = None
    at: Span = field(default=NO_SPAN, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Timing:
    """A `timing` mapping. Durations are in ns, rates in Hz, both exact; None is not written, and hence unknown.

    `outputs` is keyed by the output's complete id; `calls` by the input's, its values are calls per activation. The
    names of attributes are the keys of the YAML: linker, rules and `timing/sensitivity` read them with `getattr`.
    """

    behaviour: ActivityBehaviour | None = None
    period: Quantity | None = None
    rate: Quantity | None = None
    jitter: Quantity | None = None
    wcet: Quantity | None = None
    bcet: Quantity | None = None
    trigger: Trigger | None = None
    every: int | None = None
    throttle: Quantity | None = None
    outputs: Mapping[str, OutputTiming] = field(default_factory=dict)
    calls: Mapping[str, Fraction] = field(default_factory=dict)
    priority: int | None = None
    core: int | None = None
    response: Quantity | None = None
    places: Mapping[str, Span] = field(default_factory=dict, compare=False, repr=False)
    """The span of each key's value by the key's name, and of each entry of `calls` by `calls PORT`."""
    at: Span = field(default=NO_SPAN, compare=False, repr=False)
