"""How the responses of an analysis come about, asked one by one: nothing of it is computed before somebody asks."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import field, replace

from archgen.frozen import dataclass
from archgen.timing.figures.response_tier import ResponseTier
from archgen.timing.figures.timing_values import UnknownCause
from archgen.timing.load.busy_windows import DivergedError
from archgen.timing.load.cascade_demand import CascadeDemand
from archgen.timing.load.core_paths import CorePaths
from archgen.timing.load.core_responses import CoreSolver
from archgen.timing.load.core_workings import InnerCoreWorkings
from archgen.timing.load.event_models import arriving_model
from archgen.timing.load.event_streams import EventStreams
from archgen.timing.load.inner_core import InnerCore, prepare_inner_core
from archgen.timing.load.inner_triggers import FiringArc, InnerTriggers, find_inner_triggers
from archgen.timing.load.level_cascades import EventOrigin
from archgen.timing.load.load_system import list_written_priorities
from archgen.timing.load.ordered_cores import OrderedCore
from archgen.timing.load.plain_core_workings import find_plain_hold, list_dedicated_workings, list_plain_workings
from archgen.timing.load.propagation_state import PropagationState
from archgen.timing.load.queue_responses import QUEUE_TIERS, find_core_queue
from archgen.timing.load.queue_workings import list_queue_workings
from archgen.timing.load.run_ways import EntryWay
from archgen.timing.load.search_budgets import open_budget
from archgen.timing.load.shared_core_responses import SharedCoreSolver
from archgen.timing.load.shared_core_workings import SharedCoreWorkings
from archgen.timing.load.shared_cores import prepare_shared_cores
from archgen.timing.load.single_cores import SingleCores, find_single_cores
from archgen.timing.load.waiting_threads import model_roaming_work
from archgen.timing.load.whole_hosts import HostLimit, find_whole_hosts, list_host_limits
from archgen.timing.load.work_terms import CountFormulas, FigureWorking, choose_working
from archgen.timing.system.core_placement import ProcessingResource, find_resources
from archgen.timing.system.resource_division import split_resources


@dataclass(frozen=True, slots=True)
class ResponseWorkings:
    """The workings of a state in which everything is found; cores are looked at when somebody asks for one of theirs."""

    written_state: PropagationState
    _resources: dict[str, ProcessingResource] = field(default_factory=dict)
    _step_of: dict[str, str] = field(default_factory=dict)
    _waiting_ids: set[str] = field(default_factory=set)
    _single_cores: dict[str, SingleCores] = field(default_factory=dict)
    _core_workings: dict[str, InnerCoreWorkings | SharedCoreWorkings | None] = field(default_factory=dict)
    _host_workings: dict[str, InnerCoreWorkings | None] = field(default_factory=dict)

    @property
    def state(self) -> PropagationState:
        """Return the state as processors see it, callbacks that store inputs included."""
        return self.written_state.load_state or self.written_state

    def find_resource(self, name: str) -> ProcessingResource | None:
        """Return the cores on which an activity's response is found, None where it has one of its own."""
        self._list_resources()
        step = self._step_of.get(name)
        return None if step is None else self._resources[step]

    def _list_resources(self) -> None:
        """Look up all resources, the first time."""
        if self._resources:
            return
        system = self.state.system
        for index, resource in enumerate(split_resources(system, find_resources(system))):
            self._resources[f"{index}"] = resource
            self._step_of.update(dict.fromkeys(resource.members, f"{index}"))
            if resource.waits:
                self._waiting_ids.update(resource.members)
        shared_steps = [step for step, resource in self._resources.items() if self._is_shared(resource)]
        self._single_cores.update(find_single_cores(system, self._resources, shared_steps, self._waiting_ids))

    def _is_shared(self, resource: ProcessingResource) -> bool:
        """Whether each core of a resource may be looked at by itself: nothing there fires anything else there."""
        if resource.cores == 1 or not resource.foreign_units:
            return False
        inner_triggers = find_inner_triggers(self.state.system, self.state.triggers, resource)
        return inner_triggers is not None and not any(inner_triggers.inner_arcs.values())

    def find_response(self, name: str) -> FigureWorking | None:
        """Return how the response of an activity comes about, None where there is none or it is declared."""
        response = self.state.responses[name]
        if response.value is None or response.tier in {"declared", "unknown"}:
            return None
        return choose_working(_until_diverged(self._list_responses(name)), response.value)

    def _list_responses(self, name: str) -> Iterator[FigureWorking]:
        resource = self.find_resource(name)
        if resource is None:
            yield from list_dedicated_workings(self.state, name)
            return
        if self.state.responses[name].tier == "whole host":
            yield from self._list_whole_host(name, resource)
            return
        if self.state.responses[name].tier in QUEUE_TIERS:
            yield from self._list_queue(name, resource)
            return
        workings = self._work_out_core(name, resource)
        if workings is None:
            yield from list_plain_workings(self.state.system, resource, self._models_on(resource), name)
            return
        yield from workings.list_responses(name)
        yield from self._list_single_cores(name, workings)

    def _list_queue(self, name: str, resource: ProcessingResource) -> Iterator[FigureWorking]:
        """Yield how the order that is written for a queue bounds a response."""
        state, workings = self.state, self._work_out_core(name, resource)
        priorities = list_written_priorities(self.written_state.system, state.system)
        queue, response = find_core_queue(state.system, resource, priorities), state.responses[name].value
        if queue is None or response is None or isinstance(workings, SharedCoreWorkings):
            return
        model_of = state.event_models.__getitem__
        if workings is not None:
            solver = workings.solver
            # A solver does its work once.
            ways_to = CoreSolver(solver.core, solver.find_model, solver.budget).solve().ways_to
            model_of = OrderedCore(queue, solver.core.inner_triggers, solver.find_model, ways_to).find_activation_model
        yield from list_queue_workings(queue, model_of, name, response, CountFormulas(state.system.tick))

    def find_storing_wait(self, name: str) -> FigureWorking | None:
        """Return how long what an activity only reads may wait to be stored, as work; None where that is not known."""
        wait = self.state.storing_waits.get(name)
        if wait is None or not wait.value:
            return None
        return choose_working(_until_diverged(self._list_holds(name, wait.value, wait.tier)), wait.value)

    def _list_holds(self, name: str, hold: int, tier: ResponseTier) -> Iterator[FigureWorking]:
        resource = self.find_resource(name) or ProcessingResource(name, None, 1, ((name,),))
        workings = self._work_out_core(name, resource) if name in self._step_of else None
        if resource.waits or self.state.system.activities[name].uses:
            return
        if tier == "whole host":
            workings = self._work_out_host(resource.host or "")
        if workings is not None:
            yield from workings.list_holds(name, hold)
            return
        models = self._models_on(resource)
        working = find_plain_hold(self.state.system, resource, models, name, hold)
        if working is not None:
            yield working

    def _models_on(self, resource: ProcessingResource) -> dict[str, EventStreams | UnknownCause]:
        """Return the event models as a resource sees them."""
        state = self.state
        roaming_ids = [name for unit in resource.roaming_units for name in unit]
        return {
            **state.event_models,
            **{name: model_roaming_work(state, name, self._waiting_ids) for name in roaming_ids},
        }

    def _list_single_cores(
        self, name: str, workings: InnerCoreWorkings | SharedCoreWorkings
    ) -> Iterator[FigureWorking]:
        """Yield how each core alone bounds what may run on several that others are pinned to."""
        state, single_cores = self.state, self._single_cores.get(self._step_of[name])
        if single_cores is None or not isinstance(workings, SharedCoreWorkings):
            return
        responses = {**state.responses, **workings.responses, **state.work_ends}
        for core, models in single_cores.list_placements(name, state.event_models, responses):
            for working in list_plain_workings(single_cores.system, core, models, name):
                yield replace(working, core=core.core_set[0])

    def _list_whole_host(self, name: str, resource: ProcessingResource) -> Iterator[FigureWorking]:
        workings = self._work_out_host(resource.host or "")
        if workings is not None:
            yield from workings.list_way_responses(name, self.state.host_ways_to.get(name, ()))

    def _work_out_host(self, host: str) -> InnerCoreWorkings | None:
        """Let a host of several cores, taken as one, be solved again; None where that is not done."""
        system, key = self.state.system, f"host {host}"
        if key not in self._host_workings:
            self._list_resources()
            core = find_whole_hosts(system, self.state.triggers, self._resources.values()).get(host)
            self._host_workings[key] = None if core is None else self._solve_core(core)
        return self._host_workings[key]

    def _find_limits(self, host: str | None) -> dict[str, HostLimit]:
        workings = self._work_out_host(host) if host is not None else None
        return list_host_limits(workings.solver.solve()) if workings is not None else {}

    def find_run(self, name: str) -> tuple[EntryWay, FigureWorking] | None:
        """Return the run to an activity that takes longest, and how its time comes about."""
        ways = [way for way in self.state.ways_to.get(name, ()) if way.delay is not None and len(way.steps) > 1]
        resource = self.find_resource(name)
        if not ways or resource is None:
            return None
        way = max(ways, key=lambda each: each.delay or 0)
        workings = self._work_out_core(name, resource)
        if workings is None:
            return None
        working = choose_working(_until_diverged(workings.list_delays(name, way)), way.delay or 0)
        return (way, working) if working else None

    def _work_out_core(self, name: str, resource: ProcessingResource) -> InnerCoreWorkings | SharedCoreWorkings | None:
        """Let the solver of some cores do its work again, for the event models that came out."""
        if name not in self._core_workings:
            inner_triggers = find_inner_triggers(self.state.system, self.state.triggers, resource)
            workings = None if inner_triggers is None else self._solve_again(resource, inner_triggers)
            self._core_workings.update(dict.fromkeys(resource.members, workings))
        return self._core_workings[name]

    def _solve_again(
        self, resource: ProcessingResource, inner_triggers: InnerTriggers
    ) -> InnerCoreWorkings | SharedCoreWorkings:
        state, system = self.state, self.state.system
        roaming_ids = frozenset(name for unit in resource.roaming_units for name in unit)
        if resource.cores == 1:
            return self._solve_core(prepare_inner_core(system, resource, inner_triggers), roaming_ids)
        cores = prepare_shared_cores(system, resource, inner_triggers)
        demand = CascadeDemand(cores.cascades, lambda origin: self._find_model(origin, cores.entering_arcs))
        known_bounds = ({**state.responses, **state.work_ends}, self._find_limits(resource.host))
        shared_solver = SharedCoreSolver(CorePaths(cores), demand, known_bounds, open_budget(len(resource.members)))
        responses = shared_solver.solve().response_of
        return SharedCoreWorkings(shared_solver, state, CountFormulas(system.tick), responses)

    def _solve_core(self, core: InnerCore, roaming_ids: frozenset[str] = frozenset()) -> InnerCoreWorkings:
        core_solver = CoreSolver(
            core,
            lambda origin: self._find_model(origin, core.entering_arcs, roaming_ids),
            open_budget(len(core.thread_of)),
        )
        core_solver.solve()
        return InnerCoreWorkings(core_solver, self.state, CountFormulas(self.state.system.tick))

    def _find_model(
        self, origin: EventOrigin, entering_arcs: tuple[FiringArc, ...], roaming_ids: frozenset[str] = frozenset()
    ) -> EventStreams | UnknownCause:
        if origin.kind == "activity" and origin.key in roaming_ids:
            return model_roaming_work(self.state, str(origin.key), self._waiting_ids)
        if origin.kind == "activity":
            return self.state.event_models[str(origin.key)]
        return arriving_model(self.state, entering_arcs[int(origin.key)].arc)


def _until_diverged(workings: Iterable[FigureWorking]) -> Iterator[FigureWorking]:
    """Yield workings up to one whose search does not end."""
    try:
        yield from workings
    except DivergedError:
        return
