"""Response times of threads that Linux shares cores among: who has had least runs (EEVDF, and CFS before kernel 6.6).

Each core has a queue of its own. Let a thread wake up when nothing of it is pending, and have A to do until some job of it
has ended. While it waits, its core runs other threads of that core. One of them goes before it only as long as it has not
been served more than a lead beyond what it is behind: no other thread is served more than A and the lead on that core
while it waits, and none more than it has to do. So all others together take at most F, the sum of these. What was pending
is within that, which is why no response of another thread need be known.

A core without work takes what waits elsewhere. So all m cores are busy while the thread waits: for B at most, the greatest
time with m B = sum of min(W, B) over the other threads. Both hold at once, and the job has ended A + min(F, B) after the
thread woke up. F is not to be divided by m: all light threads may be on one core while long ones keep the others busy.

A process with several threads is served as often as it has threads, and whichever of its threads takes a job wakes up for
it: a lead more for each job. Threads with a priority (real-time ones) run before all others, and are not cut.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from itertools import accumulate
from math import lcm
from typing import NamedTuple

from archgen.timing.figures.timing_values import UnknownCause, sum_fractions, sum_ratios
from archgen.timing.load.busy_windows import (
    ActivityWork,
    DemandFunction,
    DivergedError,
    GrowingLoad,
    SearchBudget,
    WorstActivation,
    divide_among_cores,
    find_blocked_time,
)
from archgen.timing.load.core_responses import CoreResponses
from archgen.timing.load.event_streams import (
    EventStream,
    EventStreams,
    delay_streams,
    earliest_arrivals,
    max_arrivals,
    streams_of_calls,
)
from archgen.timing.load.fair_cores import FairCores, FairThread, ThreadGroup
from archgen.timing.load.level_cascades import EntryWay
from archgen.timing.load.storing_waits import longest_busy_window
from archgen.timing.load.thread_work import WorstResponse, work_utilisation
from archgen.timing.load.waiting_threads import Interference
from archgen.timing.load.work_terms import ANY_AMOUNT
from archgen.timing.system.thread_pools import ThreadUnit, find_thread_count, is_reentrant, works_in_order

FAIR_TERMS = 300_000
"""Terms for which bounds of fair shares are looked for on some cores, below those in any order: a quarter of a second's worth."""
_MAX_TURNS = 30
"""Turns over all threads; after each, all that was found is a bound, and the next one may only make it smaller."""
WayModel = Callable[[EntryWay], EventStreams | None]
"""The event model of what enters by a way, None where it is not known."""


