"""The rates found so far, which each further one rests on."""

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
"""A rate in Hz, and the largest gap in ns."""


@dataclass(slots=True)
class Paces:
    """The rates found so far. It is filled by `find_rates`, sources first, and by link_traffic."""

    state: State
    responses: Mapping[str, Response]
    of: dict[str, Pace] = field(default_factory=dict)
    outputs: dict[tuple[str, str], Pace] = field(default_factory=dict)
    derived: dict[str, Pace] = field(default_factory=dict)
    beats: dict[tuple[int, int], Beat] = field(default_factory=dict)
    """Rate and gap by period and jitter (ticks)."""
    times: dict[int, Value] = field(default_factory=dict)
    """Durations in ns by ticks."""

    carried: dict[tuple[str, str, str, int | None], Value] = field(default_factory=dict)
    """Traffic in B/s by activity, output key, topic, and message size."""

    def time(self, ticks: int) -> Value:
        """Return a duration in ns."""
        found = self.times.get(ticks)
        if found is None:
            above, below = self.state.system.tick.as_integer_ratio()
            found = self.times[ticks] = Value(Fraction(ticks * above, below))
        return found


def trigger_place(activity: Activity) -> Span:
    """Return where it is written what fires an activity."""
    return activity.places.get("trigger", activity.at)
