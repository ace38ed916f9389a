"""Event models from sources to sinks, and with them the response times, to a fixed point.

Responses make outputs later by R - B, which makes the event models of those who read them burstier, which makes responses
longer. Only what depends on itself that way is iterated, from below, so that the first repetition is the least fixed point.
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
_ONCE = Fraction(1)
_LATER = {"overload": "unbounded"}
"""What an overload is to those who read what comes out of it."""


@dataclass(slots=True)
class State:
    """What is known so far of each activity: its event model, and its worst response."""

    system: System
    triggers: Triggers
    events: dict[str, Streams | Cause] = field(default_factory=dict)
    responses: dict[str, Found] = field(default_factory=dict)
    diverged: set[str] = field(default_factory=set)
    left: dict[str, Streams | Cause] = field(default_factory=dict)
    """What leaves each activity, as far as anybody asked once all was found."""


def propagate(system: System, triggers: Triggers, budget: Budget | None = None) -> State:
    """Find the event model and the worst response of every activity. Who looks several times gives one budget for all."""
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
        for steps in components([*self.state.triggers.order, *self.resources], self.after.__getitem__):
            if len(steps) == 1 and steps[0] not in self.after[steps[0]]:
                self._step(steps[0])
            else:
                self._iterate(steps)
        return self.state

    def _after(self) -> dict[str, list[str]]:
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
                    for step in self.runs_on.get(arc.source, ()):
                        after[step].append(name)
        return after

    def _arcs(self, name: str) -> Iterator[Arc]:
        triggers = self.state.triggers
        for key, arcs in triggers.inputs[name].items():
            if (name, key) not in triggers.open:
                yield from arcs
        yield from triggers.requests[name]

    def _iterate(self, steps: tuple[str, ...]) -> None:
        """Repeat until nothing changes. Started from the execution times alone, all that is found stays below the truth."""
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
        for name in self._names(steps):
            activity = self.state.system.activities[name]
            self.state.responses.setdefault(name, Found(activity.wcet, "unknown", Cause((name,))))
            self.state.events.setdefault(name, ())

    def _names(self, steps: tuple[str, ...]) -> Iterator[str]:
        for step in steps:
            yield from self.resources[step].members if step in self.resources else (step,)

    def _give_up(self, steps: tuple[str, ...]) -> None:
        """Past the cap nothing is said at all: the last round is no bound."""
        state = self.state
        for name in self._names(steps):
            state.responses[name] = state.responses[name]._replace(value=None, cause=DIVERGED)
            state.diverged.add(name)
        for step in steps:
            if step in state.system.activities and not states_itself(state.system.activities[step]):
                state.events[step] = DIVERGED

    def _step(self, step: str) -> bool:
        """Find one step's figures anew, and tell whether they changed."""
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
        if step not in self.runs_on:
            state.responses[step] = alone(state.system, step, state.events, self.budget)
        return True

    def _stale(self, step: str) -> frozenset[str] | None:
        """Name what has another event model than when a resource was looked at last; None the first time."""
        resource, events = self.resources[step], self.state.events
        now = {name: events[name] for unit in (*resource.units, *resource.foreign) for name in unit}
        before = self.seen.get(step)
        self.seen[step] = now
        return None if before is None else frozenset(name for name in now if now[name] is not before[name])


def _differs(old: Found | None, new: Found) -> bool:
    if old is None or old.value != new.value or old.tier != new.tier:
        return True
    return old.cause is not new.cause and not alike(old.cause, new.cause)


def _is_known(old: Streams | Cause | None, new: Streams | Cause) -> bool:
    return alike(old, new) if isinstance(old, Cause) and isinstance(new, Cause) else old == new


def activation(state: State, name: str) -> Streams | Cause:
    """Give the event model of an activity's activations, from what fires it."""
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
    inputs = state.triggers.inputs[activity.id]
    asked = tuple(requests(state, activity.id))
    if not inputs and not asked:
        return Cause((activity.id,))
    data = _fired(state, activity, inputs) if inputs else ()
    if isinstance(data, Cause):
        return data
    fired = late(throttled(every(data, activity.every), activity.throttle), activity.jitter) if data else ()
    return _any((fired, *asked))


