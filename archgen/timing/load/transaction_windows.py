"""How long the ways of transactions take at most: windows over whole ways, or over the steps behind any step of them.

Let D be the longest time from an event to the end of each step, b the shortest until it begins. An event is at one place at
a time. What holds it up there in a window [t, t + L] is work of that place, done in the window: of events from t - D (older
ones are through) to t + L - b. Such work is done once, whichever visit of the way it holds up. So the way from a step that
has ended (or from the event) to another one takes L, the sum of its own work and links, and for each place that it visits of
all other work there that may come (on several cores: of that in its own threads, and of the time for which all others keep
all cores busy). No response of the way itself is in L. Of the transaction's own other events it is known when they come, so
that only those steps count which may be there at the same time as the way.

Beside it stands what was found of the last steps place by place: the smallest counts. Any D that satisfies all these at
once is safe: up to the first instant at which one failed all would have held, and so it would not have failed.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial

from archgen.frozen import NamedTuple
from archgen.timing.figures.timing_values import UnknownCause
from archgen.timing.load.busy_windows import ActivityWork, DivergedError, GrowingLoad, SearchBudget, divide_among_cores
from archgen.timing.load.event_streams import EventStreams, delay_streams, earliest_arrivals, max_arrivals
from archgen.timing.load.level_cascades import EntryWay, EventOrigin, ModelFinder
from archgen.timing.load.shared_cores import WayKey
from archgen.timing.load.transactions import Place, PlaceJob, Transactions
from archgen.timing.load.work_terms import ONCE, CountFormulas, EventCount, FigureWorking, WorkTerm, group_terms
from archgen.timing.system.thread_pools import ThreadUnit

ENDLESS = 1 << 60
"""Longer than any time that is a bound, in ticks."""
_MAX_SWEEPS = 60
"""Sweeps over all ways before those that still grow are given up."""
_PATIENT_SWEEPS = 12
_MAX_WAITING_EVENTS = 20
"""Events of one origin that may come within a delay, before it is said to have run away."""
_MAX_SPLIT_STEPS = 20
"""Steps of a way up to which a window is looked for behind each of them, and not only where another place begins."""


class JobTerm(NamedTuple):
    """Work of a place in a window: of each event of `streams` that comes in it or up to `lead` before, at most `limit`."""

    job: PlaceJob
    streams: EventStreams
    lead: int
    limit: int | None = None

    def count(self, window: int) -> int:
        """Return how often it comes."""
        number = max_arrivals(self.streams, window + self.lead)
        return number if self.limit is None else min(number, self.limit)

    @property
    def work_of_each(self) -> int:
        """Return what each time does; `ENDLESS` where nobody knows how often, or how long."""
        return ENDLESS if self.job.cost is None or self.lead >= ENDLESS else self.job.cost

    def within(self, window: int) -> int:
        """Return all that is to be done in a window."""
        return ENDLESS if self.work_of_each >= ENDLESS else self.work_of_each * self.count(window)


class _EventJob(NamedTuple):
    """A job of one event of the transaction of a way: 0 is the way's own event, 1 the next one."""

    job: PlaceJob
    number: int


class TermSum:
    """The work of some terms in a window; those of one period and lead are looked at together."""

    def __init__(self, terms: Sequence[JobTerm]) -> None:
        """Put the terms together."""
        self.terms = terms
        load, self._counted_terms = GrowingLoad(), list[JobTerm]()
        for term in terms:
            is_plain = term.limit is None and term.job.cost is not None and term.lead < ENDLESS
            if is_plain and not any(stream.distance for stream in term.streams):
                load.add_work([ActivityWork(term.job.cost or 0, delay_streams(term.streams, term.lead))])
            else:
                self._counted_terms.append(term)
        self._plain_within, plain_count, _, _ = load.demand_function()
        self.term_count = plain_count + 4 * len(self._counted_terms)

    def within(self, window: int) -> int:
        """Return all that is to be done in a window."""
        return self._plain_within(window) + sum([term.within(window) for term in self._counted_terms])


