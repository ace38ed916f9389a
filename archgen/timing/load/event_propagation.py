"""Event models from sources to sinks, and with them the response times, to a fixed point.

Responses make outputs later by R - B, which makes the event models of their readers burstier, which makes responses
longer. Only what depends on itself that way is iterated, from below, so that the first repetition is the least fixed
point (K. Tindell, J. Clark 1994; compositional analysis as in pyCPA).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from fractions import Fraction

from archgen.timing.figures.timing_values import UnknownCause, is_same_cause, unite_causes
from archgen.timing.load.busy_windows import SearchBudget
from archgen.timing.load.event_streams import (
    EventStream,
    EventStreams,
    combine_all_of,
    delay_streams,
    keep_events_apart,
    merge_streams,
    streams_of_calls,
    take_every_nth,
    throttle_streams,
    written_streams,
)
from archgen.timing.load.response_times import AnalysisEffort, find_dedicated_response, find_responses
from archgen.timing.load.thread_work import DIVERGED_CAUSE, ThreadWork, WorstResponse
from archgen.timing.system.core_placement import ProcessingResource, find_resources
from archgen.timing.system.strong_components import find_strong_components
from archgen.timing.system.timing_system import Activity, Arc, TimingSystem
from archgen.timing.system.trigger_graph import TriggerGraph, has_own_rate

_MAX_SWEEPS = 300
"""Sweeps over a loop before it is given up as diverged."""
_ONE_CALL = Fraction(1)
_DOWNSTREAM_WORDS = {"overload": "unbounded"}
"""What a note becomes for those who read the output: what reads from an overload is not overloaded itself."""


@dataclass(slots=True)
class PropagationState:
    """What is known so far of each activity: its event model, and its worst response."""

    system: TimingSystem
    triggers: TriggerGraph
    event_models: dict[str, EventStreams | UnknownCause] = field(default_factory=dict)
    responses: dict[str, WorstResponse] = field(default_factory=dict)
    diverged: set[str] = field(default_factory=set)
    leaving_models: dict[str, EventStreams | UnknownCause] = field(default_factory=dict)
    """Event models of what leaves each activity; filled on demand by sent_models, once everything else is found."""


def propagate_events(
    system: TimingSystem, triggers: TriggerGraph, budget: SearchBudget | None = None
) -> PropagationState:
    """Find the event model and the worst response of every activity.

    A caller that propagates several times passes one budget for all runs.
    """
    return _Propagation(
        PropagationState(system, triggers), find_resources(system), budget or SearchBudget()
    ).run_to_fixed_point()


class _Propagation:
    """One run. A step is an activity (find its event model) or a resource (find the responses of what it runs)."""

    def __init__(
        self, state: PropagationState, resource_list: Iterable[ProcessingResource], budget: SearchBudget
    ) -> None:
        self.state = state
        self.budget = budget
        self.resources: dict[str, ProcessingResource] = {}
        self.resources_of: dict[str, list[str]] = {}
        self.disturbed_resources: dict[str, list[str]] = {}
        for index, resource in enumerate(resource_list):
            # Resources get keys that no activity has: both are steps of one graph.
            key = f"{index} {resource.id}"
            self.resources[key] = resource
            for unit in resource.units:
                for name in unit:
                    self.resources_of.setdefault(name, []).append(key)
            for unit in (*resource.units, *resource.foreign_units):
                for name in unit:
                    self.disturbed_resources.setdefault(name, []).append(key)
        self.seen_models: dict[str, dict[str, EventStreams | UnknownCause]] = {}
        self.previous_threads: dict[str, tuple[ThreadWork, ...]] = {}
        self.successors = self._find_successors()

    def run_to_fixed_point(self) -> PropagationState:
        """Take the strong components of the dependencies in order, and iterate only those that are loops."""
        for steps in find_strong_components([*self.state.triggers.order, *self.resources], self.successors.__getitem__):
            # The strong components come in the order of dependency: what is outside of loops is found once, in one
            # pass.
            if len(steps) == 1 and steps[0] not in self.successors[steps[0]]:
                self._update_step(steps[0])
            else:
                self._iterate_steps(steps)
        return self.state

    def _find_successors(self) -> dict[str, list[str]]:
        """Return the steps that must be looked at again when a step has changed."""
        system, triggers = self.state.system, self.state.triggers
        successors: dict[str, list[str]] = {step: [] for step in (*system.activities, *self.resources)}
        for step, resource in self.resources.items():
            successors[step] += (step,) if resource.cores > 1 else ()  # what is carried in depends on responses
        for name in system.activities:
            successors[name] += self.disturbed_resources.get(name, ())
        for name, activity in system.activities.items():
            if not has_own_rate(activity) and name not in triggers.unknown_rates:
                for arc in self._trigger_arcs(name):
                    successors[arc.source].append(name)
                    # What arrives rests on the source's response as well, and that is found by its resource.
                    for step in self.resources_of.get(arc.source, ()):
                        successors[step].append(name)
        return successors

    def _trigger_arcs(self, name: str) -> Iterator[Arc]:
        """Yield the arcs on which an activity's event model rests."""
        triggers = self.state.triggers
        for key, arcs in triggers.inputs[name].items():
            if (name, key) not in triggers.open_inputs:
                yield from arcs
        yield from triggers.requests[name]

    def _iterate_steps(self, steps: tuple[str, ...]) -> None:
        """Repeat until nothing changes. Started from the execution times, it approaches the truth from below."""
        self._start_from_below(steps)
        pending = set(steps)
        for _ in range(_MAX_SWEEPS):
            for step in steps:
                if step in pending:
                    pending.discard(step)
                    if self._update_step(step):
                        pending.update(self.successors[step])
            pending.intersection_update(steps)
            if not pending:
                return
        self._give_up_steps(steps)

    def _start_from_below(self, steps: tuple[str, ...]) -> None:
        """Set the least response (the execution time) and no events for all activities of a loop."""
        for name in self._activity_ids(steps):
            activity = self.state.system.activities[name]
            # The cause is read only where the value is None, that is, where no execution time is known.
            self.state.responses.setdefault(name, WorstResponse(activity.wcet, "unknown", UnknownCause((name,))))
            self.state.event_models.setdefault(name, ())

    def _activity_ids(self, steps: tuple[str, ...]) -> Iterator[str]:
        """Yield the activities whose figures some steps find."""
        for step in steps:
            yield from self.resources[step].members if step in self.resources else (step,)

    def _give_up_steps(self, steps: tuple[str, ...]) -> None:
        """Mark everything in a loop as diverged: the last iterate is below the truth, so it is no bound."""
        state = self.state
        for name in self._activity_ids(steps):
            state.responses[name] = state.responses[name]._replace(value=None, cause=DIVERGED_CAUSE)
            state.diverged.add(name)
        for step in steps:
            if step in state.system.activities and not has_own_rate(state.system.activities[step]):
                state.event_models[step] = DIVERGED_CAUSE

    def _update_step(self, step: str) -> bool:
        """Find the figures of one step anew, and return whether they changed."""
        state = self.state
        if step in self.resources:
            new_responses, self.previous_threads[step] = find_responses(
                state.system,
                self.resources[step],
                state.event_models,
                state.responses,
                AnalysisEffort(self.budget, self._stale_activities(step), self.previous_threads.get(step)),
            )
            changed = any(_has_changed(state.responses.get(name), response) for name, response in new_responses.items())
            state.responses.update(new_responses)
            return changed
        event_model = activation_model(state, step)
        if step in state.responses and _is_unchanged(state.event_models.get(step), event_model):
            return False
        state.event_models[step] = event_model
        # On no resource: a core of its own, so that its response rests on nothing but its own events.
        if step not in self.resources_of:
            state.responses[step] = find_dedicated_response(state.system, step, state.event_models, self.budget)
        return True

    def _stale_activities(self, step: str) -> frozenset[str] | None:
        """Return what has another event model than when a resource was last looked at; None the first time."""
        resource, event_models = self.resources[step], self.state.event_models
        current_models = {
            name: event_models[name] for unit in (*resource.units, *resource.foreign_units) for name in unit
        }
        previous_models = self.seen_models.get(step)
        # Compared by identity below: `_update_step` stores an event model only where it differs from the old one.
        self.seen_models[step] = current_models
        return (
            None
            if previous_models is None
            else frozenset(name for name in current_models if current_models[name] is not previous_models[name])
        )


