"""Responses of threads that wait for resources (GPUs): they keep the thread, and leave the core.

From the last instant at which nothing of the thread was under way, until an activation has ended, at each moment one of
its activations waits for a resource or uses it, or runs, or is held up by others that are as urgent while they run on all
cores. The first takes as long as all waits of what comes in that time, the second its execution times. The third is the
work of the others: where they never wait themselves and there is one core, that instant is one at which none of them had
any, so that it is what comes in that time; else it is also what came up to their response before. How the execution time
is divided by the waits does not matter.

To all others on the core such a thread is work that comes up to its response later than it might. So nothing in between
is a cascade: what it fires comes from outside.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from types import MappingProxyType

from archgen.frozen import NamedTuple
from archgen.timing.figures.timing_values import ResponseTier, UnknownCause, sum_fractions, unite_causes
from archgen.timing.load.busy_windows import (
    ActivityWork,
    DemandFunction,
    DivergedError,
    GrowingLoad,
    SearchBudget,
    WorstActivation,
    find_worst_activation,
    longest_busy_period,
    longest_wait_for_turn,
)
from archgen.timing.load.event_streams import EventStreams, delay_streams
from archgen.timing.load.inner_core import urgency_of
from archgen.timing.load.propagation_state import PropagationState
from archgen.timing.load.resource_waits import Rivals, find_load, find_rivals, find_use_times
from archgen.timing.load.single_cores import delay_by_response
from archgen.timing.load.thread_work import (
    DIVERGED_CAUSE,
    OVERLOAD_CAUSE,
    ThreadWork,
    WorstResponse,
    build_thread,
    find_work,
    lower_crowded_threads,
    work_utilisation,
)
from archgen.timing.system.core_placement import PREEMPTIVE_ORDERS, ProcessingResource
from archgen.timing.system.thread_pools import ThreadUnit, find_pool, find_serial_process, is_reentrant, works_in_order
from archgen.timing.system.timing_system import TimingSystem

ServedWork = Callable[[int | None], "Interference | None"]
"""Returns how long others may be served before a thread that waits; None where that is not known, or not below a limit."""


def find_waiting_responses(
    state: PropagationState,
    resource: ProcessingResource,
    waiting_ids: Collection[str],
    budget: SearchBudget,
    serve_others: ServedWork | None = None,
) -> dict[str, WorstResponse]:
    """Return the responses of a thread that waits for resources; everything else there is foreign to it.

    On cores that are shared fairly, `serve_others` says what others are served before it.
    """
    system, unit = state.system, resource.units[0]
    response = _bound_unit(state, resource, waiting_ids, budget)
    if serve_others is not None:
        response = _limit_to_served(state, resource, response, serve_others, budget)
    responses: dict[str, WorstResponse] = {}
    for name in unit:
        activity = system.activities[name]
        responses[name] = response
        if activity.response is not None:
            # What is declared may hold a wait for the world outside; to others it matters when the work is done.
            responses[name] = WorstResponse(activity.response, "declared")
            is_earlier = response.value is not None and response.value <= activity.response
            state.work_ends[name] = response if is_earlier else responses[name]
        elif activity.wcet is None:
            responses[name] = WorstResponse(None, "unknown", unite_causes((UnknownCause((name,)), response.cause)))
    return responses


def _limit_to_served(
    state: PropagationState,
    resource: ProcessingResource,
    response: WorstResponse,
    serve_others: ServedWork,
    budget: SearchBudget,
) -> WorstResponse:
    """Return a response, or what it is with what others are served before the thread and a lead more for each wait."""
    window = find_served_window(state, resource, response.value, serve_others, budget)
    if isinstance(window, UnknownCause) or (response.value is not None and response.value <= window.worst.response):
        return response
    return WorstResponse(window.worst.response, "fair")


def find_served_window(
    state: PropagationState,
    resource: ProcessingResource,
    known_bound: int | None,
    serve_others: ServedWork,
    budget: SearchBudget,
) -> WaitingWindow | UnknownCause:
    """Return the window of a thread on cores that are shared fairly, or why none was looked for that is below a bound."""
    own_ids = _list_own(state.system, resource)
    waits = OVERLOAD_CAUSE if _fills_resource(state, own_ids) else _waits_by_use(state, own_ids, budget)
    if isinstance(waits, UnknownCause):
        return waits
    limit = None if known_bound is None else known_bound - max(work.cost for work in waits.works)
    interference = serve_others(limit)
    if interference is None:
        return DIVERGED_CAUSE
    is_in_order = len(own_ids) == 1 and works_in_order(state.system, state.system.activities[own_ids[0]])
    return _bound_with(waits, interference, budget, in_order=is_in_order)


def find_waiting_stores(
    state: PropagationState,
    resource: ProcessingResource,
    waiting_ids: Collection[str],
    reader_ids: Iterable[str],
    budget: SearchBudget,
) -> dict[str, WorstResponse]:
    """Return how long a message may wait to be stored in a thread that waits for resources: as long as it is busy."""
    wait = _bound_unit(state, resource, waiting_ids, budget, any_order=True)
    return dict.fromkeys(reader_ids, wait)


def delayed_model(
    state: PropagationState, name: str, waiting_ids: Collection[str], *, always: bool = False
) -> EventStreams | UnknownCause:
    """Return the event model of an activity's work as others on its core see it: up to its response later if it waits."""
    model = state.event_models[name]
    if isinstance(model, UnknownCause) or not model or not (always or name in waiting_ids):
        return model
    response = state.work_ends.get(name, state.responses.get(name))
    if response is None or response.value is None:
        # That a thread has too much to do does not say so of its core.
        return DIVERGED_CAUSE if response is None or not response.cause.missing else response.cause
    return delay_streams(model, response.value)