class PlaceWork(NamedTuple):
    """What holds up a way at a place: `own_sums` in full, and the time for which lanes keep all its cores busy.

    A lane works on one core at a time: a thread (`lanes`), or another event of the transaction (`event_works`).
    """

    place: Place
    own_sums: tuple[TermSum, ...]
    lanes: tuple[TermSum, ...] = ()
    event_works: tuple[int, ...] = ()

    def find_block(self, window: int) -> int:
        """Return the longest time for which all cores are busy beside the way."""
        lane_works = [*(lane.within(window) for lane in self.lanes), *self.event_works]
        return divide_among_cores(lane_works, 0, self.place.core_count) if lane_works else 0

    def within(self, window: int) -> int:
        """Return the longest time for which the way is held up, in a window."""
        return sum([each.within(window) for each in self.own_sums]) + self.find_block(window)


class WayWindow(NamedTuple):
    """What bounds a way: the way `before` that has ended (none: from the event on), `lead` after it, and a window.

    In it are the own work and links of `steps`, and `works`. What takes no time waits for what comes in the `closing_tick`
    after it as well.
    """

    before: WayKey | None
    lead: int
    steps: tuple[WayKey, ...] = ()
    own_work: int = 0
    link_time: int = 0
    works: tuple[PlaceWork, ...] = ()
    closing_tick: int = 0

    def within(self, window: int) -> int:
        """Return all that is to be done in a window."""
        return self.own_work + self.link_time + self.closing_tick + sum([work.within(window) for work in self.works])


