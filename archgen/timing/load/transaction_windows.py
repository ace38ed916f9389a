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
from typing import Literal, NamedTuple

from archgen.timing.figures.timing_values import UnknownCause
from archgen.timing.load.busy_cores import divide_among_cores
from archgen.timing.load.busy_windows import ActivityWork, DivergedError, GrowingLoad, SearchBudget
from archgen.timing.load.event_streams import EventStreams, delay_streams, earliest_arrivals, max_arrivals
from archgen.timing.load.level_cascades import EventOrigin
from archgen.timing.load.run_ways import EntryWay
from archgen.timing.load.shared_cores import WayKey
from archgen.timing.load.transactions import Place, PlaceJob, Transactions
from archgen.timing.system.core_sets import ThreadUnit

ENDLESS = 1 << 60
"""Longer than any time that is a bound, in ticks."""
_MAX_SWEEPS = 60
"""Sweeps over all ways before those that still grow are given up."""
_PATIENT_SWEEPS = 8
"""Sweeps after which what still grows goes ahead."""
_MAX_WAITING_EVENTS = 20
"""Events of one origin that may come within a delay, before it is said to have run away."""
_MAX_SPLIT_STEPS = 20
"""Steps of a way up to which a window is looked for behind each of them, and not only where another place begins."""


