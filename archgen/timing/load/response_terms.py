"""How the figures of an analysis come about, asked one by one: their solvers are asked again, and say what they found."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import chain

from archgen.frozen import replace
from archgen.timing.figures.timing_values import ResponseTier, UnknownCause
from archgen.timing.load.busy_windows import DivergedError, GroupBudgets, SearchBudget, WorstActivation
from archgen.timing.load.core_responses import CoreResponses, CoreSolver, open_core_solver
from archgen.timing.load.core_terms import (
    CoreTerms,
    FairTerms,
    explain_core_hold,
    explain_core_window,
    explain_queue_bound,
    explain_waiting_window,
)
from archgen.timing.load.level_cascades import EntryWay
from archgen.timing.load.load_system import list_written_priorities
from archgen.timing.load.propagation_state import PropagationState
from archgen.timing.load.queue_responses import QUEUE_TIERS
from archgen.timing.load.response_times import AnalysisEffort, find_lone_activation, find_responses
from archgen.timing.load.shared_core_terms import SharedCoreTerms
from archgen.timing.load.step_updates import StepUpdates
from archgen.timing.load.thread_work import CoreWindow, EventModels, WorstResponse, build_core_threads, find_work
from archgen.timing.load.transaction_windows import ENDLESS, TransactionWindows, explain_way_window
from archgen.timing.load.waiting_threads import WaitingWindow, find_served_window, list_waiting_windows
from archgen.timing.load.whole_hosts import list_host_limits
from archgen.timing.load.work_terms import (
    CountFormulas,
    EventCount,
    FigureWorking,
    WorkTerm,
    choose_working,
    group_terms,
)
from archgen.timing.system.core_placement import ProcessingResource, find_resources
from archgen.timing.system.thread_pools import works_in_order


class ResponseTerms:
    """The terms of a state in which everything is found; cores are looked at when somebody asks for one of theirs."""

    def __init__(self, written_state: PropagationState) -> None:
        """Prepare the cores as they were for the analysis."""
        # As processors see it, callbacks that store inputs included.
        self.state = state = written_state.load_state or written_state
        self.formulas = CountFormulas(state.system.tick)
        self._steps = StepUpdates(
            replace(state, run_arcs={}),
            find_resources(state.system),
            GroupBudgets(),
            list_written_priorities(written_state.system, state.system),
        )
        self._steps.state.single_ends = state.single_ends
        self._solved: dict[str, tuple[CoreTerms | SharedCoreTerms, dict[str, WorstResponse]]] = {}

    def find_response(self, name: str) -> FigureWorking | None:
        """Return how the response of an activity comes about, None where there is none or it is declared."""
        response = self.state.responses[name]
        if response.value is None or response.tier in {"declared", "unknown"}:
            return None
        workings = chain(_until_diverged(self._list_responses(name, response.tier)), self._list_joined(name))
        return choose_working(workings, response.value)

    def _list_responses(self, name: str, tier: ResponseTier) -> Iterator[FigureWorking]:
        step = self._find_step(name)
        if self._waits(name, step):
            yield from self._list_waiting(name, step)
        elif step is None:
            yield from self._list_lone(name)
        elif tier == "whole host":
            terms = self._solve_host(step)
            if isinstance(terms, CoreTerms):
                yield from terms.list_responses(name, self.state.host_ways_to.get(name, ()))
        elif tier == "fair":
            yield from self._open_fair(step).list_responses(name)
        elif step not in self._steps.inner_triggers:
            yield from self._list_plain(name, step, tier)
        else:
            terms, responses = self._solve(step)
            if isinstance(terms, SharedCoreTerms):
                yield from terms.list_responses(name)
                yield from self._list_single_cores(name, step, responses)
            elif tier in QUEUE_TIERS:
                yield explain_queue_bound(terms.solver.queue_bounds[name], self.formulas)
            else:
                yield from terms.list_responses(name, self.state.ways_to.get(name, ()))

    def _find_step(self, name: str) -> str | None:
        """Return the step that finds a response on some cores, None where it has a core of its own."""
        return next(iter(self._steps.resources_of.get(name, ())), None)

    def _solve(self, step: str) -> tuple[CoreTerms | SharedCoreTerms, dict[str, WorstResponse]]:
        """Let the solver of some cores, or of a host as a whole, do its work again, for what came out."""
        if step not in self._solved:
            if step not in self._steps.whole_hosts:
                self._solve_host(step)
            solver = self._steps.open_solver(step, {})
            responses = solver.solve()
            if step in self._steps.whole_hosts:
                self._steps.host_limits[step] = list_host_limits(responses)
            terms = (
                CoreTerms(solver, self.formulas)
                if isinstance(solver, CoreSolver)
                else SharedCoreTerms(solver, self.state, self.formulas)
            )
            self._solved[step] = terms, responses.response_of
        return self._solved[step]

    def _solve_host(self, step: str) -> CoreTerms | SharedCoreTerms | None:
        """Return the host of a step as a whole, None where it is not looked at as one."""
        whole_step = f"whole {self._steps.resources[step].host}"
        return self._solve(whole_step)[0] if whole_step in self._steps.whole_hosts else None

    def _open_fair(self, step: str) -> FairTerms:
        """Return how the figures of fair shares come about, from what was found in the end."""
        state, names = self.state, self._steps.resources[step].members
        ways_to = {name: state.ways_to[name] for name in names if name in state.ways_to}
        found = CoreResponses({name: state.responses[name] for name in names}, ways_to, {})
        solver = self._steps.open_fair_solver(self._steps.fair_cores[step], step, found, {})
        return FairTerms(solver, self.formulas)

    def _list_lone(self, name: str) -> Iterator[FigureWorking]:
        """Yield how the response of an activity on a core of its own was found."""
        system, work = self.state.system, find_work(self.state.system, name, self.state.event_models)
        if isinstance(work, UnknownCause):
            return
        in_order = works_in_order(system, system.activities[name])
        count, arrival, finish = find_lone_activation(work, SearchBudget(), in_order=in_order)
        events = EventCount(count, str(count)) if in_order else self.formulas.count_events(work.streams, finish)
        term = WorkTerm(((name, work.cost),), events, "its own")
        yield FigureWorking(finish - arrival, finish, group_terms([term]), count, arrival)

    def _waits(self, name: str, step: str | None) -> bool:
        return self.state.system.activities[name].suspends if step is None else self._steps.resources[step].waits

    def _list_waiting(self, name: str, step: str | None, *, any_order: bool = False) -> Iterator[FigureWorking]:
        """Yield how a bound of a thread that waits for resources was found."""
        own_core = ProcessingResource(name, None, 1, ((name,),), waits=True)
        resource = own_core if step is None else self._steps.resources[step]
        asked = self.state, resource, self._steps.waiting_ids
        windows = list_waiting_windows(*asked, SearchBudget(), any_order=any_order)
        if step in self._steps.fair_cores and not any_order:
            solver = self._open_fair(step).solver
            windows.append(find_served_window(self.state, resource, None, solver.serve_others, SearchBudget()))
        for window in windows:
            if isinstance(window, WaitingWindow):
                yield explain_waiting_window(window, self.state.system, self.formulas)

    def _list_joined(self, name: str) -> Iterator[FigureWorking]:
        """Yield how cores and the resources that their threads use, taken as one processor, bound an activity."""
        for step in self._steps.joined_steps_of.get(name, ()):
            joined, windows = self._steps.joined_resources[step], dict[str, CoreWindow]()
            workings: Iterable[FigureWorking] = ()
            if joined.core is not None:
                solver = open_core_solver(joined.core, self._steps.find_model, SearchBudget())
                ways = solver.solve().ways_to.get(name, ())
                workings = CoreTerms(solver, self.formulas).list_responses(name, ways)
            else:
                effort = AnalysisEffort(SearchBudget(), None, windows)
                find_responses(joined.system, joined.processor, self.state.event_models, effort)
                if name in windows:
                    workings = (explain_core_window(windows[name], name, self.formulas),)
            yield from (replace(working, is_joined=True) for working in workings)

    def _list_plain(self, name: str, step: str, tier: ResponseTier) -> Iterator[FigureWorking]:
        """Yield how a response was found on a core on which nothing fires anything else."""
        models, windows = self._steps.models_of(step), dict[str, CoreWindow]()
        effort = AnalysisEffort(SearchBudget(), None, windows)
        responses = find_responses(self.state.system, self._steps.resources[step], models, effort)
        if tier in QUEUE_TIERS:
            queue = self._steps.queues[step]
            bounds = self._steps.bound_queue(queue, models, responses, SearchBudget())
            yield explain_queue_bound(bounds[name], self.formulas)
        elif name in windows:
            yield explain_core_window(windows[name], name, self.formulas)

    def _list_single_cores(self, name: str, step: str, responses: dict[str, WorstResponse]) -> Iterator[FigureWorking]:
        """Yield how each core alone bounds what may run on several that others are pinned to."""
        state, single_cores = self.state, self._steps.single_cores.get(step)
        if single_cores is None:
            return
        unit = next(each for each in single_cores.resource.units if name in each)
        known_responses = {**state.responses, **responses, **state.work_ends}
        for core, models in single_cores.list_placements(unit, state.event_models, known_responses):
            windows: dict[str, CoreWindow] = {}
            find_responses(single_cores.system, core, models, AnalysisEffort(SearchBudget(), None, windows))
            if name in windows:
                working = explain_core_window(windows[name], name, self.formulas)
                yield replace(working, core=core.core_set[0])

    def find_storing_wait(self, name: str) -> FigureWorking | None:
        """Return how long what an activity only reads may wait to be stored, as work; None where that is not known."""
        wait = self.state.storing_waits.get(name)
        if wait is None or not wait.value:
            return None
        holds = _until_diverged(self._list_holds(name, wait.value, wait.tier))
        return choose_working(chain(holds, self._list_joined(name)), wait.value)

    def _list_holds(self, name: str, hold: int, tier: ResponseTier) -> Iterator[FigureWorking]:
        step = self._find_step(name)
        resource = ProcessingResource(name, None, 1, ((name,),)) if step is None else self._steps.resources[step]
        if self._waits(name, step):
            yield from self._list_waiting(name, step, any_order=True)
            return
        queue = self._steps.queues.get(step or "")
        in_rounds = queue.bound_storing(self.state.system, name) if queue is not None else None
        if in_rounds is not None:
            yield replace(explain_queue_bound(in_rounds, self.formulas), is_queue=False, is_hold=True)
        terms: CoreTerms | SharedCoreTerms | FairTerms | None = None
        if step is not None and tier == "fair":
            terms = self._open_fair(step)
        elif step is not None and tier == "whole host":
            terms = self._solve_host(step)
        elif step in self._steps.inner_triggers:
            terms = self._solve(step)[0]
        if terms is not None:
            yield from terms.list_holds(name, hold)
        else:
            models: EventModels = self.state.event_models if step is None else self._steps.models_of(step)
            threads = build_core_threads(self.state.system, resource, models)
            thread = next(each for each in threads if name in each.unit)
            window = CoreWindow(thread, threads, WorstActivation(0, 0, hold))
            yield explain_core_hold(window, name, hold, self.formulas)

    def open_windows(self, name: str) -> TransactionWindows | None:
        """Return what bounds the ways over hosts of an activity's group, with the delays that came out."""
        step = self._steps.transaction_step_of.get(name)
        if step is None:
            return None
        windows = self._steps.open_windows(step)
        for key in windows.delays:
            ways = self.state.transaction_ways.get(key[0])
            windows.delays[key] = (ways[key[1]].delay or 0) if ways else ENDLESS
        return windows

    def find_host_run(self, name: str) -> tuple[EntryWay, FigureWorking] | None:
        """Return the way over hosts to an activity that takes longest, and how its time comes about."""
        windows, ways = self.open_windows(name), self.state.transaction_ways.get(name, ())
        if windows is None or not ways:
            return None
        number = max(range(len(ways)), key=lambda each: ways[each].delay or 0)
        found = ((each, windows.find_delay(each)) for each in windows.list_windows((name, number)))
        # Place by place each response is explained for itself.
        window = next((each for each, delay in found if delay == ways[number].delay and each.steps), None)
        working = None if window is None else explain_way_window(window, windows, (name, number), self.formulas)
        return (ways[number], working) if working is not None and working.is_consistent else None

    def find_run(self, name: str) -> tuple[EntryWay, FigureWorking] | None:
        """Return the run to an activity that takes longest, and how its time comes about."""
        ways = [way for way in self.state.ways_to.get(name, ()) if way.delay is not None and len(way.steps) > 1]
        step = self._find_step(name)
        if not ways or step not in self._steps.inner_triggers:
            return None
        way, (terms, _) = max(ways, key=lambda each: each.delay or 0), self._solve(step)
        workings = terms.list_delays(name, way) if isinstance(terms, SharedCoreTerms) else terms.list_delays(way)
        if step in self._steps.fair_cores:
            workings = chain(self._open_fair(step).list_delays(way), workings)
        working = choose_working(_until_diverged(workings), way.delay or 0)
        return (way, working) if working else None


def _until_diverged(workings: Iterable[FigureWorking]) -> Iterator[FigureWorking]:
    """Yield workings up to one whose search does not end."""
    try:
        yield from workings
    except DivergedError:
        return
