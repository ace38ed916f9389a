"""The paces found so far: what each further one rests on."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction

from archgen.source import Span
from archgen.timing.analysis import Pace, Response
from archgen.timing.propagate import State
from archgen.timing.system import Activity
from archgen.timing.value import Value

Beat = tuple[Value, Value]
"""A rate and the largest gap."""


@dataclass(slots=True)
class Paces:
    """The paces found so far."""

    state: State
    responses: Mapping[str, Response]
    of: dict[str, Pace] = field(default_factory=dict)
    outputs: dict[tuple[str, str], Pace] = field(default_factory=dict)
    derived: dict[str, Pace] = field(default_factory=dict)
    beats: dict[tuple[int, int], Beat] = field(default_factory=dict)
    """Of each period and jitter."""
    times: dict[int, Value] = field(default_factory=dict)

    carried: dict[tuple[str, str, str, int | None], Value] = field(default_factory=dict)
    """Bytes a second of an output (activity and key) on a topic, with messages of a size."""

    def time(self, ticks: int) -> Value:
        """Give a duration in ns."""
        found = self.times.get(ticks)
        if found is None:
            above, below = self.state.system.tick.as_integer_ratio()
            found = self.times[ticks] = Value(Fraction(ticks * above, below))
        return found


def trigger_place(activity: Activity) -> Span:
    """Say where it is written what fires an activity."""
    return activity.places.get("trigger", activity.at)