def _has_changed(old: WorstResponse | None, new: WorstResponse) -> bool:
    """Whether a response changed. Causes are compared without regard to order (see `is_same_cause`)."""
    if old is None or old.value != new.value or old.tier != new.tier:
        return True
    return old.cause is not new.cause and not is_same_cause(old.cause, new.cause)


def _is_unchanged(old: EventStreams | UnknownCause | None, new: EventStreams | UnknownCause) -> bool:
    """Whether an event model is the same as before."""
    return is_same_cause(old, new) if isinstance(old, UnknownCause) and isinstance(new, UnknownCause) else old == new


def activation_model(state: PropagationState, name: str) -> EventStreams | UnknownCause:
    """Return the event model of an activity's activations, from what fires it."""
    activity = state.system.activities[name]
    written_model = written_streams(activity)
    if written_model is not None:
        return written_model
    if name in state.triggers.never_firing:
        return ()
    if name in state.triggers.unknown_rates:
        return UnknownCause((name,), ("a ring of triggers",))
    if activity.behaviour == "event":
        return _event_driven_model(state, activity)
    if activity.behaviour == "on_demand" and state.triggers.requests[name]:
        return _merge_models(request_models(state, name))
    return UnknownCause((name,))


def _event_driven_model(state: PropagationState, activity: Activity) -> EventStreams | UnknownCause:
    """Return the event model of an event-driven activity: what its inputs fire, and the calls that it serves."""
    inputs = state.triggers.inputs[activity.id]
    request_streams = tuple(request_models(state, activity.id))
    if not inputs and not request_streams:
        return UnknownCause((activity.id,))
    data_model = _fired_model(state, activity, inputs) if inputs else ()
    if isinstance(data_model, UnknownCause):
        return data_model
    # Calls are not thinned: `every`, `throttle` and `jitter` are about triggers.
    fired_streams = (
        delay_streams(throttle_streams(take_every_nth(data_model, activity.every), activity.throttle), activity.jitter)
        if data_model
        else ()
    )
    return _merge_models((fired_streams, *request_streams))