def _fired(state: State, activity: Activity, inputs: Mapping[str, tuple[Arc, ...]]) -> Streams | Cause:
    if activity.mode == "any":
        return _any(arrival(state, activity, key, arcs) for key, arcs in inputs.items())
    needed = [key for key, arcs in inputs.items() if not is_kept(state.system, arcs)]
    if not needed:
        fed = renewed(state.system, inputs)
        return _any(arrival(state, activity, key, arcs) for key, arcs in fed.items()) if fed else ()
    found = [
        Cause((activity.id,))
        if (activity.id, key) in state.triggers.open
        else arrival(state, activity, key, inputs[key])
        for key in needed
    ]
    known = [streams for streams in found if not isinstance(streams, Cause)]
    if any(not streams for streams in known):
        return ()
    if not known:
        return united(cause for cause in found if isinstance(cause, Cause))
    return all_of(known, complete=len(known) == len(found))


def is_kept(system: System, arcs: Iterable[Arc]) -> bool:
    """Say whether something sent once stands on an input: it is always there."""
    return any(system.activities[arc.source].behaviour == "once" for arc in arcs)


def renewed(system: System, inputs: Mapping[str, tuple[Arc, ...]]) -> dict[str, tuple[Arc, ...]]:
    """Give the inputs that something else feeds beside what is sent once: where everything is always there, they fire."""
    return {
        key: arcs
        for key, arcs in inputs.items()
        if any(system.activities[arc.source].behaviour != "once" for arc in arcs)
    }


def arrival(state: State, activity: Activity, key: str, arcs: tuple[Arc, ...]) -> Streams | Cause:
    """Give the event model of what arrives at one input."""
    if not arcs or key in state.system.external.get(activity.id, ()):
        return Cause((key,))
    return _any(arriving(state, arc, state.events[arc.source]) for arc in arcs)


def requests(state: State, name: str) -> Iterator[Streams | Cause]:
    """Give the event models of the calls that arrive: they come at any time while their caller runs."""
    for arc in state.triggers.requests[name]:
        events = state.events[arc.source]
        caller = state.system.activities[arc.source]
        if not isinstance(events, Cause):
            yield arriving(state, arc, called(events, caller.calls.get(arc.output, _ONCE)), from_start=True)
        else:
            yield events


def arriving(state: State, arc: Arc, events: Streams | Cause, *, from_start: bool = False) -> Streams | Cause:
    """Give what is left of an event model behind its source's response and a link."""
    if isinstance(events, Cause) or not events:
        return events
    source, response = state.system.activities[arc.source], state.responses[arc.source]
    if response.value is None:
        return _unanswered(response.cause)
    if arc.worst is None:
        return Cause((arc.link,)) if arc.link else Cause((arc.source, arc.target), ("no link joins their hosts",))
    return late(_done(source, response.value, events, from_start=from_start), arc.worst - (arc.best or 0))


def leaving(state: State, arc: Arc, events: Streams | Cause, *, from_start: bool = False) -> Streams | Cause:
    """Give what is left of an event model behind its source's response, before any link."""
    if isinstance(events, Cause) or not events:
        return events
    source, response = state.system.activities[arc.source], state.responses[arc.source]
    if response.value is None:
        return _unanswered(response.cause)
    return _done(source, response.value, events, from_start=from_start)


def _done(source: Activity, response: int, events: Streams, *, from_start: bool) -> Streams:
    best = 0 if from_start else source.bcet or 0
    done = late(events, max(response - best, 0))
    # What is only declared may rest on several cores at once.
    return apart(done, best) if source.response is None else done


def _unanswered(cause: Cause) -> Cause:
    return Cause(cause.missing, tuple(_LATER.get(note, note) for note in cause.notes))


def _any(inputs: Iterable[Streams | Cause]) -> Streams | Cause:
    causes: list[Cause] = []
    found: list[Stream] = []
    for one in inputs:
        if isinstance(one, Cause):
            causes.append(one)
        else:
            found += one
    return united(causes) if causes else together(found)
