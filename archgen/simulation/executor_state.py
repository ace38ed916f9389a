"""The state of callbacks, executors, threads, processors and resources in one run, by their numbers.

Where no order is written, one is drawn for each run: the bounds hold for any that leaves no thread and no core idle while
something is ready.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from random import Random

from archgen.model.declared_timing import SchedulingOrder
from archgen.simulation.run_state import Job
from archgen.simulation.simulation_plan import TIMER, Processor, SimulationPlan

(
    WAIT_SET,
    FIRST_FIRST,
    LAST_FIRST,
    RANDOM_ORDER,
    FIXED_RANKS,
    FAVOURED_OTHERS,
    BY_PRIORITY,
    BY_DEADLINE,
    TAKE_TURNS,
    LEAST_SERVED,
) = range(10)
"""Orders: the wait set of rclcpp; first come first served; last come first served; at random; ranks drawn once; first come
first served, but one activity after all others; by written priority; by deadline; in turns; who was served least.
"""
_ANY_SCHEDULER = (FIRST_FIRST, LAST_FIRST, RANDOM_ORDER, FIXED_RANKS, FAVOURED_OTHERS)
_ANY_EXECUTOR = (WAIT_SET, WAIT_SET, *_ANY_SCHEDULER)
_WRITTEN_ORDERS: dict[SchedulingOrder, int] = {
    "ros2_executor": WAIT_SET,
    "fifo": FIRST_FIRST,
    "fixed_priority": BY_PRIORITY,
    "non_preemptive": BY_PRIORITY,
    "edf": BY_DEADLINE,
    "round_robin": TAKE_TURNS,
    "fair": LEAST_SERVED,
}
_ORDERS_BY_PRIORITY = (None, "fixed_priority", "non_preemptive")
_SWITCH_NS = 5_000_000
"""After so long a thread of CPython lets another one compute (`sys.getswitchinterval`)."""
_SLICES_NS = (100_000, 1_000_000, 5_000_000, 20_000_000)
"""Time slices of a scheduler that takes turns, of which each run draws one."""


_UNFAIR_REMAINDERS = (2, 4, 6)
_UNFAIR_INTERVAL = 8


def find_last_turn(seed: int) -> int | None:
    """Return whose turn it is to come after all its neighbours, wherever no order is written; None in fair runs.

    Of eight seeds three are unfair: in one of them everything starts at once and takes its longest.
    """
    return seed // _UNFAIR_INTERVAL if seed % _UNFAIR_INTERVAL in _UNFAIR_REMAINDERS else None


def _draw_orders(
    orders: Sequence[SchedulingOrder | None], choices: Sequence[int], dice: Random, last_turn: int | None
) -> list[int]:
    """Return the orders that are written, and where none is, one that is drawn."""
    drawn = [dice.choice(choices) if last_turn is None else FAVOURED_OTHERS for _ in orders]
    return [drawn[index] if order is None else _WRITTEN_ORDERS[order] for index, order in enumerate(orders)]


def _draw_victims(members: Sequence[Sequence[int]], dice: Random, last_turn: int | None) -> list[int]:
    """Return the activity that comes last where its neighbours are favoured; -1 where there is none."""
    turns = [dice.randrange(len(activities)) if activities else 0 for activities in members]
    return [
        activities[(turn if last_turn is None else last_turn) % len(activities)] if activities else -1
        for activities, turn in zip(members, turns, strict=True)
    ]


class CallbackStates:
    """The state of every callback."""

    def __init__(self, plan: SimulationPlan) -> None:
        callbacks = plan.callbacks
        self.activity = [planned.activity for planned in callbacks]
        self.executor = [planned.executor for planned in callbacks]
        self.group = [planned.group for planned in callbacks]
        self.is_storing = [planned.is_storing for planned in callbacks]
        self.depth = [planned.depth for planned in callbacks]
        self.skips_ticks = [
            planned.kind == TIMER
            and plan.executors[planned.executor].order == "ros2_executor"
            and plan.activities[planned.activity].declared_response is None
            for planned in callbacks
        ]
        """Whether a tick that comes while another one waits makes no job: rcl counts it as done."""
        self.shortest_time = [planned.bcet for planned in callbacks]
        self.time_spread = [planned.wcet - planned.bcet for planned in callbacks]
        self.pending: list[deque[Job]] = [deque() for _ in callbacks]
        self.claim_count = [0] * len(callbacks)
        """Jobs that a thread has taken on but not begun."""
        # The last one is a place for REENTRANT, which is never looked at.
        self.is_group_busy = [False] * (2 + max((planned.group for planned in callbacks), default=0))


class ExecutorStates:
    """The state of every executor."""

    def __init__(self, plan: SimulationPlan, dice: Random, last_turn: int | None) -> None:
        count = len(plan.executors)
        members: list[list[int]] = [[] for _ in range(count)]
        for callback, planned in enumerate(plan.callbacks):
            members[planned.executor].append(callback)
        # A wait set lists timers first, then subscriptions, services and clients, each in the order of creation, which
        # nobody writes.
        self.callbacks = [
            tuple(
                sorted(
                    dice.sample(callbacks, len(callbacks)),
                    key=lambda callback: plan.callbacks[callback].kind if executor.serves_by_kind else 0,
                )
            )
            for callbacks, executor in zip(members, plan.executors, strict=True)
        ]
        self.order = _draw_orders([executor.order for executor in plan.executors], _ANY_EXECUTOR, dice, last_turn)
        self.ranks = {callback: dice.random() for callbacks in self.callbacks for callback in callbacks}
        activities = [sorted({plan.callbacks[callback].activity for callback in callbacks}) for callbacks in members]
        self.victim = _draw_victims(activities, dice, last_turn)
        self.free_count = [executor.threads for executor in plan.executors]
        self.excludes = [executor.threads > 1 for executor in plan.executors]
        """Whether groups matter: one thread excludes everything by itself."""
        self.only_callback = [
            callbacks[0] if len(callbacks) == 1 and executor.threads == 1 else -1
            for callbacks, executor in zip(self.callbacks, plan.executors, strict=True)
        ]
        """The callback of an executor that has nothing to choose; -1 for all others."""
        self.is_serial = [executor.is_serial for executor in plan.executors]
        self.computing_thread = [-1] * count
        """The thread that computes where one does at a time; -1 for none."""
        self.held_threads: list[list[int]] = [[] for _ in range(count)]
        """The threads that would like to compute meanwhile."""
        self.waiting_count = [0] * count
        """Jobs and samples that no thread has begun."""
        self.idle_threads: list[list[int]] = [[] for _ in range(count)]
        self.wait_set: list[deque[int]] = [deque() for _ in range(count)]
        """The callbacks that the executor saw ready when it last looked."""
        self.last_turn = [0] * count


class ThreadStates:
    """The state of every thread that has worked yet. Times are in units."""

    def __init__(self) -> None:
        self.callback: list[int] = []
        self.processor: list[int] = []
        self.allowed_cores: list[tuple[int, ...]] = []
        self.last_core: list[int] = []
        self.urgency: list[int] = []
        self.ready_order: list[int] = []
        self.time_left: list[int] = []
        """Execution time until it ends or waits for a resource; -1 before the job starts."""
        self.served: list[int] = []
        """For how long it ran, or might have, where it was not behind all others."""
        self.time_after_slice: list[int] = []
        self.later_steps: list[list[tuple[int, int, int]]] = []
        """What comes then, last first: a resource, the time on it, and the execution time after it."""
        self.end_time: list[int] = []
        self.end_version: list[int] = []
        self.job_activation: list[int] = []
        self.firing_wire: list[int] = []
        self.job_number: list[int] = []
        """The number of its job; of a callback that stores a sample, that of the producer's job."""

    def add_thread(self) -> int:
        """Add a thread and return its number."""
        for numbers in (self.callback, self.processor, self.urgency, self.ready_order, self.end_time, self.end_version):
            numbers.append(0)
        self.served.append(0)
        for numbers in (self.time_after_slice, self.job_activation, self.firing_wire, self.job_number):
            numbers.append(0)
        self.last_core.append(-1)
        self.time_left.append(-1)
        self.allowed_cores.append(())
        self.later_steps.append([])
        return len(self.callback) - 1