def _fired_model(
    state: PropagationState, activity: Activity, inputs: Mapping[str, tuple[Arc, ...]]
) -> EventStreams | UnknownCause:
    """Return the event model of what triggers fire, before `every`, `throttle` and `jitter`."""
    if activity.mode == "any":
        return _merge_models(input_model(state, activity, key, arcs) for key, arcs in inputs.items())
    needed_inputs = [key for key, arcs in inputs.items() if not is_always_present(state.system, arcs)]
    if not needed_inputs:
        renewed_inputs = find_renewed_inputs(state.system, inputs)
        return (
            _merge_models(input_model(state, activity, key, arcs) for key, arcs in renewed_inputs.items())
            if renewed_inputs
            else ()
        )
    input_models = [
        # An input that closes a ring: how often it comes rests on this activity itself. The others bound the rate.
        UnknownCause((activity.id,))
        if (activity.id, key) in state.triggers.open_inputs
        else input_model(state, activity, key, inputs[key])
        for key in needed_inputs
    ]
    known_models = [streams for streams in input_models if not isinstance(streams, UnknownCause)]
    # One input on which nothing ever comes is enough for all-of never to fire.
    if any(not streams for streams in known_models):
        return ()
    if not known_models:
        return unite_causes(cause for cause in input_models if isinstance(cause, UnknownCause))
    return combine_all_of(known_models, complete=len(known_models) == len(input_models))


