"""Event models from sources to sinks, and with them the response times, to a fixed point.

Responses make outputs later by R - B, which makes the event models of their readers burstier, which makes responses
longer. Only what depends on itself that way is iterated, from below, so that the first repetition is the least fixed
point (K. Tindell, J. Clark 1994; compositional analysis as in pyCPA).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from fractions import Fraction

from archgen.timing.placement import Resource, resources
from archgen.timing.response import Effort, alone, responses
from archgen.timing.rings import components
from archgen.timing.streams import Stream, Streams, all_of, apart, called, every, late, throttled, together, written
from archgen.timing.system import Activity, Arc, System
from archgen.timing.threads import DIVERGED, Found, Thread
from archgen.timing.triggers import Triggers, states_itself
from archgen.timing.value import Cause, alike, united
from archgen.timing.windows import Budget

_SWEEPS = 300
"""Sweeps over a loop before it is given up as diverged."""
_ONCE = Fraction(1)
_LATER = {"overload": "unbounded"}
"""What a note becomes for those who read the output: what reads from an overload is not overloaded itself."""


@dataclass(slots=True)
class State:
    """What is known so far of each activity: its event model, and its worst response."""

    system: System
    triggers: Triggers
    events: dict[str, Streams | Cause] = field(default_factory=dict)
    responses: dict[str, Found] = field(default_factory=dict)
    diverged: set[str] = field(default_factory=set)
    left: dict[str, Streams | Cause] = field(default_factory=dict)
    """Event models of what leaves each activity; filled on demand by sent_models, once everything else is found."""


def propagate(system: System, triggers: Triggers, budget: Budget | None = None) -> State:
    """Find the event model and the worst response of every activity.

    A caller that propagates several times passes one budget for all runs.
    """
    return _Propagation(State(system, triggers), resources(system), budget or Budget()).run()


class _Propagation:
    """One run. A step is an activity (find its event model) or a resource (find the responses of what it runs)."""

    def __init__(self, state: State, shared: Iterable[Resource], budget: Budget) -> None:
        self.state = state
        self.budget = budget
        self.resources: dict[str, Resource] = {}
        self.runs_on: dict[str, list[str]] = {}
        self.interferes: dict[str, list[str]] = {}
        for number, resource in enumerate(shared):
            # Resources get keys that no activity has: both are steps of one graph.
            key = f"{number} {resource.id}"
            self.resources[key] = resource
            for unit in resource.units:
                for name in unit:
                    self.runs_on.setdefault(name, []).append(key)
            for unit in (*resource.units, *resource.foreign):
                for name in unit:
                    self.interferes.setdefault(name, []).append(key)
        self.seen: dict[str, dict[str, Streams | Cause]] = {}
        self.before: dict[str, list[Thread]] = {}
        self.after = self._after()

    def run(self) -> State:
        """Take the strong components of the dependencies in order, and iterate only those that are loops."""
        for steps in components([*self.state.triggers.order, *self.resources], self.after.__getitem__):
            # The strong components come in the order of dependency: what is outside of loops is found once, in one
            # pass.
            if len(steps) == 1 and steps[0] not in self.after[steps[0]]:
                self._step(steps[0])
            else:
                self._iterate(steps)
        return self.state

    def _after(self) -> dict[str, list[str]]:
        """Return the steps that must be looked at again when a step has changed."""
        system, triggers = self.state.system, self.state.triggers
        after: dict[str, list[str]] = {step: [] for step in (*system.activities, *self.resources)}
        for step, resource in self.resources.items():
            after[step] += (step,) if resource.cores > 1 else ()  # what is carried in depends on responses
        for name in system.activities:
            after[name] += self.interferes.get(name, ())
        for name, activity in system.activities.items():
            if not states_itself(activity) and name not in triggers.unknown:
                for arc in self._arcs(name):
                    after[arc.source].append(name)
                    # What arrives rests on the source's response as well, and that is found by its resource.
                    for step in self.runs_on.get(arc.source, ()):
                        after[step].append(name)
        return after

    def _arcs(self, name: str) -> Iterator[Arc]:
        """Yield the arcs on which an activity's event model rests."""
        triggers = self.state.triggers
        for key, arcs in triggers.inputs[name].items():
            if (name, key) not in triggers.open:
                yield from arcs
        yield from triggers.requests[name]

    def _iterate(self, steps: tuple[str, ...]) -> None:
        """Repeat until nothing changes. Started from the execution times, it approaches the truth from below."""
        self._start(steps)
        waiting = set(steps)
        for _ in range(_SWEEPS):
            for step in steps:
                if step in waiting:
                    waiting.discard(step)
                    if self._step(step):
                        waiting.update(self.after[step])
            waiting.intersection_update(steps)
            if not waiting:
                return
        self._give_up(steps)

    def _start(self, steps: tuple[str, ...]) -> None:
        """Set the least response (the execution time) and no events for all activities of a loop."""
        for name in self._names(steps):
            activity = self.state.system.activities[name]
            # The cause is read only where the value is None, that is, where no execution time is known.
            self.state.responses.setdefault(name, Found(activity.wcet, "unknown", Cause((name,))))
            self.state.events.setdefault(name, ())

    def _names(self, steps: tuple[str, ...]) -> Iterator[str]:
        """Yield the activities whose figures some steps find."""
        for step in steps:
            yield from self.resources[step].members if step in self.resources else (step,)

    def _give_up(self, steps: tuple[str, ...]) -> None:
        """Mark everything in a loop as diverged: the last iterate is below the truth, so it is no bound."""
        state = self.state
        for name in self._names(steps):
            state.responses[name] = state.responses[name]._replace(value=None, cause=DIVERGED)
            state.diverged.add(name)
        for step in steps:
            if step in state.system.activities and not states_itself(state.system.activities[step]):
                state.events[step] = DIVERGED

    def _step(self, step: str) -> bool:
        """Find the figures of one step anew, and return whether they changed."""
        state = self.state
        if step in self.resources:
            found = responses(
                state.system,
                self.resources[step],
                state.events,
                state.responses,
                Effort(self.budget, self._stale(step), self.before.setdefault(step, [])),
            )
            changed = any(_differs(state.responses.get(name), response) for name, response in found.items())
            state.responses.update(found)
            return changed
        events = activation(state, step)
        if step in state.responses and _is_known(state.events.get(step), events):
            return False
        state.events[step] = events
        # On no resource: a core of its own, so that its response rests on nothing but its own events.
        if step not in self.runs_on:
            state.responses[step] = alone(state.system, step, state.events, self.budget)
        return True

    def _stale(self, step: str) -> frozenset[str] | None:
        """Return what has another event model than when a resource was last looked at; None the first time."""
        resource, events = self.resources[step], self.state.events
        now = {name: events[name] for unit in (*resource.units, *resource.foreign) for name in unit}
        before = self.seen.get(step)
        # Compared by identity below: `_update_step` stores an event model only where it differs from the old one.
        self.seen[step] = now
        return None if before is None else frozenset(name for name in now if now[name] is not before[name])