class TransactionWindows:
    """Finds the longest time of each way (`delays`, in ticks: `ENDLESS` where there is none), from below.

    Event models of what enters come from `model_of`, those of other work at a place (by its step) from `foreign_model_of`.
    `place_ways` are the bounds of the last steps of ways that were found place by place.
    """

    def __init__(
        self,
        transactions: Transactions,
        model_of: ModelFinder,
        foreign_model_of: Callable[[str, str], EventStreams | UnknownCause],
        place_ways: Mapping[str, Sequence[EntryWay]],
        budget: SearchBudget,
    ) -> None:
        """Begin with all own times."""
        self.transactions, self._place_ways, self._spend = transactions, place_ways, budget.start_search()
        self.models = {
            origin: model_of(origin) for origin in dict.fromkeys(way.entry for way in transactions.ways.values())
        }
        jobs = [
            (step, job)
            for step, place in transactions.places.items()
            for each in place.jobs_of.values()
            for job in each
        ]
        self.foreign_models = {
            (step, job.name): foreign_model_of(step, job.name) for step, job in jobs if job.key is None
        }
        # Begun at nothing, with best cases above it, what is late by D - b would never come.
        self.delays = {key: self._find_own_time(key) for key in transactions.paths}
        streams = [each for model in self.models.values() if not isinstance(model, UnknownCause) for each in model]
        self._longest = max((_MAX_WAITING_EVENTS * (each.period + each.jitter) for each in streams), default=0)
        self._longest += max((each for each in self.delays.values() if each < ENDLESS), default=0)
        # What takes no time meets what comes as it ends.
        self._margin = int(not all(map(self._cost_of, transactions.paths)))
        self._last_windows: dict[WayKey, int] = {}
        self._forget_sums()

    def _forget_sums(self) -> None:
        """Forget what follows from the delays."""
        # Within a sweep they are those of its begin: the last sweep, in which nothing grows, finds that all hold at once.
        self._sums: dict[tuple[str, tuple[ThreadUnit, ...], EventOrigin], TermSum] = {}
        self._met_events: dict[tuple[WayKey, WayKey], frozenset[int]] = {}

    def _cost_of(self, key: WayKey) -> int | None:
        return self.transactions.system.activities[key[0]].wcet

    def _find_own_time(self, key: WayKey) -> int:
        way, costs = self.transactions.ways[key], [self._cost_of(each) for each in self.transactions.paths[key]]
        if isinstance(self.models[way.entry], UnknownCause) or None in costs:
            return ENDLESS
        # What is declared may be pending so long, whatever is computed.
        declared_end = way.best_before + (self.transactions.system.activities[key[0]].response or 0)
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
        for sweep in range(_MAX_SWEEPS):
            self._forget_sums()
            # What goes on growing goes ahead, further and further: what is above the least delays that are safe is so too.
            steps_ahead = (1 << sweep // _PATIENT_SWEEPS) - 1
            grown_keys = [key for key in self.transactions.paths if self._raise_delay(key, steps_ahead)]
            if not grown_keys:
                break
        return grown_keys

    def _raise_delay(self, key: WayKey, steps_ahead: int) -> bool:
        """Let a delay be no less than the least of its windows, and return whether it grew."""
        delay, least = self.delays[key], ENDLESS
        # What never comes is not late.
        if delay >= ENDLESS or not self.models[self.transactions.ways[key].entry]:
            return False
        openers, last = self._list_openers(self.transactions.paths[key]), self._last_windows.get(key, 0)
        # That which bounded it last comes first: it mostly does so again.
        for number in (last, *(each for each in range(len(openers)) if each != last)):
            found = self.find_delay(openers[number](), delay, least)
            if found <= delay:
                self._last_windows[key] = number
                return False
            least = min(least, found)
        least += (least - delay) * steps_ahead
        self.delays[key] = least if least <= self._longest else ENDLESS
        return True

    def list_windows(self, key: WayKey) -> list[WayWindow]:
        """Return all that bounds a way."""
        return [open_window() for open_window in self._list_openers(self.transactions.paths[key])]

    def _list_openers(self, path: tuple[WayKey, ...]) -> list[Callable[[], WayWindow]]:
        """Return what looks at the windows of a way: those of its last steps, and of the whole way, are always among them."""
        last, places = len(path) - 1, [self.transactions.place_of[name] for name, _ in path]
        starts = [
            first
            for first in range(last, -1, -1)
            if first in {0, last} or last < _MAX_SPLIT_STEPS or places[first] != places[first - 1]
        ]
        names, delays = tuple(name for name, _ in path), dict[int, int]()
        for way in self._place_ways.get(names[-1], ()):
            if names[-len(way.steps) :] == way.steps:
                delays[len(way.steps)] = max(way.delay or 0, delays.get(len(way.steps), 0))
        return [
            *(partial(self._close_window, path, len(path) - count, delay) for count, delay in delays.items()),
            *(partial(self._open_window, path, first) for first in starts),
        ]

    def find_delay(self, window: WayWindow, enough: int = 0, limit: int = ENDLESS) -> int:
        """Return the delay that a window gives; `enough`, or more than a limit, where that is known."""
        base = window.lead + (0 if window.before is None else self.delays[window.before])
        if not window.steps:
            return min(base, ENDLESS)
        length, tick = max(window.own_work + window.link_time, 1), window.closing_tick
        term_count = 1 + sum(each.term_count for work in window.works for each in (*work.own_sums, *work.lanes))
        if enough >= base + length:
            self._spend(term_count)
            if window.within(enough - base + tick) <= enough - base + tick:
                return enough
        while base + length <= min(limit, self._longest):
            self._spend(term_count)
            needed = window.within(length)
            if needed <= length:
                return base + (needed if length == 1 else length) - tick
            length = needed
        return ENDLESS

    def _find_link_time(self, path: Sequence[WayKey], first: int) -> int:
        """Return how long the links of a way take from the step before the given one on."""
        ways = self.transactions.ways
        return ways[path[-1]].link_time - (ways[path[first - 1]].link_time if first else 0)

    def _close_window(self, path: tuple[WayKey, ...], first: int, delay: int) -> WayWindow:
        """Return the bound of the last steps of a way that are known to take no longer, from when they are fired."""
        return WayWindow(path[first - 1] if first else None, self._find_link_time(path[: first + 1], first) + delay)

    def _open_window(self, path: tuple[WayKey, ...], first: int) -> WayWindow:
        """Return the window of the steps of a way from the given one on."""
        visits_at: dict[str, list[WayKey]] = {}
        for key in path[first:]:
            visits_at.setdefault(self.transactions.place_of[key[0]], []).append(key)
        works = (self._find_work(self.transactions.places[step], keys, path) for step, keys in visits_at.items())
        costs = [self._cost_of(key) or 0 for key in path[first:]]
        link_time = self._find_link_time(path, first)
        before = path[first - 1] if first else None
        return WayWindow(before, 0, path[first:], sum(costs), link_time, tuple(works), int(not costs[-1]))

    def _find_work(self, place: Place, visits: Sequence[WayKey], path: tuple[WayKey, ...]) -> PlaceWork:
        """Return what may hold up some steps of a way at the place that they visit.

        On several cores it is held up at a visit by its own thread, or by as many other lanes as there are cores: threads, and
        the transaction's own other events (where it forks, each job of them). With fewer lanes it is not held up.
        """
        origin, units = self.transactions.ways[path[-1]].entry, place.list_units(name for name, _ in visits)
        own_units = tuple(dict.fromkeys(place.thread_of[name].unit for name, _ in visits))
        full_units = units if place.core_count == 1 else own_units
        jobs = [job for unit in units for job in place.jobs_of[unit] if job.key is not None and job.origin == origin]
        counted: dict[_EventJob, None] = {}
        is_blocked = False
        for key in visits:
            met = [_EventJob(job, number) for job in jobs for number in sorted(self._list_met_events(job, key, path))]
            beside = [each for each in met if key[0] not in each.job.unit]
            others = [unit for unit in units if key[0] not in unit and self._sum_jobs(place, (unit,), origin).terms]
            if place.core_count == 1 or len(others) + len({*map(self._name_lane, beside)}) >= place.core_count:
                is_blocked = True
                counted |= dict.fromkeys(met)
            else:
                counted |= dict.fromkeys(each for each in met if key[0] in each.job.unit)
        numbers = Counter(each.job for each in counted if each.job.unit in full_units)
        own_terms = [self._build_term(place, job)._replace(limit=number) for job, number in numbers.items()]
        own_sum = self._sum_jobs(place, full_units, origin)
        work = PlaceWork(place, (own_sum, TermSum(own_terms)) if own_terms else (own_sum,))
        if place.core_count == 1 or not is_blocked:
            return work
        event_works: dict[object, int] = {}
        for each in counted:
            if each.job.unit not in full_units:
                term, lane = self._build_term(place, each.job), self._name_lane(each)
                # Nobody knows how many of an endless one there are: so many keep all cores busy.
                lanes = [lane] if term.lead < ENDLESS else [(lane, core) for core in range(place.core_count)]
                event_works |= {name: event_works.get(name, 0) + term.work_of_each for name in lanes}
        other_sums = [self._sum_jobs(place, (unit,), origin) for unit in units if unit not in full_units]
        return work._replace(
            lanes=tuple(each for each in other_sums if each.terms), event_works=tuple(event_works.values())
        )

    def _sum_jobs(self, place: Place, units: tuple[ThreadUnit, ...], origin: EventOrigin) -> TermSum:
        """Return the work of some threads at a place, without that of a transaction."""
        key = (place.step, units, origin)
        if key not in self._sums:
            jobs = (job for unit in units for job in place.jobs_of[unit] if job.key is None or job.origin != origin)
            self._sums[key] = TermSum([self._build_term(place, job) for job in jobs])
        return self._sums[key]

    def _name_lane(self, event_job: _EventJob) -> object:
        job, number = event_job
        return event_job if job.origin in self.transactions.forked_origins else number

    def _build_term(self, place: Place, job: PlaceJob) -> JobTerm:
        """Return the work of a job in a window: nothing is left of what came longer than D before it."""
        model = self.foreign_models[place.step, job.name] if job.key is None else self.models[job.origin]
        delay = 0 if job.key is None else self.delays[job.key]
        if isinstance(model, UnknownCause) or delay >= ENDLESS:
            return JobTerm(job, (), ENDLESS)
        best_before = 0 if job.key is None else self.transactions.ways[job.key].best_before
        return JobTerm(job, model, max(delay - best_before, 0))

    def _list_met_events(self, job: PlaceJob, visit: WayKey, path: tuple[WayKey, ...]) -> frozenset[int]:
        """Return by number the events (0: the way's own, 1: the next one) whose job may be there during a visit."""
        if job.key is None:
            return frozenset()
        if (job.key, visit) not in self._met_events:
            self._met_events[job.key, visit] = frozenset(self._find_met_events(job.key, visit))
        # Steps of the way come one after the other, and what is behind it begins when it has ended.
        job_path, known = self.transactions.paths[job.key], self._met_events[job.key, visit]
        is_on_way = job_path == path[: len(job_path)] or path == job_path[: len(path)]
        return known - {0} if is_on_way else known

    def _find_met_events(self, key: WayKey, visit: WayKey) -> Iterator[int]:
        way, activities = self.transactions.ways[key], self.transactions.system.activities
        model, own_begin, own_end = self.models[way.entry], way.best_before, self.delays[key]
        if isinstance(model, UnknownCause) or own_end >= ENDLESS or self.delays[visit] >= ENDLESS:
            yield 1
            return
        begin, end = self.transactions.ways[visit].best_before - self._margin, self.delays[visit] + self._margin
        # Only of a timer it is known that its next event has come by then.
        is_timed = way.entry.kind == "activity" and activities[str(way.entry.key)].behaviour == "periodic"
        for number, apart in enumerate(earliest_arrivals(model)):
            if number and apart + own_begin >= end and own_end - apart <= begin:
                return
            self._spend(1)
            latest = number * model[0].period + model[0].jitter if is_timed else ENDLESS
            if apart + own_begin < end and (latest if number else 0) + own_end > begin:
                yield number
            if number and own_end - apart > begin and own_begin - latest < end:
                yield -number


def explain_way_window(
    window: WayWindow, windows: TransactionWindows, key: WayKey, formulas: CountFormulas
) -> FigureWorking:
    """Return how the time of a way comes about: of the step that has ended before, own work and links, place by place."""
    before = 0 if window.before is None else windows.delays[window.before]
    length, steps = windows.delays[key] - before, tuple(name for name, _ in windows.transactions.paths[key])
    own_parts = tuple((name, windows.transactions.system.activities[name].wcet or 0) for name, _ in window.steps)
    terms = [WorkTerm(own_parts, ONCE, "its own"), WorkTerm((("links", window.link_time),), ONCE, "on the way")]
    if window.before is not None:
        terms.insert(
            0, WorkTerm(((window.before[0], before),), ONCE, "the time until it has ended, looked at by itself")
        )
    span = length + window.closing_tick
    for work in window.works:
        place = windows.transactions.system.activities[next(iter(work.place.thread_of))].host or work.place.step
        for term in (term for each in work.own_sums for term in each.terms):
            count = formulas.count_events(term.streams, span + term.lead)
            reason = f"on {place}, those of {formulas.write_duration(term.lead)} before included"
            if term.limit is not None and term.limit <= count.number:
                count = EventCount(term.limit, str(term.limit))
                reason = f"on {place}, of its own events: so many can be there at the same time"
            terms.append(WorkTerm(((term.job.name, term.job.cost or 0),), count, reason))
        lane_works = [*(lane.within(span) for lane in work.lanes), *work.event_works]
        texts = " + ".join(map(formulas.write_duration, sorted(lane_works, reverse=True)))
        reason = f"all {work.place.core_count} cores of {place} busy with others: {texts}, none for longer than that"
        terms.append(WorkTerm((("others", work.find_block(span)),), ONCE, reason))
    return FigureWorking(before + length, before + length, group_terms(terms), steps=steps)