def is_always_present(system: TimingSystem, arcs: Iterable[Arc]) -> bool:
    """Whether something sent once stands on an input, so that it is always there."""
    return any(system.activities[arc.source].behaviour == "once" for arc in arcs)


def find_renewed_inputs(system: TimingSystem, inputs: Mapping[str, tuple[Arc, ...]]) -> dict[str, tuple[Arc, ...]]:
    """Return the inputs that something feeds beside what is sent once: where everything is always there, they fire."""
    return {
        key: arcs
        for key, arcs in inputs.items()
        if any(system.activities[arc.source].behaviour != "once" for arc in arcs)
    }


def input_model(
    state: PropagationState, activity: Activity, key: str, arcs: tuple[Arc, ...]
) -> EventStreams | UnknownCause:
    """Return the event model of what arrives at one input."""
    if not arcs or key in state.system.external_inputs.get(activity.id, ()):
        return UnknownCause((key,))
    return _merge_models(arriving_model(state, arc, state.event_models[arc.source]) for arc in arcs)


def request_models(state: PropagationState, name: str) -> Iterator[EventStreams | UnknownCause]:
    """Yield the event models of the calls that arrive: they may come at any time while their caller runs."""
    for arc in state.triggers.requests[name]:
        event_model = state.event_models[arc.source]
        caller = state.system.activities[arc.source]
        if not isinstance(event_model, UnknownCause):
            yield arriving_model(
                state, arc, streams_of_calls(event_model, caller.calls.get(arc.output, _ONE_CALL)), from_start=True
            )
        else:
            yield event_model


def arriving_model(
    state: PropagationState, arc: Arc, event_model: EventStreams | UnknownCause, *, from_start: bool = False
) -> EventStreams | UnknownCause:
    """Return the event model behind a source's response and a link.

    With `from_start` the event may leave as soon as the source starts, not only after its best case.
    """
    if isinstance(event_model, UnknownCause) or not event_model:
        return event_model
    source, response = state.system.activities[arc.source], state.responses[arc.source]
    if response.value is None:
        return _downstream_cause(response.cause)
    if arc.worst is None:
        return (
            UnknownCause((arc.link,))
            if arc.link
            else UnknownCause((arc.source, arc.target), ("no link joins their hosts",))
        )
    return delay_streams(
        _completion_streams(source, response.value, event_model, from_start=from_start), arc.worst - (arc.best or 0)
    )


def leaving_model(
    state: PropagationState, arc: Arc, event_model: EventStreams | UnknownCause, *, from_start: bool = False
) -> EventStreams | UnknownCause:
    """Return the event model behind a source's response, before any link."""
    if isinstance(event_model, UnknownCause) or not event_model:
        return event_model
    source, response = state.system.activities[arc.source], state.responses[arc.source]
    if response.value is None:
        return _downstream_cause(response.cause)
    return _completion_streams(source, response.value, event_model, from_start=from_start)


def _completion_streams(source: Activity, response: int, streams: EventStreams, *, from_start: bool) -> EventStreams:
    """Return the event model of completions: up to R - B later than activations, and at least B apart."""
    best_case = 0 if from_start else source.bcet or 0
    completed = delay_streams(streams, max(response - best_case, 0))
    # A declared response may rest on several executions at once: its completions are not known to be B apart.
    return keep_events_apart(completed, best_case) if source.response is None else completed


def _downstream_cause(cause: UnknownCause) -> UnknownCause:
    """Return the cause as those see it who read the output."""
    return UnknownCause(cause.missing, tuple(_DOWNSTREAM_WORDS.get(note, note) for note in cause.notes))


def _merge_models(models: Iterable[EventStreams | UnknownCause]) -> EventStreams | UnknownCause:
    """Merge event models: any of them fires. One unknown makes all unknown."""
    causes: list[UnknownCause] = []
    streams: list[EventStream] = []
    for model in models:
        if isinstance(model, UnknownCause):
            causes.append(model)
        else:
            streams += model
    return unite_causes(causes) if causes else merge_streams(streams)
