"""What each step of a way adds to a latency: waiting to be read, the response, the link (chains are sums of these).

Largest reaction time = largest data age: M. Guenzel et al., "On the Equivalence of Maximum Reaction Time and Maximum Data
Age for Cause-Effect Chains", ECRTS 2023. For periodic chains the sum is A. Davare et al., "Period Optimization for Hard
Real-time Distributed Automotive Systems", DAC 2007: T_i + R_i for each element.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from fractions import Fraction

from archgen.source import Span
from archgen.timing import wording
from archgen.timing.analysis import Analysis
from archgen.timing.sums import known, nameless, total
from archgen.timing.system import Activity, Arc
from archgen.timing.value import UNKNOWN, ZERO, Value

NEVER = Value(None, complete=True, assumptions=("unbounded",))


@dataclass(frozen=True, slots=True)
class Delay:
    """A delay in ns, why there is one, and where that is written."""

    value: Value
    why: str
    at: Span


@dataclass(frozen=True, slots=True)
class Steps:
    """The delays of a system's steps; what they rest on is worked out once for each activity."""

    analysis: Analysis
    _streams: dict[str, dict[str, Value]] = field(default_factory=dict)

    def start(self, name: str) -> Delay:
        """Give S0: the gap of an element that samples the world, 0 where its activation is the stimulus."""
        activity = self.analysis.system.activities[name]
        if activity.behaviour == "periodic":
            gap = self._gap(name)
            return Delay(gap, f"samples the world{_each(gap)}", _place(activity, "period", "rate"))
        if activity.behaviour in {"event", "on_demand"}:
            thinned = self._thinned(activity)
            why = "its event is the stimulus" + (f"; {_thinning(activity)}" if thinned is not ZERO else "")
            return Delay(thinned, why, activity.at)
        return self._strange(activity)

    def sampling(self, arc: Arc) -> Delay:
        """Give S of a step: how long a sample may lie before the reader takes it, and before it is sent at all."""
        waited = self._read(arc)
        held = self._condition(arc)
        return waited if held is ZERO else Delay(total((waited.value, held)), waited.why, waited.at)

    def _read(self, arc: Arc) -> Delay:
        reader = self.analysis.system.activities[arc.target]
        if self.fires(arc):
            return self._triggered(reader, arc)
        if reader.behaviour is None or reader.behaviour == "once":
            return self._strange(reader)
        gap = self._gap(reader.id)
        what = "takes the answer" if arc.role == "answer" else f"reads {arc.topic}"
        return Delay(gap, f"{what}{_each(gap)}", _place(reader, "period", "rate"))

    def _triggered(self, reader: Activity, arc: Arc) -> Delay:
        others = self._others(reader, arc)
        waits = total((others, self._thinned(reader)))
        why = f"triggered by {arc.topic}"
        if others is not ZERO:
            why += ", waits for its other triggers"
        if waits is not others:
            why += f"; {_thinning(reader)}" if _thinning(reader) else ""
        return Delay(waits, why, _place(reader, "trigger"))

    def holding(self, arc: Arc) -> Value:
        """Give H of a step: how old a sample may have become when it is used (again), since it was sent."""
        reader = self.analysis.system.activities[arc.target]
        gap = self._out_gap(arc)
        if not self.fires(arc):
            return gap
        if self._waits_for_all(reader):
            others = self._others(reader, arc)
            options = [value for value in (gap, others) if known(value)]
            return min(options, key=lambda value: value.value or Fraction(0)) if options else gap
        return ZERO if self._sole(arc) else gap

    def fires(self, arc: Arc) -> bool:
        """Tell whether what arrives on an arc triggers its reader."""
        reader = self.analysis.system.activities[arc.target]
        if arc.role != "data":
            return arc.role == "request" and reader.behaviour in {"event", "on_demand"}
        return reader.behaviour == "event" and arc.input in reader.triggers

    def response(self, name: str) -> Value:
        """Give R, the largest response time."""
        return nameless(self._response(name, worst=True), name)

    def best_response(self, name: str) -> Value:
        """Give B, the smallest."""
        return nameless(self._response(name, worst=False), name)

    def link(self, arc: Arc, *, worst: bool = True) -> Value:
        """Give a link's largest (or smallest) latency, as it is written; its own queueing is not in it."""
        ticks = arc.worst if worst else arc.best
        if ticks is None:
            return Value(None, complete=False, missing=(arc.link or arc.topic,))
        if not ticks:
            return ZERO if arc.link is None else self._linked(arc, ticks, worst=worst)
        return self._linked(arc, ticks, worst=worst)

    def _linked(self, arc: Arc, ticks: int, *, worst: bool) -> Value:
        value = self._time(ticks)
        load = self.analysis.links.get(arc.link or "")
        queueing = load.queueing.value if load and worst else None
        if not queueing:
            return value
        left_out = f"queueing on link {arc.link} (up to {wording.duration(queueing)}) is within its latency"
        return replace(value, assumptions=(left_out,))

    def _response(self, name: str, *, worst: bool) -> Value:
        found = self.analysis.responses.get(name)
        if found is None:
            return UNKNOWN
        return found.worst if worst else found.best

    def _gap(self, name: str) -> Value:
        pace = self.analysis.paces.get(name)
        return nameless(pace.gap if pace else UNKNOWN, name)

    def _out_gap(self, arc: Arc) -> Value:
        pace = self.analysis.outputs.get((arc.source, arc.output)) or self.analysis.paces.get(arc.source)
        return nameless(pace.gap if pace else UNKNOWN, arc.source)

    def _time(self, ticks: int) -> Value:
        return Value(ticks * self.analysis.system.tick) if ticks else ZERO

    def _strange(self, activity: Activity) -> Delay:
        if activity.behaviour == "once":
            return Delay(NEVER, "works once, at the start: nothing later reaches it", _place(activity, "behaviour"))
        missing = Value(None, complete=False, missing=(activity.id,))
        return Delay(missing, "its behaviour is not known", activity.at)

    def _condition(self, arc: Arc) -> Value:
        """Give what an output adds that is not published each time: its promised gap, or the assumption that it is."""
        source = self.analysis.system.activities[arc.source]
        calls = source.calls.get(arc.output, source.calls.get(arc.input, Fraction(1))) if arc.role == "request" else 1
        if calls < 1:
            return Value(Fraction(0), assumptions=(f"{arc.source} calls {arc.topic} in this very activation",))
        if arc.role == "request" or arc.output not in source.conditional:
            return ZERO
        promised = source.max_gaps.get(arc.output)
        if promised is not None:
            return self._time(promised)
        return Value(Fraction(0), assumptions=(f"{arc.source} publishes {arc.topic} for this very input",))

    def _thinned(self, activity: Activity) -> Value:
        """Give what `every` and `throttle` let a trigger wait: (n - 1) gaps, and q + gap - the smallest gap."""
        if activity.behaviour not in {"event", "on_demand"} or (activity.every == 1 and not activity.throttle):
            return ZERO
        gap = self._firing_gap(activity)
        parts: list[Value] = []
        if activity.throttle:
            gap = total((gap, self._time(activity.throttle)))
            parts.append(_less(gap, self._smallest(activity)))
        if activity.every > 1:
            parts.append(_times(gap, activity.every - 1))
        return total(parts)

    def _waits_for_all(self, activity: Activity) -> bool:
        return activity.mode == "all" and len(self._stream(activity)) > 1

    def _others(self, activity: Activity, arc: Arc) -> Value:
        """Give the largest gap of the other triggers of an all-of element."""
        if not self._waits_for_all(activity):
            return ZERO
        return _largest(gap for key, gap in self._stream(activity).items() if key != arc.input)

    def _firing_gap(self, activity: Activity) -> Value:
        """Give the largest gap between two occasions to fire."""
        gaps = self._stream(activity).values()
        merged = _largest(gaps) if activity.mode == "all" else _smallest(gaps)
        return nameless(merged, activity.id)

    def _stream(self, activity: Activity) -> dict[str, Value]:
        """Give the largest gap of what arrives at each trigger; one that arrives once at the start is left out."""
        found = self._streams.get(activity.id)
        if found is None:
            arcs = [arc for arc in self.analysis.system.into.get(activity.id, ()) if self.fires(arc)]
            keys = dict.fromkeys((*activity.triggers, *(arc.input for arc in arcs)))
            found = {key: self._arriving(activity, key, [arc for arc in arcs if arc.input == key]) for key in keys}
            kept = [arc.input for arc in arcs if self.analysis.system.activities[arc.source].behaviour != "once"]
            outside = self.analysis.system.external.get(activity.id, ())
            found = {key: gap for key, gap in found.items() if key in kept or key in outside}
            self._streams[activity.id] = found
        return found

    def _arriving(self, activity: Activity, key: str, arcs: list[Arc]) -> Value:
        gaps = [self._arriving_on(arc) for arc in arcs]
        outside = key in self.analysis.system.external.get(activity.id, ())
        unknown = Value(None, complete=False, missing=(activity.id,))
        return _smallest([*gaps, unknown] if outside else gaps)

    def _arriving_on(self, arc: Arc) -> Value:
        if arc.best is None or arc.worst is None:
            return Value(None, complete=False, missing=(arc.link or arc.topic,))
        return total((self._out_gap(arc), self._time(arc.worst - arc.best)))

    def _smallest(self, activity: Activity) -> Value:
        """Give the smallest gap between two triggers: known of a single stream only, else 0."""
        arcs = [arc for arc in self.analysis.system.into.get(activity.id, ()) if self.fires(arc)]
        if len(arcs) != 1 or arcs[0].best is None or arcs[0].worst is None:
            return ZERO
        pace = self.analysis.outputs.get((arcs[0].source, arcs[0].output))
        if pace is None or pace.distance.value is None or not known(pace.distance, "at least"):
            return ZERO
        spread = (arcs[0].worst - arcs[0].best) * self.analysis.system.tick
        return Value(max(Fraction(0), pace.distance.value - spread))

    def _sole(self, arc: Arc) -> bool:
        """Tell whether nothing else fires an arc's reader."""
        firing = [other for other in self.analysis.system.into.get(arc.target, ()) if self.fires(other)]
        outside = self.analysis.system.external.get(arc.target, ())
        reader = self.analysis.system.activities[arc.target]
        return len(firing) == 1 and not any(key in outside for key in reader.triggers)


