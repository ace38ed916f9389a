"""Which cores and threads work off one queue in an order that is written, and what that order makes of their responses."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import field
from typing import Literal

from archgen.frozen import dataclass
from archgen.model.declared_timing import SchedulingOrder
from archgen.timing.figures.timing_values import UnknownCause
from archgen.timing.load.busy_windows import DivergedError, SearchBudget
from archgen.timing.load.event_streams import EventStreams
from archgen.timing.load.load_system import order_of_core
from archgen.timing.load.queue_orders import (
    QueueBound,
    QueuedTask,
    bound_edf,
    bound_fifo,
    bound_non_preemptive,
    bound_round,
)
from archgen.timing.system.core_placement import ProcessingResource
from archgen.timing.system.thread_pools import count_entities, find_crowded_pools, is_reentrant
from archgen.timing.system.timing_system import Activity, TimingSystem, samples_inputs

QueueOrder = Literal["non_preemptive", "fifo", "ros2_executor", "edf"]
"""The orders that say more of a queue than that it is worked off."""
_QUEUE_ORDERS: Mapping[SchedulingOrder | None, QueueOrder] = {
    "non_preemptive": "non_preemptive",
    "fifo": "fifo",
    "ros2_executor": "ros2_executor",
    "edf": "edf",
}
QUEUE_TIERS = frozenset(_QUEUE_ORDERS.values())
"""The tiers of responses that such an order bounds."""
_RANKS = {"periodic": 0, "event": 1, "on_demand": 2}
"""The place of what fires an activity in a round of rclcpp's executor."""


@dataclass(frozen=True, slots=True)
class CoreQueue:
    """What works off a queue: the order, and whether it is a core, for which threads wait, or a thread."""

    order: QueueOrder
    is_core: bool
    tasks: tuple[QueuedTask, ...] = field(default=())
    """Without events: those are not known yet."""

    @property
    def stores_in_time(self) -> bool:
        """Whether a message that comes before an activation is stored before that begins."""
        return self.order == "fifo" and not self.is_core

    def bound_responses(
        self, model_of: Callable[[str], EventStreams | UnknownCause], busy_period: int, budget: SearchBudget
    ) -> dict[str, QueueBound]:
        """Return the bounds that the order gives, for the event models of all that waits; none where one is unknown."""
        tasks: list[QueuedTask] = []
        for task in self.tasks:
            model = model_of(task.name)
            if task.cost and (isinstance(model, UnknownCause) or not model):
                return {}
            tasks.append(task._replace(streams=() if isinstance(model, UnknownCause) else model))
        working_tasks = [task for task in tasks if task.streams]
        if len(working_tasks) == 1:
            return {}  # what is alone waits for itself only
        bounds: dict[str, QueueBound] = {}
        for task in working_tasks:
            try:
                bound = self._bound_response(task, working_tasks, busy_period, budget)
            except DivergedError:
                break
            if bound is not None:
                bounds[task.name] = bound
        return bounds

    def _bound_response(
        self, task: QueuedTask, tasks: Sequence[QueuedTask], busy_period: int, budget: SearchBudget
    ) -> QueueBound | None:
        if self.order == "ros2_executor":
            return bound_round(task, tasks, busy_period, budget)
        if self.order == "fifo":
            bound: QueueBound | None = bound_fifo(tasks, busy_period, budget)
            if not self.is_core:
                return bound
        elif self.order == "non_preemptive":
            bound = bound_non_preemptive(task, tasks, busy_period, budget)
        else:
            bound = bound_edf(task, tasks, busy_period, budget, preemptive=self.is_core)
        # Own jobs are taken to be done in the order in which they come, which a thread that waits for a core decides.
        is_ordered = task.entities == 1 or (bound is not None and bound.response <= task.min_spacing)
        return bound if is_ordered else None


def find_core_queue(
    system: TimingSystem, resource: ProcessingResource, priorities: Mapping[str, int | None]
) -> CoreQueue | None:
    """Return the queue of a core, None where its order is not written, or says nothing about what it works off.

    That is a thread that has a core to itself, or a core of threads with one activity each. `priorities` are those that
    are written, whether the cores look at them or not.
    """
    members = [system.activities[name] for name in resource.members]
    if resource.cores > 1 or resource.joined or resource.missing or resource.foreign_units or not members:
        return None
    if any(activity.wcet is None or (activity.behaviour == "once" and activity.wcet) for activity in members):
        return None
    written_order, is_core = _find_order(system, resource, members)
    order = _QUEUE_ORDERS.get(written_order)
    if order is None:
        return None
    return CoreQueue(
        order,
        is_core,
        tuple(_build_task(system, activity, priorities) for activity in members),
    )


def _find_order(
    system: TimingSystem, resource: ProcessingResource, members: Sequence[Activity]
) -> tuple[SchedulingOrder | None, bool]:
    """Return the order of a queue, and whether it is that of a core."""
    if any(activity.suspends for activity in members):
        return None, False  # who waits for a resource leaves the core to others
    if len(resource.units) == 1:
        executor = system.executors.get(members[0].executor)
        return (executor.order if executor is not None and executor.threads == 1 else None), False
    is_plain = all(len(unit) == 1 for unit in resource.units) and not any(is_reentrant(system, a) for a in members)
    if not is_plain or find_crowded_pools(system, members) or resource.host is None or len(resource.core_set) != 1:
        return None, False
    order = order_of_core(system, resource.host, resource.core_set[0])
    # A thread takes its turn on the core with what it has taken on first, which may be a message to be stored.
    is_held_up = order != "non_preemptive" and any(samples_inputs(system, activity) for activity in members)
    return None if is_held_up else order, True


def _build_task(system: TimingSystem, activity: Activity, priorities: Mapping[str, int | None]) -> QueuedTask:
    executor = system.executors.get(activity.executor)
    by_kind = executor is None or executor.library.serves_by_kind
    return QueuedTask(
        activity.id,
        activity.wcet or 0,
        (),
        priorities.get(activity.id),
        activity.deadline if activity.deadline is not None else activity.period,
        _RANKS.get(activity.behaviour or "", 2) if by_kind else 0,
        max(count_entities(system, activity), 1),
    )