def model_roaming_work(state: PropagationState, name: str, waiting_ids: Collection[str]) -> EventStreams | UnknownCause:
    """Return the event model of work that another core may have begun."""
    if name in waiting_ids:
        return delayed_model(state, name, waiting_ids)
    return delay_by_response(state.event_models[name], state.responses.get(name), state.single_ends.get(name))


def _bound_unit(
    state: PropagationState,
    resource: ProcessingResource,
    waiting_ids: Collection[str],
    budget: SearchBudget,
    *,
    any_order: bool = False,
) -> WorstResponse:
    """Bound the response of all activities of a thread."""
    windows = list_waiting_windows(state, resource, waiting_ids, budget, any_order=any_order)
    tier = _name_tier(state.system, resource)
    bounds = [window.worst.response for window in windows if isinstance(window, WaitingWindow)]
    if bounds:
        return WorstResponse(min(bounds), tier)
    return WorstResponse(None, tier, unite_causes([window for window in windows if isinstance(window, UnknownCause)]))


def list_waiting_windows(
    state: PropagationState,
    resource: ProcessingResource,
    waiting_ids: Collection[str],
    budget: SearchBudget,
    *,
    any_order: bool = False,
) -> list[WaitingWindow | UnknownCause]:
    """Return the windows that bound all activities of a thread, or why there is none."""
    system = state.system
    own_ids = _list_own(system, resource)
    if _fills_resource(state, own_ids) or (len(own_ids) == len(resource.units[0]) and _fills_thread(state, own_ids)):
        return [OVERLOAD_CAUSE]
    others = list(_list_others(state, resource, own_ids, waiting_ids))
    if causes := [thread.cause for thread in others if thread.cause]:
        return list(causes)
    mates = _list_mates(system, resource, others)
    beside = [thread for thread in others if thread not in mates] if mates else others
    interference = _divide_demand(beside, 1 if resource.joined else resource.cores, mates)
    is_in_order = not any_order and len(own_ids) == 1 and works_in_order(system, system.activities[own_ids[0]])
    # Use by use, or all uses of others in the whole time at once: either may be the smaller one.
    return [
        _bound_with(waits, interference, budget, in_order=is_in_order)
        for waits in (_waits_by_use(state, own_ids, budget), _waits_together(state, own_ids))
    ]


class ThreadWaits(NamedTuple):
    """The work of a thread with its waits for resources, and what of them is not counted for each activation alone."""

    own_ids: tuple[str, ...]
    works: tuple[ActivityWork, ...]
    rivals: Mapping[str, Rivals] = MappingProxyType({})
    """By resource: who may use it in the whole time."""


class Interference(NamedTuple):
    """How long others can keep all cores busy in a window, and their share of them in the long run.

    That is what `threads` have to do, divided by the cores, and all that `mates` have to do; or what `list_served` yields.
    """

    demand: DemandFunction
    share: Fraction
    threads: Sequence[ThreadWork] = ()
    core_count: int = 1
    mates: Sequence[ThreadWork] = ()
    list_served: Callable[[int], Iterator[tuple[str, int]]] | None = None


class WaitingWindow(NamedTuple):
    """The window that bounds a thread that waits: what it does in it itself, what holds it up, and what takes longest."""

    waits: ThreadWaits
    interference: Interference
    worst: WorstActivation


def _waits_by_use(state: PropagationState, own_ids: Sequence[str], budget: SearchBudget) -> ThreadWaits | UnknownCause:
    """Return the work of a thread with the longest wait for each use."""
    use_times = {name: find_use_times(state, name, budget) for name in own_ids}
    return _add_waits(state, use_times)


