"""How the responses of an analysis come about, asked one by one: nothing of it is computed before somebody asks."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import field

from archgen.frozen import dataclass
from archgen.timing.figures.timing_values import UnknownCause
from archgen.timing.load.busy_windows import DivergedError
from archgen.timing.load.cascade_demand import CascadeDemand
from archgen.timing.load.core_paths import CorePaths
from archgen.timing.load.core_responses import CoreSolver
from archgen.timing.load.core_workings import InnerCoreWorkings, list_dedicated_workings, list_plain_workings
from archgen.timing.load.event_models import PropagationState, arriving_model
from archgen.timing.load.event_streams import EventStreams
from archgen.timing.load.inner_core import InnerCore, prepare_inner_core
from archgen.timing.load.inner_triggers import FiringArc, InnerTriggers, find_inner_triggers
from archgen.timing.load.level_cascades import Origin
from archgen.timing.load.run_ways import EntryWay
from archgen.timing.load.search_budgets import open_budget
from archgen.timing.load.shared_core_responses import SharedCoreSolver
from archgen.timing.load.shared_core_workings import SharedCoreWorkings
from archgen.timing.load.shared_cores import prepare_shared_cores
from archgen.timing.load.whole_hosts import HostLimit, find_whole_hosts, list_host_limits
from archgen.timing.load.work_terms import CountFormulas, FigureWorking, choose_working
from archgen.timing.system.core_placement import ProcessingResource, divide_resource, find_resources


@dataclass(frozen=True, slots=True)
class ResponseWorkings:
    """The workings of a state in which everything is found; cores are looked at when somebody asks for one of theirs."""

    state: PropagationState
    _resource_of: dict[str, ProcessingResource] = field(default_factory=dict)
    _core_workings: dict[str, InnerCoreWorkings | SharedCoreWorkings | None] = field(default_factory=dict)
    _host_workings: dict[str, InnerCoreWorkings | None] = field(default_factory=dict)

    def find_resource(self, name: str) -> ProcessingResource | None:
        """Return the cores on which an activity's response is found, None where it has one of its own."""
        if not self._resource_of:
            system = self.state.system
            for resource in (part for whole in find_resources(system) for part in divide_resource(system, whole)):
                self._resource_of.update(dict.fromkeys(resource.members, resource))
        return self._resource_of.get(name)

    def find_response(self, name: str) -> FigureWorking | None:
        """Return how the response of an activity comes about, None where there is none or it is declared."""
        response = self.state.responses[name]
        if response.value is None or response.tier in {"declared", "unknown"}:
            return None
        return choose_working(_until_diverged(self._list_responses(name)), response.value)

    def _list_responses(self, name: str) -> Iterator[FigureWorking]:
        resource = self.find_resource(name)
        if resource is None:
            return list_dedicated_workings(self.state, name)
        if self.state.responses[name].tier == "whole host":
            return self._list_whole_host(name, resource)
        workings = self._work_out_core(name, resource)
        return workings.list_responses(name) if workings else list_plain_workings(self.state, resource, name)

    def _list_whole_host(self, name: str, resource: ProcessingResource) -> Iterator[FigureWorking]:
        workings = self._work_out_host(resource.host or "")
        if workings is not None:
            yield from workings.list_way_responses(name, self.state.host_ways_to.get(name, ()))

    def _work_out_host(self, host: str) -> InnerCoreWorkings | None:
        """Let a host of several cores, taken as one, be solved again; None where that is not done."""
        system, key = self.state.system, f"host {host}"
        if key not in self._host_workings:
            resources = [part for whole in find_resources(system) for part in divide_resource(system, whole)]
            core = find_whole_hosts(system, self.state.triggers, resources).get(host)
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
        if resource.cores == 1:
            return self._solve_core(prepare_inner_core(system, resource, inner_triggers))
        cores = prepare_shared_cores(system, resource, inner_triggers)
        demand = CascadeDemand(cores.cascades, lambda origin: self._find_model(origin, cores.entering_arcs))
        known_bounds = (state.responses, self._find_limits(resource.host))
        shared_solver = SharedCoreSolver(CorePaths(cores), demand, known_bounds, open_budget(len(resource.members)))
        shared_solver.solve()
        return SharedCoreWorkings(shared_solver, state, CountFormulas(system.tick))

    def _solve_core(self, core: InnerCore) -> InnerCoreWorkings:
        core_solver = CoreSolver(
            core, lambda origin: self._find_model(origin, core.entering_arcs), open_budget(len(core.thread_of))
        )
        core_solver.solve()
        return InnerCoreWorkings(core_solver, self.state, CountFormulas(self.state.system.tick))

    def _find_model(self, origin: Origin, entering_arcs: tuple[FiringArc, ...]) -> EventStreams | UnknownCause:
        if origin.kind == "activity":
            return self.state.event_models[str(origin.key)]
        return arriving_model(self.state, entering_arcs[int(origin.key)].arc)


def _until_diverged(workings: Iterable[FigureWorking]) -> Iterator[FigureWorking]:
    """Yield workings up to one whose search does not end."""
    try:
        yield from workings
    except DivergedError:
        return