class _LaneWork(NamedTuple):
    """What a lane may do beside a thread: its work in a window, with what may be pending (None: any amount).

    `share` is what it takes of a core in the long run; it may run on `width` cores at once.
    """

    within: Callable[[int], int] | None
    share: Fraction | None
    term_count: int
    width: int
    works: Sequence[tuple[str, ActivityWork]] = ()

    @property
    def known_share(self) -> Fraction:
        """Return what it takes of a core in the long run."""
        return Fraction(ANY_AMOUNT) if self.share is None else self.share

    def count_work(self, window: int) -> int:
        """Return its work in a window."""
        return ANY_AMOUNT if self.within is None else self.within(window)

    def split_work(self, window: int) -> list[int]:
        """Return its work in a window, in the parts that one core at a time may do."""
        work = self.count_work(window)
        return [work] if self.width == 1 else [-(-work // self.width)] * self.width


class _OtherWork(NamedTuple):
    """What all other groups may do beside a thread, lane by lane, and how many terms a look at them takes."""

    groups: Sequence[tuple[ThreadGroup, Sequence[_LaneWork]]]
    term_count: int


class FairBlock(NamedTuple):
    """What may come before a thread that has so much of its `own` to do, in ticks.

    Others are `served` for so long on its core, no thread of them for longer than the `cut`: the own work and so many
    leads. All cores are `blocked` for so long at most.
    """

    own: int
    leads: int
    cut: int
    served: int
    blocked: int


class FairBound(NamedTuple):
    """What bounds a thread: the `window` in which all that comes for it is done, and which activation takes longest."""

    thread: FairThread
    own_works: Sequence[ActivityWork]
    others: _OtherWork
    window: int
    worst: WorstActivation


@dataclass(slots=True)
class FairSolver:
    """Makes responses, ways and waits smaller by what a fair order makes of them; all that is found before is a bound."""

    cores: FairCores
    model_of: WayModel
    foreign_models: Mapping[str, EventStreams | UnknownCause]
    found: CoreResponses
    """What is known of the cores' own activities, in any order. What is smaller is put there."""
    foreign_responses: Mapping[str, WorstResponse]
    budget: SearchBudget
    _arrivals: dict[tuple[str, ThreadUnit], EventStreams | None] = field(default_factory=dict)
    _lanes: dict[ThreadUnit, _LaneWork] = field(default_factory=dict)
    _process_lanes: dict[str, tuple[Sequence[_LaneWork], int]] = field(default_factory=dict)
    _leasts: list[int] = field(default_factory=list)
    """What one job of each activity of a process takes, in ascending order; empty before somebody asks."""
    _least_sums: list[int] = field(default_factory=list)

    def solve(self) -> None:
        """Look at each thread, until nothing gets smaller."""
        for _ in range(_MAX_TURNS):
            self._arrivals.clear()
            self._lanes.clear()
            self._process_lanes.clear()
            if not sum([self._improve_thread(thread) for thread in self.cores.threads]):
                break

    def _improve_thread(self, thread: FairThread) -> bool:
        """Make the figures of a thread smaller, and return whether any is."""
        is_spent = self.budget.spent_terms >= FAIR_TERMS
        bound = self.find_bound(thread) if not is_spent and self._may_help(thread) else None
        if bound is None:
            return False
        return sum([self._note(thread, name, bound.worst.response, bound.window) for name in thread.unit]) > 0

    def find_bound(self, thread: FairThread) -> FairBound | None:
        """Return the window in which a thread has done all that came, and its worst activation; None without an end."""
        own_works = self._list_own(thread)
        others = self._collect_others(thread)
        if own_works is None or not self._has_end(thread, own_works, others):
            return None
        try:
            window = self._find_window(thread, own_works, others)
            return FairBound(thread, own_works, others, window, self._find_worst(thread, own_works, others, window))
        except DivergedError:
            return None

    def _note(self, thread: FairThread, name: str, response: int, window: int) -> bool:
        """Note the response of an activity, and the delays of the ways to it, where they are smaller."""
        found, is_smaller = self.found, False
        ways = list(found.ways_to.get(name, ()))
        for number, way in enumerate(ways):
            before = self._find_delay_before(way)
            delay = None if before is None else before + response
            if all(step in thread.unit for step in way.steps) and (delay is None or window < delay):
                delay = window  # all of the run lies in one window of its thread
            if delay is not None and (way.delay is None or delay < way.delay):
                ways[number], is_smaller = way._replace(delay=delay), True
        if is_smaller:
            found.ways_to[name] = tuple(ways)
        delays = [way.delay for way in ways]
        if ways and None not in delays:
            response = min(response, max((way.delay or 0) - way.best_before for way in ways))
        old = found.response_of[name]
        if old.tier not in {"declared", "unknown"} and (old.value is None or response < old.value):
            found.response_of[name], is_smaller = WorstResponse(response, "fair"), True
        return is_smaller

    def find_hold(self, name: str, known: int | None) -> int | None:
        """Return how long a message may wait to be stored until an activation of its reader that does not read it."""
        thread = next((each for each in self.cores.threads if name in each.unit), None)
        if self.budget.spent_terms >= FAIR_TERMS:
            return None
        if thread is not None and known is not None and self._find_least_time(thread, 0) >= known:
            return None
        own_works = self._list_own(thread) if thread is not None else None
        if thread is None or own_works is None:
            return None
        others = self._collect_others(thread)
        if not self._has_end(thread, own_works, others):
            return None
        number, spend = thread.own_ids.index(name), self.budget.start_search()

        def work_within(window: int, fewer: int) -> int:
            counts = [max_arrivals(work.streams, window) for work in own_works]
            if fewer:
                # The activation itself comes at the end of the window.
                counts[number] = max(max_arrivals(own_works[number].streams, window + 1) - 1, 0)
            return self._find_time(thread, own_works, counts, others, window)

        try:
            window = 1
            while (work := work_within(window, 0)) >= window:
                spend(others.term_count)
                window = work + 1
            return longest_busy_window(lambda each: work_within(each, 1), window, spend, others.term_count)
        except DivergedError:
            return None

    def _may_help(self, thread: FairThread) -> bool:
        """Whether what is found may be smaller than what is known."""
        known = [self.found.response_of[name].value for name in thread.unit]
        own_cost = max(self.cores.system.activities[name].wcet or 0 for name in thread.unit)
        return None in known or self._find_least_time(thread, own_cost) < max(each or 0 for each in known)

    def _find_least_time(self, thread: FairThread, own_cost: int) -> int:
        """Return how long it takes where one job of each other activity comes first, as far as it may."""
        if not self._leasts:
            self._leasts = sorted(map(self._find_least, self.cores.groups.values()))
            self._least_sums = list(accumulate(self._leasts, initial=0))
        cut = own_cost + self.cores.lead
        short_count = bisect_right(self._leasts, cut)
        beside = self._least_sums[short_count] + cut * (len(self._leasts) - short_count)
        return own_cost + beside - min(self._find_least(self.cores.groups[thread.process]), cut)

    def _find_least(self, group: ThreadGroup) -> int:
        """Return how long one job of each activity of a process takes."""
        return sum([self.cores.system.activities[name].wcet or 0 for unit in group.units for name in unit])

    def serve_others(self, limit: int | None) -> Interference | None:
        """Return how long others may be served before the only thread, which waits for each of its uses in between.

        None where that is not known, or is not below the limit.
        """
        thread = next(iter(self.cores.threads), None)
        own_works = self._list_own(thread) if thread else None
        if thread is None or own_works is None:
            return None
        own_cost = max(work.cost for work in own_works)
        if limit is not None and self._find_least_time(thread, own_cost) - own_cost >= limit:
            return None
        others, lead = self._collect_others(thread), self.cores.lead
        own_activities = [self.cores.system.activities[name] for name in thread.own_ids]
        uses = [len(each.uses) + (each.wait > 0) + thread.changes_threads for each in own_activities]
        work_and_lead = [
            ActivityWork(work.cost + lead * count, work.streams) for work, count in zip(own_works, uses, strict=True)
        ]
        own = GrowingLoad(work_and_lead).demand_function()
        share = sum_fractions(work_utilisation(each.cost, each.streams) for each in work_and_lead)

        names = ["/".join(name for unit in group.units for name in unit) for group, _ in others.groups]

        def list_served(window: int) -> Iterator[tuple[str, int]]:
            cut = own.within(window) + lead
            for (group, lanes), name in zip(others.groups, names, strict=True):
                yield name, group.cut_work(sum([each.count_work(window) for each in lanes]), cut)

        served_shares = [
            group.cut_work(sum_fractions(each.known_share for each in lanes), share) for group, lanes in others.groups
        ]
        demand = DemandFunction(lambda window: sum([served for _, served in list_served(window)]), others.term_count)
        return Interference(demand, sum_fractions(served_shares), list_served=list_served)

    def _find_window(self, thread: FairThread, own_works: Sequence[ActivityWork], others: _OtherWork) -> int:
        """Return the least window in which all that comes for a thread is done."""
        # What takes no time waits until nothing else does: as if it took the smallest part of a tick.
        closing_tick = int(any(not work.cost for work in own_works))
        spend, window = self.budget.start_search(), 1
        while True:
            spend(others.term_count)
            looked_at = window + closing_tick
            counts = [max_arrivals(work.streams, looked_at) for work in own_works]
            needed = self._find_time(thread, own_works, counts, others, looked_at)
            if needed <= window:
                return needed if window == 1 else window
            window = needed

    def _find_worst(
        self, thread: FairThread, own_works: Sequence[ActivityWork], others: _OtherWork, whole_window: int
    ) -> WorstActivation:
        """Return what takes longest: of the only activity of a thread, each activation since it woke up is looked at."""
        if len(own_works) > 1 or not works_in_order(self.cores.system, self.cores.system.activities[thread.unit[0]]):
            return WorstActivation(0, 0, whole_window)
        arrival_times, spend = earliest_arrivals(own_works[0].streams), self.budget.start_search()
        closing_tick = int(not own_works[0].cost)
        arrival, count, window = next(arrival_times, 0), 0, 1
        worst = WorstActivation(0, 0, 0)
        while True:
            count += 1
            next_arrival = next(arrival_times, None)
            while True:
                spend(others.term_count)
                needed = self._find_time(thread, own_works, (count,), others, window + closing_tick)
                if needed <= window:
                    break
                window = needed
            if window - arrival > worst.response:
                worst = WorstActivation(count, arrival, needed if window == 1 else window)
            if next_arrival is None or window <= next_arrival:
                return worst
            arrival = next_arrival

    def _find_time(
        self,
        thread: FairThread,
        own_works: Sequence[ActivityWork],
        counts: Sequence[int],
        others: _OtherWork,
        window: int,
    ) -> int:
        """Return how long all takes in a window with so many jobs of the thread's own: A + min(F, B)."""
        block = self.find_block(thread, own_works, counts, others, window)
        return block.own + min(block.served, block.blocked)

    def find_block(
        self,
        thread: FairThread,
        own_works: Sequence[ActivityWork],
        counts: Sequence[int],
        others: _OtherWork,
        window: int,
    ) -> FairBlock:
        """Return what may come before a thread in a window in which so many jobs of its own are done."""
        own = sum([work.cost * count for work, count in zip(own_works, counts, strict=True)])
        leads = sum(counts) if thread.changes_threads else 1
        cut, served = own + self.cores.lead * leads, 0
        lane_works: list[int] = []
        # As `split_work` and `cut_work` say; to call them for each lane took half of the time.
        for (_, group_width, is_urgent), lanes in others.groups:
            group_work = 0
            for within, _, _, width, _ in lanes:
                part = ANY_AMOUNT if within is None else within(window)
                if width > 1:
                    part = -(-part // width)
                group_work += part * width
                lane_works += [part] * width
            served += group_work if is_urgent or group_width is None else min(group_work, group_width * cut)
        core_count = self.cores.core_count
        blocked = divide_among_cores(lane_works, 0, core_count) if core_count > 1 and served else served
        return FairBlock(own, leads, cut, served, blocked)

    def _has_end(self, thread: FairThread, own_works: Sequence[ActivityWork], others: _OtherWork) -> bool:
        """Whether less comes in the long run than is done."""
        lead = self.cores.lead if thread.changes_threads else 0
        rates = [(cost, *stream.max_rate_ratio) for cost, streams in own_works for stream in streams]
        own, own_divisor = sum_ratios([(numerator * cost, divisor) for cost, numerator, divisor in rates])
        cut, cut_divisor = sum_ratios([(numerator * (cost + lead), divisor) for cost, numerator, divisor in rates])
        # In whole parts of a core: sums of fractions would take most of the time of a thread.
        known = [
            (group, [(*lane.known_share.as_integer_ratio(), lane.width) for lane in lanes])
            for group, lanes in others.groups
        ]
        whole = lcm(own_divisor, cut_divisor, *[divisor * width for _, shares in known for _, divisor, width in shares])
        own_parts, cut_parts, beside, lane_parts = own * (whole // own_divisor), cut * (whole // cut_divisor), 0, [0]
        for group, shares in known:
            parts = [numerator * (whole // divisor) for numerator, divisor, _ in shares]
            beside += group.cut_work(sum(parts), cut_parts)
            for part, (_, _, width) in zip(parts, shares, strict=True):
                lane_parts += [part // width] * width
        blocked, divisor = find_blocked_time(lane_parts, 0, self.cores.core_count)
        return own_parts + beside < whole or own_parts * divisor + blocked < whole * divisor

    def _collect_others(self, thread: FairThread) -> _OtherWork:
        """Return what all other groups may do beside a thread."""
        groups = [
            (group, *self._look_up_lanes(key, group))
            for key, group in self.cores.groups.items()
            if key != thread.process
        ]
        if thread.rest is not None:
            groups.append((thread.rest, *self._find_lanes(thread.rest)))
        return _OtherWork([each[:2] for each in groups], 1 + sum([term_count for _, _, term_count in groups]))

    def _look_up_lanes(self, process: str, group: ThreadGroup) -> tuple[Sequence[_LaneWork], int]:
        """Return what the lanes of a process may do beside a thread, and how many terms that takes."""
        known = self._process_lanes.get(process)
        if known is None:
            known = self._process_lanes[process] = self._find_lanes(group)
        return known

    def _find_lanes(self, group: ThreadGroup) -> tuple[Sequence[_LaneWork], int]:
        lanes = [self._look_up_lane(unit) for unit in group.units]
        return lanes, sum([lane.term_count for lane in lanes])

    def _look_up_lane(self, unit: ThreadUnit) -> _LaneWork:
        """Return what a lane may do beside a thread, as far as it is known now."""
        known = self._lanes.get(unit)
        if known is None:
            known = self._lanes[unit] = self._find_lane(unit)
        return known

    def _find_lane(self, unit: ThreadUnit) -> _LaneWork:
        activities = self.cores.system.activities
        works = [self._find_work_of_other(name) for name in unit]
        width = 1
        if is_reentrant(self.cores.system, activities[unit[0]]):
            width = min(find_thread_count(self.cores.system, unit[0]) or self.cores.core_count, self.cores.core_count)
        sure_works = [work for work in works if work is not None]
        if len(sure_works) < len(works):
            return _LaneWork(None, None, 1, width)
        demand = GrowingLoad(sure_works).demand_function()
        shares = [work_utilisation(each.cost, each.streams) for each in sure_works]
        named_works = tuple(zip(unit, sure_works, strict=True))
        share = sum_fractions(shares)
        return _LaneWork(demand.within, share, demand.term_count, width, named_works)

    def _find_work_of_other(self, name: str) -> ActivityWork | None:
        """Return the work of an activity beside a thread, of what may be pending too; None where it is not known."""
        activity = self.cores.system.activities[name]
        streams = self._arrivals_at(name, ())
        if streams == () or activity.wcet == 0:
            return ActivityWork(0, ())
        response = self.found.response_of.get(name) or self.foreign_responses.get(name)
        if streams is None or activity.wcet is None or response is None or response.value is None:
            return None
        if activity.response is not None:
            return None  # when its work is done is not what is declared
        return ActivityWork(activity.wcet, delay_streams(streams, response.value))

    def _list_own(self, thread: FairThread) -> list[ActivityWork] | None:
        """Return what comes for a thread itself, None where some of it is not known."""
        works: list[ActivityWork] = []
        for name in thread.own_ids:
            streams = self._arrivals_at(name, thread.own_ids if not thread.changes_threads else ())
            if streams is None:
                return None
            works.append(ActivityWork(self.cores.system.activities[name].wcet or 0, streams))
        return works

    def _arrivals_at(self, name: str, idle_ids: tuple[str, ...]) -> EventStreams | None:
        """Return when an activity is activated; what reaches it through `idle_ids` alone is not late before the window."""
        key = (name, idle_ids)
        if key not in self._arrivals:
            self._arrivals[key] = self._find_arrivals(name, idle_ids)
        return self._arrivals[key]

    def _find_arrivals(self, name: str, idle_ids: tuple[str, ...]) -> EventStreams | None:
        ways = self.found.ways_to.get(name) or self.cores.ways_to.get(name)
        if ways is None:
            foreign_model = self.foreign_models[name]
            return None if isinstance(foreign_model, UnknownCause) else foreign_model
        streams: list[EventStream] = []
        for way in ways:
            model = self.model_of(way)
            if model is None:
                return None
            before = 0 if all(step in idle_ids for step in way.steps[:-1]) else self._find_delay_before(way)
            if before is None:
                return None
            entering = streams_of_calls(model, Fraction(way.multiplicity)) if way.multiplicity > 1 else model
            streams += delay_streams(entering, max(before - way.best_before, 0))
        return tuple(streams)

    def _find_delay_before(self, way: EntryWay) -> int | None:
        """Return how long a way takes to the step before its last one, None where that is not bounded."""
        before = self.find_way_before(way)
        return before.delay if before else 0

    def find_way_before(self, way: EntryWay) -> EntryWay | None:
        """Return the way to the step before the last one of a way."""
        if len(way.steps) == 1:
            return None
        known = self.found.ways_to.get(way.steps[-2]) or self.cores.ways_to[way.steps[-2]]
        return next(each for each in known if each.entry == way.entry and each.steps == way.steps[:-1])