def _waits_together(state: PropagationState, own_ids: Sequence[str]) -> ThreadWaits | UnknownCause:
    """Return the work of a thread with its uses alone, and the rivals: no use of theirs is waited for twice."""
    rivals = {
        resource_id: find_rivals(state, own_ids, resource_id)
        for resource_id in dict.fromkeys(key for name in own_ids for key in state.system.activities[name].uses)
    }
    causes = [each for each in rivals.values() if isinstance(each, UnknownCause)]
    if causes:
        return unite_causes(causes)
    known_rivals = {key: each for key, each in rivals.items() if isinstance(each, Rivals)}
    use_times: dict[str, int | UnknownCause] = {
        name: sum(use.worst + known_rivals[key].blocking for key, use in activity.uses.items()) + activity.wait
        for name in own_ids
        if (activity := state.system.activities[name])
    }
    waits = _add_waits(state, use_times)
    return waits if isinstance(waits, UnknownCause) else waits._replace(rivals=known_rivals)


def _add_waits(state: PropagationState, use_times: Mapping[str, int | UnknownCause]) -> ThreadWaits | UnknownCause:
    """Return the work of a thread, each activation with a time on top, or what is missing of it."""
    works: list[ActivityWork] = []
    causes: list[UnknownCause] = []
    for name, use_time in use_times.items():
        work = find_work(state.system, name, state.event_models)
        model = state.event_models[name]
        causes += [each for each in (work, use_time) if isinstance(each, UnknownCause)]
        if isinstance(work, ActivityWork) and not isinstance(use_time, UnknownCause):
            if isinstance(model, UnknownCause) and use_time:
                causes.append(model)
            else:
                works.append(ActivityWork(work.cost + use_time, () if isinstance(model, UnknownCause) else model))
    return unite_causes(causes) if causes else ThreadWaits(tuple(use_times), tuple(works))


def _bound_with(
    waits: ThreadWaits | UnknownCause, interference: Interference, budget: SearchBudget, *, in_order: bool
) -> WaitingWindow | UnknownCause:
    """Return the window of a thread with some waits, or why none is found."""
    if isinstance(waits, UnknownCause):
        return waits
    shares = [work_utilisation(work.cost, work.streams) for work in waits.works]
    if sum_fractions([interference.share, *shares, *(rivals.share for rivals in waits.rivals.values())]) >= 1:
        return DIVERGED_CAUSE
    demand = DemandFunction(
        lambda window: (
            interference.demand.within(window) + sum([each.work_within(window) for each in waits.rivals.values()])
        ),
        interference.demand.term_count + sum([2 * len(each.competitors) for each in waits.rivals.values()]),
    )
    try:
        return WaitingWindow(
            waits, interference, _find_longest_response(waits.works, demand, budget, in_order=in_order)
        )
    except DivergedError:
        return DIVERGED_CAUSE


def _find_longest_response(
    works: Sequence[ActivityWork], interference: DemandFunction, budget: SearchBudget, *, in_order: bool
) -> WorstActivation:
    """Return the longest response: by activation where one comes after the other, else the whole busy time."""
    if in_order and works[0].streams:
        return find_worst_activation(works[0], interference, budget)
    own_demand = GrowingLoad(works).demand_function()
    once_cost = sum(work.cost for work in works if not work.streams)
    total = DemandFunction(
        lambda window: once_cost + own_demand.within(window) + interference.within(window),
        own_demand.term_count + interference.term_count,
    )
    search = longest_wait_for_turn if any(not work.cost for work in works) else longest_busy_period
    return WorstActivation(0, 0, search(total, budget))


