"""One step of a propagation at a time: the event model of an activity, or the responses of what a resource runs."""

from __future__ import annotations

from collections import ChainMap
from collections.abc import Mapping
from typing import TYPE_CHECKING

from archgen.timing.figures.timing_values import UnknownCause, is_same_cause
from archgen.timing.load.busy_windows import SearchBudget
from archgen.timing.load.core_responses import CoreResponses, CoreSolver, open_core_solver
from archgen.timing.load.event_models import activation_model, arriving_model
from archgen.timing.load.event_streams import EventStreams
from archgen.timing.load.fair_cores import FairCores
from archgen.timing.load.fair_shares import FAIR_TERMS, FairSolver
from archgen.timing.load.inner_triggers import FiringArc
from archgen.timing.load.level_cascades import ArcModelFinder, EntryWay, EventOrigin, look_up_arcs
from archgen.timing.load.propagation_steps import PropagationSteps
from archgen.timing.load.queue_orders import QueueBound
from archgen.timing.load.queue_responses import CoreQueue
from archgen.timing.load.response_times import AnalysisEffort, find_dedicated_response, find_responses
from archgen.timing.load.single_cores import delay_by_response
from archgen.timing.load.thread_work import EventModels, WorstResponse
from archgen.timing.load.transaction_windows import ENDLESS, TransactionWindows
from archgen.timing.load.waiting_threads import find_waiting_responses
from archgen.timing.load.whole_hosts import HostLimit, limit_responses, list_host_limits
from archgen.timing.system.core_placement import ProcessingResource

if TYPE_CHECKING:
    from archgen.timing.load.shared_core_responses import SharedCoreSolver


