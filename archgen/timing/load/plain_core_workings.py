"""How a response comes about on a core on which nothing fires anything else, or on a core of its own."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from archgen.timing.figures.timing_values import UnknownCause
from archgen.timing.load.busy_windows import (
    NO_DEMAND,
    ActivityWork,
    DemandFunction,
    GrowingLoad,
    SearchBudget,
    add_demands,
    find_worst_activation,
    longest_busy_period,
    longest_wait_for_turn,
)
from archgen.timing.load.propagation_state import PropagationState
from archgen.timing.load.thread_work import EventModels, ThreadWork, build_thread, lower_crowded_threads
from archgen.timing.load.work_terms import (
    ONCE,
    CountFormulas,
    EventCount,
    FigureWorking,
    WorkTerm,
    group_terms,
)
from archgen.timing.system.core_placement import ProcessingResource
from archgen.timing.system.thread_pools import works_in_order
from archgen.timing.system.timing_system import TimingSystem

OWN_JOBS = "its own jobs before the one that comes too soon"


def list_plain_workings(
    system: TimingSystem, resource: ProcessingResource, models: EventModels, name: str
) -> Iterator[FigureWorking]:
    """Yield how the response of an activity may have been found on a core where each is looked at by itself."""
    thread, others = split_threads(system, resource, models, name)
    formulas, budget = CountFormulas(system.tick), SearchBudget()
    if any(each.cause for each in (thread, *others)):
        return
    load = GrowingLoad(work for each in others for work in each.works).demand_function()
    own_works = dict(zip(thread.unit, thread.works, strict=True))
    is_alone = thread.lowest_priority is not None or not others
    if len(thread.unit) == 1 and is_alone and own_works[name].streams and thread.in_order:
        count, arrival, finish = find_worst_activation(own_works[name], load, budget)
        own_term = WorkTerm(((name, own_works[name].cost),), EventCount(count, str(count)), "its own")
        # What takes no time waits for what comes at the very end as well: a tick more has it.
        closing_tick = 0 if own_works[name].cost else 1
        terms = [own_term, *_count_threads(formulas, others, finish + closing_tick)]
        yield FigureWorking(finish - arrival, finish, group_terms(terms), count, arrival)
        return
    # What works only at the start has no events, but takes its own time.
    start_costs = [(each, work.cost) for each, work in own_works.items() if not work.streams and work.cost]
    start_work = sum(cost for _, cost in start_costs)
    demand = add_demands(load, GrowingLoad(thread.works).demand_function())
    whole_demand = add_demands(demand, DemandFunction(lambda _: start_work))
    closing_tick = int(thread.takes_no_time)
    search = longest_wait_for_turn if closing_tick else longest_busy_period
    window = search(whole_demand, budget, start_work)
    terms = [
        *_count_threads(formulas, (thread, *others), window + closing_tick),
        WorkTerm(tuple(start_costs), ONCE, "at the start"),
    ]
    yield FigureWorking(window, window, group_terms(terms))


def find_plain_hold(
    system: TimingSystem, resource: ProcessingResource, models: EventModels, name: str, hold: int
) -> FigureWorking | None:
    """Return what holds up the storing of an activity's inputs for so long, on such a core; None where it is not known."""
    thread, others = split_threads(system, resource, models, name)
    if any(each.cause for each in (thread, *others)):
        return None
    formulas = CountFormulas(system.tick)
    terms = [
        WorkTerm(((name, work.cost),), formulas.count_held_jobs(work.streams, hold), OWN_JOBS)
        for each, work in zip(thread.unit, thread.works, strict=True)
        if each == name
    ]
    terms += [
        term
        for term in _count_threads(formulas, (thread, *others), hold)
        if all(each != name for each, _ in term.parts)
    ]
    return FigureWorking(hold, hold, group_terms(terms), is_hold=True)


def split_threads(
    system: TimingSystem, resource: ProcessingResource, models: EventModels, name: str
) -> tuple[ThreadWork, list[ThreadWork]]:
    """Return the thread of an activity on a core, and the others there for which it may have to wait."""
    threads = lower_crowded_threads(
        system,
        [build_thread(system, unit, models) for unit in (*resource.units, *resource.foreign_units)],
        models,
    )
    thread = next(each for each in threads if name in each.unit)
    level = thread.lowest_priority
    others = [
        each
        for each in threads
        if each is not thread
        and (level is None or (each.highest_priority is not None and each.highest_priority >= level))
    ]
    return thread, others


def list_dedicated_workings(state: PropagationState, name: str) -> Iterator[FigureWorking]:
    """Yield how the response of an activity on a core of its own was found."""
    streams, cost = state.event_models[name], state.system.activities[name].wcet
    if not isinstance(streams, UnknownCause) and cost is not None:
        work = ActivityWork(cost, streams)
        if works_in_order(state.system, state.system.activities[name]):
            count, arrival, finish = find_worst_activation(work, NO_DEMAND, SearchBudget())
            term = WorkTerm(((name, cost),), EventCount(count, str(count)), "its own")
            yield FigureWorking(finish - arrival, finish, group_terms([term]), count, arrival)
            return
        window = longest_busy_period(GrowingLoad((work,)).demand_function(), SearchBudget())
        events = CountFormulas(state.system.tick).count_events(streams, window)
        yield FigureWorking(window, window, group_terms([WorkTerm(((name, cost),), events, "its own")]))


def _count_threads(formulas: CountFormulas, threads: Iterable[ThreadWork], window: int) -> Iterator[WorkTerm]:
    for thread in threads:
        for name, work in zip(thread.unit, thread.works, strict=True):
            if work.streams and work.cost:
                yield WorkTerm(((name, work.cost),), formulas.count_events(work.streams, window))
