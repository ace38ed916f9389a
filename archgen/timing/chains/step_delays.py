"""What each step of a path adds to a latency: waiting to be read, the response, the link; chains are sums of these.

Largest reaction time = largest data age: M. Guenzel et al., "On the Equivalence of Maximum Reaction Time and Maximum
Data Age for Cause-Effect Chains", ECRTS 2023. For periodic chains the sum is A. Davare et al., "Period Optimization for
Hard Real-time Distributed Automotive Systems", DAC 2007: T_i + R_i for each element.
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction

from archgen.diagnostics.source_span import Span
from archgen.frozen import dataclass, field, replace
from archgen.timing.analysis import Analysis, RunResponse
from archgen.timing.chains.trigger_arrivals import TriggerArrivals
from archgen.timing.figures import figure_wording
from archgen.timing.figures.timing_values import (
    NO_USE_NOTE,
    SATURATED_NOTE,
    UNBOUNDED_VALUE,
    UNKNOWN_VALUE,
    ZERO_VALUE,
    TimingValue,
    is_boundless,
    is_known_bound,
    name_missing_element,
    sum_bounds,
)
from archgen.timing.system.thread_pools import is_reentrant
from archgen.timing.system.timing_system import Activity, Arc, is_sampled, is_selective_arc

_SELECTIVE_ASSUMPTIONS = {
    "data": "{0} publishes {1} for this very input",
    "request": "{0} calls {1} in this very activation",
    "answer": "{0} answers {2} on {1} in this very activation",
}
"""What is assumed of an activity that does not send at each activation, by the arc's role."""


@dataclass(frozen=True, slots=True)
class StepDelay:
    """A delay in ns, why there is one, and where that is written."""

    value: TimingValue
    why: str
    at: Span


