"""Busy windows: how long work can hold a processor, and threads all of several cores, in integer ticks.

`longest_busy_period` holds for any work-conserving scheduler. `find_worst_activation` is response-time analysis over all
activations of a busy period (Lehoczky 1990, with jitter as in Tindell, Burns and Wellings 1994), counted from the
activation itself (the jitter before it belongs to the event model).

The least t with C + W(t) <= t is found by repetition from below. Since eta+(t) >= (t + J)/P for each stream, no t below
(C + sum of u J)/(1 - sum of u) can be it: the repetition begins there, as far ahead as the average says (M. Sjodin and
H. Hansson, "Improved Response-Time Analysis Calculations", RTSS 1998, begin so without jitter). Streams of equal period
and jitter are one term.

Budgets of searches: one for each group of activities that depend on one another, so that no other group spends it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from fractions import Fraction
from typing import TypeVar

from archgen.frozen import NamedTuple
from archgen.model.graph_search import find_strong_components
from archgen.timing.load.event_streams import EventStream, EventStreams, earliest_arrivals
from archgen.timing.system.timing_system import TimingSystem

_MAX_TERMS = 40_000_000
"""Terms that searches may look at where nobody says how many: some seconds' worth."""
_MAX_TERMS_PER_SEARCH = 6_000_000
"""Terms that one search may look at, so that one that does not end leaves most of the budget to all others."""
_TERMS_PER_ACTIVATION = 8
"""Looking at one more activation takes as long as so many terms."""
# Fixed-point numbers, not Fractions: the start of a search is only a lower bound, so that rounding down is safe.
SHARE_BITS = 64
WHOLE_SHARE = 1 << SHARE_BITS
"""A whole processor, in the parts that shares are counted in."""


