"""The rates found so far, which each further one rests on."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction

from archgen.diagnostics.source_span import Span
from archgen.frozen import dataclass, field
from archgen.timing.analysis import EventPace, MatchFigures, ResponseTime
from archgen.timing.figures.timing_values import TimingValue
from archgen.timing.load.propagation_state import PropagationState
from archgen.timing.system.timing_system import Activity

RateAndGap = tuple[TimingValue, TimingValue]
"""A rate in Hz, and the largest gap in ns."""


@dataclass(slots=True)
class RateTable:
    """The rates found so far. It is filled by `find_rates`, sources first, and by link_traffic."""

    state: PropagationState
    responses: Mapping[str, ResponseTime]
    paces: dict[str, EventPace] = field(default_factory=dict)
    outputs: dict[tuple[str, str], EventPace] = field(default_factory=dict)
    derived: dict[str, EventPace] = field(default_factory=dict)
    matches: dict[str, MatchFigures] = field(default_factory=dict)
    """What is sure of the matches of those whose inputs are matched by time."""
    written_rates: dict[tuple[int, int], RateAndGap] = field(default_factory=dict)
    """Rate and gap by period and jitter (ticks)."""
    duration_values: dict[int, TimingValue] = field(default_factory=dict)
    """Durations in ns by ticks."""

    output_traffic: dict[tuple[str, str, str, int | None], TimingValue] = field(default_factory=dict)
    """Traffic in B/s by activity, output key, topic, and message size."""

    def duration_value(self, ticks: int) -> TimingValue:
        """Return a duration in ns."""
        duration = self.duration_values.get(ticks)
        if duration is None:
            numerator, denominator = self.state.system.tick.as_integer_ratio()
            duration = self.duration_values[ticks] = TimingValue(Fraction(ticks * numerator, denominator))
        return duration


def trigger_span(activity: Activity) -> Span:
    """Return where it is written what fires an activity."""
    return activity.places.get("trigger", activity.at)
