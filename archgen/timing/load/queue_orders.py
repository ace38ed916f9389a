"""Responses of one queue whose order is known: what one thread, or one core, works off one after the other.

Each analysis looks at a busy time that begins at 0, and at an activation that comes at `a` in it: what is done before it
is what comes before it in the queue's order. Between the instants at which something comes (or its deadline does) nothing
changes but `a`, so that only these are looked at. Windows are closed: what comes at the same instant may come first.

- `fifo`: all that came up to a (the published figures of FIFO are of this sum).
- `non_preemptive`: L. George, N. Rivierre, M. Spuri 1996; R. Davis, A. Burns, R. Bril, J. Lukkien 2007: a less urgent job
  that has just begun, own jobs, and all more urgent ones that come until the job begins.
- `edf`: M. Spuri 1996 where a job may be preempted, George et al. 1996 where not: what has a deadline up to a + D.
- `ros2_executor`: the round that is under way when it comes, and one round for each job of its own that waits, in which
  nothing works twice (D. Casini et al. 2019; Y. Tang et al. 2020; T. Blass et al. 2021 for the rounds). It holds at any
  load: ticks that come while one waits are skipped, and queues keep no more messages than their depth (H. Teper et al. 2022).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from heapq import merge

from archgen.frozen import NamedTuple
from archgen.timing.load.busy_windows import SearchBudget
from archgen.timing.load.event_streams import EventStreams, earliest_arrivals, max_arrivals

Spend = Callable[[int], None]


class QueuedTask(NamedTuple):
    """What waits in the queue. `priority` None is after all others; `deadline` None: nobody knows how urgent it is.

    `entities` is how often it may work in one round of an executor of ROS 2; each keeps `depth` messages, None all.
    """

    name: str
    cost: int
    streams: EventStreams
    priority: int | None = None
    deadline: int | None = None
    entities: int = 1
    depth: int | None = None
    is_timer: bool = False

    def count_until(self, time: int) -> int:
        """Return how many activations come in a closed window of a length (ticks), none where that is negative."""
        return max_arrivals(self.streams, time + 1) if time >= 0 else 0

    @property
    def min_spacing(self) -> int:
        """Return the smallest distance between two activations (ticks); 0 where it is not known."""
        return self.streams[0].min_spacing if len(self.streams) == 1 else 0


class QueueShare(NamedTuple):
    """What a task does before the end of an activation: `work` so often (`number`) for a reason, or at all that comes `until` then."""

    task: QueuedTask
    work: int
    number: int = 0
    reason: str = ""
    until: int | None = None


class QueueBound(NamedTuple):
    """The longest response in a queue: of an activation that comes at `arrival` and ends at `finish`, behind some work."""

    finish: int
    arrival: int
    shares: tuple[QueueShare, ...]

    @property
    def response(self) -> int:
        """Return how long it takes."""
        return self.finish - self.arrival


def bound_fifo(tasks: Sequence[QueuedTask], busy_period: int, budget: SearchBudget) -> QueueBound:
    """Return the response of each task where what came first is first."""
    spend, worst_finish, worst_arrival = budget.start_search(), 0, 0
    for arrival in list_arrivals(busy_period, ((each, 0) for each in tasks)):
        spend(len(tasks))
        finish = sum(each.cost * each.count_until(arrival) for each in tasks)
        if finish - arrival > worst_finish - worst_arrival:
            worst_finish, worst_arrival = finish, arrival
    return QueueBound(
        worst_finish, worst_arrival, tuple(QueueShare(each, each.cost, until=worst_arrival) for each in tasks)
    )


def bound_rounds(task: QueuedTask, tasks: Sequence[QueuedTask], budget: SearchBudget) -> QueueBound | None:
    """Return the response in an executor of ROS 2 of one thread; None where more messages may wait than queues keep."""
    spend, round_work, waiting = budget.start_search(), work_of_round(tasks), 1
    if task.depth is None and not task.is_timer and sum(each.max_rate for each in task.streams) * round_work >= 1:
        return None
    while True:
        spend(2)
        # All own jobs that may wait when this one comes: those that came up to a response before. Of ticks one waits.
        count = 1 if task.is_timer else task.count_until((waiting + 1) * round_work)
        if task.depth is not None and count > task.depth:
            return None
        if count <= waiting:
            return share_rounds(tasks, waiting + 1)
        waiting = count


def share_rounds(tasks: Iterable[QueuedTask], number: int) -> QueueBound:
    """Return the bound of so many rounds in which everything is ready: the one under way, and up to one's own."""
    shares = tuple(QueueShare(each, each.cost * each.entities, number, "in each round") for each in tasks)
    return QueueBound(sum(each.work * number for each in shares), 0, shares)


def work_of_round(tasks: Iterable[QueuedTask]) -> int:
    """Return the work of a round of an executor of ROS 2 in which everything is ready."""
    return sum(each.cost * each.entities for each in tasks)