def round_up_share(share: Fraction) -> int:
    """Return a share of a processor in such parts, rounded up."""
    return -((-share.numerator << SHARE_BITS) // share.denominator)


class DivergedError(Exception):
    """The budget is used up: nothing can be said."""


class SearchBudget:
    """How many terms some searches may still look at: terms and not seconds, so that results can be repeated."""

    def __init__(
        self, term_count: int = _MAX_TERMS, terms_per_search: int | None = None, whole: SearchBudget | None = None
    ) -> None:
        """Start with the whole budget; what is spent of a part is spent of the `whole` as well."""
        self._whole = whole
        self._term_count = self._terms_left = term_count
        self._terms_per_search = _MAX_TERMS_PER_SEARCH if terms_per_search is None else terms_per_search

    @property
    def spent_terms(self) -> int:
        """Return how many terms were looked at."""
        return self._term_count - self._terms_left

    def open_part(self, term_count: int) -> SearchBudget:
        """Return a budget of so many terms of this one, if there are so many left, for searches of any length."""
        part_count = min(term_count, max(self._terms_left, 0))
        return SearchBudget(part_count, part_count, self)

    def start_search(self) -> Callable[[int], None]:
        """Begin a search: the returned function spends terms, and raises DivergedError after too many."""
        min_terms_left = max(self._terms_left - self._terms_per_search, 0)

        def spend(steps: int) -> None:
            self._terms_left -= steps
            if self._whole is not None:
                self._whole._terms_left -= steps  # noqa: SLF001 - it is one of these as well
            if self._terms_left < min_terms_left:
                raise DivergedError

        return spend


class ActivityWork(NamedTuple):
    """What one activity asks of a processor: execution time and event model."""

    cost: int
    streams: EventStreams


class DemandFunction(NamedTuple):
    """The most work that comes in a window of a length (a request bound function).

    `term_count` is the cost of a look; at least `scaled_rate` t + `scaled_offset` of it comes, in 2^-64 ticks.
    """

    within: Callable[[int], int]
    term_count: int = 0
    scaled_rate: int = 0
    scaled_offset: int = 0


NO_DEMAND = DemandFunction(lambda _: 0)


class GrowingLoad:
    """The work of activities in a window, sum of eta+(t) C; works can be added, and equal streams are one term."""

    def __init__(self, works: Iterable[ActivityWork] = ()) -> None:
        """Begin with some work."""
        # Lists beside the tables, because going through a list of plain tuples takes half the time of a table's items.
        self._periodic_terms: list[tuple[int, int, int]] = []
        self._general_terms: list[tuple[int, int, int, int, int]] = []
        self._periodic_places: dict[tuple[int, int], int] = {}
        self._general_places: dict[tuple[int, int, int, int], int] = {}
        self._scaled_rate = self._scaled_offset = 0
        self.add_work(works)

    def add_work(self, works: Iterable[ActivityWork]) -> None:
        """Add work."""
        terms, places = self._periodic_terms, self._periodic_places
        for cost, streams in works:
            for stream in streams if cost else ():
                period, jitter, distance, per_period, batch = stream
                # Two lists, because nearly all streams are plain ones, and their term is a single division.
                if distance or per_period != 1:
                    scaled_rate, scaled_offset = _lower_bound(stream, cost)
                    self._add_general((period, jitter, distance, per_period), cost * batch)
                else:
                    scaled_rate = (cost * batch << SHARE_BITS) // period
                    scaled_offset = scaled_rate * jitter
                    place = places.setdefault((period, jitter), len(terms))
                    if place < len(terms):
                        terms[place] = (period, -jitter, terms[place][2] + cost * batch)
                    else:
                        terms.append((period, -jitter, cost * batch))
                self._scaled_rate += scaled_rate
                self._scaled_offset += scaled_offset

    def _add_general(self, key: tuple[int, int, int, int], cost: int) -> None:
        terms = self._general_terms
        place = self._general_places.setdefault(key, len(terms))
        if place < len(terms):
            terms[place] = (*key, cost + terms[place][4])
        else:
            terms.append((*key, cost))

    def demand_function(self) -> DemandFunction:
        """Return the demand function. It is a live view: it goes on growing with the load."""
        # What one look costs, by the two kinds of terms in `_demand_within`.
        term_count = len(self._periodic_terms) + 2 * len(self._general_terms) + 1
        return DemandFunction(self._demand_within, term_count, self._scaled_rate, self._scaled_offset)

    def _demand_within(self, window: int) -> int:
        """Return the most work in a window."""
        work_sum, before = 0, -window
        for period, negative_jitter, cost in self._periodic_terms:
            work_sum -= (before + negative_jitter) // period * cost
        for period, jitter, distance, per_period, cost in self._general_terms:
            jobs = -(-(window + jitter) * per_period // period)
            if distance:
                jobs = min(jobs, -(-window // distance))
            work_sum += jobs * cost
        return work_sum


def _lower_bound(stream: EventStream, cost: int) -> tuple[int, int]:
    """Return a lower bound of a stream's work in a window t: rate and offset of rate t + offset, both rounded down."""
    period, jitter, distance, per_period, batch = stream
    scaled_rate = (cost * batch * per_period << SHARE_BITS) // period
    if distance:
        # eta-plus is the smaller of (t + J) / P and t / d, of which the second has no offset: only the rate is sure.
        return min(scaled_rate, (cost * batch << SHARE_BITS) // distance), 0
    return scaled_rate, scaled_rate * jitter


def subtract_demand(total: DemandFunction, subtracted: DemandFunction) -> DemandFunction:
    """Return what is left of some demand without a part of it.

    The part must be contained in the whole term by term, else the lower bound of the difference is none.
    """
    other_fields = (
        total.term_count + subtracted.term_count,
        total.scaled_rate - subtracted.scaled_rate,
        total.scaled_offset - subtracted.scaled_offset,
    )
    total_within, subtracted_within = total.within, subtracted.within
    return DemandFunction(lambda window: total_within(window) - subtracted_within(window), *other_fields)


def add_demands(first: DemandFunction, second: DemandFunction) -> DemandFunction:
    """Return the sum of two demands."""
    other_fields = (
        first.term_count + second.term_count,
        first.scaled_rate + second.scaled_rate,
        first.scaled_offset + second.scaled_offset,
    )
    return DemandFunction(lambda window: first.within(window) + second.within(window), *other_fields)


def longest_busy_period(demand: DemandFunction, budget: SearchBudget, lower_bound: int = 0) -> int:
    """Return the least t > 0 in which all work that came is done; `lower_bound` must not be above it."""
    return _find_fixed_point(0, demand, budget.start_search(), start=lower_bound)


def longest_wait_for_turn(demand: DemandFunction, budget: SearchBudget, lower_bound: int = 0) -> int:
    """Return the same for what takes no time itself: it waits on where something else comes as the last work ends.

    So the windows are closed: it is as if it took the smallest part of a tick.
    """
    return _find_fixed_point(1, demand, budget.start_search(), start=lower_bound) - 1


class WorstActivation(NamedTuple):
    """The activation of a busy period that takes longest: the `ordinal`-th, which comes and ends so long after the start.

    Where no single activation is looked at it stands for the whole busy period: `ordinal` and `arrival` are 0.
    """

    ordinal: int
    arrival: int
    finish: int

    @property
    def response(self) -> int:
        """Return how long it takes."""
        return self.finish - self.arrival


def find_worst_activation(
    work: ActivityWork, interference: DemandFunction, budget: SearchBudget, busy_period: int = 0
) -> WorstActivation:
    """Find the activation with the worst response, over all activations of the busy period.

    Where the length of the busy period of all work together is known (`busy_period`), no job ends before it, unless
    another job has come by then.
    """
    arrival_times, spend = earliest_arrivals(work.streams), budget.start_search()
    arrival, work_done, finish, count = next(arrival_times, 0), 0, 0, 0
    worst = WorstActivation(1, 0, 0)
    while True:
        spend(_TERMS_PER_ACTIVATION)
        # The q-th job ends at the least t = q C + W(t). The next one matters only if it comes before that: else the
        # busy period of this level is over, and the next job begins a new one that cannot be worse.
        work_done += work.cost
        count += 1
        next_arrival = next(arrival_times, None)
        # Must never be above the true end, or the search would step over the least fixed point. If this job ends before
        # the next one comes, its end is the end of the busy period; else it ends after `next_arrival`.
        earliest_finish = busy_period if next_arrival is None else min(busy_period, next_arrival + 1)
        start = max(finish, earliest_finish)
        finish = (
            _find_fixed_point(work_done, interference, spend, start=start)
            if work.cost
            else _find_fixed_point(1, interference, spend, start=start) - 1  # as in `longest_wait_for_turn`
        )
        if finish - arrival > worst.finish - worst.arrival:
            worst = WorstActivation(count, arrival, finish)
        if next_arrival is None or finish <= next_arrival:
            return worst
        arrival = next_arrival


def _find_fixed_point(own_work: int, demand: DemandFunction, spend: Callable[[int], None], *, start: int = 0) -> int:
    """Return the least t with own work + demand(t) <= t, searching from `start`."""
    within, term_count, scaled_rate, scaled_offset = demand
    # More than t comes in each t: there is no such t, and no need to look for it.
    if scaled_rate >= WHOLE_SHARE and (scaled_rate > WHOLE_SHARE or own_work or scaled_offset):
        raise DivergedError
    lower_bound = (
        ((own_work << SHARE_BITS) + scaled_offset) // (WHOLE_SHARE - scaled_rate) if scaled_rate < WHOLE_SHARE else 0
    )
    # The smallest window is 1 tick: it stands for one just longer than nothing, in which all first jobs come.
    window = max(start, own_work, lower_bound, 1)
    while True:
        spend(term_count + 1)
        work_sum = own_work + within(window)
        if work_sum <= window:
            # At the smallest window the need itself is the answer, which may be 0: work without execution time.
            return work_sum if window == 1 else window
        window = work_sum


_Amount = TypeVar("_Amount", int, Fraction)


def divide_among_cores(lane_works: Sequence[int], pending_work: int, core_count: int) -> int:
    """Return the longest time for which threads can keep all cores busy, rounded up."""
    # The plain quotient is the answer where no thread has more work than it.
    quotient = -(-(sum(lane_works) + pending_work) // core_count)
    if not lane_works or max(lane_works) <= quotient:
        return quotient
    numerator, denominator = find_blocked_time(lane_works, pending_work, core_count)
    return -(-numerator // denominator)


def find_blocked_time(lane_works: Sequence[_Amount], pending_work: _Amount, core_count: int) -> tuple[_Amount, int]:
    """Return the longest time B for which threads can keep all cores busy, as numerator and denominator.

    m B = pending work + sum of min(work, B): no thread works longer than that time.
    """
    rest = sum(lane_works, start=pending_work)
    # A whole sort: of a few dozen numbers it takes less than a tenth of `heapq.nlargest`.
    largest_works = sorted(lane_works, reverse=True)[: core_count - 1]
    # The k threads with the most work are busy all the time: what is left fills the other m - k cores.
    for busy_count, work in enumerate(largest_works):
        if work * (core_count - busy_count) <= rest:
            return rest, core_count - busy_count
        rest -= work
    return rest, core_count - len(largest_works)


_TERMS_PER_GROUP = 3_000_000
"""Terms that a group may look at, however small it is: half a second's worth. What ends has needed less than a million
in each of 25 random hosts of 60 activities at a load of 55 %."""
_TERMS_PER_MEMBER = 20_000
"""Terms that each activity of a group adds: larger hosts need more, and have more that is worth them."""

_TERMS_PER_WAY = 20_000
"""Terms for each way of transactions: those that come to rest in 1,000 random systems take a quarter of it."""
_SEARCHES_PER_GROUP = 6
"""How many searches that do not end it takes to spend a budget."""


class GroupBudgets:
    """Hands each group its budget, the same one in all turns of an analysis."""

    def __init__(self) -> None:
        """Start with no group."""
        # By the group's first step: a search that never ends must not begin anew with each turn.
        self._budgets: dict[str, SearchBudget] = {}
        self._transaction_budgets: dict[str, SearchBudget] = {}

    @property
    def spent_terms(self) -> int:
        """Return how many terms all groups have looked at."""
        budgets = (*self._budgets.values(), *self._transaction_budgets.values())
        return sum(budget.spent_terms for budget in budgets)

    def open_transactions(self, step: str, way_count: int) -> SearchBudget:
        """Return the budget of transactions, a small one: where it ends there are the bounds of each place alone."""
        term_count = _TERMS_PER_WAY * way_count
        return self._transaction_budgets.setdefault(step, SearchBudget(term_count, term_count))

    def assign_budgets(self, system: TimingSystem, successors: Mapping[str, Sequence[str]]) -> dict[str, SearchBudget]:
        """Return the budget of each step (activity or resource); `successors` say what a change of it changes."""
        neighbours: dict[str, list[str]] = {step: [] for step in successors}
        for step, next_steps in successors.items():
            for next_step in next_steps:
                neighbours[step].append(next_step)
                neighbours[next_step].append(step)
        _join_senders(system, neighbours)
        budget_of: dict[str, SearchBudget] = {}
        for group in find_strong_components(neighbours, neighbours.__getitem__):
            new_budget = open_budget(sum(step in system.activities for step in group))
            budget_of |= dict.fromkeys(group, self._budgets.setdefault(group[0], new_budget))
        return budget_of


def open_budget(member_count: int) -> SearchBudget:
    """Return the budget of a group of so many activities."""
    term_count = _TERMS_PER_GROUP + _TERMS_PER_MEMBER * member_count
    return SearchBudget(term_count, term_count // _SEARCHES_PER_GROUP)


def _join_senders(system: TimingSystem, neighbours: Mapping[str, list[str]]) -> None:
    """Make neighbours of all that waits for the same link: there each message may wait for all others."""
    last_senders: dict[str, str] = {}
    for arc in system.arcs:
        if arc.link is not None and arc.link in system.queued_links:
            last_sender = last_senders.get(arc.link, arc.source)
            for sender, other in ((arc.source, last_sender), (arc.source, arc.target)):
                neighbours[sender].append(other)
                neighbours[other].append(sender)
            last_senders[arc.link] = arc.source