@dataclass(frozen=True, slots=True)
class StepDelays:
    """The delays of a system's steps. S, H and R are as in docs/timing.md."""

    analysis: Analysis
    arrivals: TriggerArrivals
    _latencies: dict[tuple[str | None, int], TimingValue] = field(default_factory=dict)
    _sampling_waits: dict[int, TimingValue] = field(default_factory=dict)
    """By the identity of an arc, which the system keeps: each view of the costs asks for the same ones."""

    @classmethod
    def of_analysis(cls, analysis: Analysis) -> StepDelays:
        """Prepare an analysis."""
        return cls(analysis, TriggerArrivals(analysis))

    def start_delay(self, name: str) -> StepDelay:
        """Return S0: the gap of an activity that samples the world, 0 where its activation is the stimulus."""
        activity = self.analysis.system.activities[name]
        if activity.behaviour == "periodic":
            gap = self.arrivals.activation_gap(name)
            return StepDelay(gap, f"samples the world{_write_gap(gap)}", _span_of_keys(activity, "period", "rate"))
        if activity.behaviour in {"event", "on_demand"}:
            # An event that `every` or `throttle` lets wait is a stimulus all the same: it waits for others to come.
            thinning_wait = self.arrivals.thinning_wait(activity)
            return StepDelay(thinning_wait, f"its event is the stimulus{_write_thinning(activity)}", activity.at)
        return _undefined_delay(activity)

    def sampling_wait(self, arc: Arc) -> TimingValue:
        """Return S of a step: how long a sample may lie until the reader takes it, and until it is sent at all."""
        key = id(arc)
        if key not in self._sampling_waits:
            self._sampling_waits[key] = self._find_sampling_wait(arc)
        return self._sampling_waits[key]

    def _find_sampling_wait(self, arc: Arc) -> TimingValue:
        reading_wait, condition_wait = self._reading_wait(arc), self._condition_wait(arc)
        overtaking_wait = self.overtaking_wait(arc)
        if overtaking_wait is not ZERO_VALUE:
            return sum_bounds((reading_wait, condition_wait, overtaking_wait))
        # Compared with `is`: adding up is slow, and nearly all arcs have no condition.
        return reading_wait if condition_wait is ZERO_VALUE else sum_bounds((reading_wait, condition_wait))

    def sampling_delay(self, arc: Arc) -> StepDelay:
        """Return S of a step with its reason and its place."""
        reader, value = self.analysis.system.activities[arc.target], self.sampling_wait(arc)
        if arc.role == "request":
            return StepDelay(value, f"called by {arc.topic}", arc.at)
        if self.arrivals.fires_reader(arc):
            waiting_text = (
                ", waits for messages of the same time"
                if reader.mode == "match"
                else ", waits for its other triggers"
                if self.arrivals.other_triggers_gap(reader, arc) is not ZERO_VALUE
                else ""
            )
            return StepDelay(
                value,
                f"triggered by {arc.topic}{waiting_text}{_write_thinning(reader)}{_write_overtaking(self.overtaking_wait(arc))}",
                _span_of_keys(reader, "trigger"),
            )
        if reader.behaviour is None or reader.behaviour == "once":
            return _undefined_delay(reader)
        verb_text = "takes the answer of" if arc.role == "answer" else "reads"
        gap_text = _write_gap(self.arrivals.activation_gap(reader.id))
        storing_text = _write_storing(self.storing_wait(arc))
        why = f"{verb_text} {arc.topic}{gap_text}{storing_text}{_write_overtaking(self.overtaking_wait(arc))}"
        return StepDelay(value, why, _span_of_keys(reader, "period", "rate"))

    def holding_age(self, arc: Arc) -> TimingValue:
        """Return H of a step: how old a sample may have become, since it was sent, when it is used (again)."""
        reader = self.analysis.system.activities[arc.target]
        gap = self.arrivals.sent_gap(arc)
        if not self.arrivals.fires_reader(arc):
            storing_wait = self.storing_wait(arc)
            return gap if storing_wait is ZERO_VALUE else sum_bounds((gap, storing_wait))
        jitter_wait = self.arrivals.duration_value(reader.jitter) if arc.role == "data" else ZERO_VALUE
        # All-of uses a sample once, when the set is complete: it is no older than the gap of its output (a newer one
        # would have replaced it), nor than the wait for the others. Calls make it work again with the same set, so that
        # both add up.
        if reader.mode == "match" and arc.role == "data":
            sample_age = self._matched_age(reader, arc)
        elif self.arrivals.waits_for_all(reader):
            # Where another source of the input completes the set, what this one sent last is used again.
            gaps = (gap,) if self.arrivals.shares_input(arc) else (gap, self.arrivals.other_triggers_gap(reader, arc))
            known_gaps = [value for value in gaps if is_known_bound(value)]
            sample_age = min(known_gaps, key=lambda value: value.value or Fraction(0)) if known_gaps else gap
            if any(other_arc.role == "request" for other_arc in self.analysis.system.arcs_into.get(reader.id, ())):
                sample_age = sum_bounds(
                    (gap, self.arrivals.other_triggers_gap(reader, arc))
                )  # a call finds what last came together
        else:
            # Any-of: another trigger sends on what this one brought last, which may be a gap old.
            sample_age = ZERO_VALUE if self.arrivals.is_sole_trigger(arc) else self._kept_age(reader, arc, gap)
        return sample_age if jitter_wait is ZERO_VALUE else sum_bounds((sample_age, jitter_wait))

    def _matched_age(self, reader: Activity, arc: Arc) -> TimingValue:
        """Return how old a matched sample may be, since it was sent; calls make its reader work with it again."""
        sample_age = self.arrivals.match_age(reader, arc)
        if any(other_arc.role == "request" for other_arc in self.analysis.system.arcs_into.get(reader.id, ())):
            return sum_bounds((sample_age, self.arrivals.activation_gap(reader.id)))
        return sample_age

    def _kept_age(self, reader: Activity, arc: Arc, gap: TimingValue) -> TimingValue:
        """Return how old the last sample of a trigger may be when another one fires: what is forgotten does not replace it."""
        if self.arrivals.lacks_sure_use(reader, arc):
            return _unsure_use(reader)
        return self.arrivals.activation_gap(reader.id) if self.arrivals.forgets_dropped(reader) else gap

    def response_value(self, name: str, *, worst: bool = True) -> TimingValue:
        """Return R, the largest response time, or the smallest."""
        response_time = self.analysis.responses.get(name)
        value = (response_time.worst if worst else response_time.best) if response_time else UNKNOWN_VALUE
        if worst and response_time and response_time.tier == "declared":
            value = replace(value, assumptions=(f"the response of {name} is as declared",))
        return name_missing_element(value, name)

    def run_response(self, name: str, runs: Mapping[str, RunResponse]) -> TimingValue:
        """Return how long a run takes at most, from the event on that it begins with; else the activity's own response."""
        run = runs.get(name)
        return run.worst if run else self.response_value(name)

    def added_response(self, arc: Arc, runs: Mapping[str, RunResponse]) -> TimingValue:
        """Return what a step adds to a run that comes over an arc; where the run begins here, how long it takes.

        Along a run the sum of what its steps add is never below what the run takes up to there.
        """
        if not self.continues_run(arc, runs):
            return self.run_response(arc.target, runs)
        before, after = self.run_response(arc.source, runs), self.run_response(arc.target, runs)
        if before.value is None or after.value is None:
            return after
        counted = before.value + (arc.worst or 0) * self.analysis.system.tick
        return replace(after, value=max(after.value - counted, Fraction(0)))

    def continues_run(self, arc: Arc, runs: Mapping[str, RunResponse]) -> bool:
        """Whether an arc's reader starts at the end of its source, or behind a link, for this very message."""
        run = runs.get(arc.target)
        if run is None or not any(run_arc is arc for run_arc in run.arcs):
            return False
        return arc.output not in self.analysis.system.activities[arc.source].max_gaps

    def link_latency(self, arc: Arc, *, worst: bool = True) -> TimingValue:
        """Return a link's largest (or smallest) latency, as it is written; its own queueing is not added.

        Where more is sent than the link carries, nothing that is written can be kept.
        """
        load = self.analysis.links.get(arc.link or "")
        if worst and load is not None and is_boundless(load.queueing):
            return replace(UNBOUNDED_VALUE, assumptions=("unbounded", f"{SATURATED_NOTE}: {arc.link}"))
        ticks = arc.worst if worst else arc.best
        if ticks is None:
            return TimingValue(None, complete=False, missing=self.arrivals.missing_link_names(arc))
        key = (arc.link if worst else None, ticks)
        if key not in self._latencies:
            self._latencies[key] = self._latency_with_notes(arc, ticks, worst=worst)
        return self._latencies[key]

    def _latency_with_notes(self, arc: Arc, ticks: int, *, worst: bool) -> TimingValue:
        """Return a latency with what it assumes about the link's queueing."""
        value = self.arrivals.duration_value(ticks)
        if worst and arc.link in self.analysis.system.queued_links:
            return replace(value, assumptions=(f"link {arc.link} takes no longer than its bandwidth lets it",))
        load = self.analysis.links.get(arc.link or "")
        queueing = load.queueing.value if load and worst else None
        if queueing is None and load and load.longest_sending and worst:  # of some messages the size is unknown
            queueing, _ = load.longest_sending
        if not queueing:
            return value
        queueing_text = figure_wording.format_duration(queueing)
        if value.value is not None and queueing > value.value:
            assumption = f"link {arc.link} keeps its written latency, though {queueing_text} of traffic can wait for it"
        else:
            assumption = f"queueing on link {arc.link} (up to {queueing_text}) is within its latency"
        return replace(value, assumptions=(assumption,))

    def _reading_wait(self, arc: Arc) -> TimingValue:
        """Return how long the reader leaves a sample that has arrived."""
        reader = self.analysis.system.activities[arc.target]
        lost_use = self.arrivals.find_lost_use(arc)
        if lost_use is not None:
            return lost_use
        if self.arrivals.fires_reader(arc):
            if arc.role == "request":
                return ZERO_VALUE
            if self.arrivals.lacks_sure_use(reader, arc):
                return _unsure_use(reader)
            thinning_wait = self.arrivals.thinning_wait(reader)
            others_gap = (
                self.arrivals.match_wait(reader, arc)
                if reader.mode == "match"
                else self.arrivals.other_triggers_gap(reader, arc)
            )
            return others_gap if thinning_wait is ZERO_VALUE else sum_bounds((others_gap, thinning_wait))
        # Of what works once, or nobody knows when, the gap is unbounded or unknown as well.
        gap, storing_wait = self.arrivals.activation_gap(reader.id), self.storing_wait(arc)
        return gap if storing_wait is ZERO_VALUE else sum_bounds((gap, storing_wait))

    def storing_wait(self, arc: Arc) -> TimingValue:
        """Return how long a message that has arrived may wait to be stored while its reader is activated.

        `ZERO_VALUE` (the very object: callers compare with `is`) where it is there at once.
        """
        if not is_sampled(self.analysis.system.activities[arc.target], arc):
            return ZERO_VALUE
        return self.analysis.storing_waits.get(arc.target, ZERO_VALUE)

    def overtaking_wait(self, arc: Arc) -> TimingValue:
        """Return for how long a newer message may be replaced by an older one that it has overtaken.

        That is so where activations of a reentrant source run at once, and a message waits to be read. All that began before
        one has ended R after its activation; what begins then, at most a gap later, is the last to come, and comes at most R
        later. `ZERO_VALUE` (the very object) where messages come in the order of their activations.
        """
        system = self.analysis.system
        source, reader = system.activities[arc.source], system.activities[arc.target]
        if arc.role != "data":
            return ZERO_VALUE
        is_read_at_once = self.arrivals.fires_reader(arc) and reader.mode == "any"
        if is_read_at_once and reader.every == 1 and not reader.throttle:
            return ZERO_VALUE
        return self.replacing_wait(source)

    def replacing_wait(self, source: Activity) -> TimingValue:
        """Return for how long what an activity sends may be replaced by what it began earlier, and ended later.

        `ZERO_VALUE` (the very object) where its outputs come in the order of their activations.
        """
        system = self.analysis.system
        if not is_reentrant(system, source):
            return ZERO_VALUE
        response, gap = self.response_value(source.id), self.arrivals.activation_gap(source.id)
        if source.period and response.value is not None and response.complete:
            spread = response.value - (source.bcet or 0) * system.tick
            if spread <= (source.period - source.jitter) * system.tick:
                return ZERO_VALUE
        return sum_bounds((response, gap))

    def _condition_wait(self, arc: Arc) -> TimingValue:
        """Return what an output that is not always published adds: its promised gap, or an assumption."""
        system = self.analysis.system
        if is_selective_arc(system, arc):
            return TimingValue(
                Fraction(0), assumptions=(_SELECTIVE_ASSUMPTIONS[arc.role].format(arc.source, arc.topic, arc.target),)
            )
        source = system.activities[arc.source]
        if arc.role != "data" or arc.output not in source.conditional:
            return ZERO_VALUE
        return self.arrivals.duration_value(source.max_gaps[arc.output])