class ProcessorStates:
    """The state of every processor. Times are in units."""

    def __init__(self, plan: SimulationPlan, dice: Random, last_turn: int | None) -> None:
        processors = plan.processors
        count = len(processors)
        self.of_activity = [planned.processor for planned in plan.activities]
        self.allowed_cores = [planned.allowed_cores for planned in plan.activities]
        self.cores = [processor.cores for processor in processors]
        self.has_masks = [False] * count
        """Whether some threads of a processor may use only some of its cores."""
        members: list[list[int]] = [[] for _ in processors]
        ranked = set()
        for activity, planned in enumerate(plan.activities):
            members[planned.processor].append(activity)
            self.has_masks[planned.processor] |= bool(planned.allowed_cores)
            if planned.priority is not None:
                ranked.add(planned.processor)
        self.rank = dice.sample(range(len(plan.activities)), len(plan.activities))
        """The rank of each activity where ranks are drawn."""
        self.victim = _draw_victims(members, dice, last_turn)
        self.uses_priority = [processor.order in (*_ORDERS_BY_PRIORITY, "fair") for processor in processors]
        # Also where priorities count, something may have none, or the same one: for that an order is drawn.
        other_orders = [None if processor.order in _ORDERS_BY_PRIORITY else processor.order for processor in processors]
        self.scheduler = _draw_orders(other_orders, _ANY_SCHEDULER, dice, last_turn)
        self.is_preemptive = [
            _is_preemptive(processor, scheduler, has_priorities=index in ranked)
            for index, (processor, scheduler) in enumerate(zip(processors, self.scheduler, strict=True))
        ]
        slice_time = max(1, int(dice.choice(_SLICES_NS) / plan.unit))
        self.has_slices = not {TAKE_TURNS, LEAST_SERVED}.isdisjoint(self.scheduler) or any(
            executor.is_serial for executor in plan.executors
        )
        self.switch_time = max(1, int(_SWITCH_NS / plan.unit))
        self.slice_time = [
            max(1, int(processor.turn / plan.unit)) if processor.turn else slice_time if scheduler == TAKE_TURNS else 0
            for processor, scheduler in zip(processors, self.scheduler, strict=True)
        ]
        self.least_served = [0] * count
        """How long the thread was served by then that began last, where the one comes first that was served least."""
        self.ready: list[list[tuple[int, int, int]]] = [[] for _ in processors]
        self.running: list[list[int]] = [[] for _ in processors]
        self.busy_time = [0] * count


def _is_preemptive(processor: Processor, scheduler: int, *, has_priorities: bool) -> bool:
    """Return whether a more urgent thread takes a core from a less urgent one."""
    if processor.order in ("non_preemptive", "fifo", "round_robin"):
        return False
    # One written priority makes the whole processor preemptive, as a scheduler with fixed priorities is.
    return has_priorities or scheduler in (FIXED_RANKS, FAVOURED_OTHERS, BY_DEADLINE)


class ResourceStates:
    """The state of every resource."""

    def __init__(self, plan: SimulationPlan, dice: Random, last_turn: int | None) -> None:
        self.order = _draw_orders([resource.order for resource in plan.resources], _ANY_SCHEDULER, dice, last_turn)
        users = [
            [index for index, planned in enumerate(plan.activities) if any(use[0] == at for use in planned.uses)]
            for at in range(len(plan.resources))
        ]
        self.victim = _draw_victims(users, dice, last_turn)
        self.uses = [planned.uses for planned in plan.activities]
        self.queue: list[list[tuple[int, int, int, int]]] = [[] for _ in plan.resources]
        """Who waits: urgency, order of arrival, thread, and how long it uses the resource."""
        self.user = [-1] * len(plan.resources)
        """The thread that uses it; -1 for none."""
