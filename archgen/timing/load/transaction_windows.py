"""How long the ways of transactions take at most: windows over whole ways, or over the steps behind any step of them.

Let D be the longest time from an event to the end of each step, b the shortest until it begins. An event is at one place at
a time. What holds it up there in a window [t, t + L] is work of that place, done in the window: of events from t - D (older
ones are through) to t + L - b. Such work is done once, whichever visit of the way it holds up. So the way from a step that
has ended (or from the event) to another one takes L, the sum of its own work and links, and for each place that it visits of
all other work there that may come (on several cores: of that in its own threads, and of the time for which all others keep
all cores busy). No response of the way itself is in L. Of the transaction's own other events it is known when they come, so
that only those steps count which may be there at the same time as the way.

Beside it stands the busy window of the last place alone: the smaller one counts. Any D that satisfies all these at once is
safe: up to the first instant at which one failed all would have held, and so it would not have failed.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import partial
from typing import NamedTuple

from archgen.timing.figures.timing_values import UnknownCause
from archgen.timing.load.busy_cores import divide_among_cores
from archgen.timing.load.busy_windows import ActivityWork, DivergedError, GrowingLoad, SearchBudget
from archgen.timing.load.event_streams import EventStreams, delay_streams, earliest_arrivals, max_arrivals
from archgen.timing.load.level_cascades import EventOrigin
from archgen.timing.load.shared_cores import WayKey
from archgen.timing.load.transactions import Place, PlaceJob, Transactions
from archgen.timing.system.core_sets import ThreadUnit

ENDLESS = 1 << 60
"""Longer than any time that is a bound, in ticks."""
_MAX_SWEEPS = 60
"""Sweeps over all ways before those that still grow are given up."""
_MAX_WAITING_EVENTS = 50
"""Events of one origin that may come within a delay, before it is said to have run away."""
_MAX_SPLIT_STEPS = 20
"""Steps of a way up to which a window is looked for behind each of them, and not only where another place begins."""


class JobTerm(NamedTuple):
    """Work of a place in a window: of each event of `streams` that comes in it or up to `lead` before, at most `limit`."""

    job: PlaceJob
    streams: EventStreams
    lead: int
    limit: int | None = None

    @property
    def is_endless(self) -> bool:
        """Whether any amount of it may come."""
        return self.job.cost is None or self.lead >= ENDLESS

    def count(self, window: int) -> int:
        """Return how often it comes."""
        number = max_arrivals(self.streams, window + self.lead)
        return number if self.limit is None else min(number, self.limit)


class TermSum:
    """The work of some terms in a window; those of one period and lead are looked at together."""

    def __init__(self, terms: Sequence[JobTerm]) -> None:
        """Put the terms together."""
        self.terms = terms
        self._endless_work = sum(ENDLESS for term in terms if term.is_endless)
        load, self._counted_terms = GrowingLoad(), list[tuple[int, JobTerm]]()
        for term in terms:
            is_plain = term.limit is None and not any(stream.distance for stream in term.streams)
            if term.is_endless:
                continue
            if is_plain:
                load.add_work([ActivityWork(term.job.cost or 0, delay_streams(term.streams, term.lead))])
            else:
                self._counted_terms.append((term.job.cost or 0, term))
        self._plain_within, plain_count, _, _ = load.demand_function()
        self.term_count = plain_count + 4 * len(self._counted_terms)

    def within(self, window: int) -> int:
        """Return all that is to be done in a window."""
        work = self._endless_work + self._plain_within(window)
        for cost, term in self._counted_terms:
            work += cost * term.count(window)
        return work


class PlaceWork(NamedTuple):
    """What holds up a way at a place: `own_sums` in full, and the time for which `lanes` keep all its cores busy.

    A lane works on one core at a time: a thread, or one event of a transaction that does not fork (`event_works`). Of
    `uncut_sums` several may run at once. Where all began as a core was idle, `full_lanes` have what may have been pending
    besides: in fewer threads than there are cores.
    """

    place: Place
    own_sums: tuple[TermSum, ...]
    lanes: tuple[TermSum, ...] = ()
    event_works: tuple[int, ...] = ()
    uncut_sums: tuple[TermSum, ...] = ()
    full_lanes: tuple[TermSum, ...] = ()

    def sum_within(self, window: int) -> int:
        """Return the longest time for which it holds up the way, in a window."""
        return sum([each.within(window) for each in self.own_sums]) + self.find_block(window)

    def find_block(self, window: int) -> int:
        """Return the longest time for which all cores are busy beside it."""
        if not (self.lanes or self.event_works or self.uncut_sums):
            return 0
        core_count, uncut_work = self.place.core_count, sum([each.within(window) for each in self.uncut_sums])
        lane_works = [lane.within(window) for lane in self.lanes]
        if not self.full_lanes:
            return divide_among_cores([*lane_works, *self.event_works], uncut_work, core_count)
        full_works = [lane.within(window) for lane in self.full_lanes]
        pending_works = sorted((full - work for full, work in zip(full_works, lane_works, strict=True)), reverse=True)
        pending_work = uncut_work + sum(pending_works[: core_count - 1])
        return min(
            divide_among_cores(lane_works, pending_work, core_count),
            divide_among_cores(full_works, uncut_work, core_count),
        )

    @property
    def term_count(self) -> int:
        """Return what one look at it costs."""
        return 1 + sum([each.term_count for each in (*self.own_sums, *self.lanes, *self.uncut_sums, *self.full_lanes)])


class _SplitWork(NamedTuple):
    """The work of other transactions at a place: what counts in full, that of each other thread, and what is not cut."""

    own_sum: TermSum
    lanes: Mapping[ThreadUnit, TermSum]
    uncut_sum: TermSum


class WayWindow(NamedTuple):
    """What bounds a way: the way `before` that has ended (none: from the event on), `lead` after it, and a window.

    In it are the own work and links of `steps`, and `works`; in the busy window of a place the own work is among these. What
    takes no time waits for what comes in the `closing_tick` after it as well.
    """

    before: WayKey | None
    lead: int
    steps: tuple[WayKey, ...]
    own_work: int
    link_time: int
    works: tuple[PlaceWork, ...]
    closing_tick: int

    def sum_within(self, window: int) -> int:
        """Return all that is to be done in a window."""
        return self.own_work + self.link_time + self.closing_tick + sum([work.sum_within(window) for work in self.works])


class TransactionWindows:
    """Finds the longest time of each way (`delays`, in ticks: `ENDLESS` where there is none), from below.

    Event models of what enters come from `model_of`, those of other work at a place (by its step) from `foreign_model_of`.
    """

    def __init__(
        self,
        transactions: Transactions,
        model_of: Callable[[EventOrigin], EventStreams | UnknownCause],
        foreign_model_of: Callable[[str, str], EventStreams | UnknownCause],
        delays: Mapping[WayKey, int],
        budget: SearchBudget,
    ) -> None:
        """Begin with some delays: those of a time when less came."""
        self.transactions, self._budget, self._spend = transactions, budget, budget.start_search()
        origins = dict.fromkeys(transactions.way_of(key).entry for key in transactions.paths)
        self._models = {origin: model_of(origin) for origin in origins}
        self._foreign_models = {
            (step, job.name): foreign_model_of(step, job.name)
            for step, place in transactions.places.items()
            for job in place.jobs
            if job.key is None
        }
        own_times = {key: self._find_own_time(path) for key, path in transactions.paths.items()}
        # Begun at nothing, with best cases above it, what is late by D - b would never come.
        self.delays = {key: max(delays.get(key, 0), own_time) for key, own_time in own_times.items()}
        streams = [each for model in self._models.values() if not isinstance(model, UnknownCause) for each in model]
        self._longest = max((_MAX_WAITING_EVENTS * (each.period + each.jitter) for each in streams), default=0)
        self._longest += max((each for each in own_times.values() if each < ENDLESS), default=0)
        # What takes no time meets what comes as it ends.
        self._margin = int(not all(transactions.costs[name] for name in transactions.ways_to))
        self._last_windows: dict[WayKey, int] = {}
        self._jobs_of_origin: dict[tuple[str, EventOrigin], list[PlaceJob]] = {}
        for step, place in transactions.places.items():
            for job in place.jobs:
                if job.key is not None:
                    self._jobs_of_origin.setdefault((step, job.origin), []).append(job)
        self._forget_works()

    def _forget_works(self) -> None:
        """Forget what follows from the delays."""
        # Within a sweep they are those of its begin: the last sweep, in which nothing grows, finds that all hold at once.
        self._foreign_works: dict[tuple[str, int | None, EventOrigin, frozenset[ThreadUnit]], _SplitWork] = {}
        self._busy_works: dict[tuple[str, int | None, bool, frozenset[ThreadUnit]], PlaceWork] = {}
        self._met_events: dict[tuple[WayKey, WayKey], frozenset[int]] = {}

    def _find_own_time(self, path: Sequence[WayKey]) -> int:
        way, costs = self.transactions.way_of(path[-1]), [self.transactions.costs[name] for name, _ in path]
        if isinstance(self._models[way.entry], UnknownCause) or None in costs:
            return ENDLESS
        # What is declared may be pending so long, whatever is computed.
        declared_end = way.best_before + self.transactions.declared.get(path[-1][0], 0)
        return max(way.link_time + sum(cost or 0 for cost in costs), declared_end)

    def solve(self) -> None:
        """Repeat until nothing grows. What runs away has no bound, nor has what it holds up."""
        try:
            while grown_keys := self._repeat_sweeps():
                self.delays.update(dict.fromkeys(grown_keys, ENDLESS))
        except DivergedError:
            self.delays = dict.fromkeys(self.delays, ENDLESS)

    def _repeat_sweeps(self) -> list[WayKey]:
        """Sweep until nothing grows; return what still does where the end is not reached."""
        grown_keys: list[WayKey] = []
        for _ in range(_MAX_SWEEPS):
            self._forget_works()
            grown_keys = [key for key in self.transactions.paths if self._raise_delay(key)]
            if not grown_keys:
                break
        return grown_keys

    def _raise_delay(self, key: WayKey) -> bool:
        """Let a delay be no less than the least of its windows, and return whether it grew."""
        delay, least = self.delays[key], ENDLESS
        # What never comes is not late.
        if delay >= ENDLESS or not self._models[self.transactions.way_of(key).entry]:
            return False
        openers, last = self._list_openers(self.transactions.paths[key]), self._last_windows.get(key, 0)
        # That which bounded it last comes first: it mostly does so again.
        for number in (last, *(each for each in range(len(openers)) if each != last)):
            window = openers[number]()
            if window is not None:
                found = self._find_delay(window, delay, least)
                if found <= delay:
                    self._last_windows[key] = number
                    return False
                least = min(least, found)
        self.delays[key] = least if least <= self._longest else ENDLESS
        return True

    def list_windows(self, key: WayKey) -> Iterator[WayWindow]:
        """Yield all that bounds a way."""
        for open_window in self._list_openers(self.transactions.paths[key]):
            window = open_window()
            if window is not None:
                yield window

    def _list_openers(self, path: tuple[WayKey, ...]) -> list[Callable[[], WayWindow | None]]:
        """Return what looks at the windows of a way: the busy window, the last step, longer rests, the whole way."""
        last, places = len(path) - 1, [self.transactions.place_of[name] for name, _ in path]
        starts = [
            first
            for first in range(last, -1, -1)
            if first in {0, last} or last < _MAX_SPLIT_STEPS or places[first] != places[first - 1]
        ]
        return [partial(self._open_busy_window, path), *(partial(self._open_window, path, first) for first in starts)]

    def _find_delay(self, window: WayWindow, enough: int, limit: int) -> int:
        """Return the delay that a window gives, `enough` where it is no more, something above the limit where it is above."""
        base = window.lead + (0 if window.before is None else self.delays[window.before])
        return min(base + self.find_length(window, enough - base, limit - base), ENDLESS)

    def find_length(self, window: WayWindow, enough: int = 0, limit: int = ENDLESS) -> int:
        """Return the least time in which a window's work is done; `enough`, or more than a limit, where that is known."""
        term_count = sum(work.term_count for work in window.works)
        length, tick = max(window.own_work + window.link_time, 1), window.closing_tick
        if enough >= length:
            self._spend(term_count)
            if window.sum_within(enough + tick) <= enough + tick:
                return enough
        limit = min(limit, self._longest)
        while length <= limit:
            self._spend(term_count)
            needed = window.sum_within(length)
            if needed <= length:
                return (needed if length == 1 else length) - tick
            length = needed
        return ENDLESS

    def _open_window(self, path: tuple[WayKey, ...], first: int) -> WayWindow | None:
        """Return the window of the steps from the given one on; None where the step before has no bound."""
        transactions, before = self.transactions, path[first - 1] if first else None
        if before is not None and self.delays[before] >= ENDLESS:
            return None
        link_time = transactions.way_of(path[-1]).link_time - (transactions.way_of(before).link_time if before else 0)
        steps_at: dict[str, list[WayKey]] = {}
        for key in path[first:]:
            steps_at.setdefault(transactions.place_of[key[0]], []).append(key)
        works = tuple(self._find_work(transactions.places[step], keys, path) for step, keys in steps_at.items())
        costs = [transactions.costs[name] or 0 for name, _ in path[first:]]
        return WayWindow(before, 0, path[first:], sum(costs), link_time, works, int(not costs[-1]))

    def _find_work(self, place: Place, visits: Sequence[WayKey], path: tuple[WayKey, ...]) -> PlaceWork:
        """Return what may hold up some steps of a way at the place that they visit."""
        own_units = self._list_own_units(place, visits)
        origin, level = self.transactions.way_of(path[-1]).entry, place.find_level(self._list_units(visits))
        others = self._split_others(place, level, origin, own_units)
        own_terms: list[JobTerm] = []
        beside_jobs: list[PlaceJob] = []
        for job in self._jobs_of_origin.get((place.step, origin), ()):
            if job.unit not in own_units and not place.counts_at(job.unit, level):
                continue
            if place.core_count > 1 and job.unit not in own_units:
                beside_jobs.append(job)
                continue
            met_visits = [key for key in visits if place.core_count == 1 or job.unit in self._list_own_units(place, [key])]
            event_ids = {each for key in met_visits for each in self._list_met_events(job, key, path)}
            if event_ids:
                own_terms.append(self._build_term(place, job)._replace(limit=len(event_ids)))
        work = PlaceWork(place, (others.own_sum, TermSum(own_terms)) if own_terms else (others.own_sum,))
        return work if place.core_count == 1 else self._add_beside(work, others, beside_jobs, visits, path)

    def _split_others(
        self, place: Place, level: int | None, origin: EventOrigin, own_units: frozenset[ThreadUnit]
    ) -> _SplitWork:
        """Return the work of all other transactions at a place: in some threads, and of each other one."""
        key = (place.step, level, origin, own_units if place.core_count > 1 else frozenset())
        if key not in self._foreign_works:
            own_terms: list[JobTerm] = []
            uncut_terms: list[JobTerm] = []
            lanes: dict[ThreadUnit, list[JobTerm]] = {}
            for job in place.jobs:
                if (job.key is None or job.origin != origin) and (
                    job.unit in own_units or place.counts_at(job.unit, level)
                ):
                    is_in_full = place.core_count == 1 or job.unit in own_units
                    is_cut = job.unit not in place.reentrant_units
                    beside_terms = lanes.setdefault(job.unit, []) if is_cut and not is_in_full else uncut_terms
                    (own_terms if is_in_full else beside_terms).append(self._build_term(place, job))
            self._foreign_works[key] = _SplitWork(
                TermSum(own_terms), {unit: TermSum(terms) for unit, terms in lanes.items()}, TermSum(uncut_terms)
            )
        return self._foreign_works[key]

    def _list_units(self, keys: Iterable[WayKey]) -> list[ThreadUnit]:
        return [self.transactions.unit_of[name] for name, _ in keys]

    def _list_own_units(self, place: Place, keys: Iterable[WayKey]) -> frozenset[ThreadUnit]:
        """Return the threads that some steps may wait for: their own, and those of their crowded container."""
        return frozenset(other for unit in self._list_units(keys) for other in place.crowd_of.get(unit, (unit,)))

    def _add_beside(
        self, work: PlaceWork, others: _SplitWork, jobs: Sequence[PlaceJob], visits: Sequence[WayKey], path: tuple[WayKey, ...]
    ) -> PlaceWork:
        """Return the work at a place with the time for which all its cores are busy beside a way, if that can be.

        Where the transaction does not fork, each of its other events is a lane, else each thread. A visit that fewer lanes
        meet than there are cores is not held up by them.
        """
        place, is_forked = work.place, self.transactions.way_of(path[-1]).entry in self.transactions.forked_origins
        met_events: dict[PlaceJob, set[int]] = {job: set() for job in jobs}
        is_blocked = False
        for key in visits:
            met_at = {job: event_ids for job in jobs if (event_ids := self._list_met_events(job, key, path))}
            own_lanes = {job.unit for job in met_at} if is_forked else {each for ids in met_at.values() for each in ids}
            is_uncut = others.uncut_sum.terms or any(job.unit in place.reentrant_units for job in met_at)
            if is_uncut or len({*others.lanes, *own_lanes}) >= place.core_count:
                is_blocked = True
                for job, event_ids in met_at.items():
                    met_events[job] |= event_ids
        if not is_blocked:
            return work
        event_works: dict[int, int] = {}
        uncut_terms: list[JobTerm] = []
        lanes: dict[ThreadUnit, list[JobTerm]] = {}
        for job, event_ids in met_events.items():
            term = self._build_term(place, job)._replace(limit=len(event_ids))
            if job.unit in place.reentrant_units:
                uncut_terms.append(term)
            elif is_forked or term.is_endless:
                lanes.setdefault(job.unit, []).append(term)
            else:
                for each in sorted(event_ids):
                    event_works[each] = event_works.get(each, 0) + (job.cost or 0)
        return work._replace(
            lanes=(
                *(lane for unit, lane in others.lanes.items() if unit not in lanes),
                *(TermSum([*(others.lanes[unit].terms if unit in others.lanes else ()), *lanes[unit]]) for unit in lanes),
            ),
            event_works=tuple(event_works.values()),
            uncut_sums=tuple(each for each in (others.uncut_sum, TermSum(uncut_terms)) if each.terms),
        )

    def _build_term(self, place: Place, job: PlaceJob) -> JobTerm:
        """Return the work of a job in a window in which the place need not have been idle at first."""
        if job.key is None:
            model = self._foreign_models[place.step, job.name]
            return JobTerm(job, (), ENDLESS) if isinstance(model, UnknownCause) else JobTerm(job, model, 0)
        return self._build_late_term(job, self.delays[job.key], job.key)

    def _build_late_term(self, job: PlaceJob, latest: int, key: WayKey) -> JobTerm:
        """Return the work of a job of which nothing is left so long after its event; it begins with a step of its way."""
        model = self._models[job.origin]
        if isinstance(model, UnknownCause) or latest >= ENDLESS:
            return JobTerm(job, (), ENDLESS)
        return JobTerm(job, model, max(latest - self.transactions.way_of(key).best_before, 0))

    def _list_met_events(self, job: PlaceJob, visit: WayKey, path: tuple[WayKey, ...]) -> frozenset[int]:
        """Return by number the events (0: the way's own, 1: the next one) whose job may be there during a visit."""
        if job.key is None:
            return frozenset()
        known = self._met_events.get((job.key, visit))
        if known is None:
            known = self._met_events[job.key, visit] = frozenset(self._find_met_events(job, job.key, visit))
        # Steps of the way come one after the other, and what is behind it begins when it has ended.
        job_path = self.transactions.paths[job.key]
        is_on_way = job_path == path[: len(job_path)] or path == job_path[: len(path)]
        return known - {0} if is_on_way else known

    def _find_met_events(self, job: PlaceJob, key: WayKey, visit: WayKey) -> Iterator[int]:
        model, own_end = self._models[job.origin], self.delays[key]
        if isinstance(model, UnknownCause) or own_end >= ENDLESS or self.delays[visit] >= ENDLESS:
            yield 1
            return
        own_begin = self.transactions.way_of(key).best_before
        begin, end = self.transactions.way_of(visit).best_before - self._margin, self.delays[visit] + self._margin
        is_timed = len(model) == 1 and model[0][3:] == (1, 1) and job.origin.key in self.transactions.periodic_ids
        for number, apart in enumerate(earliest_arrivals(model)):
            if number and apart + own_begin >= end and own_end - apart <= begin:
                return
            self._spend(1)
            latest = number * model[0].period + model[0].jitter if is_timed else ENDLESS
            if apart + own_begin < end and (latest if number else 0) + own_end > begin:
                yield number
            if number and own_end - apart > begin and own_begin - latest < end:
                yield -number

    def _open_busy_window(self, path: tuple[WayKey, ...]) -> WayWindow | None:
        """Return the busy window of the place of the last step: all that has come there since nothing waited."""
        place = self.transactions.places[self.transactions.place_of[path[-1][0]]]
        level = place.find_level(self._list_own_units(place, path[-1:]))
        # In any order all steps that follow one another on one core are done in one busy window.
        is_whole_run = place.core_count == 1 and level is None
        first = self._find_run_start(path) if is_whole_run else len(path) - 1
        before = path[first - 1] if first else None
        if before is not None and self.delays[before] >= ENDLESS:
            return None
        way, way_before = self.transactions.way_of(path[first]), self.transactions.way_of(before) if before else None
        lead = way.link_time - way_before.link_time if way_before else 0
        tick = int(not self.transactions.costs[path[-1][0]])
        work = self._find_busy_work(place, path[-1], level, is_whole_run=is_whole_run)
        return WayWindow(before, lead, path[first:], 0, 0, (work,), tick)

    def _find_run_start(self, path: Sequence[WayKey]) -> int:
        """Return the place in a way of the first of its last steps that follow one another at one place."""
        places = [self.transactions.place_of[name] for name, _ in path]
        first = len(places) - 1
        while first and places[first - 1] == places[-1]:
            first -= 1
        return first

    def _find_busy_work(self, place: Place, key: WayKey, level: int | None, *, is_whole_run: bool) -> PlaceWork:
        """Return what comes at a place, for the last step of a way, since nothing waited there in its threads."""
        own_units = self._list_own_units(place, [key]) if place.core_count > 1 else frozenset()
        known = self._busy_works.get((place.step, level, is_whole_run, own_units))
        if known is not None:
            return known
        own_terms: list[JobTerm] = []
        uncut_terms: list[JobTerm] = []
        lanes: dict[ThreadUnit, list[JobTerm]] = {}
        full_lanes: dict[ThreadUnit, list[JobTerm]] = {}
        for job in place.jobs:
            if job.unit not in own_units and not place.counts_at(job.unit, level):
                continue
            full_term = self._build_term(place, job)
            # What may have begun on other cores may have been pending here as well.
            term = full_term if job.key is None or job.is_foreign else self._build_entry(job, job.key, is_whole_run)
            if place.core_count == 1 or job.unit in own_units:
                own_terms.append(term)
            elif job.unit in place.reentrant_units:
                uncut_terms.append(full_term)
            else:
                lanes.setdefault(job.unit, []).append(term)
                full_lanes.setdefault(job.unit, []).append(full_term)
        work = self._busy_works[place.step, level, is_whole_run, own_units] = PlaceWork(
            place,
            (TermSum(own_terms),),
            tuple(map(TermSum, lanes.values())),
            (),
            (TermSum(uncut_terms),) if uncut_terms else (),
            tuple(map(TermSum, full_lanes.values())),
        )
        return work

    def _build_entry(self, job: PlaceJob, key: WayKey, is_whole_run: bool) -> JobTerm:
        """Return the work of a job that comes with its activation, or with that of the first step of its run."""
        path = self.transactions.paths[key]
        first = self._find_run_start(path) if is_whole_run else len(path) - 1
        if not first:
            return self._build_late_term(job, 0, path[0])
        before = path[first - 1]
        link_time = self.transactions.way_of(path[first]).link_time - self.transactions.way_of(before).link_time
        return self._build_late_term(job, self.delays[before] + link_time, path[first])
