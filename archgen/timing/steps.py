"""What each step of a path adds to a latency: waiting to be read, the response, the link; chains are sums of these.

Largest reaction time = largest data age: M. Guenzel et al., "On the Equivalence of Maximum Reaction Time and Maximum
Data Age for Cause-Effect Chains", ECRTS 2023. For periodic chains the sum is A. Davare et al., "Period Optimization for
Hard Real-time Distributed Automotive Systems", DAC 2007: T_i + R_i for each element.
"""

from __future__ import annotations

from dataclasses import field, replace
from fractions import Fraction

from archgen.frozen import dataclass
from archgen.source import Span
from archgen.timing import wording
from archgen.timing.analysis import Analysis
from archgen.timing.arrivals import Arrivals
from archgen.timing.selective import selective
from archgen.timing.sums import UNBOUNDED, bounded, known, nameless
from archgen.timing.system import Activity, Arc
from archgen.timing.value import UNKNOWN, ZERO, Value

_SENT = {
    "data": "{0} publishes {1} for this very input",
    "request": "{0} calls {1} in this very activation",
    "answer": "{0} answers {2} on {1} in this very activation",
}
"""What is assumed of an activity that does not send at each activation, by the arc's role."""


@dataclass(frozen=True, slots=True)
class Delay:
    """A delay in ns, why there is one, and where that is written."""

    value: Value
    why: str
    at: Span