class StepUpdates(PropagationSteps):
    """Finds the figures of single steps anew."""

    def _update_step(self, step: str) -> bool:
        """Find the figures of one step anew, and return whether they changed."""
        if step in self.whole_hosts:
            return self._update_whole_host(step)
        if step in self.transactions:
            return self._update_transactions(step)
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
            for name, response in self._limit_to_fair(
                step, CoreResponses(self._find_responses(step), {}, {}), {}
            ).response_of.items()
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
        is_waiting = step not in self.resources_of and state.system.activities[step].suspends
        if is_same_model and not is_waiting and step not in self.transaction_step_of:
            return False
        state.event_models[step] = event_model
        if is_waiting:
            return self._update_dedicated_user(step) or not is_same_model
        if step in self.resources_of:
            return not is_same_model
        # On no resource: a core of its own, so that its response rests on its own events, and on the ways that lead to it.
        response = find_dedicated_response(state.system, step, state.event_models, self.budget_of[step])
        found = limit_responses(CoreResponses({step: response}, {}, {}), self._limits_of(step)).response_of[step]
        changed = not is_same_model or _has_changed(state.responses.get(step), found)
        state.responses[step] = found
        return changed

    def _update_joined_resources(self, step: str) -> bool:
        """Find the bounds of joined resources, and return whether they changed."""
        bounds = self.joined_resources[step].find_bounds(self.find_model, self.state.event_models, self.budget_of[step])
        changed = bounds != self.joined_bounds.get(step)
        self.joined_bounds[step] = bounds
        return changed

    def find_model(self, origin: EventOrigin, entry_arc: FiringArc | None) -> EventStreams | UnknownCause:
        """Return the event model of what enters joined resources."""
        if entry_arc is None:
            return self.state.event_models[str(origin.key)]
        return arriving_model(self.state, entry_arc.arc)

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
            fair, nothing = self.fair_cores.get(step), CoreResponses({}, {}, {})
            serve_others = self.open_fair_solver(fair, step, nothing, {}).serve_others if fair else None
            return find_waiting_responses(state, resource, self.waiting_ids, budget, serve_others)
        models = self.models_of(step)
        queue, stale_ids = self.queues.get(step), self._stale_activities(step)
        # In a queue each response rests on all that waits there.
        effort = AnalysisEffort(budget, stale_ids if queue is None else None)
        responses = find_responses(state.system, resource, models, effort)
        if queue is not None:
            for name, bound in self.bound_queue(queue, models, responses, budget).items():
                responses[name] = responses[name].limit_to(bound.response, queue.order)
        return limit_responses(CoreResponses(responses, {}, {}), self._limits_of(step)).response_of

    @staticmethod
    def bound_queue(
        queue: CoreQueue, models: EventModels, responses: Mapping[str, WorstResponse], budget: SearchBudget
    ) -> dict[str, QueueBound]:
        """Return what the order of a queue makes of the responses in any order."""
        values = [each.value for each in responses.values() if each.tier != "declared"]
        if None in values and not queue.works_in_rounds:
            return {}
        busy_period = max((value or 0 for value in values), default=0)
        return queue.bound_responses(models.__getitem__, busy_period, budget)

    def _limits_of(self, step: str) -> dict[str, HostLimit]:
        """Return what bounds the activities of a resource on its host as a whole, and on ways over hosts."""
        resource = self.resources.get(step)
        limits = dict(self.host_limits.get(f"whole {resource.host}", {})) if resource else {}
        for name in resource.members if resource else (step,):
            ways = self.state.transaction_ways.get(name)
            response = max((way.delay or 0) - way.best_before for way in ways) if ways else 0
            # What was found place by place is found again there.
            is_known = any(
                way.steps == (name,) and way.delay == response for way in self.state.place_ways.get(name, ())
            )
            if ways and not is_known:
                limit = HostLimit(response, None, None, "whole way")
                limits[name] = limits[name].limit_to(limit) if name in limits else limit
        return limits

    def _model_finder(self, step: str, entering_models: dict[int, EventStreams | UnknownCause]) -> ArcModelFinder:
        """Return a look-up of event models of what enters a core, which notes those of arcs (by identity)."""

        def find_model(origin: EventOrigin, entry_arc: FiringArc | None) -> EventStreams | UnknownCause:
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
        core_responses = self.open_solver(step, {}).solve()
        limits = list_host_limits(core_responses)
        changed = self.host_limits.get(step) != limits
        self.host_limits[step] = limits
        self.state.host_ways_to.update({name: core_responses.ways_to[name] for name in limits})
        return changed

    def _update_transactions(self, step: str) -> bool:
        """Find how long the ways of transactions take, and return whether anything changed."""
        state, transactions = self.state, self.transactions[step]
        if state.settled_ids.isdisjoint(transactions.place_of):
            return False
        windows = self.open_windows(step)
        inputs = (windows.models, windows.foreign_models)
        if self.window_inputs.get(step) == inputs:
            return False
        self.window_inputs[step] = inputs
        windows.solve()
        old_ways = {name: state.transaction_ways.pop(name, None) for name in transactions.ways_to}
        for name, ways in transactions.ways_to.items():
            delays = [windows.delays[name, number] for number in range(len(ways))]
            if max(delays) < ENDLESS and name not in transactions.inner_triggers.silent_ids:
                state.transaction_ways[name] = tuple(
                    way._replace(delay=delay) for way, delay in zip(ways, delays, strict=True)
                )
        return any(state.transaction_ways.get(name) != ways for name, ways in old_ways.items())

    def open_windows(self, step: str) -> TransactionWindows:
        """Return what finds how long the ways of transactions take."""
        transactions = self.transactions[step]
        find_entering = look_up_arcs(self._model_finder(step, {}), transactions.entering_arcs)
        budget = self.group_budgets.open_transactions(step, len(transactions.paths))
        return TransactionWindows(transactions, find_entering, self._find_foreign_model, self.state.place_ways, budget)

    def _find_foreign_model(self, step: str, name: str) -> EventStreams | UnknownCause:
        """Return the event model of what works at a place from elsewhere, as it may have come up to its response ago."""
        model = self.models_of(step)[name]
        if name in self.roaming_ids.get(step, ()):
            return model
        return delay_by_response(model, self.state.responses.get(name))

    def open_solver(
        self, step: str, entering_models: dict[int, EventStreams | UnknownCause]
    ) -> CoreSolver | SharedCoreSolver:
        """Return what finds the responses of a core, or several, on which activities fire one another, or of a host."""
        find_model, budget = self._model_finder(step, entering_models), self.budget_of[step]
        if step in self.shared_cores:
            from archgen.timing.load.shared_core_responses import open_shared_solver

            known_bounds = ChainMap(self.state.work_ends, self.state.responses)
            return open_shared_solver(
                self.shared_cores[step], find_model, (known_bounds, self._limits_of(step)), budget
            )
        return open_core_solver(self.whole_hosts.get(step) or self.inner_cores[step], find_model, budget)

    def _update_inner_core(self, step: str) -> bool:
        """Find the responses of a core on which activities fire one another, and return whether anything changed."""
        state = self.state
        entering_models: dict[int, EventStreams | UnknownCause] = {}
        solved = self.open_solver(step, entering_models).solve()
        found = limit_responses(solved, self._limits_of(step)) if step in self.inner_cores else solved
        new_responses, new_ways, new_waits = self._limit_to_fair(step, found, entering_models)
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

    def _limit_to_fair(
        self, step: str, found: CoreResponses, entering_models: dict[int, EventStreams | UnknownCause]
    ) -> CoreResponses:
        """Limit what was found in any order to what it is on cores that are shared fairly."""
        cores = self.fair_cores.get(step)
        if cores is None or self.resources[step].waits:
            return found
        solver = self.open_fair_solver(cores, step, found, entering_models)
        solver.solve()
        for name, wait in found.storing_waits.items():
            hold = solver.find_hold(name, wait.value)
            if hold is not None and (wait.value is None or hold < wait.value):
                found.storing_waits[name] = WorstResponse(hold, "fair")
        return found

    def open_fair_solver(
        self,
        cores: FairCores,
        step: str,
        found: CoreResponses,
        entering_models: dict[int, EventStreams | UnknownCause],
    ) -> FairSolver:
        """Return what finds the responses of threads that share cores fairly."""
        find_model, inner_triggers = self._model_finder(step, entering_models), self.inner_triggers.get(step)

        def find_way_model(way: EntryWay) -> EventStreams | None:
            # What comes through a gate of a core has no event model of its own there.
            is_behind_gate = (
                inner_triggers is not None and way.entry_arc is None and way.entry.key not in inner_triggers.entry_ids
            )
            model = UnknownCause() if is_behind_gate else find_model(way.entry, way.entry_arc)
            return None if isinstance(model, UnknownCause) else model

        known_responses = ChainMap(self.state.work_ends, self.state.responses)
        budget = self.budget_of[step].open_part(FAIR_TERMS)
        return FairSolver(cores, find_way_model, self.state.event_models, found, known_responses, budget)

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
        resource, event_models = self.resources[step], self.models_of(step)
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