def _undefined_delay(activity: Activity) -> StepDelay:
    """Return the delay at an activity that nothing later reaches, or whose behaviour is unknown."""
    if activity.behaviour == "once":
        return StepDelay(
            UNBOUNDED_VALUE, "works once, at the start: nothing later reaches it", _span_of_keys(activity, "behaviour")
        )
    unknown_delay = TimingValue(None, complete=False, missing=(activity.id,))
    return StepDelay(unknown_delay, "its behaviour is not known", activity.at)


def _unsure_use(reader: Activity) -> TimingValue:
    """Return the wait for a use that nothing promises: each message may be among those that are dropped and forgotten."""
    text = f"{NO_USE_NOTE}: {reader.id} forgets what it drops (`dropped: forgotten`), and any of its triggers may be dropped"
    return TimingValue(None, assumptions=("diverged", text))


def _span_of_keys(activity: Activity, *keys: str) -> Span:
    """Return where the first of some keys is written, else the activity's place."""
    return next((activity.places[key] for key in keys if key in activity.places), activity.at)


def _write_gap(gap: TimingValue) -> str:
    """Return the words for a reader's gap, where it is a bound."""
    return (
        f" every {figure_wording.format_duration(gap.value)} at the latest"
        if gap.value is not None and is_known_bound(gap)
        else ""
    )


def _write_overtaking(wait: TimingValue) -> str:
    """Return the words for the time for which an older message may stand in a newer one's place."""
    if not wait.value or not is_known_bound(wait):
        return ""
    return f", which an older one may replace for {figure_wording.format_duration(wait.value)}"


def _write_storing(wait: TimingValue) -> str:
    """Return the words for the time that a message may wait to be stored."""
    if wait.value is None or not wait.value:
        return ""
    return f", which may wait {figure_wording.format_duration(wait.value)} to be stored"


def _write_thinning(activity: Activity) -> str:
    """Return the words for what lets a trigger wait."""
    phrases = [f"fires only once for {activity.every} triggers"] if activity.every > 1 else []
    if activity.throttle:
        phrases.append("keeps a smallest gap")
    if activity.jitter:
        phrases.append("starts late by its jitter")
    return f"; {', '.join(phrases)}" if phrases else ""
