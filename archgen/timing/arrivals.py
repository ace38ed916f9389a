"""What arrives at an activity's triggers: how far apart at most, how close at least, and what fires it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import field, replace
from fractions import Fraction

from archgen.frozen import dataclass
from archgen.timing.analysis import Analysis
from archgen.timing.sums import bounded, known, nameless, smallest, times, unknown
from archgen.timing.system import Activity, Arc
from archgen.timing.value import UNKNOWN, ZERO, Value


@dataclass(frozen=True, slots=True)
class Arrivals:
    """Answers questions about the arrivals of an analysis; the gaps of each activity's triggers are cached."""

    analysis: Analysis
    _streams: dict[str, dict[str, Value]] = field(default_factory=dict)

    def fires(self, arc: Arc) -> bool:
        """Whether what arrives on an arc triggers its reader."""
        reader = self.analysis.system.activities[arc.target]
        if arc.role != "data":
            return arc.role == "request" and reader.behaviour in {"event", "on_demand"}
        return reader.behaviour == "event" and arc.input in reader.triggers

    def sole(self, arc: Arc) -> bool:
        """Whether nothing else fires an arc's reader."""
        firing = [other for other in self.analysis.system.into.get(arc.target, ()) if self.fires(other)]
        outside = self.analysis.system.external.get(arc.target, ())
        reader = self.analysis.system.activities[arc.target]
        return len(firing) == 1 and not any(key in outside for key in reader.triggers)

    def gap(self, name: str) -> Value:
        """Return the largest gap between two activations."""
        pace = self.analysis.paces.get(name)
        return nameless(pace.gap if pace else UNKNOWN, name)

    def sent_gap(self, arc: Arc) -> Value:
        """Return the largest gap between two messages, where they are sent."""
        pace = self.analysis.outputs.get((arc.source, arc.output)) or self.analysis.paces.get(arc.source)
        return nameless(pace.gap if pace else UNKNOWN, arc.source)

    def waits_for_all(self, activity: Activity) -> bool:
        """Whether several triggers must have come before an activity fires."""
        return activity.mode == "all" and len(self._stream(activity)) > 1

    def others(self, activity: Activity, arc: Arc) -> Value:
        """Return the largest gap of the other triggers of an all-of activity.

        `ZERO_VALUE` (the very object: callers compare with `is`) for any other activity, and for calls.
        """
        if arc.role != "data" or not self.waits_for_all(activity):
            return ZERO
        return _largest(gap for key, gap in self._stream(activity).items() if key != arc.input)

    def thinned(self, activity: Activity) -> Value:
        """Return how long `every`, `throttle` and `jitter` let a trigger wait.

        Every n-th: (n - 1) gaps. A throttle q fires at the first (n-th) trigger that comes q after the last firing, so
        within q + n gaps of it; what waits came a smallest gap after it at the earliest.
        """
        if activity.behaviour != "event" or (activity.every == 1 and not activity.throttle):
            return self.time(activity.jitter) if activity.behaviour == "event" else ZERO
        gap = self._firing_gap(activity)
        if not activity.throttle:
            return bounded((times(gap, activity.every - 1), self.time(activity.jitter)))
        kept = (times(gap, activity.every), self.time(activity.throttle), self.time(activity.jitter))
        return _less(bounded(kept), self._smallest_gap(activity))

    def time(self, ticks: int) -> Value:
        """Return a duration of the system (ticks) in ns."""
        return Value(ticks * self.analysis.system.tick) if ticks else ZERO

    def _firing_gap(self, activity: Activity) -> Value:
        """Return the largest gap between two occasions to fire."""
        gaps = self._stream(activity).values()
        merged = _largest(gaps) if activity.mode == "all" else _smallest(gaps)
        return nameless(merged, activity.id)

    def _stream(self, activity: Activity) -> dict[str, Value]:
        """Return the largest gap at each trigger, except where something arrives only once, at the start."""
        found = self._streams.get(activity.id)
        if found is None:
            arcs = [a for a in self.analysis.system.into.get(activity.id, ()) if a.role == "data" and self.fires(a)]
            outside = self.analysis.system.external.get(activity.id, ())
            kept = {arc.input for arc in arcs if self.analysis.system.activities[arc.source].behaviour != "once"}
            keys = dict.fromkeys((*activity.triggers, *(arc.input for arc in arcs)))
            found = self._streams[activity.id] = {
                key: self._arriving(activity, key in outside, [arc for arc in arcs if arc.input == key])
                for key in keys
                if key in kept or key in outside
            }
        return found

    def _arriving(self, activity: Activity, outside: bool, arcs: Iterable[Arc]) -> Value:  # noqa: FBT001 - told by its name
        """Return the largest gap at one trigger: the smallest of its sources' gaps."""
        gaps = [self._arriving_on(arc) for arc in arcs]
        # Something outside may come at any time, or never: it is no bound, and named only if no arc gives one.
        return _smallest([*gaps, Value(None, complete=False, missing=(activity.id,))] if outside else gaps)

    def _arriving_on(self, arc: Arc) -> Value:
        """Return the largest gap of what arrives on an arc: that of the output, and the spread of the link."""
        spread = unknown(*self.unlinked(arc)) if arc.worst is None else self.time(arc.worst - (arc.best or 0))
        return bounded((self.sent_gap(arc), spread))

    def unlinked(self, arc: Arc) -> tuple[str, ...]:
        """Return what is missing where a link's latency is unknown: the link, or whose host is not written."""
        if arc.link is not None:
            return (arc.link,)
        activities = self.analysis.system.activities
        homeless = tuple(name for name in (arc.source, arc.target) if activities[name].host is None)
        return homeless or (f"{activities[arc.source].host} - {activities[arc.target].host}",)

    def _smallest_gap(self, activity: Activity) -> Value:
        """Return the smallest gap between two triggers: known for a single stream only, else 0 (the safe side)."""
        arcs = [arc for arc in self.analysis.system.into.get(activity.id, ()) if self.fires(arc)]
        if len(arcs) != 1 or arcs[0].worst is None:
            return ZERO
        pace = self.analysis.outputs.get((arcs[0].source, arcs[0].output))
        if pace is None or pace.distance.value is None or not known(pace.distance, "at least"):
            return ZERO
        spread = (arcs[0].worst - (arcs[0].best or 0)) * self.analysis.system.tick
        return Value(max(Fraction(0), pace.distance.value - spread))


def _largest(values: Iterable[Value]) -> Value:
    """Return the largest of the gaps, or their causes where one has no bound."""
    parts = tuple(values)
    if not parts:
        return ZERO
    open_parts = tuple(part for part in parts if not known(part))
    if open_parts:
        return bounded(tuple(replace(part, value=None) for part in open_parts))
    return max(parts, key=lambda part: part.value or Fraction(0))


def _smallest(values: Iterable[Value]) -> Value:
    """Return the smallest of the gaps, unknown where there are none."""
    parts = tuple(values)
    return smallest(parts) if parts else UNKNOWN


def _less(value: Value, off: Value) -> Value:
    """Return a bound less something, where it is complete."""
    if value.value is None or not value.complete:
        return value
    return replace(value, value=value.value - (off.value or 0))