def _largest(values: Iterable[Value]) -> Value:
    parts = tuple(values)
    if not parts:
        return ZERO
    open_parts = tuple(part for part in parts if not known(part))
    if open_parts:
        return total(tuple(replace(part, value=None) for part in open_parts))
    return max(parts, key=lambda part: part.value or Fraction(0))


def _smallest(values: Iterable[Value]) -> Value:
    parts = tuple(values)
    shut = [part for part in parts if known(part)]
    if shut:
        return min(shut, key=lambda part: part.value or Fraction(0))
    return total(parts) if parts else UNKNOWN


def _times(value: Value, count: int) -> Value:
    return replace(value, value=value.value * count) if value.value is not None else value


def _less(value: Value, off: Value) -> Value:
    if value.value is None or not value.complete:
        return value
    return replace(value, value=value.value - (off.value or 0))


def _each(gap: Value) -> str:
    return f" every {wording.duration(gap.value)} at the latest" if gap.value is not None and known(gap) else ""


def _thinning(activity: Activity) -> str:
    said = [f"fires at every {activity.every}th only"] if activity.every > 1 else []
    return ", ".join([*said, "keeps a smallest gap"] if activity.throttle else said)


def _place(activity: Activity, *keys: str) -> Span:
    return next((activity.places[key] for key in keys if key in activity.places), activity.at)