@dataclass(frozen=True, slots=True)
class Steps:
    """The delays of a system's steps. S, H and R are as in docs/timing.md."""

    analysis: Analysis
    arrivals: Arrivals
    _links: dict[tuple[str | None, int], Value] = field(default_factory=dict)

    @classmethod
    def of(cls, analysis: Analysis) -> Steps:
        """Prepare an analysis."""
        return cls(analysis, Arrivals(analysis))

    def start(self, name: str) -> Delay:
        """Return S0: the gap of an activity that samples the world, 0 where its activation is the stimulus."""
        activity = self.analysis.system.activities[name]
        if activity.behaviour == "periodic":
            gap = self.arrivals.gap(name)
            return Delay(gap, f"samples the world{_each(gap)}", _place(activity, "period", "rate"))
        if activity.behaviour in {"event", "on_demand"}:
            # An event that `every` or `throttle` lets wait is a stimulus all the same: it waits for others to come.
            thinned = self.arrivals.thinned(activity)
            return Delay(thinned, f"its event is the stimulus{_thinning(activity)}", activity.at)
        return _strange(activity)

    def sampling(self, arc: Arc) -> Value:
        """Return S of a step: how long a sample may lie until the reader takes it, and until it is sent at all."""
        waited, held = self._reading(arc), self._condition(arc)
        # Compared with `is`: adding up is slow, and nearly all arcs have no condition.
        return waited if held is ZERO else bounded((waited, held))

    def delay(self, arc: Arc) -> Delay:
        """Return S of a step with its reason and its place."""
        reader, value = self.analysis.system.activities[arc.target], self.sampling(arc)
        if arc.role == "request":
            return Delay(value, f"called by {arc.topic}", arc.at)
        if self.arrivals.fires(arc):
            waiting = ", waits for its other triggers" if self.arrivals.others(reader, arc) is not ZERO else ""
            return Delay(value, f"triggered by {arc.topic}{waiting}{_thinning(reader)}", _place(reader, "trigger"))
        if reader.behaviour is None or reader.behaviour == "once":
            return _strange(reader)
        what = "takes the answer of" if arc.role == "answer" else "reads"
        why = f"{what} {arc.topic}{_each(self.arrivals.gap(reader.id))}"
        return Delay(value, why, _place(reader, "period", "rate"))

    def holding(self, arc: Arc) -> Value:
        """Return H of a step: how old a sample may have become, since it was sent, when it is used (again)."""
        reader = self.analysis.system.activities[arc.target]
        gap = self.arrivals.sent_gap(arc)
        if not self.arrivals.fires(arc):
            return gap
        late = self.arrivals.time(reader.jitter) if arc.role == "data" else ZERO
        # All-of uses a sample once, when the set is complete: it is no older than the gap of its output (a newer one
        # would have replaced it), nor than the wait for the others. Calls make it work again with the same set, so that
        # both add up.
        if self.arrivals.waits_for_all(reader):
            options = [value for value in (gap, self.arrivals.others(reader, arc)) if known(value)]
            waited = min(options, key=lambda value: value.value or Fraction(0)) if options else gap
            if any(other.role == "request" for other in self.analysis.system.into.get(reader.id, ())):
                waited = bounded((gap, self.arrivals.others(reader, arc)))  # a call finds what last came together
        else:
            # Any-of: another trigger sends on what this one brought last, which may be a gap old.
            waited = ZERO if self.arrivals.sole(arc) else gap
        return waited if late is ZERO else bounded((waited, late))

    def response(self, name: str, *, worst: bool = True) -> Value:
        """Return R, the largest response time, or the smallest."""
        found = self.analysis.responses.get(name)
        value = (found.worst if worst else found.best) if found else UNKNOWN
        if worst and found and found.tier == "declared":
            value = replace(value, assumptions=(f"the response of {name} is as declared",))
        return nameless(value, name)

    def link(self, arc: Arc, *, worst: bool = True) -> Value:
        """Return a link's largest (or smallest) latency, as it is written; its own queueing is not added."""
        ticks = arc.worst if worst else arc.best
        if ticks is None:
            return Value(None, complete=False, missing=self.arrivals.unlinked(arc))
        if arc.link is None and not ticks:
            return ZERO
        key = (arc.link if worst else None, ticks)
        if key not in self._links:
            self._links[key] = self._linked(arc, ticks, worst=worst)
        return self._links[key]

    def _linked(self, arc: Arc, ticks: int, *, worst: bool) -> Value:
        """Return a latency with what it assumes about the link's queueing."""
        value = self.arrivals.time(ticks)
        if worst and arc.link in self.analysis.system.queued:
            return replace(value, assumptions=(f"link {arc.link} takes no longer than its bandwidth lets it",))
        load = self.analysis.links.get(arc.link or "")
        queueing = load.queueing.value if load and worst else None
        if not queueing:
            return value
        waits = wording.duration(queueing)
        if value.value is not None and queueing > value.value:
            said = f"link {arc.link} keeps its written latency, though {waits} of traffic can wait for it"
        else:
            said = f"queueing on link {arc.link} (up to {waits}) is within its latency"
        return replace(value, assumptions=(said,))

    def _reading(self, arc: Arc) -> Value:
        """Return how long the reader leaves a sample that has arrived."""
        reader = self.analysis.system.activities[arc.target]
        if self.arrivals.fires(arc):
            if arc.role == "request":
                return ZERO
            others, thinned = self.arrivals.others(reader, arc), self.arrivals.thinned(reader)
            return others if thinned is ZERO else bounded((others, thinned))
        if reader.behaviour is None or reader.behaviour == "once":
            return _strange(reader).value
        return self.arrivals.gap(reader.id)

    def _condition(self, arc: Arc) -> Value:
        """Return what an output that is not always published adds: its promised gap, or an assumption."""
        system = self.analysis.system
        if selective(system, arc):
            return Value(Fraction(0), assumptions=(_SENT[arc.role].format(arc.source, arc.topic, arc.target),))
        source = system.activities[arc.source]
        if arc.role != "data" or arc.output not in source.conditional:
            return ZERO
        return self.arrivals.time(source.max_gaps[arc.output])


def _strange(activity: Activity) -> Delay:
    """Return the delay at an activity that nothing later reaches, or whose behaviour is unknown."""
    if activity.behaviour == "once":
        return Delay(UNBOUNDED, "works once, at the start: nothing later reaches it", _place(activity, "behaviour"))
    missing = Value(None, complete=False, missing=(activity.id,))
    return Delay(missing, "its behaviour is not known", activity.at)


def _each(gap: Value) -> str:
    """Return the words for a reader's gap, where it is a bound."""
    return f" every {wording.duration(gap.value)} at the latest" if gap.value is not None and known(gap) else ""


def _thinning(activity: Activity) -> str:
    """Return the words for what lets a trigger wait."""
    said = [f"fires only once for {activity.every} triggers"] if activity.every > 1 else []
    if activity.throttle:
        said.append("keeps a smallest gap")
    if activity.jitter:
        said.append("starts late by its jitter")
    return f"; {', '.join(said)}" if said else ""


def _place(activity: Activity, *keys: str) -> Span:
    """Return where the first of some keys is written, else the activity's place."""
    return next((activity.places[key] for key in keys if key in activity.places), activity.at)
