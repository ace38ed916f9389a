"""Event models from sources to sinks, and with them the response times, to a fixed point.

Responses make outputs later by R - B, which makes the event models of their readers burstier, which makes responses
longer. Only what depends on itself that way is iterated, from below, so that the first repetition is the least fixed
point (K. Tindell, J. Clark 1994; compositional analysis as in pyCPA).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import replace
from typing import TypeVar

from archgen.model.graph_search import find_strong_components
from archgen.timing.figures.timing_values import UnknownCause, is_same_cause, sum_ratios
from archgen.timing.load.core_paths import CorePaths
from archgen.timing.load.core_responses import CoreResponses, solve_inner_core
from archgen.timing.load.event_models import PropagationState, activation_model, arriving_model
from archgen.timing.load.event_streams import EventStreams
from archgen.timing.load.inner_core import InnerCore, prepare_inner_core
from archgen.timing.load.inner_triggers import FiringArc, InnerTriggers, find_inner_triggers
from archgen.timing.load.joined_resources import JoinedResources, find_joined_resources
from archgen.timing.load.level_cascades import Origin
from archgen.timing.load.load_system import build_load_system, list_written_priorities
from archgen.timing.load.queue_responses import find_core_queue
from archgen.timing.load.response_times import AnalysisEffort, find_dedicated_response, find_responses
from archgen.timing.load.run_ways import EntryWay, find_run_arcs
from archgen.timing.load.search_budgets import GroupBudgets
from archgen.timing.load.shared_core_responses import solve_shared_cores
from archgen.timing.load.shared_cores import prepare_shared_cores
from archgen.timing.load.single_cores import SingleCores, find_single_cores
from archgen.timing.load.storing_waits import find_core_waits
from archgen.timing.load.thread_work import DIVERGED_CAUSE, WorstResponse
from archgen.timing.load.waiting_threads import find_waiting_responses, find_waiting_stores, model_roaming_work
from archgen.timing.load.whole_hosts import HostLimit, find_whole_hosts, limit_responses, list_host_limits
from archgen.timing.system.core_placement import (
    ProcessingResource,
    find_resources,
    split_resources,
)
from archgen.timing.system.timing_system import Arc, TimingSystem, samples_inputs
from archgen.timing.system.trigger_graph import TriggerGraph, find_triggers, has_own_rate

_Figure = TypeVar("_Figure")
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
        run_arcs=keep_written(load_state.run_arcs),
        leaving_models={},
        load_state=load_state,
    )


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
        divided_resources = split_resources(state.system, resource_list)
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
        self.waiting_ids = frozenset(
            name for resource in self.resources.values() if resource.waits for name in resource.members
        )
        self.queues = {
            key: queue
            for key, resource in self.resources.items()
            # What waits for a resource comes back into the queue, later than what it came with.
            if not (resource.waits or resource.neighbour_units)
            and (queue := find_core_queue(state.system, resource, priorities)) is not None
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
        self.whole_hosts: dict[str, InnerCore] = {}
        self.resources_of_host: dict[str, list[str]] = {}
        self.host_limits: dict[str, dict[str, HostLimit]] = {}
        self._prepare_whole_hosts()
        self.single_cores = self._find_single_cores()
        # From below, as everything that is found by repetition.
        self.state.single_ends = {
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
        self.joined_resources: dict[str, JoinedResources] = {
            f"joined {index}": joined
            for index, joined in enumerate(find_joined_resources(state.system, state.triggers, self.resources))
        }
        self.joined_bounds: dict[str, Mapping[str, int]] = {}
        self.joined_steps_of: dict[str, list[str]] = {}
        for step, joined in self.joined_resources.items():
            for name in joined.processor.members:
                self.joined_steps_of.setdefault(name, []).append(step)
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

    def _prepare_whole_hosts(self) -> None:
        """Prepare the hosts that bound their activities as if they had one core."""
        whole_hosts = find_whole_hosts(self.state.system, self.state.triggers, self.resources.values())
        for host, core in whole_hosts.items():
            step = f"whole {host}"
            self.whole_hosts[step] = core
            self.resources_of_host[step] = [key for key, resource in self.resources.items() if resource.host == host]

    def _find_single_cores(self) -> dict[str, SingleCores]:
        """Return the cores, one by one, of what shares several of them with what is pinned to some of them."""
        shared_steps = [step for step in self.shared_cores if not any(self.inner_triggers[step].inner_arcs.values())]
        return find_single_cores(self.state.system, self.resources, shared_steps, self.waiting_ids)

    def run_to_fixed_point(self) -> PropagationState:
        """Take the strong components of the dependencies in order, and iterate only those that are loops."""
        all_steps = [*self.state.triggers.order, *self.whole_hosts, *self.resources, *self.joined_resources]
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
        for step, resource in self.resources.items():
            names = [name for name in resource.members if name in readers]
            queue = self.queues.get(step)
            if resource.waits:
                stores = find_waiting_stores(state, resource, self.waiting_ids, names, self.budget_of[step])
                state.storing_waits |= {name: self._limit_response(name, wait) for name, wait in stores.items()}
            elif queue is not None and queue.stores_in_time:
                state.storing_waits |= dict.fromkeys(names, WorstResponse(0, "fifo"))
            elif names and step not in self.inner_triggers:
                models = self._models_of(step)
                waits = find_core_waits(state.system, resource, models, names, self.budget_of[step])
                state.storing_waits |= limit_responses(
                    CoreResponses({}, {}, waits), self._limits_of(step)
                ).storing_waits
        for name in sorted(readers.difference(self.resources_of)):
            own_core = ProcessingResource(name, None, 1, ((name,),))
            if state.system.activities[name].uses:
                stores = find_waiting_stores(state, own_core, self.waiting_ids, (name,), self.budget_of[name])
                state.storing_waits |= {name: self._limit_response(name, stores[name])}
                continue
            state.storing_waits |= find_core_waits(
                state.system, own_core, state.event_models, (name,), self.budget_of[name]
            )

    def _models_of(self, step: str) -> Mapping[str, EventStreams | UnknownCause]:
        """Return the event models as a resource sees them."""
        roaming_ids = self.roaming_ids.get(step, frozenset())
        return {**self.state.event_models, **{name: self._model_of_roaming(name) for name in roaming_ids}}

    def _model_of_roaming(self, name: str) -> EventStreams | UnknownCause:
        """Return the event model of work that another core may have begun."""
        return model_roaming_work(self.state, name, self.waiting_ids)

    def _find_successors(self) -> dict[str, list[str]]:
        """Return the steps that must be looked at again when a step has changed."""
        system, triggers = self.state.system, self.state.triggers
        successors: dict[str, list[str]] = {
            step: [] for step in (*system.activities, *self.whole_hosts, *self.resources, *self.joined_resources)
        }
        self._add_resource_steps(successors)
        self._add_shared_uses(successors)
        self._add_joined_steps(successors)
        for name, activity in system.activities.items():
            if not has_own_rate(activity) and name not in triggers.unknown_rates:
                for arc in self._trigger_arcs(name):
                    successors[arc.source].append(name)
                    # What arrives rests on the source's response as well, and that is found by its resource.
                    for step in self._response_steps(arc.source):
                        successors[step].append(name)
        return successors

    def _add_resource_steps(self, successors: dict[str, list[str]]) -> None:
        """Add what the responses on each resource rest on."""
        for step, resource in self.resources.items():
            for name in (name for unit in resource.foreign_units for name in unit):
                rests_on_response = resource.cores > 1 or resource.waits or name in self.roaming_ids.get(step, ())
                for foreign_step in self.resources_of.get(name, ()) if rests_on_response else ():
                    successors[foreign_step].append(step)
        for name in self.state.system.activities:
            successors[name] += (step for step in self.disturbed_resources.get(name, ()) if self._rests_on(step, name))
        self._add_whole_host_steps(successors)
        all_inner_triggers = self.inner_triggers | {
            step: core.inner_triggers for step, core in self.whole_hosts.items()
        }
        for step, inner_triggers in all_inner_triggers.items():
            for source in dict.fromkeys(inner_triggers.outer_sources):
                successors[source].append(step)
                for source_step in self._response_steps(source):
                    successors[source_step].append(step)

    def _add_whole_host_steps(self, successors: dict[str, list[str]]) -> None:
        """Add what hosts taken as one core rest on, and what rests on them."""
        for step, core in self.whole_hosts.items():
            successors[step] += self.resources_of_host[step]
            for name in sorted(core.inner_triggers.entry_ids):
                successors[name].append(step)

    def _response_steps(self, name: str) -> Iterator[str]:
        """Yield the steps that find how long an activity takes: its resource, and its host as a whole."""
        yield from self.resources_of.get(name, ())
        whole_step = f"whole {self.state.system.activities[name].host}"
        if whole_step in self.whole_hosts:
            yield whole_step

    def _add_shared_uses(self, successors: dict[str, list[str]]) -> None:
        """Add what the waits for resources rest on: the event models and responses of all that use them."""
        activities = self.state.system.activities.values()
        for resource_id in dict.fromkeys(key for activity in activities for key in activity.uses):
            user_ids = [activity.id for activity in activities if resource_id in activity.uses]
            for user in user_ids:
                for other in user_ids:
                    if other != user:
                        for step in self.resources_of.get(other, (other,)):
                            successors[user].append(step)
                            for user_step in self.resources_of.get(user, ()):
                                successors[user_step].append(step)

    def _add_joined_steps(self, successors: dict[str, list[str]]) -> None:
        """Add what the bounds of joined resources rest on, and the steps that they bound."""
        for step, joined in self.joined_resources.items():
            inner_triggers = joined.inner_triggers
            for name in joined.processor.members:
                if inner_triggers is None or name not in inner_triggers.inner_arcs:
                    successors[name].append(step)
                successors[step] += self.resources_of.get(name, (name,))
            for source in dict.fromkeys(inner_triggers.outer_sources if inner_triggers else ()):
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
            if step not in self.whole_hosts and step not in self.joined_resources:
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
            for name in self.host_limits.pop(step, ()):
                state.host_ways_to.pop(name, None)
            if step in state.system.activities and not has_own_rate(state.system.activities[step]):
                state.event_models[step] = DIVERGED_CAUSE

    def _update_step(self, step: str) -> bool:
        """Find the figures of one step anew, and return whether they changed."""
        if step in self.whole_hosts:
            return self._update_whole_host(step)
        if step in self.joined_resources:
            return self._update_joined_resources(step)
        if step in self.inner_triggers:
            return self._update_inner_core(step)
        return self._update_plain_resource(step) if step in self.resources else self._update_activity(step)

    def _update_plain_resource(self, step: str) -> bool:
        """Find the responses of a resource on which nothing fires anything else, and return whether any changed."""
        state = self.state
        old_ends = dict(state.work_ends)
        new_responses = {
            name: self._limit_response(name, _name_tier(self.resources[step], response))
            for name, response in self._find_responses(step).items()
        }
        changed = old_ends != state.work_ends or any(
            _has_changed(state.responses.get(name), response) for name, response in new_responses.items()
        )
        state.responses.update(new_responses)
        return changed

    def _update_activity(self, step: str) -> bool:
        """Find the event model of an activity, its response too where it has a core of its own."""
        state = self.state
        event_model = activation_model(state, step)
        is_same_model = step in state.responses and _is_unchanged(state.event_models.get(step), event_model)
        is_waiting = step not in self.resources_of and bool(state.system.activities[step].uses)
        if is_same_model and not is_waiting:
            return False
        state.event_models[step] = event_model
        if is_waiting:
            return self._update_dedicated_user(step) or not is_same_model
        # On no resource: a core of its own, so that its response rests on nothing but its own events.
        if step not in self.resources_of:
            state.responses[step] = find_dedicated_response(
                state.system, step, state.event_models, self.budget_of[step]
            )
        return True

    def _update_joined_resources(self, step: str) -> bool:
        """Find the bounds of joined resources, and return whether they changed."""

        def find_model(origin: Origin, entry_arc: FiringArc | None) -> EventStreams | UnknownCause:
            if entry_arc is None:
                return self.state.event_models[str(origin.key)]
            return arriving_model(self.state, entry_arc.arc)

        bounds = self.joined_resources[step].find_bounds(find_model, self.state.event_models, self.budget_of[step])
        changed = bounds != self.joined_bounds.get(step)
        self.joined_bounds[step] = bounds
        return changed

    def _limit_response(self, name: str, response: WorstResponse) -> WorstResponse:
        """Return a response, or the bound of all resources that are joined with its core, whichever is less."""
        bounds = [self.joined_bounds.get(step, {}).get(name) for step in self.joined_steps_of.get(name, ())]
        bound = min((each for each in bounds if each is not None), default=None)
        if bound is None or response.tier == "declared" or (response.value is not None and response.value <= bound):
            return response
        return WorstResponse(bound, response.tier)

    def _update_dedicated_user(self, step: str) -> bool:
        """Find the response of what has a core of its own and waits for resources, and return whether it changed."""
        own_core = ProcessingResource(step, None, 1, ((step,),), waits=True)
        response = find_waiting_responses(self.state, own_core, self.waiting_ids, self.budget_of[step])[step]
        response = self._limit_response(step, response)
        changed = _has_changed(self.state.responses.get(step), response)
        self.state.responses[step] = response
        return changed

    def _find_responses(self, step: str) -> dict[str, WorstResponse]:
        """Find the responses of a resource on which nothing fires anything else."""
        state, resource, budget = self.state, self.resources[step], self.budget_of[step]
        if resource.waits:
            return find_waiting_responses(state, resource, self.waiting_ids, budget)
        models = self._models_of(step) if step in self.roaming_ids else state.event_models
        queue, stale_ids = self.queues.get(step), self._stale_activities(step)
        # In a queue each response rests on all that waits there.
        effort = AnalysisEffort(budget, stale_ids if queue is None else None)
        responses = find_responses(state.system, resource, models, effort)
        if queue is not None:
            busy_period = max((each.value or 0 for each in responses.values() if each.tier != "declared"), default=0)
            bounds = queue.bound_responses(models.__getitem__, busy_period, budget)
            responses = {name: response.limit_to(bounds.get(name), queue.order) for name, response in responses.items()}
        return limit_responses(CoreResponses(responses, {}, {}), self._limits_of(step)).response_of

    def _limits_of(self, step: str) -> dict[str, HostLimit]:
        """Return what bounds the activities of a resource on its host as a whole."""
        return self.host_limits.get(f"whole {self.resources[step].host}", {})

    def _model_finder(
        self, step: str, entering_models: dict[int, EventStreams | UnknownCause]
    ) -> Callable[[Origin, FiringArc | None], EventStreams | UnknownCause]:
        """Return a look-up of event models of what enters a core, which notes those of arcs (by identity)."""

        def find_model(origin: Origin, entry_arc: FiringArc | None) -> EventStreams | UnknownCause:
            if entry_arc is None:
                name = str(origin.key)
                is_roaming = step in self.inner_cores and name in self.roaming_ids.get(step, ())
                return self._model_of_roaming(name) if is_roaming else self.state.event_models[name]
            key = id(entry_arc.arc)
            if key not in entering_models:
                entering_models[key] = arriving_model(self.state, entry_arc.arc)
            return entering_models[key]

        return find_model

    def _update_whole_host(self, step: str) -> bool:
        """Find how long a host taken as one core is busy, and return whether anything changed."""
        find_model = self._model_finder(step, {})
        core_responses = solve_inner_core(self.whole_hosts[step], find_model, self.budget_of[step])
        limits = list_host_limits(core_responses)
        changed = self.host_limits.get(step) != limits
        self.host_limits[step] = limits
        self.state.host_ways_to.update({name: core_responses.ways_to[name] for name in limits})
        return changed

    def _update_inner_core(self, step: str) -> bool:
        """Find the responses of a core on which activities fire one another, and return whether anything changed."""
        state, limits, budget = self.state, self._limits_of(step), self.budget_of[step]
        entering_models: dict[int, EventStreams | UnknownCause] = {}
        find_model = self._model_finder(step, entering_models)
        new_responses, new_ways, new_waits = (
            limit_responses(solve_inner_core(self.inner_cores[step], find_model, budget), limits)
            if step in self.inner_cores
            else solve_shared_cores(
                self.shared_cores[step], find_model, ({**state.responses, **state.work_ends}, limits), budget
            )
        )
        old_ends = dict(self.state.single_ends)
        if step in self.single_cores:
            self._limit_to_single_cores(step, new_responses, new_ways)
        new_responses = {
            name: self._limit_response(name, _name_tier(self.resources[step], response))
            for name, response in new_responses.items()
        }
        changed = old_ends != self.state.single_ends or any(
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
            state.event_models, {**state.responses, **responses, **state.work_ends}, self.budget_of[step]
        )
        for name in self.resources[step].members:
            self.state.single_ends.pop(name, None)
        self.state.single_ends.update(bounds)
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
        resource, event_models = self.resources[step], self._models_of(step)
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
    if not resource.undisturbed or resource.waits or response.tier not in {"host", "priorities", "executor"}:
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
