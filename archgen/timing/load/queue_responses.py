"""Which cores and threads work off one queue in an order that is written, and what it makes of responses and ways there."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from typing import Literal

from archgen.frozen import dataclass, field
from archgen.model.declared_timing import SchedulingOrder
from archgen.timing.figures.timing_values import UnknownCause
from archgen.timing.load.busy_windows import DivergedError, SearchBudget
from archgen.timing.load.event_streams import EventStream, EventStreams, delay_streams, streams_of_calls
from archgen.timing.load.inner_triggers import InnerTriggers
from archgen.timing.load.level_cascades import EntryWay, ModelFinder
from archgen.timing.load.load_system import order_of_core
from archgen.timing.load.queue_orders import (
    QueueBound,
    QueuedTask,
    QueueShare,
    bound_edf,
    bound_fifo,
    bound_non_preemptive,
    bound_rounds,
    share_rounds,
)
from archgen.timing.load.thread_work import WorstResponse
from archgen.timing.system.core_placement import ProcessingResource
from archgen.timing.system.thread_pools import count_entities, find_crowded_pools, is_reentrant, list_waiting_arcs
from archgen.timing.system.timing_system import Activity, Arc, TimingSystem, is_sampled, samples_inputs

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

    @property
    def works_in_rounds(self) -> bool:
        """Whether there is a bound at any load: each callback works once in a round, ticks are skipped, queues are full."""
        return self.order == "ros2_executor"

    def bound_responses(
        self, model_of: Callable[[str], EventStreams | UnknownCause], busy_period: int, budget: SearchBudget
    ) -> dict[str, QueueBound]:
        """Return the bounds that the order gives, for the event models of all that waits; none where one is unknown."""
        if self.works_in_rounds:
            rounds = {task.name: self.bound_rounds(task, model_of(task.name), budget) for task in self.tasks}
            return {name: bound for name, bound in rounds.items() if bound is not None}
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

    def bound_rounds(
        self, task: QueuedTask, model: EventStreams | UnknownCause, budget: SearchBudget
    ) -> QueueBound | None:
        """Return the bound of the rounds of an executor, whatever else it does; None where the events are not known."""
        if isinstance(model, UnknownCause) and not task.is_timer:
            return None
        try:
            return bound_rounds(
                task._replace(streams=() if isinstance(model, UnknownCause) else model), self.tasks, budget
            )
        except DivergedError:
            return None

    def brings_one_a_round(self, arc: Arc, arcs: Iterable[Arc]) -> bool:
        """Whether a subscription or service gets one message in a round at most: `arc` alone of some arcs leads to it."""
        entities = [(each.role, each.input, each.topic) for each in arcs]
        return entities.count((arc.role, arc.input, arc.topic)) == 1 and any(
            task.name == arc.source and task.entities == 1 for task in self.tasks
        )

    def limit_storing_wait(self, system: TimingSystem, name: str, wait: WorstResponse) -> WorstResponse:
        """Return how long a message that an activity only stores may wait, or what it is in rounds, whichever is less."""
        bound = self.bound_storing(system, name)
        if bound is None:
            return wait
        return WorstResponse(bound.finish if wait.value is None else min(wait.value, bound.finish), wait.tier)

    def bound_storing(self, system: TimingSystem, name: str) -> QueueBound | None:
        """Return how long a message that an activity only stores may wait in rounds, until a job begins that does not read it.

        Something as new is stored after a round for each message that its queue keeps, and the one under way; that job
        takes its time before. None where it keeps any number.
        """
        activity = system.activities[name]
        arcs = [arc for arc in system.arcs_into.get(name, ()) if is_sampled(activity, arc)]
        depths = [1 if self.brings_one_a_round(arc, arcs) else arc.depth for arc in arcs]
        known_depths = [depth for depth in depths if depth is not None]
        if not self.works_in_rounds or len(known_depths) < len(depths):
            return None
        rounds = max(known_depths, default=0) + 1
        counts = [(each, rounds * each.entities - (each.name == name)) for each in self.tasks]
        shares = tuple(QueueShare(each, each.cost, count, "in the rounds until then") for each, count in counts)
        return QueueBound(sum(each.work * each.number for each in shares), 0, shares)

    def _bound_response(
        self, task: QueuedTask, tasks: Sequence[QueuedTask], busy_period: int, budget: SearchBudget
    ) -> QueueBound | None:
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
    return QueuedTask(
        activity.id,
        activity.wcet or 0,
        (),
        priorities.get(activity.id),
        activity.deadline if activity.deadline is not None else activity.period,
        max(count_entities(system, activity), 1),
        min((arc.depth for arc in list_waiting_arcs(system, activity) if arc.depth is not None), default=None),
        activity.behaviour == "periodic",
    )


@dataclass(frozen=True, slots=True)
class OrderedCore:
    """A queue with the ways that lead to what waits in it, and how long any order may make them."""

    queue: CoreQueue
    inner_triggers: InnerTriggers
    find_model: ModelFinder
    ways_to: dict[str, tuple[EntryWay, ...]]

    def limit(
        self, responses: dict[str, WorstResponse], busy_period: int, budget: SearchBudget
    ) -> dict[str, QueueBound]:
        """Limit responses to what the order makes of them, and in rounds also ways; return the bounds that it gives."""
        if self.queue.works_in_rounds:
            bounds = dict(self._bound_rounds(budget))
        else:
            bounds = self.queue.bound_responses(self.find_activation_model, busy_period, budget)
        for name, bound in bounds.items():
            responses[name] = responses[name].limit_to(bound.response, self.queue.order)
        return bounds

    def _bound_rounds(self, budget: SearchBudget) -> Iterator[tuple[str, QueueBound]]:
        """Yield the bounds of rounds, each behind what fires it, and limit the ways: a run goes on by a step in each round."""
        for name in self.inner_triggers.order:
            task = next(each for each in self.queue.tasks if each.name == name)
            is_taken = self._is_taken_in_next_round(name)
            bound = (
                share_rounds(self.queue.tasks, 2)
                if is_taken
                else self.queue.bound_rounds(task, self.find_activation_model(name), budget)
            )
            if bound is None:
                continue
            yield name, bound
            ways: list[EntryWay] = []
            for way in self.ways_to[name]:
                before = self._delay_before(way) if len(way.steps) > 1 else 0
                rounds = None if before is None else before + (bound.response // 2 if is_taken else bound.response)
                delays = [each for each in (way.delay, rounds) if each is not None]
                ways.append(way._replace(delay=min(delays, default=None)))
            self.ways_to[name] = tuple(ways)

    def _is_taken_in_next_round(self, name: str) -> bool:
        """Whether each message that fires an activity comes from here, at most one in a round, and is never overwritten.

        One more may come before its turn in the next round: queues keep two. With a depth of 1 it takes the other's place.
        """
        firing_arcs = self.inner_triggers.inner_arcs.get(name, ())
        arcs = [arc for arc, _ in firing_arcs]
        return (
            bool(arcs)
            and not self.inner_triggers.outer_arcs.get(name)
            and all(len(way.steps) > 1 for way in self.ways_to[name])
            and all(
                calls <= 1 and self.queue.brings_one_a_round(arc, arcs) and (arc.depth is None or arc.depth > 1)
                for arc, calls in firing_arcs
            )
        )

    def find_activation_model(self, name: str) -> EventStreams | UnknownCause:
        """Return the event model of an activity's activations: what enters, behind the steps before it."""
        # These are delayed by at most as much as any order may delay them: nothing here rests on the order itself.
        if name in self.inner_triggers.silent_ids:
            return ()
        streams: list[EventStream] = []
        for way in self.ways_to[name]:
            if way.entry.kind == "activity" and str(way.entry.key) not in self.inner_triggers.entry_ids:
                return UnknownCause((name,))  # behind a gate
            model = self.find_model(way.entry)
            delay = self._delay_before(way) if len(way.steps) > 1 else 0
            if isinstance(model, UnknownCause) or delay is None:
                return UnknownCause((name,))
            model = streams_of_calls(model, Fraction(way.multiplicity)) if way.multiplicity > 1 else model
            streams += delay_streams(model, max(delay - way.best_before, 0))
        return tuple(streams)

    def _delay_before(self, way: EntryWay) -> int | None:
        """Return how long the way to the step before the last one of a way takes at most."""
        return next(
            each.delay
            for each in self.ways_to[way.steps[-2]]
            if each.entry == way.entry and each.steps == way.steps[:-1]
        )
