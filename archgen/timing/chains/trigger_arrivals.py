"""What arrives at an activity's triggers: how far apart at most, how close at least, and what fires it."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from math import ceil

from archgen.diagnostics.common_wording import join_first
from archgen.frozen import dataclass, field, replace
from archgen.timing.analysis import Analysis
from archgen.timing.figures.timing_values import (
    NO_USE_NOTE,
    REPLACED_WORDS,
    UNKNOWN_VALUE,
    ZERO_VALUE,
    TimingValue,
    UnknownCause,
    is_known_bound,
    multiply_value,
    name_missing_element,
    smallest_value,
    sum_bounds,
    unknown_value,
    value_of_cause,
)
from archgen.timing.load.event_models import input_model
from archgen.timing.load.event_streams import max_arrivals
from archgen.timing.load.propagation_state import PropagationState
from archgen.timing.system.timing_system import Activity, Arc, best_response, list_memory_rivals


@dataclass(frozen=True, slots=True)
class TriggerArrivals:
    """Answers questions about the arrivals of an analysis; the gaps of each activity's triggers are cached."""

    analysis: Analysis
    _gaps_by_activity: dict[str, dict[str, TimingValue]] = field(default_factory=dict)
    _waiting_counts: dict[tuple[str, str, str], int | UnknownCause | None] = field(default_factory=dict)
    """Most messages that wait in the queues of several sources, by reader, input and topic."""

    def fires_reader(self, arc: Arc) -> bool:
        """Whether what arrives on an arc triggers its reader."""
        reader = self.analysis.system.activities[arc.target]
        if arc.role != "data":
            return arc.role == "request" and reader.behaviour in {"event", "on_demand"}
        return reader.behaviour == "event" and arc.input in reader.triggers

    def is_sole_trigger(self, arc: Arc) -> bool:
        """Whether nothing else fires an arc's reader."""
        firing_arcs = [
            other_arc
            for other_arc in self.analysis.system.arcs_into.get(arc.target, ())
            if self.fires_reader(other_arc)
        ]
        outside_inputs = self.analysis.system.external_inputs.get(arc.target, ())
        reader = self.analysis.system.activities[arc.target]
        return len(firing_arcs) == 1 and not any(key in outside_inputs for key in reader.triggers)

    def shares_input(self, arc: Arc) -> bool:
        """Whether messages of others come to the input of an arc as well."""
        arcs_into = self.analysis.system.arcs_into.get(arc.target, ())
        return any(
            other_arc is not arc and other_arc.role == "data" and other_arc.input == arc.input
            for other_arc in arcs_into
        ) or arc.input in self.analysis.system.external_inputs.get(arc.target, ())

    def activation_gap(self, name: str) -> TimingValue:
        """Return the largest gap between two activations."""
        pace = self.analysis.paces.get(name)
        return name_missing_element(pace.gap if pace else UNKNOWN_VALUE, name)

    def sent_gap(self, arc: Arc) -> TimingValue:
        """Return the largest gap between two messages, where they are sent."""
        pace = self.analysis.outputs.get((arc.source, arc.output)) or self.analysis.paces.get(arc.source)
        return name_missing_element(pace.gap if pace else UNKNOWN_VALUE, arc.source)

    def waits_for_all(self, activity: Activity) -> bool:
        """Whether several triggers must have come before an activity fires."""
        return activity.mode == "all" and len(self._trigger_gaps(activity)) > 1

    def other_triggers_gap(self, activity: Activity, arc: Arc) -> TimingValue:
        """Return the largest gap of the other triggers of an all-of activity.

        `ZERO_VALUE` (the very object: callers compare with `is`) for any other activity, and for calls.
        """
        if arc.role != "data" or not self.waits_for_all(activity):
            return ZERO_VALUE
        return _largest_known(gap for key, gap in self._trigger_gaps(activity).items() if key != arc.input)

    def match_wait(self, activity: Activity, arc: Arc) -> TimingValue:
        """Return how long a message waits at most for a match of it or of a newer one, where inputs are matched."""
        figures = self.analysis.matches.get(activity.id)
        return figures.waits[arc.input] if figures else self.activation_gap(activity.id)

    def match_age(self, activity: Activity, arc: Arc) -> TimingValue:
        """Return how old a message may be when it is matched, since it was sent, without the link's worst latency."""
        figures = self.analysis.matches.get(activity.id)
        age = figures.ages[arc.input] if figures else self.activation_gap(activity.id)
        if age.value is None:
            return age
        source = self.analysis.system.activities[arc.source]
        covered = (best_response(source) + (arc.worst or 0)) * self.analysis.system.tick
        return replace(age, value=max(age.value - covered, Fraction(0)))

    def find_lost_use(self, arc: Arc) -> TimingValue | None:
        """Return why nothing promises that a message on an arc is used, though one of each source comes; None where it is.

        Others send to the same memory of the reader, and theirs may take its place: always where it is stored, or waits
        for messages of other inputs; where each fires the reader as long as the queue may hold too many.
        """
        system, state = self.analysis.system, self.analysis.state
        rivals = list_memory_rivals(system, arc)
        reader = system.activities[arc.target]
        if not rivals or reader.mode == "match":  # a match of several sources is never sure
            return None
        is_worked_off = self.fires_reader(arc) and not self.waits_for_all(reader)
        if is_worked_off and reader.every == 1 and not reader.throttle:
            if arc.depth is None or state is None:
                return None
            queue = (arc.target, arc.input, arc.topic)
            if queue not in self._waiting_counts:
                self._waiting_counts[queue] = self._count_waiting(state, reader, (arc, *rivals))
            count = self._waiting_counts[queue]
            if isinstance(count, UnknownCause):
                return value_of_cause(count)
            if count is None or count <= arc.depth:
                return None
            reason = f"keeps {arc.depth} of {count} messages of {arc.topic} that may wait (`depth: {count}` keeps all)"
        else:
            reason = f"keeps the last message of {arc.topic}"
        others = join_first(tuple(dict.fromkeys(each.source for each in rivals)))
        text = f"{NO_USE_NOTE}: {reader.id} {reason}: one of {others} {REPLACED_WORDS} that of {arc.source}"
        return TimingValue(None, assumptions=("diverged", text))

    def _count_waiting(
        self, state: PropagationState, reader: Activity, arcs: tuple[Arc, ...]
    ) -> int | UnknownCause | None:
        """Return how many messages may wait in a reader's queue; None where no bound says how long they do."""
        response = self.analysis.responses[reader.id].worst
        if response.value is None or not response.complete:
            return None
        # A job has begun R - B after it was activated; what comes at that very moment may come before.
        wait = ceil(response.value / state.system.tick) - best_response(reader) + reader.jitter
        model = input_model(state, reader, arcs[0].input, arcs)
        return model if isinstance(model, UnknownCause) else max_arrivals(model, max(wait, 0) + 1)

    def lacks_sure_use(self, activity: Activity, arc: Arc) -> bool:
        """Whether each message of an arc may be among those that are dropped and forgotten: others may come before it."""
        if arc.role != "data" or activity.mode != "any" or not self.forgets_dropped(activity):
            return False
        data_arcs = [
            other_arc
            for other_arc in self.analysis.system.arcs_into.get(activity.id, ())
            if other_arc.role == "data" and self.fires_reader(other_arc)
        ]
        outside_inputs = self.analysis.system.external_inputs.get(activity.id, ())
        return len(data_arcs) > 1 or any(key in outside_inputs for key in activity.triggers)

    def forgets_dropped(self, activity: Activity) -> bool:
        """Whether an activity drops messages, and does not store what it drops."""
        return not activity.keeps_dropped and (activity.every > 1 or activity.throttle > 0)

    def thinning_wait(self, activity: Activity) -> TimingValue:
        """Return how long `every`, `throttle` and `jitter` let a trigger wait.

        Every n-th: (n - 1) gaps. A throttle q fires at the first (n-th) trigger that comes q after the last firing, so
        within q + n gaps of it; what waits came a smallest gap after it at the earliest.
        """
        if activity.behaviour != "event" or (activity.every == 1 and not activity.throttle):
            return self.duration_value(activity.jitter) if activity.behaviour == "event" else ZERO_VALUE
        gap = self.firing_gap(activity)
        if not activity.throttle:
            return sum_bounds((multiply_value(gap, activity.every - 1), self.duration_value(activity.jitter)))
        wait_terms = (
            multiply_value(gap, activity.every),
            self.duration_value(activity.throttle),
            self.duration_value(activity.jitter),
        )
        return _subtract_value(sum_bounds(wait_terms), self.min_trigger_gap(activity))

    def duration_value(self, ticks: int) -> TimingValue:
        """Return a duration of the system (ticks) in ns."""
        return TimingValue(ticks * self.analysis.system.tick) if ticks else ZERO_VALUE

    def firing_gap(self, activity: Activity) -> TimingValue:
        """Return the largest gap between two occasions to fire."""
        if activity.mode == "match":
            figures = self.analysis.matches.get(activity.id)
            return figures.gap if figures else self.activation_gap(activity.id)
        gaps = self._trigger_gaps(activity).values()
        merged = _largest_known(gaps) if activity.mode == "all" else _smallest_known(gaps)
        return name_missing_element(merged, activity.id)

    def _trigger_gaps(self, activity: Activity) -> dict[str, TimingValue]:
        """Return the largest gap at each trigger, except where something arrives only once, at the start."""
        gaps = self._gaps_by_activity.get(activity.id)
        if gaps is None:
            arcs = [
                firing_arc
                for firing_arc in self.analysis.system.arcs_into.get(activity.id, ())
                if firing_arc.role == "data" and self.fires_reader(firing_arc)
            ]
            outside_inputs = self.analysis.system.external_inputs.get(activity.id, ())
            repeating_inputs = {
                arc.input for arc in arcs if self.analysis.system.activities[arc.source].behaviour != "once"
            }
            keys = dict.fromkeys((*activity.triggers, *(arc.input for arc in arcs)))
            gaps = self._gaps_by_activity[activity.id] = {
                key: self._arriving_gap(activity, key in outside_inputs, [arc for arc in arcs if arc.input == key])
                for key in keys
                if key in repeating_inputs or key in outside_inputs
            }
        return gaps

    def _arriving_gap(self, activity: Activity, is_outside: bool, arcs: Iterable[Arc]) -> TimingValue:  # noqa: FBT001 - told by its name
        """Return the largest gap at one trigger: the smallest of its sources' gaps."""
        gaps = [self._gap_on_arc(arc) for arc in arcs]
        # Something outside may come at any time, or never: it is no bound, and named only if no arc gives one.
        return _smallest_known(
            [*gaps, TimingValue(None, complete=False, missing=(activity.id,))] if is_outside else gaps
        )

    def _gap_on_arc(self, arc: Arc) -> TimingValue:
        """Return the largest gap of what arrives on an arc: that of the output, and the spread of the link."""
        spread = (
            unknown_value(*self.missing_link_names(arc))
            if arc.worst is None
            else self.duration_value(arc.worst - (arc.best or 0))
        )
        return sum_bounds((self.sent_gap(arc), spread))

    def missing_link_names(self, arc: Arc) -> tuple[str, ...]:
        """Return what is missing where a link's latency is unknown: the link, or whose host is not written."""
        if arc.link is not None:
            return (arc.link,)
        activities = self.analysis.system.activities
        unhosted = tuple(name for name in (arc.source, arc.target) if activities[name].host is None)
        return unhosted or (f"{activities[arc.source].host} - {activities[arc.target].host}",)

    def min_trigger_gap(self, activity: Activity) -> TimingValue:
        """Return the smallest gap between two triggers: known for a single stream only, else 0 (the safe side)."""
        arcs = [arc for arc in self.analysis.system.arcs_into.get(activity.id, ()) if self.fires_reader(arc)]
        if len(arcs) != 1 or arcs[0].worst is None:
            return ZERO_VALUE
        pace = self.analysis.outputs.get((arcs[0].source, arcs[0].output))
        if pace is None or pace.distance.value is None or not is_known_bound(pace.distance, "at least"):
            return ZERO_VALUE
        spread = (arcs[0].worst - (arcs[0].best or 0)) * self.analysis.system.tick
        return TimingValue(max(Fraction(0), pace.distance.value - spread))


def _largest_known(values: Iterable[TimingValue]) -> TimingValue:
    """Return the largest of the gaps, or their causes where one has no bound."""
    value_list = tuple(values)
    if not value_list:
        return ZERO_VALUE
    open_values = tuple(value for value in value_list if not is_known_bound(value))
    if open_values:
        return sum_bounds(tuple(replace(value, value=None) for value in open_values))
    return max(value_list, key=lambda value: value.value or Fraction(0))


def _smallest_known(values: Iterable[TimingValue]) -> TimingValue:
    """Return the smallest of the gaps, unknown where there are none."""
    value_list = tuple(values)
    return smallest_value(value_list) if value_list else UNKNOWN_VALUE


def _subtract_value(value: TimingValue, subtrahend: TimingValue) -> TimingValue:
    """Return a bound less something, where it is complete."""
    if value.value is None or not value.complete:
        return value
    return replace(value, value=value.value - (subtrahend.value or 0))
