"""Event models from sources to sinks, and with them the response times, to a fixed point.

Responses make outputs later by R - B, which makes the event models of their readers burstier, which makes responses
longer. Only what depends on itself that way is iterated, from below, so that the first repetition is the least fixed
point (K. Tindell, J. Clark 1994; compositional analysis as in pyCPA).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import TypeVar

from archgen.frozen import replace
from archgen.model.graph_search import find_strong_components
from archgen.timing.figures.timing_values import UnknownCause, sum_ratios
from archgen.timing.load.busy_windows import GroupBudgets
from archgen.timing.load.core_responses import CoreResponses
from archgen.timing.load.level_cascades import EntryWay, EventOrigin
from archgen.timing.load.load_system import build_load_system, list_written_priorities
from archgen.timing.load.propagation_state import PropagationState
from archgen.timing.load.step_updates import StepUpdates
from archgen.timing.load.storing_waits import find_core_waits
from archgen.timing.load.thread_work import DIVERGED_CAUSE, WorstResponse
from archgen.timing.load.waiting_threads import find_waiting_stores
from archgen.timing.load.whole_hosts import limit_responses
from archgen.timing.system.core_placement import ProcessingResource, find_resources
from archgen.timing.system.thread_pools import may_skip_ticks
from archgen.timing.system.timing_system import TimingSystem, samples_inputs
from archgen.timing.system.trigger_graph import TriggerGraph, find_triggers, has_own_rate

_Figure = TypeVar("_Figure")
_MAX_SWEEPS = 300
"""Sweeps over a loop before it is given up as diverged."""


def propagate_events(
    system: TimingSystem, triggers: TriggerGraph, group_budgets: GroupBudgets | None = None
) -> PropagationState:
    """Find the event model and the worst response of every activity.

    A caller that propagates several times passes the same budgets to all runs.
    """
    load_system = build_load_system(system)
    load_triggers = triggers if load_system is system else find_triggers(load_system)
    load_state = _Propagation(
        PropagationState(load_system, load_triggers),
        find_resources(load_system),
        group_budgets or GroupBudgets(),
        list_written_priorities(system, load_system),
    ).run_to_fixed_point()
    return load_state if load_system is system else _restrict_state(load_state, system, triggers)


def _restrict_state(load_state: PropagationState, system: TimingSystem, triggers: TriggerGraph) -> PropagationState:
    """Return what is known of the activities that somebody wrote, without those that only store inputs."""

    def keep_written(figures: Mapping[str, _Figure]) -> dict[str, _Figure]:
        return {name: figure for name, figure in figures.items() if name in system.activities}

    return replace(
        load_state,
        system=system,
        triggers=triggers,
        event_models=keep_written(load_state.event_models),
        responses=keep_written(load_state.responses),
        diverged=load_state.diverged & system.activities.keys(),
        storing_waits=keep_written(load_state.storing_waits),
        ways_to=keep_written(load_state.ways_to),
        transaction_ways=keep_written(load_state.transaction_ways),
        transaction_arcs=keep_written(load_state.transaction_arcs),
        run_arcs=keep_written(load_state.run_arcs),
        leaving_models={},
        load_state=load_state,
    )


class _Propagation(StepUpdates):
    """One run over all steps, to a fixed point."""

    def run_to_fixed_point(self) -> PropagationState:
        """Take the strong components of the dependencies in order, and iterate only those that are loops."""
        all_steps = [
            *self.state.triggers.order,
            *self.whole_hosts,
            *self.transactions,
            *self.resources,
            *self.joined_resources,
        ]
        for steps in find_strong_components(all_steps, self.successors.__getitem__):
            # The strong components come in the order of dependency: what is outside of loops is found once, in one
            # pass.
            if len(steps) == 1 and steps[0] not in self.successors[steps[0]]:
                self._update_step(steps[0])
            else:
                self._iterate_steps(steps)
        self._find_storing_waits()
        return self.state

    def _find_storing_waits(self) -> None:
        """Find how long storing callbacks may wait, where the responses on a core were found without them."""
        state = self.state
        readers = {name for name, activity in state.system.activities.items() if samples_inputs(state.system, activity)}
        for name in sorted(readers.difference(state.storing_waits)):
            # Found below, but for a core on which activities fire one another and that was given up before its turn.
            state.storing_waits[name] = WorstResponse(None, "host", DIVERGED_CAUSE)
        for step, resource in self.resources.items():
            names = [name for name in resource.members if name in readers]
            queue = self.queues.get(step)
            if resource.waits:
                stores = find_waiting_stores(state, resource, self.waiting_ids, names, self.budget_of[step])
                state.storing_waits |= {name: self._limit_response(name, wait) for name, wait in stores.items()}
            elif queue is not None and queue.stores_in_time:
                state.storing_waits |= dict.fromkeys(names, WorstResponse(0, "fifo"))
            elif names and step not in self.inner_triggers:
                models = self.models_of(step)
                waits = find_core_waits(state.system, resource, models, names, self.budget_of[step])
                waits = limit_responses(CoreResponses({}, {}, waits), self._limits_of(step)).storing_waits
                responses = {name: state.responses[name] for name in resource.members}
                state.storing_waits |= self._limit_to_fair(step, CoreResponses(responses, {}, waits), {}).storing_waits
            if queue is not None and queue.works_in_rounds:
                for name in names:
                    wait = state.storing_waits[name]
                    state.storing_waits[name] = queue.limit_storing_wait(state.system, name, wait)
        for name in sorted(readers.difference(self.resources_of)):
            own_core, budget = ProcessingResource(name, None, 1, ((name,),)), self.budget_of[name]
            if state.system.activities[name].suspends:
                stores = find_waiting_stores(state, own_core, self.waiting_ids, (name,), budget)
                state.storing_waits[name] = self._limit_response(name, stores[name])
            else:
                waits = find_core_waits(state.system, own_core, state.event_models, (name,), budget)
                state.storing_waits[name] = waits[name]
        self._add_skipped_ticks(readers)

    def _add_skipped_ticks(self, readers: Iterable[str]) -> None:
        """Add to waits on other resources than a single core that a tick which waits for its job skips the next ones."""
        state = self.state
        single_cores = {name for step in self._list_single_steps() for name in self.resources[step].members}
        for name in sorted(set(readers) - single_cores):
            activity, wait, response = state.system.activities[name], state.storing_waits[name], state.responses[name]
            if wait.value and response.value and may_skip_ticks(state.system, activity, response.value):
                state.storing_waits[name] = wait._replace(value=wait.value + response.value - (activity.wcet or 0))

    def _list_single_steps(self) -> Iterator[str]:
        """Yield the resources of one core: their waits end where a job begins, whatever is skipped."""
        return (step for step, each in self.resources.items() if not each.waits and step not in self.shared_cores)

    def _iterate_steps(self, steps: tuple[str, ...]) -> None:
        """Repeat until nothing changes: place by place, and then with what the ways over hosts say of all that leaves them."""
        is_at_rest = self._begin_anew(steps)
        settled_ids = {name for step in steps if step in self.transactions for name in self.transactions[step].place_of}
        # What nobody wrote is what is told: no other way of looking finds a bound there, nor does anything diverge.
        causes = [self.state.responses[name].cause for name in sorted(settled_ids)] if is_at_rest else []
        if settled_ids and not any(cause is not None and cause.missing for cause in causes):
            is_at_rest = self._settle_transactions(steps, settled_ids, is_at_rest=is_at_rest)
        if not is_at_rest:
            self._give_up_steps(steps)

    def _settle_transactions(self, steps: tuple[str, ...], settled_ids: set[str], *, is_at_rest: bool) -> bool:
        """Repeat with what the ways over hosts say of all that leaves them, and return whether all came to rest."""
        state = self.state
        place_responses = {name: state.responses[name] for name in sorted(settled_ids)} if is_at_rest else {}
        state.place_ways |= {name: self._list_place_ways(name) if is_at_rest else () for name in sorted(settled_ids)}
        state.settled_ids |= settled_ids
        if not self._begin_anew(steps):
            state.settled_ids -= settled_ids
            return self._begin_anew(steps)
        for name, response in place_responses.items():
            value = state.responses[name].value
            # Where a search did not end now, what was found place by place is as safe.
            if response.value is not None and (value is None or response.value < value):
                state.responses[name] = response
        return True

    def _list_place_ways(self, name: str) -> tuple[EntryWay, ...]:
        """Return how long events stay on the cores of an activity at most, as it was found from these alone."""
        state = self.state
        entry = EntryWay(EventOrigin("activity", name), None, (name,), delay=state.responses[name].value)
        core_ways = (*state.ways_to.get(name, ()), *state.host_ways_to.get(name, ()), entry)
        return tuple(way for way in core_ways if way.delay is not None)

    def _begin_anew(self, steps: tuple[str, ...]) -> bool:
        """Repeat from below until nothing changes, and return whether it came to rest."""
        for step in steps:
            self.state.event_models.pop(step, None)
            self.seen_models.pop(step, None)
            self.window_inputs.pop(step, None)
            for name in self.transactions[step].place_of if step in self.transactions else ():
                self.state.transaction_ways.pop(name, None)
        for name in self._activity_ids(steps):
            self.state.responses.pop(name, None)
        self._start_from_below(steps)
        return self._settle_steps(steps)

    def _settle_steps(self, steps: tuple[str, ...]) -> bool:
        """Repeat, and return whether it came to rest. Started from the execution times, it approaches the truth from below."""
        pending = set(steps)
        for _ in range(_MAX_SWEEPS):
            for step in steps:
                if step in pending:
                    pending.discard(step)
                    if self._update_step(step):
                        pending.update(self.successors[step])
                        if self._has_run_away(step):
                            return False
            pending.intersection_update(steps)
            if not pending:
                return True
        return False

    def _has_run_away(self, step: str) -> bool:
        """Whether a response has grown so long that it is of no use to anybody, if it ends at all."""
        # Loops without a fixed point grow by a factor with each sweep: without this the budget of their whole group
        # is spent on them, though nothing will come of it.
        state = self.state
        for name in self.resources[step].members if step in self.resources else ():
            response, event_model = state.responses[name], state.event_models[name]
            if response.value and response.tier != "declared" and not isinstance(event_model, UnknownCause):
                numerator, denominator = sum_ratios([stream.max_rate_ratio for stream in event_model])
                if response.value * numerator > self.max_waiting * denominator:
                    return True
        return False

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
            if step not in self.whole_hosts and step not in self.joined_resources and step not in self.transactions:
                yield from self.resources[step].members if step in self.resources else (step,)

    def _give_up_steps(self, steps: tuple[str, ...]) -> None:
        """Mark everything in a loop as diverged: the last iterate is below the truth, so it is no bound."""
        state = self.state
        for name in self._activity_ids(steps):
            state.responses[name] = state.responses[name]._replace(value=None, cause=DIVERGED_CAUSE)
            state.diverged.add(name)
            state.storing_waits.pop(name, None)
            if name in state.ways_to:
                state.ways_to[name] = tuple(way._replace(delay=None) for way in state.ways_to[name])
        for step in steps:
            self.joined_bounds.pop(step, None)
            for name in self.host_limits.pop(step, ()):
                state.host_ways_to.pop(name, None)
            if step in state.system.activities and not has_own_rate(state.system.activities[step]):
                state.event_models[step] = DIVERGED_CAUSE
