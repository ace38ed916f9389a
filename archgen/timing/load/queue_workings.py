"""How a response comes about in a queue whose order is written: what comes before an activation, with its count.

Each function offers what the analysis may have found; the one that gives the very figure is it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

from archgen.timing.figures.timing_values import UnknownCause
from archgen.timing.load.busy_windows import SearchBudget
from archgen.timing.load.event_streams import EventStreams, earliest_arrivals
from archgen.timing.load.queue_orders import (
    QueuedTask,
    find_end,
    find_lead,
    find_start,
    list_arrivals,
    work_of_round,
)
from archgen.timing.load.queue_responses import CoreQueue
from archgen.timing.load.work_terms import ONCE, CountFormulas, EventCount, FigureWorking, WorkTerm, group_terms

_ModelFinder = Callable[[str], EventStreams | UnknownCause]


def list_queue_workings(
    queue: CoreQueue, model_of: _ModelFinder, name: str, response: int, formulas: CountFormulas
) -> Iterator[FigureWorking]:
    """Yield how the response (ticks) of an activity may have been found in a queue."""
    tasks: list[QueuedTask] = []
    for queued_task in queue.tasks:
        model = model_of(queued_task.name)
        if not isinstance(model, UnknownCause) and model:
            tasks.append(queued_task._replace(streams=model))
    task = next((each for each in tasks if each.name == name), None)
    if task is None:
        return
    if queue.order == "fifo":
        yield from _list_fifo(tasks, response, formulas)
    elif queue.order == "non_preemptive":
        yield from _list_non_preemptive(task, tasks, response, formulas)
    elif queue.order == "edf":
        yield from _list_edf(task, tasks, response, formulas, preemptive=queue.is_core)
    else:
        yield from _list_rounds(task, tasks, response)


def _list_fifo(tasks: Sequence[QueuedTask], response: int, formulas: CountFormulas) -> Iterator[FigureWorking]:
    for arrival in list_arrivals(_longest_busy(tasks), ((each, 0) for each in tasks)):
        finish = sum(each.cost * each.count_until(arrival) for each in tasks)
        if finish - arrival == response:
            terms = [_count_until(each, arrival, formulas) for each in tasks]
            yield _build_working(finish, arrival, terms)
            return


def _list_non_preemptive(
    task: QueuedTask, tasks: Sequence[QueuedTask], response: int, formulas: CountFormulas
) -> Iterator[FigureWorking]:
    others = [each for each in tasks if each is not task]
    urgent = [
        each
        for each in others
        if each.priority is not None and task.priority is not None and each.priority >= task.priority
    ]
    blocking = max((each for each in others if each not in urgent), key=lambda each: each.cost, default=None)
    blocking_terms = (
        [WorkTerm(((blocking.name, blocking.cost),), ONCE, "which may just have begun")] if blocking else []
    )
    spend = SearchBudget().start_search()
    for count, arrival in enumerate(earliest_arrivals(task.streams)):
        own_work = (blocking.cost if blocking else 0) + count * task.cost
        start = find_start(own_work, [(each, None) for each in urgent], spend)
        if start + task.cost - arrival == response:
            own_term = WorkTerm(((task.name, task.cost),), EventCount(count + 1, str(count + 1)), "its own")
            terms = [*blocking_terms, own_term, *(_count_until(each, start, formulas) for each in urgent)]
            yield _build_working(start + task.cost, arrival, terms)
            return
        if arrival > _longest_busy(tasks):
            return


def _list_edf(
    task: QueuedTask, tasks: Sequence[QueuedTask], response: int, formulas: CountFormulas, *, preemptive: bool
) -> Iterator[FigureWorking]:
    if task.deadline is None:
        return
    others, spend = [each for each in tasks if each is not task], SearchBudget().start_search()
    leads = [(each, find_lead(each, task.deadline)) for each in others]
    jumps = [(task, 0), *((each, lead) for each, lead in leads if lead is not None)]
    for arrival in list_arrivals(_longest_busy(tasks), jumps):
        own_count = max(task.count_until(arrival), 1)
        limits = [(each, None if lead is None else arrival + lead) for each, lead in leads]
        later = [each for each, limit in limits if limit is not None and limit < 0]
        blocking = None if preemptive else max(later, key=lambda each: each.cost, default=None)
        blocking_cost = blocking.cost if blocking else 0
        end = (
            find_end(task.cost * own_count, limits, spend)
            if preemptive
            else find_start(task.cost * (own_count - 1) + blocking_cost, limits, spend) + task.cost
        )
        if end - arrival == response:
            until = end - 1 if preemptive else end - task.cost
            terms = [WorkTerm(((task.name, task.cost),), EventCount(own_count, str(own_count)), "its own")]
            if blocking:
                terms.append(WorkTerm(((blocking.name, blocking.cost),), ONCE, "which may just have begun"))
            terms += [
                _count_until(each, until if limit is None else min(until, limit), formulas) for each, limit in limits
            ]
            yield _build_working(end, arrival, terms)
            return


def _list_rounds(task: QueuedTask, tasks: Sequence[QueuedTask], response: int) -> Iterator[FigureWorking]:
    last_tasks = [each for each in tasks if each.rank <= task.rank]
    last_round, round_work = work_of_round(last_tasks), work_of_round(tasks)
    if not round_work or response < last_round or (response - last_round) % round_work:
        return
    rounds = (response - last_round) // round_work
    terms = [
        WorkTerm(((each.name, each.cost * each.entities),), EventCount(rounds, str(rounds)), "in the rounds before")
        for each in tasks
    ]
    terms += [WorkTerm(((each.name, each.cost * each.entities),), ONCE, "in its own round") for each in last_tasks]
    yield _build_working(response, 0, terms)


def _count_until(task: QueuedTask, time: int, formulas: CountFormulas) -> WorkTerm:
    """Count what comes in a closed window, nothing where that ends before it begins."""
    count = formulas.count_until(task.streams, time) if time >= 0 else EventCount(0, "0")
    reason = f"those that come until {formulas.write_duration(time)}" if time >= 0 else ""
    return WorkTerm(((task.name, task.cost),), count, reason)


def _build_working(finish: int, arrival: int, terms: Sequence[WorkTerm]) -> FigureWorking:
    return FigureWorking(finish - arrival, finish, group_terms(terms), arrival=arrival, is_queue=True)


def _longest_busy(tasks: Sequence[QueuedTask]) -> int:
    """Return the longest time for which the queue is never empty."""
    window, spend = 1, SearchBudget().start_search()
    while (work := sum(each.cost * each.count_until(window - 1) for each in tasks)) > window:
        spend(len(tasks))
        window = work
    return window