def bound_non_preemptive(
    task: QueuedTask, tasks: Sequence[QueuedTask], busy_period: int, budget: SearchBudget
) -> QueueBound | None:
    """Return the response by priorities where what has begun is not preempted; None without a priority."""
    if task.priority is None:
        return None
    spend = budget.start_search()
    others = [each for each in tasks if each is not task]
    urgent = [each for each in others if each.priority is not None and each.priority >= task.priority]
    begun = _choose_begun(each for each in others if each not in urgent)
    worst = QueueBound(0, 0, ())
    for count, arrival in enumerate(earliest_arrivals(task.streams)):
        if arrival and arrival >= busy_period:
            break
        own_work = sum(each.work for each in begun) + count * task.cost
        start = find_start(own_work, [(each, None) for each in urgent], spend)
        if start + task.cost - arrival > worst.response or not worst.shares:
            own = QueueShare(task, task.cost, count + 1, "its own")
            come = (QueueShare(each, each.cost, until=start) for each in urgent)
            worst = QueueBound(start + task.cost, arrival, (*begun, own, *come))
    return worst


def _choose_begun(less_urgent: Iterable[QueuedTask]) -> tuple[QueueShare, ...]:
    """Return the longest of some tasks, of which one may have begun."""
    longest = max(less_urgent, key=lambda each: each.cost, default=None)
    return (QueueShare(longest, longest.cost, 1, "which may just have begun"),) if longest else ()


def bound_edf(
    task: QueuedTask, tasks: Sequence[QueuedTask], busy_period: int, budget: SearchBudget, *, preemptive: bool
) -> QueueBound | None:
    """Return the response where the earliest deadline is first; None where the task's own is not known."""
    if task.deadline is None:
        return None
    spend, worst = budget.start_search(), QueueBound(0, 0, ())
    others = [each for each in tasks if each is not task]
    own_deadline = task.deadline
    # A deadline that nobody knows may always be the earlier one: as if it were long ago.
    leads = [(each, find_lead(each, own_deadline)) for each in others]
    jumps = [(task, 0), *((each, lead) for each, lead in leads if lead is not None)]
    for arrival in list_arrivals(busy_period, jumps):
        own_count = max(task.count_until(arrival), 1)
        limits = [(each, None if lead is None else arrival + lead) for each, lead in leads]
        begun: tuple[QueueShare, ...] = ()
        if preemptive and task.cost:
            end = find_end(task.cost * own_count, limits, spend)
            until = end - 1
        elif preemptive:  # what takes no time ends when it begins
            end = until = find_start(0, limits, spend)
        else:
            begun = _choose_begun(each for each, limit in limits if limit is not None and limit < 0)
            until = find_start(task.cost * (own_count - 1) + sum(each.work for each in begun), limits, spend)
            end = until + task.cost
        if end - arrival > worst.response or not worst.shares:
            own = QueueShare(task, task.cost, own_count, "its own")
            come = (
                QueueShare(each, each.cost, until=until if limit is None else min(until, limit))
                for each, limit in limits
            )
            worst = QueueBound(end, arrival, (own, *begun, *come))
    return worst


def find_lead(other: QueuedTask, own_deadline: int) -> int | None:
    """Return how much later another task may come and still be first; None where it always may."""
    return None if other.deadline is None else own_deadline - other.deadline


def find_end(own_work: int, limits: Sequence[tuple[QueuedTask, int | None]], spend: Spend) -> int:
    """Return when own work is done that others may interrupt: those that come before then, and up to their limit."""
    end = own_work
    while True:
        spend(len(limits) + 1)
        work = own_work + sum(_work_of(each, end - 1, limit) for each, limit in limits)
        if work <= end:
            return end
        end = work


def find_start(work_before: int, limits: Sequence[tuple[QueuedTask, int | None]], spend: Spend) -> int:
    """Return when a job begins that waits for some work, and for all that comes up to its begin and up to their limit."""
    start = work_before
    while True:
        spend(len(limits) + 1)
        work = work_before + sum(_work_of(each, start, limit) for each, limit in limits)
        if work <= start:
            return start
        start = work


def _work_of(task: QueuedTask, time: int, limit: int | None) -> int:
    return task.cost * task.count_until(time if limit is None else min(time, limit))


def list_arrivals(end: int, shifted_tasks: Iterable[tuple[QueuedTask, int]]) -> Iterator[int]:
    """Yield 0 and all instants before an end at which tasks come, each less its shift, in ascending order."""

    def arrivals_of(task: QueuedTask, shift: int) -> Iterator[int]:
        for time in earliest_arrivals(task.streams) if task.streams else ():
            if time - shift >= end:
                return
            if time >= shift:
                yield time - shift

    yield 0
    previous = 0
    for time in merge(*(arrivals_of(task, shift) for task, shift in shifted_tasks)):
        if time != previous:
            yield time
            previous = time
