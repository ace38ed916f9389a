"""Event models from sources to sinks, and with them the response times, to a fixed point.

Responses make outputs later by R - B, which makes the event models of their readers burstier, which makes responses
longer. Only what depends on itself that way is iterated, from below, so that the first repetition is the least fixed
point (K. Tindell, J. Clark 1994; compositional analysis as in pyCPA).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace

from archgen.model.graph_search import find_strong_components
from archgen.timing.figures.timing_values import UnknownCause, is_same_cause, sum_ratios
from archgen.timing.load.core_paths import CorePaths
from archgen.timing.load.core_responses import solve_inner_core
from archgen.timing.load.event_models import PropagationState, activation_model, arriving_model
from archgen.timing.load.event_streams import EventStreams
from archgen.timing.load.inner_core import InnerCore, prepare_inner_core
from archgen.timing.load.inner_triggers import FiringArc, InnerTriggers, find_inner_triggers
from archgen.timing.load.level_cascades import Origin
from archgen.timing.load.load_system import build_load_system, list_written_priorities
from archgen.timing.load.queue_responses import find_core_queue
from archgen.timing.load.response_times import AnalysisEffort, find_dedicated_response, find_responses
from archgen.timing.load.run_ways import EntryWay, find_run_arcs
from archgen.timing.load.search_budgets import GroupBudgets
from archgen.timing.load.shared_core_responses import solve_shared_cores
from archgen.timing.load.shared_cores import prepare_shared_cores
from archgen.timing.load.single_cores import SingleCores, delay_by_response
from archgen.timing.load.storing_waits import find_core_waits
from archgen.timing.load.thread_work import DIVERGED_CAUSE, WorstResponse
from archgen.timing.system.core_placement import ProcessingResource, divide_resource, find_resources
from archgen.timing.system.timing_system import Arc, TimingSystem, samples_inputs
from archgen.timing.system.trigger_graph import TriggerGraph, find_triggers, has_own_rate

_MAX_SWEEPS = 300
"""Sweeps over a loop before it is given up as diverged."""
_MAX_WAITING_ACTIVATIONS = 200
"""Activations of one activity that may come within its response, in a loop, before the loop is given up."""


def propagate_events(
    system: TimingSystem, triggers: TriggerGraph, group_budgets: GroupBudgets | None = None
) -> PropagationState:
    """Find the event model and the worst response of every activity.

    A caller that propagates several times passes the same budgets to all runs.
    """
    load_system = build_load_system(system)
    load_triggers = triggers if load_system is system else find_triggers(load_system)
    state = _Propagation(
        PropagationState(load_system, load_triggers),
        find_resources(load_system),
        group_budgets or GroupBudgets(),
        list_written_priorities(system, load_system),
    ).run_to_fixed_point()
    # What is asked of the state later is about the activities that somebody wrote.
    state.system, state.triggers = system, triggers
    for name in load_system.activities.keys() - system.activities.keys():
        for table in (state.event_models, state.responses, state.ways_to, state.run_arcs, state.storing_waits):
            table.pop(name, None)
        state.diverged.discard(name)
    return state


class _Propagation:
    """One run. A step is an activity (find its event model) or a resource (find the responses of what it runs)."""

    def __init__(
        self,
        state: PropagationState,
        resource_list: Iterable[ProcessingResource],
        group_budgets: GroupBudgets,
        priorities: Mapping[str, int | None],
    ) -> None:
        self.state = state
        self.resources: dict[str, ProcessingResource] = {}
        self.resources_of: dict[str, list[str]] = {}
        self.disturbed_resources: dict[str, list[str]] = {}
        divided_resources = (part for resource in resource_list for part in divide_resource(state.system, resource))
        for index, resource in enumerate(divided_resources):
            # Resources get keys that no activity has: both are steps of one graph.
            key = f"{index} {resource.id}"
            self.resources[key] = resource
            for unit in resource.units:
                for name in unit:
                    self.resources_of.setdefault(name, []).append(key)
            for unit in (*resource.units, *resource.foreign_units):
                for name in unit:
                    self.disturbed_resources.setdefault(name, []).append(key)
        self.queues = {
            key: queue
            for key, resource in self.resources.items()
            if (queue := find_core_queue(state.system, resource, priorities)) is not None
        }
        self.roaming_ids = {
            key: frozenset(name for unit in resource.roaming_units for name in unit)
            for key, resource in self.resources.items()
            if resource.roaming_units
        }
        self.inner_cores: dict[str, InnerCore] = {}
        self.shared_cores: dict[str, CorePaths] = {}
        self.inner_triggers: dict[str, InnerTriggers] = {}
        self._prepare_inner_cores()
        self.single_cores = self._find_single_cores()
        # From below, as everything that is found by repetition.
        self.work_ends = {
            name: self.state.system.activities[name].wcet or 0
            for step in self.single_cores
            for name in self.resources[step].members
        }
        self.seen_models: dict[str, dict[str, EventStreams | UnknownCause]] = {}
        # Where a written jitter lets many come at once, that many may wait without anything having run away.
        activities = state.system.activities.values()
        shortest_period = min((activity.period for activity in activities if activity.period), default=1)
        largest_jitter = max((activity.jitter for activity in activities), default=0)
        self.max_waiting = _MAX_WAITING_ACTIVATIONS * (1 + largest_jitter // shortest_period)
        self.successors = self._find_successors()
        self.budget_of = group_budgets.assign_budgets(state.system, self.successors)

    def _prepare_inner_cores(self) -> None:
        """Prepare the cores on which activities fire one another, and those that share their work."""
        system = self.state.system
        for step, resource in self.resources.items():
            inner_triggers = find_inner_triggers(system, self.state.triggers, resource)
            if inner_triggers is None:
                continue
            if resource.cores == 1:
                core = prepare_inner_core(system, resource, inner_triggers)
                core = self.inner_cores[step] = replace(core, queue=self.queues.get(step))
                self.inner_triggers[step], ways_to = core.inner_triggers, core.ways_to
            else:
                cores = prepare_shared_cores(system, resource, inner_triggers)
                self.shared_cores[step] = CorePaths(cores)
                self.inner_triggers[step], ways_to = cores.inner_triggers, cores.ways_to
            self.state.run_arcs.update(find_run_arcs(self.inner_triggers[step], ways_to))

    def _find_single_cores(self) -> dict[str, SingleCores]:
        """Return the cores, one by one, of what shares several of them with what is pinned to some of them."""
        cores_of = {unit: resource.core_set for resource in self.resources.values() for unit in resource.units}
        return {
            step: SingleCores(self.state.system, self.resources[step], cores_of)
            for step in self.shared_cores
            if self.resources[step].foreign_units and not any(self.inner_triggers[step].inner_arcs.values())
        }

    def run_to_fixed_point(self) -> PropagationState:
        """Take the strong components of the dependencies in order, and iterate only those that are loops."""
        for steps in find_strong_components([*self.state.triggers.order, *self.resources], self.successors.__getitem__):
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
        for step, resource in self.resources.items():
            names = [name for name in resource.members if name in readers]
            queue = self.queues.get(step)
            if queue is not None and queue.stores_in_time:
                state.storing_waits |= dict.fromkeys(names, WorstResponse(0, "fifo"))
            elif names and step not in self.inner_triggers:
                models = self._models_of(step)
                state.storing_waits |= find_core_waits(state.system, resource, models, names, self.budget_of[step])
        for name in readers.difference(self.resources_of):
            own_core = ProcessingResource(name, None, 1, ((name,),))
            state.storing_waits |= find_core_waits(
                state.system, own_core, state.event_models, (name,), self.budget_of[name]
            )

    def _models_of(self, step: str) -> Mapping[str, EventStreams | UnknownCause]:
        """Return the event models as a resource sees them."""
        roaming_ids = self.roaming_ids.get(step, frozenset())
        return {**self.state.event_models, **{name: self._model_of_roaming(name) for name in roaming_ids}}

    def _model_of_roaming(self, name: str) -> EventStreams | UnknownCause:
        """Return the event model of work that another core may have begun."""
        return delay_by_response(
            self.state.event_models[name], self.state.responses.get(name), self.work_ends.get(name)
        )

    def _find_successors(self) -> dict[str, list[str]]:
        """Return the steps that must be looked at again when a step has changed."""
        system, triggers = self.state.system, self.state.triggers
        successors: dict[str, list[str]] = {step: [] for step in (*system.activities, *self.resources)}
        self._add_resource_steps(successors)
        for name, activity in system.activities.items():
            if not has_own_rate(activity) and name not in triggers.unknown_rates:
                for arc in self._trigger_arcs(name):
                    successors[arc.source].append(name)
                    # What arrives rests on the source's response as well, and that is found by its resource.
                    for step in self.resources_of.get(arc.source, ()):
                        successors[step].append(name)
        return successors

    def _add_resource_steps(self, successors: dict[str, list[str]]) -> None:
        """Add what the responses on each resource rest on."""
        for step, resource in self.resources.items():
            for name in (name for unit in resource.foreign_units for name in unit):
                if resource.cores > 1 or name in self.roaming_ids.get(step, ()):
                    for foreign_step in self.resources_of.get(name, ()):
                        successors[foreign_step].append(step)
        for name in self.state.system.activities:
            successors[name] += (step for step in self.disturbed_resources.get(name, ()) if self._rests_on(step, name))
        for step, inner_triggers in self.inner_triggers.items():
            for source in dict.fromkeys(inner_triggers.outer_sources):
                successors[source].append(step)
                for source_step in self.resources_of.get(source, ()):
                    successors[source_step].append(step)

    def _rests_on(self, step: str, name: str) -> bool:
        """Whether a resource's responses rest on an activity's event model: not where it is fired from inside."""
        inner_triggers = self.inner_triggers.get(step)
        return inner_triggers is None or name not in inner_triggers.inner_arcs

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
                        if self._has_run_away(step):
                            self._give_up_steps(steps)
                            return
            pending.intersection_update(steps)
            if not pending:
                return
        self._give_up_steps(steps)

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
            yield from self.resources[step].members if step in self.resources else (step,)

    def _give_up_steps(self, steps: tuple[str, ...]) -> None:
        """Mark everything in a loop as diverged: the last iterate is below the truth, so it is no bound."""
        state = self.state
        for name in self._activity_ids(steps):
            state.responses[name] = state.responses[name]._replace(value=None, cause=DIVERGED_CAUSE)
            state.diverged.add(name)
            if name in state.ways_to:
                state.ways_to[name] = tuple(way._replace(delay=None) for way in state.ways_to[name])
        for step in steps:
            if step in state.system.activities and not has_own_rate(state.system.activities[step]):
                state.event_models[step] = DIVERGED_CAUSE

    def _update_step(self, step: str) -> bool:
        """Find the figures of one step anew, and return whether they changed."""
        state = self.state
        if step in self.inner_triggers:
            return self._update_inner_core(step)
        if step in self.resources:
            new_responses = self._find_responses(step)
            new_responses = {
                name: _name_tier(self.resources[step], response) for name, response in new_responses.items()
            }
            changed = any(_has_changed(state.responses.get(name), response) for name, response in new_responses.items())
            state.responses.update(new_responses)
            return changed
        event_model = activation_model(state, step)
        if step in state.responses and _is_unchanged(state.event_models.get(step), event_model):
            return False
        state.event_models[step] = event_model
        # On no resource: a core of its own, so that its response rests on nothing but its own events.
        if step not in self.resources_of:
            state.responses[step] = find_dedicated_response(
                state.system, step, state.event_models, self.budget_of[step]
            )
        return True

    def _find_responses(self, step: str) -> dict[str, WorstResponse]:
        """Find the responses of a resource on which nothing fires anything else."""
        state, resource, budget = self.state, self.resources[step], self.budget_of[step]
        models = self._models_of(step) if step in self.roaming_ids else state.event_models
        queue, stale_ids = self.queues.get(step), self._stale_activities(step)
        # In a queue each response rests on all that waits there.
        effort = AnalysisEffort(budget, stale_ids if queue is None else None)
        responses = find_responses(state.system, resource, models, effort)
        if queue is None:
            return responses
        busy_period = max((each.value or 0 for each in responses.values() if each.tier != "declared"), default=0)
        bounds = queue.bound_responses(models.__getitem__, busy_period, budget)
        return {name: response.limit_to(bounds.get(name), queue.order) for name, response in responses.items()}

    def _update_inner_core(self, step: str) -> bool:
        """Find the responses of a core on which activities fire one another, and return whether anything changed."""
        state = self.state
        entering_models: dict[int, EventStreams | UnknownCause] = {}

        def find_model(origin: Origin, entry_arc: FiringArc | None) -> EventStreams | UnknownCause:
            if entry_arc is None:
                name = str(origin.key)
                is_roaming = step in self.inner_cores and name in self.roaming_ids.get(step, ())
                return self._model_of_roaming(name) if is_roaming else state.event_models[name]
            key = id(entry_arc.arc)
            if key not in entering_models:
                entering_models[key] = arriving_model(state, entry_arc.arc)
            return entering_models[key]

        new_responses, new_ways, new_waits = (
            solve_inner_core(self.inner_cores[step], find_model, self.budget_of[step])
            if step in self.inner_cores
            else solve_shared_cores(self.shared_cores[step], find_model, state.responses, self.budget_of[step])
        )
        old_ends = dict(self.work_ends)
        if step in self.single_cores:
            self._limit_to_single_cores(step, new_responses, new_ways)
        new_responses = {name: _name_tier(self.resources[step], response) for name, response in new_responses.items()}
        changed = old_ends != self.work_ends or any(
            not _is_unchanged(state.entering_models.get(key), entering_models[key]) for key in entering_models
        )
        state.entering_models.update(entering_models)
        changed = changed or any(
            _has_changed(state.responses.get(name), response) or state.ways_to.get(name) != new_ways[name]
            for name, response in new_responses.items()
        )
        state.responses.update(new_responses)
        state.ways_to.update(new_ways)
        state.storing_waits.update(new_waits)
        return changed

    def _limit_to_single_cores(
        self, step: str, responses: dict[str, WorstResponse], ways_to: dict[str, tuple[EntryWay, ...]]
    ) -> None:
        """Limit the responses on several cores to what each of these cores alone would let them be."""
        state = self.state
        bounds = self.single_cores[step].limit(
            state.event_models, {**state.responses, **responses}, self.budget_of[step]
        )
        for name in self.resources[step].members:
            self.work_ends.pop(name, None)
        self.work_ends.update(bounds)
        for name, bound in bounds.items():
            response = responses[name]
            if response.value is not None and bound < response.value and response.tier != "declared":
                responses[name] = response._replace(value=bound)
                ways_to[name] = tuple(
                    way._replace(delay=min(way.delay, bound)) if len(way.steps) == 1 and way.delay is not None else way
                    for way in ways_to[name]
                )

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


def _name_tier(resource: ProcessingResource, response: WorstResponse) -> WorstResponse:
    """Name the tier of a thread that has one of several cores to itself."""
    if not resource.undisturbed or response.tier in {"declared", "unknown"}:
        return response
    return response._replace(tier="executor" if len(resource.units[0]) > 1 else "cores")


def _has_changed(old: WorstResponse | None, new: WorstResponse) -> bool:
    """Whether a response changed. Causes are compared without regard to order (see `is_same_cause`)."""
    if old is None or old.value != new.value or old.tier != new.tier:
        return True
    return old.cause is not new.cause and not is_same_cause(old.cause, new.cause)


def _is_unchanged(old: EventStreams | UnknownCause | None, new: EventStreams | UnknownCause) -> bool:
    """Whether an event model is the same as before."""
    return is_same_cause(old, new) if isinstance(old, UnknownCause) and isinstance(new, UnknownCause) else old == new
