"""Bounds on several cores from how much can be pending while a core is idle. They hold in any order, and no delay on the
cores is in them that is not in a thread which several ways share: so they do not run away where delays come back as jitter.

Z(t) is what is left at t of the work that all events before t lead to. K bounds it whenever a core was idle just before t.
Let an event have reached the end of its way to some step only at t, and go back from there. Either its step runs; or its
thread runs other work; or all m cores are busy (or all k threads of its container, with k < m). Or it was not ready yet: then go
on with what it waited for, its own step before or the same step of the event before, down to an event's arrival, and
further to when the first thread of the way had no work, and a core was idle, at t1. So in w = t - t1 each instant is one at which
the way's threads run for it, for A together, or the container's threads are all busy, for G, or all cores are, for P. The
steps of n + 1 events take their sum once and n times the slowest step, as they follow one another in order through the
threads that have one step of the way. All that was done is m P + A + k G <= Z(t1) + (what comes in w) - Z(t), so that

    w = A + G + P <= A (1 - 1/m) + G (1 - k/m) + (what comes in w + Z(t1) - Z(t)) / m.

With Z(t1) <= K and Z(t) >= 0 the least such w bounds the delay: were the event not through at t1 + w, more would have been done
than there is. Now let t be the first idle instant at which Z(t) > K. Just before it each pending event has a step in
one of the at most m - 1 threads that run, or in a container with all threads busy. For it Z(t1) <= K < Z(t), so that K
stands on neither side: w is at most the *greatest* that what comes in w leaves possible, and that says how many events can be pending,
in each thread. K is the most that m - 1 threads can have then; so Z(t) <= K after all. (It is a Lyapunov argument: what is pending
may not grow from one idle instant to the next once it is large.) What is in a thread that several ways share may have come as much
earlier as its own way takes: those delays are found by repetition from below, all together, and count only once nothing
changes any more. The first bound to fail would need another one that failed before.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import cache
from heapq import nlargest
from itertools import islice

from archgen.frozen import NamedTuple
from archgen.timing.load.busy_windows import (
    SHARE_BITS,
    WHOLE_SHARE,
    DivergedError,
    SearchBudget,
    WorstActivation,
    round_up_share,
)
from archgen.timing.load.core_paths import SharedWork, WayWork
from archgen.timing.load.event_streams import EventStreams, earliest_arrivals, max_arrivals
from archgen.timing.load.level_cascades import CascadeDemand, EventOrigin
from archgen.timing.load.shared_cores import SharedCores, WayKey

_MAX_ROUNDS = 25
"""Repetitions for the delays in threads that several ways share."""
_MAX_EVENTS = 300
"""Events in a row that are looked at on one way: more of them come only where next to nothing is left of the cores."""


class PendingShare(NamedTuple):
    """What a thread (or container), called like its first activity, may have pending of an origin: so much work at most.

    They may be `age` old, so that there are `events` of them, with `rest` still to be done for each; in ticks.
    """

    name: str
    origin: EventOrigin
    age: int
    events: int
    rest: int
    work: int


def find_idle_backlog(
    cores: SharedCores, way_works: Mapping[WayKey, WayWork], demand: CascadeDemand, budget: SearchBudget
) -> IdleBacklog | None:
    """Return what can be pending on some cores, None where no bound is found."""
    backlog = IdleBacklog(cores, way_works, demand, budget.start_search())
    try:
        backlog.find()
    except DivergedError:
        return None
    return backlog


class IdleBacklog:
    """The most that can be pending just after a core was idle (`pending_shares`), and how long each way takes (`delays`):
    its `worst_events`.
    """

    def __init__(
        self,
        cores: SharedCores,
        way_works: Mapping[WayKey, WayWork],
        demand: CascadeDemand,
        spend: Callable[[int], None],
    ) -> None:
        """Add up the long-run rates of all that comes; each look at it is one that `spend` counts."""
        self.spend = spend
        self.cores, self.core_count, self.way_works = cores, cores.core_count, way_works
        self.streams: dict[EventOrigin, EventStreams] = {
            origin: demand.streams_of(origin) for origin, volume in cores.cascades.volumes.items() if volume
        }
        work_within, self.term_count, _, _ = demand.demand_function()
        # Many ways are looked at for the same windows.
        self.work_within = cache(work_within)
        volumes = cores.cascades.volumes
        # Whole numbers, rounded up: a search from above may begin a little higher.
        self.scaled_rates = {origin: round_up_share(demand.rate_of(origin)) for origin in self.streams}
        # What comes in a window is at most rate x window and this: a whole batch, and its jitter's worth.
        self.bursts = {origin: _find_burst(model) for origin, model in self.streams.items()}
        self.whole_rate = sum(rate * volumes[origin] for origin, rate in self.scaled_rates.items())
        self.whole_burst = sum(burst * volumes[origin] for origin, burst in self.bursts.items())
        # With as many threads as cores, none waits for a thread while a core is idle.
        self.small_crowds = {crowd for crowd in cores.crowd_of.values() if crowd[1] < cores.core_count}
        self.delays: dict[WayKey, int] = dict.fromkeys(way_works, 0)
        self.worst_events: dict[WayKey, WorstActivation] = {}
        self.growths: dict[WayKey, int] = {}
        self.pending_shares: tuple[PendingShare, ...] = ()
        self.pending_work = 0
        """K."""

    def find(self) -> None:
        """Find all of it, by repetition where some thread serves several ways."""
        self.growths = {key: self._find_growth(way_work) for key, way_work in self.way_works.items()}
        if any(growth >= WHOLE_SHARE for growth in self.growths.values()):
            raise DivergedError
        is_shared = any(way_work.others or way_work.crowds for way_work in self.way_works.values())
        for _ in range(_MAX_ROUNDS):
            self.pending_shares = self._find_pending()
            self.pending_work = _sum_works(self.pending_shares)
            self.worst_events = {key: self._find_worst_event(way_work) for key, way_work in self.way_works.items()}
            delays = {key: max(self.delays[key], worst.response) for key, worst in self.worst_events.items()}
            is_settled = not is_shared or delays == self.delays
            self.delays = delays
            if is_settled:
                return
        raise DivergedError

    def _find_worst_event(self, way_work: WayWork) -> WorstActivation:
        """Return the event of a way that takes longest, of all that may come in a busy window."""
        whole_window = self.find_busy_window(way_work)
        window, delay, worst = 0, 0, WorstActivation(1, 0, 0)
        arrivals = self._list_arrivals(way_work, whole_window)
        for count, arrival in enumerate(arrivals):
            if whole_window - arrival <= delay:
                break
            if count == len(arrivals) - 1 and not way_work.behind:
                window = whole_window  # nothing of this event, nor of another one, comes after it
            else:
                window = self._find_window(way_work, count, max(window, arrival))
            if window - arrival > delay:
                delay, worst = window - arrival, WorstActivation(count + 1, arrival, window)
        return worst

    def _list_arrivals(self, way_work: WayWork, window: int) -> list[int]:
        """Return the earliest times of the events of a way in a window."""
        model = self.streams.get(way_work.origin)
        if not model:
            return [0]
        count = max_arrivals(model, window)
        if count > _MAX_EVENTS:
            raise DivergedError
        return list(islice(earliest_arrivals(model), count))

    def find_busy_window(self, way_work: WayWork) -> int:
        """Return the longest window in which a way, or all cores, may be busy."""
        window, model, pending_work = 1, self.streams.get(way_work.origin, ()), self.pending_work
        while True:
            events = max(max_arrivals(model, window), 1)
            needed = self._find_need(way_work, events - 1, window, self.work_within(window) + pending_work)
            if needed <= window:
                return window
            window = needed

    def _find_window(self, way_work: WayWork, count: int, window: int) -> int:
        """Return the least window, from `window` on, in which an event behind `count` others is through its way."""
        model, pending_work = self.streams.get(way_work.origin, ()), self.pending_work
        while True:
            work = self.work_within(window) - self.count_unfinished(way_work, count, max_arrivals(model, window))
            needed = self._find_need(way_work, count, window, work + pending_work)
            if needed <= window:
                return window
            window = needed

    def count_unfinished(self, way_work: WayWork, count: int, events: int) -> int:
        """Return the work of so many events that is not done before one behind `count` others is through its way.

        That is what comes behind its last step, and of the events after it all from that step on.
        """
        later_events = events - count - 1
        return way_work.behind + later_events * way_work.from_last if later_events >= 0 else 0

    def _find_need(self, way_work: WayWork, count: int, window: int, work: int) -> int:
        """Return A (1 - 1/m) + G (1 - k/m) + work / m, rounded up."""
        self.spend(self.term_count + len(way_work.others))
        own_work = way_work.cost + count * way_work.slowest
        if way_work.others:
            own_work += self._count_shared(way_work.others, window)
        total = own_work * (self.core_count - 1) + work
        for members, threads in way_work.crowds:
            total += -(-self._count_shared(members, window) * (self.core_count - threads) // threads)
        return max(-(-total // self.core_count), 1)

    def _count_shared(self, shared_works: Iterable[SharedWork], window: int) -> int:
        return sum(
            [
                work * max_arrivals(self.streams[origin], window + (self.delays[way_before] if way_before else 0))
                for origin, work, way_before in shared_works
            ]
        )

    def _find_growth(self, way_work: WayWork) -> int:
        """Return by how much what is needed grows with the window, in 2^-64 of it: there is an end only below the whole."""
        core_count, rates = self.core_count, self.scaled_rates
        own_rate = way_work.slowest * rates.get(way_work.origin, 0)
        own_rate += sum([work * rates[origin] for origin, work, _ in way_work.others])
        growth = own_rate * (core_count - 1) + self.whole_rate
        for members, threads in way_work.crowds:
            crowd_rate = sum([work * rates[origin] for origin, work, _ in members])
            growth -= -crowd_rate * (core_count - threads) // threads
        return -(-growth // core_count)

    def _find_pending(self) -> tuple[PendingShare, ...]:
        """Return K: what the m - 1 threads that can have most pending may have, and all that waits for containers.

        It is no more than all that the events lead to which can be pending, in whatever threads.
        """
        share_of: dict[tuple[object, EventOrigin], PendingShare] = {}
        whole_shares: dict[EventOrigin, PendingShare] = {}
        for way_work in self.way_works.values():
            origin = way_work.origin
            if origin not in self.streams:
                continue
            age = self._find_age(way_work)
            lane = self._find_lane(way_work.key[0])
            share = share_of.get((lane, origin), PendingShare(way_work.key[0], origin, 0, 0, 0, 0))
            age, rest = max(age, share.age), max(way_work.left, share.rest)
            count = max_arrivals(self.streams[origin], age) if age > 0 else 0
            share_of[lane, origin] = PendingShare(share.name, origin, age, count, rest, count * rest)
            if origin not in whole_shares or count > whole_shares[origin].events:
                volume = self.cores.cascades.volumes[origin]
                whole_shares[origin] = PendingShare(share.name, origin, age, count, volume, count * volume)
        crowd_shares = [share for (lane, _), share in share_of.items() if lane in self.small_crowds]
        lanes: dict[object, list[PendingShare]] = {}
        for (lane, _), share in share_of.items():
            if lane not in self.small_crowds:
                lanes.setdefault(lane, []).append(share)
        most_of_origin = {origin: share.work for origin, share in whole_shares.items()}
        lane_shares = choose_largest_lanes(list(lanes.values()), most_of_origin, self.core_count - 1)
        return min((*crowd_shares, *lane_shares), tuple(whole_shares.values()), key=_sum_works)

    def _find_lane(self, name: str) -> object:
        """Return what an activity waits for while a core is idle: its thread, or those of its container."""
        crowd = self.cores.crowd_of.get(name)
        return crowd if crowd in self.small_crowds else self.cores.unit_of[name]

    def _find_age(self, way_work: WayWork) -> int:
        """Return for how long an event may have been on a way at an idle instant before which less was pending."""
        window = self._find_greatest_window(way_work, None)
        age = 0
        arrivals = self._list_arrivals(way_work, window)
        for count, arrival in enumerate(arrivals):
            if window - arrival <= age:
                break
            # Of the last one the window is known: all others came before it.
            is_last = count == len(arrivals) - 1
            greatest = window if is_last else self._find_greatest_window(way_work, count, window)
            age = max(age, greatest - arrival)
        return age

    def _find_greatest_window(self, way_work: WayWork, count: int | None, window: int | None = None) -> int:
        """Return the greatest window that is not longer than what is needed in it.

        An event is behind `count` others; None stands for all that come in the window. It is found from above.
        """
        model = self.streams.get(way_work.origin, ())
        if window is None:
            window = self._find_window_above(way_work)
        while window > 0:
            others = max(max_arrivals(model, window), 1) - 1 if count is None else count
            needed = self._find_need(way_work, others, window, self.work_within(window))
            if needed >= window:
                break
            window = needed
        return window

    def _find_window_above(self, way_work: WayWork) -> int:
        """Return a window in which less is needed than it lasts, as in all longer ones."""
        growth, core_count = self.growths[way_work.key], self.core_count
        own_burst = way_work.cost + way_work.slowest * self.bursts.get(way_work.origin, 0)
        burst = (own_burst + self._sum_bursts(way_work.others)) * (core_count - 1) + self.whole_burst + core_count
        for members, threads in way_work.crowds:
            burst += self._sum_bursts(members) * core_count // threads + core_count
        return (burst << SHARE_BITS) // (core_count * (WHOLE_SHARE - growth)) + 1

    def _sum_bursts(self, shared_works: Iterable[SharedWork]) -> int:
        total = 0
        for origin, work, way_before in shared_works:
            early = self.scaled_rates[origin] * self.delays[way_before] if way_before else 0
            total += work * (self.bursts[origin] - (-early >> SHARE_BITS))
        return total


def _sum_works(shares: Iterable[PendingShare]) -> int:
    return sum(share.work for share in shares)


def _find_burst(streams: EventStreams) -> int:
    """Return how many events may come at once, and what jitter adds to any window, rounded up."""
    return sum(
        stream.batch_size - (-stream.jitter * stream.max_rate_ratio[0] // stream.max_rate_ratio[1])
        for stream in streams
    )


def choose_largest_lanes(
    lanes: Sequence[Sequence[PendingShare]], most_of_origin: Mapping[EventOrigin, int], number: int
) -> Iterator[PendingShare]:
    """Yield what so many lanes may have at most, where of each origin no more counts than there is of it."""
    if any(len(lane) > 1 for lane in lanes):
        for lane in nlargest(number, lanes, key=lambda lane: sum(share.work for share in lane)):
            yield from lane
        return
    shares_of: dict[EventOrigin, list[PendingShare]] = {}
    for (share,) in lanes:
        shares_of.setdefault(share.origin, []).append(share)
    # What another lane of an origin adds is less each time, so that the largest additions are the most.
    additions: list[PendingShare] = []
    for origin, shares in shares_of.items():
        rest = most_of_origin[origin]
        for share in sorted(shares, key=lambda each: -each.work):
            additions.append(share._replace(work=min(share.work, rest)))
            rest -= additions[-1].work
    yield from nlargest(number, additions, key=lambda share: share.work)