def _divide_demand(others: Sequence[ThreadWork], core_count: int, mates: Sequence[ThreadWork]) -> Interference:
    """Return how long others can be busy on all cores at once in a window.

    What computes in turn with the thread holds it up for all that it computes, on however many cores.
    """
    demand, in_turn = (
        GrowingLoad([work for thread in threads for work in thread.works]).demand_function()
        for threads in (others, mates)
    )
    shares = [sum_fractions(thread.share for thread in threads) for threads in (others, mates)]
    return Interference(
        DemandFunction(
            lambda window: -(-demand.within(window) // core_count) + in_turn.within(window),
            demand.term_count + in_turn.term_count,
        ),
        shares[0] / core_count + shares[1],
        others,
        core_count,
        mates,
    )


def _fills_resource(state: PropagationState, own_ids: Sequence[str]) -> bool:
    """Whether more is asked of a resource that a thread uses than it can do."""
    return any(
        find_load(state, resource_id) > 1
        for resource_id in dict.fromkeys(key for name in own_ids for key in state.system.activities[name].uses)
    )


def _fills_thread(state: PropagationState, own_ids: Sequence[str]) -> bool:
    """Whether a thread has more to do than it can, were it never to wait for anybody else."""
    system = state.system
    first = system.activities[own_ids[0]]
    pool = find_pool(system, first)
    if is_reentrant(system, first) or (len(own_ids) > 1 and pool is not None and pool.threads != 1):
        return False
    shares = [
        work_utilisation((activity.wcet or 0) + sum(use.worst for use in activity.uses.values()) + activity.wait, model)
        for activity in (system.activities[name] for name in own_ids)
        if not isinstance(model := state.event_models[activity.id], UnknownCause)
    ]
    return sum_fractions(shares) > 1 if shares else False


def _list_own(system: TimingSystem, resource: ProcessingResource) -> tuple[str, ...]:
    """Return what may hold the threads that a unit waits for: itself, and members of its container on other cores."""
    unit = resource.units[0]
    pool = find_pool(system, system.activities[unit[0]])
    if not resource.joined or pool is None or pool.threads == 1:
        return unit
    foreign_ids = [name for foreign_unit in resource.foreign_units for name in foreign_unit]
    return (*unit, *(name for name in foreign_ids if find_pool(system, system.activities[name]) == pool))


def _list_others(
    state: PropagationState, resource: ProcessingResource, own_ids: Sequence[str], waiting_ids: Collection[str]
) -> Iterator[ThreadWork]:
    """Yield the threads that may hold up a unit on its core, with the work that they may do there in a window."""
    system = state.system
    is_late = resource.cores > 1 or resource.joined
    strangers = {name for unit in resource.stranger_units for name in unit}
    other_units = [
        rest for unit in resource.foreign_units if (rest := tuple(name for name in unit if name not in own_ids))
    ]
    models = {name: state.event_models[name] for name in own_ids}
    others = [
        _build_late_thread(state, unit, models, waiting_ids, is_late=is_late or unit[0] in strangers)
        for unit in other_units
    ]
    threads = lower_crowded_threads(system, [build_thread(system, tuple(own_ids), models), *others], models)
    mates = _list_mates(system, resource, threads[1:])
    # Who computes in turn with something less urgent waits for whatever keeps that from its core.
    lowest = min((each.lowest_priority for each in (threads[0], *mates)), key=urgency_of)
    level = None if _ignores_priorities(system, resource) else lowest
    for thread in threads[1:]:
        if level is None or (thread.highest_priority is not None and thread.highest_priority >= level):
            yield thread


def _build_late_thread(
    state: PropagationState,
    unit: ThreadUnit,
    models: dict[str, EventStreams | UnknownCause],
    waiting_ids: Collection[str],
    *,
    is_late: bool,
) -> ThreadWork:
    """Return a thread as others on its core see it, and put the event models of its members into `models`."""
    responses = [state.work_ends.get(name, state.responses.get(name)) for name in unit]
    found_from = (is_late, *(state.event_models[name] for name in unit), *responses)
    known = state.late_threads.get(unit)
    if known is None or known[0] != found_from:
        late = {name: delayed_model(state, name, waiting_ids, always=is_late) for name in unit}
        known = state.late_threads[unit] = found_from, build_thread(state.system, unit, late)
    for name in unit:
        models[name] = state.event_models[name]
    return known[1]


def _list_mates(system: TimingSystem, resource: ProcessingResource, threads: Iterable[ThreadWork]) -> list[ThreadWork]:
    """Return the threads of the process that waits, where each computes only while no other one does."""
    process = find_serial_process(system, resource.units[0][0])
    if process is None:
        return []
    return [thread for thread in threads if find_serial_process(system, thread.unit[0]) == process]


def _ignores_priorities(system: TimingSystem, resource: ProcessingResource) -> bool:
    """Whether something other than preemptive priorities may decide who runs."""
    host = resource.host or ""
    orders = {system.host_orders.get(host), *(order for (name, _), order in system.core_orders.items() if name == host)}
    return not orders <= PREEMPTIVE_ORDERS


def _name_tier(system: TimingSystem, resource: ProcessingResource) -> ResponseTier:
    if resource.host is None and len(resource.units[0]) == 1:
        return "dedicated"
    if len(resource.units[0]) > 1:
        return "executor"
    if resource.cores > 1:
        return "cores"
    is_ranked = all(system.activities[name].priority is not None for name in _list_own(system, resource))
    return "priorities" if is_ranked and not _ignores_priorities(system, resource) else "host"