def _differs(old: Found | None, new: Found) -> bool:
    """Whether a response changed. Causes are compared without regard to order (see `is_same_cause`)."""
    if old is None or old.value != new.value or old.tier != new.tier:
        return True
    return old.cause is not new.cause and not alike(old.cause, new.cause)


def _is_known(old: Streams | Cause | None, new: Streams | Cause) -> bool:
    """Whether an event model is the same as before."""
    return alike(old, new) if isinstance(old, Cause) and isinstance(new, Cause) else old == new


def activation(state: State, name: str) -> Streams | Cause:
    """Return the event model of an activity's activations, from what fires it."""
    activity = state.system.activities[name]
    own = written(activity)
    if own is not None:
        return own
    if name in state.triggers.never:
        return ()
    if name in state.triggers.unknown:
        return Cause((name,), ("a ring of triggers",))
    if activity.behaviour == "event":
        return _event(state, activity)
    if activity.behaviour == "on_demand" and state.triggers.requests[name]:
        return _any(requests(state, name))
    return Cause((name,))


def _event(state: State, activity: Activity) -> Streams | Cause:
    """Return the event model of an event-driven activity: what its inputs fire, and the calls that it serves."""
    inputs = state.triggers.inputs[activity.id]
    asked = tuple(requests(state, activity.id))
    if not inputs and not asked:
        return Cause((activity.id,))
    data = _fired(state, activity, inputs) if inputs else ()
    if isinstance(data, Cause):
        return data
    # Calls are not thinned: `every`, `throttle` and `jitter` are about triggers.
    fired = late(throttled(every(data, activity.every), activity.throttle), activity.jitter) if data else ()
    return _any((fired, *asked))


