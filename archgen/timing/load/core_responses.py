"""Response times on one core on which activities fire one another: of each activity, and of whole runs of them.

From the arrival of an event until the last activity that it leads to has ended, the core always has work of the level of
the least urgent of them. So the busy period of that level bounds them all together: J. Lehoczky's level-i busy period
(RTSS 1990) of cascades instead of jobs.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from fractions import Fraction

from archgen.frozen import NamedTuple
from archgen.timing.figures.timing_values import ResponseTier, UnknownCause, unite_causes
from archgen.timing.load.busy_windows import (
    ActivityWork,
    DemandFunction,
    DivergedError,
    GrowingLoad,
    SearchBudget,
    WorstActivation,
    add_demands,
    find_worst_activation,
    longest_busy_period,
    longest_wait_for_turn,
    subtract_demand,
)
from archgen.timing.load.event_streams import EventStreams, settles_at_full_load, streams_of_calls
from archgen.timing.load.inner_core import InnerCore, urgency_of
from archgen.timing.load.level_cascades import (
    ArcModelFinder,
    CascadeDemand,
    EntryWay,
    EventOrigin,
    LevelCascades,
    ModelFinder,
    Priority,
    look_up_arcs,
)
from archgen.timing.load.queue_orders import QueueBound
from archgen.timing.load.queue_responses import OrderedCore
from archgen.timing.load.storing_waits import hold_before_activation
from archgen.timing.load.thread_work import DIVERGED_CAUSE, OVERLOAD_CAUSE, ThreadWork, WorstResponse
from archgen.timing.system.thread_pools import may_skip_ticks
from archgen.timing.system.timing_system import samples_inputs


class CoreResponses(NamedTuple):
    """The responses of what a core runs, the ways to each activity with their delays, and how long storing waits."""

    response_of: dict[str, WorstResponse]
    ways_to: dict[str, tuple[EntryWay, ...]]
    storing_waits: dict[str, WorstResponse]


class LevelBound(NamedTuple):
    """The busy period of a level (ticks), or why there is none; and the demand that it is found from."""

    busy_period: int | None
    cause: UnknownCause
    demand: CascadeDemand


class LevelWindow(NamedTuple):
    """A window of the busy period of a level that bounds a response, or the delay of a way.

    It is that of an activation of `name`, where `worst` says which; else the whole busy period, with what is done once at
    the start of it (`start_costs`), and with what comes in the `closing_tick` after it. What it bounds begins `lead` after
    the window at the earliest.
    """

    level: Priority
    worst: WorstActivation
    name: str = ""
    lead: int = 0
    start_costs: tuple[tuple[str, int], ...] = ()
    closing_tick: int = 0


WayKey = tuple[str, ...]
"""The entry of a way, and its steps."""


def name_way(way: EntryWay) -> WayKey:
    """Return the key of a way."""
    return (*map(str, way.entry), *way.steps)


def open_core_solver(
    inner_core: InnerCore,
    model_of: ArcModelFinder,
    budget: SearchBudget,
) -> CoreSolver:
    """Return what finds the responses on a core, for the event models of what enters it (`model_of`)."""
    return CoreSolver(inner_core, look_up_arcs(model_of, inner_core.entering_arcs), budget)


class CoreSolver:
    """Finds the responses on one core from the busy periods of its levels (`bounds`).

    `windows` then has what bounds each response, and `way_windows` each way, the smaller one first where they are equal.
    """

    def __init__(
        self,
        inner_core: InnerCore,
        find_model: ModelFinder,
        budget: SearchBudget,
    ) -> None:
        """Take the event models of what enters from `find_model`."""
        self.core = inner_core
        self.find_model = find_model
        self.budget = budget
        self.bounds: dict[Priority, LevelBound] = {}
        self.windows: dict[str, list[LevelWindow]] = {}
        self.way_windows: dict[WayKey, list[LevelWindow]] = {}
        self.queue_bounds: dict[str, QueueBound] = {}
        self._waits_for_turn: dict[Priority, int | None] = {}

    def solve(self) -> CoreResponses:
        """Find the busy periods level by level, then the responses and the delays of ways in the order of triggers."""
        for level, cascades in self.core.levels.items():
            self.bounds[level] = self._bound_level(level, cascades)
        responses: dict[str, WorstResponse] = {}
        ways_to: dict[str, tuple[EntryWay, ...]] = {}
        for name in self.core.inner_triggers.order:
            activity = self.core.system.activities[name]
            response = self._find_response(name)
            whole_delay = self._delay_of_only_way(name, self.core.ways_to[name])
            if whole_delay is not None and response.value is not None:
                response = response._replace(
                    value=min(response.value, whole_delay - self.core.ways_to[name][0].best_before)
                )
            # What is declared counts instead, also where less was found.
            if activity.response is not None:
                response = WorstResponse(activity.response, "declared")
            if self._is_idle(name):  # its work is not in the busy periods, nor has it any events
                responses[name], ways_to[name] = response, self.core.ways_to[name]
                continue
            ways = [
                way._replace(delay=self._find_delay(name, way, whole_delay, response.value))
                for way in self.core.ways_to[name]
            ]
            if ways and all(way.delay is not None for way in ways) and response.tier != "declared":
                # The delay of a way begins at its event, the response at the activation, `best_before` later or more.
                longest = max((way.delay or 0) - way.best_before for way in ways)
                if response.value is not None and longest < response.value:
                    response = response._replace(value=longest)
            responses[name] = response
            ways_to[name] = tuple(ways)
        self._limit_to_order(responses, ways_to)
        waits = {
            name: self._find_storing_wait(name)
            for name in self.core.inner_triggers.order
            if samples_inputs(self.core.system, self.core.system.activities[name])
        }
        return CoreResponses(responses, ways_to, waits)

    def _find_delay(self, name: str, way: EntryWay, whole_delay: int | None, response: int | None) -> int | None:
        """Return the longest time of a way: as a whole, or at its level; of a single step, its response."""
        level = self._level_of_steps(way.steps)
        period = self._period_of_level(name, level)
        if period is not None:
            self._note_way(name_way(way), self._whole_period(name, level, period))
        candidates = (whole_delay, period, response if len(way.steps) == 1 else None)
        return min((each for each in candidates if each is not None), default=None)

    def _limit_to_order(self, responses: dict[str, WorstResponse], ways_to: dict[str, tuple[EntryWay, ...]]) -> None:
        """Limit responses and delays to what an order that is written makes of them."""
        queue, busy_periods = self.core.queue, [bound.busy_period for bound in self.bounds.values()]
        if queue is not None and (queue.works_in_rounds or None not in busy_periods):
            longest = max((each or 0 for each in busy_periods), default=0)
            ordered_core = OrderedCore(queue, self.core.inner_triggers, self.find_model, ways_to)
            self.queue_bounds = ordered_core.limit(responses, longest, self.budget)

    def _note_way(self, key: WayKey, window: LevelWindow) -> None:
        self.way_windows.setdefault(key, []).append(window)

    def _whole_period(self, name: str, level: Priority, period: int) -> LevelWindow:
        """Return the whole busy period of a level, as it bounds an activity."""
        closing_tick = int(not self.core.system.activities[name].wcet)
        return LevelWindow(level, WorstActivation(0, 0, period), closing_tick=closing_tick)

    def _find_storing_wait(self, name: str) -> WorstResponse:
        """Return how long a message that an activity only stores may wait until an activation that does not read it."""
        if self.core.queue is not None and self.core.queue.stores_in_time:
            return WorstResponse(0, "fifo")
        level = self.core.thread_of[name].lowest_priority
        _, cause, demand = self.bounds[level]
        busy_period = self.find_wait_for_turn(level)
        if busy_period is None:
            return WorstResponse(None, "host", cause if cause != UnknownCause() else DIVERGED_CAUSE)
        activity = self.core.system.activities[name]
        if may_skip_ticks(self.core.system, activity, busy_period):
            # It is stored within the busy period, and the job before that does not read it has ended then.
            return WorstResponse(busy_period - (activity.wcet or 0), "host")
        origin = EventOrigin("activity", name)
        if not self._enters(name) or self._is_idle(name) or not demand.level.volumes.get(origin):
            return WorstResponse(busy_period, "host")
        streams, volume = demand.streams_of(origin), demand.level.volumes[origin]
        try:
            hold = hold_before_activation(demand.demand_function(), volume, streams, busy_period, self.budget)
        except DivergedError:
            return WorstResponse(busy_period, "host")
        return WorstResponse(hold, "host")

    def _bound_level(self, level: Priority, cascades: LevelCascades) -> LevelBound:
        """Return the busy period of a level, or why there is none."""
        demand = CascadeDemand(cascades, self.find_model)
        share = demand.share()
        if share > 1 or (share == 1 and (level is None or not _settles_at_full_load(demand))):
            return LevelBound(None, OVERLOAD_CAUSE, demand)
        unknown_costs = [name for name in cascades.unknown_costs if not self._is_idle(name)]
        if unknown_costs or demand.causes:
            return LevelBound(
                None, unite_causes((*(UnknownCause((name,)) for name in unknown_costs), *demand.causes)), demand
            )
        previous = next(reversed(self.bounds.values()), None)
        # A level holds all the work of the level before: where that search ended in nothing, this one would, too.
        if previous is not None and previous.cause == DIVERGED_CAUSE:
            return LevelBound(None, DIVERGED_CAUSE, demand)
        try:
            busy_period = longest_busy_period(demand.demand_function(), self.budget)
        except DivergedError:
            return LevelBound(None, DIVERGED_CAUSE, demand)
        return LevelBound(busy_period, UnknownCause(), demand)

    def _is_idle(self, name: str) -> bool:
        """Whether an activity never works, or only at the start."""
        return name in self.core.inner_triggers.silent_ids

    def _find_response(self, name: str) -> WorstResponse:
        """Return the response of an activity from its activation on, as far as its level says."""
        thread, activity = self.core.thread_of[name], self.core.system.activities[name]
        level = thread.lowest_priority
        bound = self.bounds[level]
        if activity.wcet is None:
            return WorstResponse(None, "unknown", unite_causes((UnknownCause((name,)), bound.cause)))
        tier = self._tier_of(thread)
        busy_period = self._period_of_level(name, level)
        if bound.busy_period is None or busy_period is None:
            return WorstResponse(None, tier, DIVERGED_CAUSE if bound.cause == UnknownCause() else bound.cause)
        windows = self.windows[name] = [self._whole_period(name, level, busy_period)]
        start_costs = tuple(
            (each, cost)
            for each in thread.unit
            if self._is_idle(each) and (cost := self.core.system.activities[each].wcet)
        )
        if start_costs:
            extended_period = self._extend_busy_period(name, bound, sum(cost for _, cost in start_costs))
            if extended_period is None:
                return WorstResponse(None, tier, DIVERGED_CAUSE)
            windows[0] = self._whole_period(name, level, extended_period)._replace(start_costs=start_costs)
            return WorstResponse(extended_period, tier)
        # Only a thread of one activity, whose activations run in their order, can be followed activation by activation.
        if level is None or len(thread.unit) > 1 or not thread.in_order or not activity.wcet:
            return WorstResponse(busy_period, tier)
        return WorstResponse(self._response_by_activation(name, bound), tier)

    def _tier_of(self, thread: ThreadWork) -> ResponseTier:
        if thread.lowest_priority is None:
            return "executor" if len(self.core.threads) == 1 and len(thread.unit) > 1 else "host"
        return "priorities" if len(thread.unit) == 1 else "executor"

    def _extend_busy_period(self, name: str, bound: LevelBound, start_work: int) -> int | None:
        """Return the busy period with work that is done once, at the start, on top."""
        demand = add_demands(bound.demand.demand_function(), DemandFunction(lambda _: start_work))
        search = longest_busy_period if self.core.system.activities[name].wcet else longest_wait_for_turn
        try:
            return search(demand, self.budget, bound.busy_period or 0)
        except DivergedError:
            return None

    def _response_by_activation(self, name: str, bound: LevelBound) -> int:
        """Return the response of an activity over all its activations in the busy period of its level.

        Its n-th activation comes no sooner than the n-th event that leads to it, on whatever way.
        """
        busy_period = bound.busy_period or 0
        ways = self.core.ways_to[name]
        if any(way.entry.kind == "activity" and not self._enters(str(way.entry.key)) for way in ways):
            return busy_period  # behind a gate: how its events follow one another is not known here
        level_ids = self.bounds[self.core.thread_of[name].lowest_priority].demand.level.activations
        if not all(step in level_ids for way in ways for step in way.steps):
            return busy_period  # only where all of them may run at its level, all its activations count from them
        streams = tuple(
            stream
            for way in ways
            for stream in streams_of_calls(bound.demand.streams_of(way.entry), Fraction(way.multiplicity))
        )
        worst = self._find_worst_activation(name, streams, bound)
        if worst is None:
            return busy_period
        lead = min((way.best_before for way in ways), default=0)
        level = self.core.thread_of[name].lowest_priority
        self.windows[name].insert(0, LevelWindow(level, worst, name, lead))
        return min(busy_period, worst.response - lead)

    def _enters(self, name: str) -> bool:
        return name in self.core.inner_triggers.entry_ids

    def _find_worst_activation(self, name: str, streams: EventStreams, bound: LevelBound) -> WorstActivation | None:
        """Return what takes longest from an event to the end of the activation that it makes of `name`."""
        cost = self.core.system.activities[name].wcet or 0
        own_work = ActivityWork(cost, streams)
        interference = subtract_demand(bound.demand.demand_function(), GrowingLoad((own_work,)).demand_function())
        try:
            return find_worst_activation(own_work, interference, self.budget, bound.busy_period or 0)
        except DivergedError:
            return None

    def _delay_of_only_way(self, name: str, ways: Sequence[EntryWay]) -> int | None:
        """Return the delay of a way, activation by activation, where no other leads to its last step."""
        if len(ways) != 1 or ways[0].multiplicity != 1 or len(ways[0].steps) == 1:
            return None
        level = self._level_of_steps(ways[0].steps)
        bound = self.bounds.get(level)
        thread = self.core.thread_of[name]
        if level is None or bound is None or bound.busy_period is None or len(thread.unit) > 1 or not thread.in_order:
            return None
        if ways[0].entry.kind == "activity" and not self._enters(str(ways[0].entry.key)):
            return None
        if not self.core.system.activities[name].wcet:
            return None
        worst = self._find_worst_activation(name, bound.demand.streams_of(ways[0].entry), bound)
        if worst is None:
            return bound.busy_period
        self._note_way(name_way(ways[0]), LevelWindow(level, worst, name))
        return min(bound.busy_period, worst.response)

    def _level_of_steps(self, steps: Iterable[str]) -> Priority:
        """Return the level of the least urgent of some steps."""
        return min((self.core.thread_of[step].lowest_priority for step in steps), key=urgency_of)

    def _period_of_level(self, name: str, level: Priority) -> int | None:
        """Return the longest time that an activity, with all that leads to it, may take at a level."""
        return (
            self.bounds[level].busy_period if self.core.system.activities[name].wcet else self.find_wait_for_turn(level)
        )

    def find_wait_for_turn(self, level: Priority) -> int | None:
        """Return the busy period of a level for what takes no time, None where there is none."""
        if level not in self._waits_for_turn:
            busy_period, _, demand = self.bounds[level]
            try:
                self._waits_for_turn[level] = (
                    None
                    if busy_period is None
                    else longest_wait_for_turn(demand.demand_function(), self.budget, busy_period)
                )
            except DivergedError:
                self._waits_for_turn[level] = None
        return self._waits_for_turn[level]


def _settles_at_full_load(demand: CascadeDemand) -> bool:
    return not demand.has_gates and settles_at_full_load([each for model in demand.list_streams() for each in model])
