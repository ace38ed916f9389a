"""The steps of a propagation: what each core, host and activity is looked at as, and what must be looked at again behind it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING

from archgen.frozen import replace
from archgen.timing.figures.timing_values import UnknownCause
from archgen.timing.load.busy_windows import GroupBudgets
from archgen.timing.load.event_streams import EventStreams
from archgen.timing.load.fair_cores import FairCores, prepare_fair_cores
from archgen.timing.load.inner_core import InnerCore, prepare_inner_core
from archgen.timing.load.inner_triggers import InnerTriggers, find_inner_triggers
from archgen.timing.load.joined_resources import JoinedResources, find_joined_resources
from archgen.timing.load.level_cascades import EntryWay, begin_way, find_run_arcs
from archgen.timing.load.propagation_state import PropagationState
from archgen.timing.load.queue_responses import find_core_queue
from archgen.timing.load.shared_cores import prepare_shared_cores
from archgen.timing.load.single_cores import SingleCores, find_single_cores
from archgen.timing.load.transactions import find_transactions
from archgen.timing.load.waiting_threads import model_roaming_work
from archgen.timing.load.whole_hosts import HostLimit, find_whole_hosts
from archgen.timing.system.core_placement import ProcessingResource, split_resources
from archgen.timing.system.timing_system import Arc, find_request, is_taken_answer
from archgen.timing.system.trigger_graph import has_own_rate

if TYPE_CHECKING:
    from archgen.timing.load.core_paths import CorePaths

_MAX_WAITING_ACTIVATIONS = 200
"""Activations of one activity that may come within its response, in a loop, before the loop is given up."""


class PropagationSteps:
    """The steps of one run. A step is an activity (find its event model) or a resource (find the responses of what it runs)."""

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
        self.fair_cores = {
            step: cores for step, resource in self.resources.items() if (cores := self._find_fair_cores(step, resource))
        }
        self.whole_hosts: dict[str, InnerCore] = {}
        self.resources_of_host: dict[str, list[str]] = {}
        self.host_limits: dict[str, dict[str, HostLimit]] = {}
        self._prepare_whole_hosts()
        self.transactions = {
            f"transactions {index}": each
            for index, each in enumerate(
                find_transactions(state.system, state.triggers, self.resources, self._list_firing_arcs())
            )
        }
        self.transaction_step_of = {name: step for step, each in self.transactions.items() for name in each.place_of}
        for each in self.transactions.values():
            state.transaction_arcs.update(find_run_arcs(each.inner_triggers, each.ways_to))
        self.window_inputs: dict[str, tuple[object, object]] = {}
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
        self.group_budgets = group_budgets
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
                # Imported here: most projects have no such host.
                from archgen.timing.load.core_paths import CorePaths

                cores = prepare_shared_cores(system, resource, inner_triggers)
                self.shared_cores[step] = CorePaths(cores)
                self.inner_triggers[step], ways_to = cores.inner_triggers, cores.ways_to
            self.state.run_arcs.update(find_run_arcs(self.inner_triggers[step], ways_to))

    def _find_fair_cores(self, step: str, resource: ProcessingResource) -> FairCores | None:
        """Return the cores of a resource as threads share them fairly, if they do."""
        ways_to: Mapping[str, tuple[EntryWay, ...]] = {name: (begin_way(name),) for name in resource.members}
        if step in self.inner_cores:
            ways_to = self.inner_cores[step].ways_to
        elif step in self.shared_cores:
            ways_to = self.shared_cores[step].cores.ways_to
        return prepare_fair_cores(self.state.system, resource, ways_to)

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

    def models_of(self, step: str) -> Mapping[str, EventStreams | UnknownCause]:
        """Return the event models as a resource sees them."""
        roaming_ids = self.roaming_ids.get(step)
        if not roaming_ids:
            return self.state.event_models  # not copied: there are as many resources as hosts
        return {**self.state.event_models, **{name: self._model_of_roaming(name) for name in roaming_ids}}

    def _model_of_roaming(self, name: str) -> EventStreams | UnknownCause:
        """Return the event model of work that another core may have begun."""
        return model_roaming_work(self.state, name, self.waiting_ids)

    def _find_successors(self) -> dict[str, list[str]]:
        """Return the steps that must be looked at again when a step has changed."""
        system = self.state.system
        successors: dict[str, list[str]] = {
            step: []
            for step in (
                *system.activities,
                *self.whole_hosts,
                *self.transactions,
                *self.resources,
                *self.joined_resources,
            )
        }
        self._add_resource_steps(successors)
        self._add_transaction_steps(successors)
        self._add_shared_uses(successors)
        self._add_joined_steps(successors)
        for arc in self._list_firing_arcs():
            successors[arc.source].append(arc.target)
            # What arrives rests on the source's response as well, and that is found by its resource.
            for step in self._response_steps(arc.source):
                successors[step].append(arc.target)
        return successors

    def _list_firing_arcs(self) -> Iterator[Arc]:
        """Yield the arcs on which event models rest."""
        for name, activity in self.state.system.activities.items():
            if not has_own_rate(activity) and name not in self.state.triggers.unknown_rates:
                yield from self._trigger_arcs(name)

    def _add_transaction_steps(self, successors: dict[str, list[str]]) -> None:
        """Add what transactions rest on, and the cores that they bound."""
        for step, transactions in self.transactions.items():
            # What has a core of its own is found with its event model.
            successors[step] += transactions.places
            for place in transactions.places:
                successors[place].append(step)
            for name in sorted(transactions.inner_triggers.entry_ids):
                successors[name].append(step)
            for name in transactions.outer_ids:
                for source_step in (name, *self._response_steps(name)):
                    successors[source_step].append(step)

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
        if name in self.transaction_step_of:
            yield self.transaction_step_of[name]

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
                # Answers come as often as their client asks.
                yield from (find_request(self.state.system, arc) for arc in arcs if is_taken_answer(arc))
        yield from triggers.requests[name]