def _fired(state: State, activity: Activity, inputs: Mapping[str, tuple[Arc, ...]]) -> Streams | Cause:
    """Return the event model of what triggers fire, before `every`, `throttle` and `jitter`."""
    if activity.mode == "any":
        return _any(arrival(state, activity, key, arcs) for key, arcs in inputs.items())
    needed = [key for key, arcs in inputs.items() if not is_kept(state.system, arcs)]
    if not needed:
        fed = renewed(state.system, inputs)
        return _any(arrival(state, activity, key, arcs) for key, arcs in fed.items()) if fed else ()
    found = [
        # An input that closes a ring: how often it comes rests on this activity itself. The others bound the rate.
        Cause((activity.id,))
        if (activity.id, key) in state.triggers.open
        else arrival(state, activity, key, inputs[key])
        for key in needed
    ]
    known = [streams for streams in found if not isinstance(streams, Cause)]
    # One input on which nothing ever comes is enough for all-of never to fire.
    if any(not streams for streams in known):
        return ()
    if not known:
        return united(cause for cause in found if isinstance(cause, Cause))
    return all_of(known, complete=len(known) == len(found))


def is_kept(system: System, arcs: Iterable[Arc]) -> bool:
    """Whether something sent once stands on an input, so that it is always there."""
    return any(system.activities[arc.source].behaviour == "once" for arc in arcs)


def renewed(system: System, inputs: Mapping[str, tuple[Arc, ...]]) -> dict[str, tuple[Arc, ...]]:
    """Return the inputs that something feeds beside what is sent once: where everything is always there, they fire."""
    return {
        key: arcs
        for key, arcs in inputs.items()
        if any(system.activities[arc.source].behaviour != "once" for arc in arcs)
    }


def arrival(state: State, activity: Activity, key: str, arcs: tuple[Arc, ...]) -> Streams | Cause:
    """Return the event model of what arrives at one input."""
    if not arcs or key in state.system.external.get(activity.id, ()):
        return Cause((key,))
    return _any(arriving(state, arc, state.events[arc.source]) for arc in arcs)


def requests(state: State, name: str) -> Iterator[Streams | Cause]:
    """Yield the event models of the calls that arrive: they may come at any time while their caller runs."""
    for arc in state.triggers.requests[name]:
        events = state.events[arc.source]
        caller = state.system.activities[arc.source]
        if not isinstance(events, Cause):
            yield arriving(state, arc, called(events, caller.calls.get(arc.output, _ONCE)), from_start=True)
        else:
            yield events


def arriving(state: State, arc: Arc, events: Streams | Cause, *, from_start: bool = False) -> Streams | Cause:
    """Return the event model behind a source's response and a link.

    With `from_start` the event may leave as soon as the source starts, not only after its best case.
    """
    if isinstance(events, Cause) or not events:
        return events
    source, response = state.system.activities[arc.source], state.responses[arc.source]
    if response.value is None:
        return _unanswered(response.cause)
    if arc.worst is None:
        return Cause((arc.link,)) if arc.link else Cause((arc.source, arc.target), ("no link joins their hosts",))
    return late(_done(source, response.value, events, from_start=from_start), arc.worst - (arc.best or 0))


def leaving(state: State, arc: Arc, events: Streams | Cause, *, from_start: bool = False) -> Streams | Cause:
    """Return the event model behind a source's response, before any link."""
    if isinstance(events, Cause) or not events:
        return events
    source, response = state.system.activities[arc.source], state.responses[arc.source]
    if response.value is None:
        return _unanswered(response.cause)
    return _done(source, response.value, events, from_start=from_start)


def _done(source: Activity, response: int, events: Streams, *, from_start: bool) -> Streams:
    """Return the event model of completions: up to R - B later than activations, and at least B apart."""
    best = 0 if from_start else source.bcet or 0
    done = late(events, max(response - best, 0))
    # A declared response may rest on several executions at once: its completions are not known to be B apart.
    return apart(done, best) if source.response is None else done


def _unanswered(cause: Cause) -> Cause:
    """Return the cause as those see it who read the output."""
    return Cause(cause.missing, tuple(_LATER.get(note, note) for note in cause.notes))


def _any(inputs: Iterable[Streams | Cause]) -> Streams | Cause:
    """Merge event models: any of them fires. One unknown makes all unknown."""
    causes: list[Cause] = []
    found: list[Stream] = []
    for one in inputs:
        if isinstance(one, Cause):
            causes.append(one)
        else:
            found += one
    return united(causes) if causes else together(found)