_WorkBegin = Literal["late", "step", "run"]
"""Since when work may be there: as late as it may be; its activation; that of the first of its steps at the place."""


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
        place_ways: Mapping[str, Sequence[EntryWay]],
        budget: SearchBudget,
    ) -> None:
        """Begin with all own times. `place_ways` are the bounds of the last steps that were found place by place."""
        self._place_ways = place_ways
        self.transactions, self._budget, self._spend = transactions, budget, budget.start_search()
        origins = dict.fromkeys(transactions.way_of(key).entry for key in transactions.paths)
        self._models = {origin: model_of(origin) for origin in origins}
        self._foreign_models = {
            (step, job.name): foreign_model_of(step, job.name)
            for step, place in transactions.places.items()
            for jobs in place.jobs_of.values()
            for job in jobs
            if job.key is None
        }
        # Begun at nothing, with best cases above it, what is late by D - b would never come.
        self.delays = {key: self._find_own_time(path) for key, path in transactions.paths.items()}
        streams = [each for model in self._models.values() if not isinstance(model, UnknownCause) for each in model]
        self._longest = max((_MAX_WAITING_EVENTS * (each.period + each.jitter) for each in streams), default=0)
        self._longest += max((each for each in self.delays.values() if each < ENDLESS), default=0)
        # What takes no time meets what comes as it ends.
        self._margin = int(not all(transactions.costs[name] for name in transactions.ways_to))
        self._is_ahead = False
        self._last_windows: dict[WayKey, int] = {}
        self._jobs_of_origin: dict[tuple[str, EventOrigin], list[PlaceJob]] = {}
        for step, place in transactions.places.items():
            for job in (job for jobs in place.jobs_of.values() for job in jobs if job.key is not None):
                self._jobs_of_origin.setdefault((step, job.origin), []).append(job)
        self._forget_works()

    @property
    def inputs(self) -> tuple[object, ...]:
        """Return what the delays rest on."""
        return self._models, self._foreign_models, self._place_ways

    def begin_at(self, delays: Mapping[WayKey, int]) -> None:
        """Begin with the delays of a time when less came."""
        self.delays = {key: max(delay, delays[key]) for key, delay in self.delays.items()}

    def _forget_works(self) -> None:
        """Forget what follows from the delays."""
        # Within a sweep they are those of its begin: the last sweep, in which nothing grows, finds that all hold at once.
        self._sums: dict[tuple[str, tuple[ThreadUnit, ...], EventOrigin | None, _WorkBegin], TermSum] = {}
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
            return
        if self._is_ahead:
            self._lower_delays()

    def _repeat_sweeps(self) -> list[WayKey]:
        """Sweep until nothing grows; return what still does where the end is not reached."""
        grown_keys: list[WayKey] = []
        for sweep in range(_MAX_SWEEPS):
            self._forget_works()
            # What goes on growing goes ahead, further and further: so all come to rest, or run away, in a few sweeps.
            ahead = (1 << sweep // _PATIENT_SWEEPS) - 1
            grown_keys = [key for key in self.transactions.paths if self._raise_delay(key, ahead)]
            if not grown_keys:
                break
            self._is_ahead = self._is_ahead or ahead > 0
        return grown_keys

    def _lower_delays(self) -> None:
        """Take back what went too far: where no window of any delay gives more, the least ones of all give no more either."""
        safe_delays = dict(self.delays)
        try:
            for _ in range(_PATIENT_SWEEPS):
                self._forget_works()
                lowered = False
                for key, path in self.transactions.paths.items():
                    if self._models[self.transactions.way_of(key).entry]:
                        windows = filter(None, (open_window() for open_window in self._list_openers(path)))
                        least = min((self._find_delay(window, 0, self.delays[key]) for window in windows), default=ENDLESS)
                        lowered = lowered or least < self.delays[key]
                        self.delays[key] = min(least, self.delays[key])
                safe_delays = dict(self.delays)
                if not lowered:
                    return
        except DivergedError:
            self.delays = safe_delays

    def _raise_delay(self, key: WayKey, ahead: int) -> bool:
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
        least += (least - delay) * ahead
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
        return [
            partial(self._open_place_way, path),
            partial(self._open_busy_window, path),
            *(partial(self._open_window, path, first) for first in starts),
        ]

    def _open_place_way(self, path: tuple[WayKey, ...]) -> WayWindow | None:
        """Return what was found of the last steps from their own cores alone: that which gives least."""
        names = tuple(name for name, _ in path)
        longest: dict[int, int] = {}
        for way in self._place_ways.get(names[-1], ()):
            if names[-len(way.steps) :] == way.steps:
                longest[len(way.steps)] = max(way.delay or 0, longest.get(len(way.steps), 0))
        windows = [self._close_window(path, len(path) - count, delay) for count, delay in longest.items()]
        known_windows = [window for window in windows if window is not None]
        return min(known_windows, key=lambda window: self._find_delay(window, 0, ENDLESS), default=None)

    def _close_window(self, path: tuple[WayKey, ...], first: int, delay: int) -> WayWindow | None:
        """Return the window of the last steps of a way that are known to take no longer."""
        before = path[first - 1] if first else None
        if before is not None and self.delays[before] >= ENDLESS:
            return None
        return WayWindow(before, self._find_link_time(path[: first + 1], first) + delay, path[first:], 0, 0, (), 0)

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
        link_time = self._find_link_time(path, first)
        steps_at: dict[str, list[WayKey]] = {}
        for key in path[first:]:
            steps_at.setdefault(transactions.place_of[key[0]], []).append(key)
        works = tuple(self._find_work(transactions.places[step], keys, path) for step, keys in steps_at.items())
        costs = [transactions.costs[name] or 0 for name, _ in path[first:]]
        return WayWindow(before, 0, path[first:], sum(costs), link_time, works, int(not costs[-1]))

    def _find_link_time(self, path: Sequence[WayKey], first: int) -> int:
        """Return how long the links of a way take from the step before the given one on."""
        link_time = self.transactions.way_of(path[-1]).link_time
        return link_time - (self.transactions.way_of(path[first - 1]).link_time if first else 0)

    def _find_work(self, place: Place, visits: Sequence[WayKey], path: tuple[WayKey, ...]) -> PlaceWork:
        """Return what may hold up some steps of a way at the place that they visit."""
        origin, own_units = self.transactions.way_of(path[-1]).entry, self._list_own_units(place, visits)
        level_units = place.list_units(place.find_level(self._list_units(visits)))
        full_units = level_units if place.core_count == 1 else own_units
        work = PlaceWork(place, (self._sum_jobs(place, full_units, origin, "late"),))
        own_terms: list[JobTerm] = []
        beside_jobs: list[PlaceJob] = []
        for job in self._jobs_of_origin.get((place.step, origin), ()):
            if job.unit in full_units:
                met_visits = (
                    key for key in visits if place.core_count == 1 or job.unit in self._list_own_units(place, [key])
                )
                event_ids = {each for key in met_visits for each in self._list_met_events(job, key, path)}
                if event_ids:
                    own_terms.append(self._build_term(place, job, "late")._replace(limit=len(event_ids)))
            elif job.unit in level_units:
                beside_jobs.append(job)
        if own_terms:
            work = work._replace(own_sums=(*work.own_sums, TermSum(own_terms)))
        other_units = [unit for unit in level_units if unit not in full_units]
        return self._add_beside(work, other_units, beside_jobs, visits, path) if other_units else work

    def _sum_jobs(
        self, place: Place, units: tuple[ThreadUnit, ...], origin: EventOrigin | None, begin: _WorkBegin
    ) -> TermSum:
        """Return the work of some threads at a place, without that of a transaction."""
        key = (place.step, units, origin, begin)
        if key not in self._sums:
            jobs = (job for unit in units for job in place.jobs_of[unit] if job.key is None or job.origin != origin)
            self._sums[key] = TermSum([self._build_term(place, job, begin) for job in jobs])
        return self._sums[key]

    def _list_units(self, keys: Iterable[WayKey]) -> list[ThreadUnit]:
        return [self.transactions.unit_of[name] for name, _ in keys]

    def _list_own_units(self, place: Place, keys: Iterable[WayKey]) -> tuple[ThreadUnit, ...]:
        """Return the threads that some steps may wait for: their own, and those of their crowded container."""
        return tuple(
            dict.fromkeys(other for unit in self._list_units(keys) for other in place.crowd_of.get(unit, (unit,)))
        )

    def _add_beside(
        self,
        work: PlaceWork,
        units: Sequence[ThreadUnit],
        jobs: Sequence[PlaceJob],
        visits: Sequence[WayKey],
        path: tuple[WayKey, ...],
    ) -> PlaceWork:
        """Return the work at a place with the time for which all its cores are busy beside a way, if that can be.

        Where the transaction does not fork, each of its other events is a lane, else each thread. A visit that fewer lanes
        meet than there are cores is not held up by them.
        """
        place, origin = work.place, self.transactions.way_of(path[-1]).entry
        is_forked = origin in self.transactions.forked_origins
        sums = {unit: each for unit in units if (each := self._sum_jobs(place, (unit,), origin, "late")).terms}
        is_uncut = not place.reentrant_units.isdisjoint(sums)
        met_events: dict[PlaceJob, set[int]] = {job: set() for job in jobs}
        is_blocked = False
        for key in visits:
            met_at = {job: event_ids for job in jobs if (event_ids := self._list_met_events(job, key, path))}
            own_lanes = {job.unit for job in met_at} if is_forked else {each for ids in met_at.values() for each in ids}
            if (
                is_uncut
                or any(job.unit in place.reentrant_units for job in met_at)
                or len({*sums, *own_lanes}) >= place.core_count
            ):
                is_blocked = True
                for job, event_ids in met_at.items():
                    met_events[job] |= event_ids
        if not is_blocked:
            return work
        event_works: dict[int, int] = {}
        own_terms: dict[ThreadUnit, list[JobTerm]] = {}
        for job, event_ids in met_events.items():
            term = self._build_term(place, job, "late")._replace(limit=len(event_ids))
            if is_forked or term.is_endless or job.unit in place.reentrant_units:
                own_terms.setdefault(job.unit, []).append(term)
            else:
                for each in sorted(event_ids):
                    event_works[each] = event_works.get(each, 0) + (job.cost or 0)
        sums |= {
            unit: TermSum([*(sums[unit].terms if unit in sums else ()), *terms]) for unit, terms in own_terms.items()
        }
        return work._replace(
            lanes=tuple(each for unit, each in sums.items() if unit not in place.reentrant_units),
            event_works=tuple(event_works.values()),
            uncut_sums=tuple(each for unit, each in sums.items() if unit in place.reentrant_units),
        )

    def _build_term(self, place: Place, job: PlaceJob, begin: _WorkBegin) -> JobTerm:
        """Return the work of a job in a window: what came up to its longest time before, or what comes in it alone.

        What may run on other cores too may have begun there. In its `run` a job comes with the first step of those that
        follow one another at the place.
        """
        if job.key is None:
            foreign_model = self._foreign_models[place.step, job.name]
            is_known = not isinstance(foreign_model, UnknownCause)
            return JobTerm(job, foreign_model if is_known else (), 0 if is_known else ENDLESS)
        model, path = self._models[job.origin], self.transactions.paths[job.key]
        first, latest = len(path) - 1, self.delays[job.key]
        if begin != "late" and not job.is_foreign:
            first = self._find_run_start(path) if begin == "run" else first
            latest = self._find_link_time(path[: first + 1], first) + (self.delays[path[first - 1]] if first else 0)
        if isinstance(model, UnknownCause) or latest >= ENDLESS:
            return JobTerm(job, (), ENDLESS)
        return JobTerm(job, model, max(latest - self.transactions.way_of(path[first]).best_before, 0))

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
        own_units, level = self._list_own_units(place, path[-1:]), place.find_level(self._list_units(path[-1:]))
        # In any order all steps that follow one another on one core are done in one busy window.
        begin: _WorkBegin = "run" if place.core_count == 1 and level is None else "step"
        first = self._find_run_start(path) if begin == "run" else len(path) - 1
        before = path[first - 1] if first else None
        if before is not None and self.delays[before] >= ENDLESS:
            return None
        units = place.list_units(level)
        full_units = units if place.core_count == 1 else own_units
        work = PlaceWork(place, (self._sum_jobs(place, full_units, None, begin),))
        others = [unit for unit in units if unit not in full_units]
        if others:
            lanes = [unit for unit in others if unit not in place.reentrant_units]
            work = work._replace(
                lanes=tuple(self._sum_jobs(place, (unit,), None, begin) for unit in lanes),
                full_lanes=tuple(self._sum_jobs(place, (unit,), None, "late") for unit in lanes),
                uncut_sums=tuple(
                    self._sum_jobs(place, (unit,), None, "late") for unit in others if unit in place.reentrant_units
                ),
            )
        lead, tick = self._find_link_time(path[: first + 1], first), int(not self.transactions.costs[path[-1][0]])
        return WayWindow(before, lead, path[first:], 0, 0, (work,), tick)

    def _find_run_start(self, path: Sequence[WayKey]) -> int:
        """Return the place in a way of the first of its last steps that follow one another at one place."""
        first = len(path) - 1
        while first and self.transactions.place_of[path[first - 1][0]] == self.transactions.place_of[path[-1][0]]:
            first -= 1
        return first
