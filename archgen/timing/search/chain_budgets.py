"""How much each element may take, how rarely it may work, and by what a host may slow down, until a chain is late.

Each figure is looked at alone, all others as they are; and all together, grown by one common factor. It is tried in steps, each
a tick of its own; the largest one is found in few looks, by a secant of exact figures, or by halves.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from fractions import Fraction

from archgen.frozen import dataclass
from archgen.model.architecture import Architecture
from archgen.timing.analysis import Analysis, ChainResult, ChainTerm
from archgen.timing.figures.figure_wording import write_exact_duration
from archgen.timing.figures.tick_unit import NS_PER_SECOND, written_period
from archgen.timing.search.change_trials import Changes, ChangeTrials, TriedChange, TriesSpentError
from archgen.timing.system.timing_system import Activity

MAX_TRIES = 1_000
"""How many figures are tried for the budget of one chain."""
MAX_SHARE_TRIES = 300
"""How many common factors are tried for the shares of one chain."""
FACTOR_STEPS = 1_000
"""Factors are found in thousandths."""
_LARGEST_FACTOR = 1_000
SlackFunction = Callable[[int], Fraction | None]
"""How much is left of a deadline at a step; None where nothing is known to be left. It grows with no step."""


@dataclass(frozen=True, slots=True)
class FigureBudget:
    """How large a figure of an element (`wcet`, `response`, `period`) may be, all others as they are; durations in ns.

    `largest` is None where the chain is late however small it is, and where it is in time however large (`is_free`).
    """

    activity: str
    key: str
    written: Fraction
    largest: Fraction | None
    is_free: bool = False


@dataclass(frozen=True, slots=True)
class FactorBudget:
    """By which factor all execution times of some elements may grow; None where no factor does, or any (`is_free`)."""

    factor: Fraction | None
    is_free: bool = False


@dataclass(frozen=True, slots=True)
class PartnerShare:
    """What an element of some partners may take where all grow alike; durations in ns. `on_chain`: not only beside it."""

    owners: tuple[str, ...]
    activity: str
    key: str
    written: Fraction
    may_take: Fraction
    on_chain: bool


@dataclass(frozen=True, slots=True)
class SharedBudget:
    """The factor by which all elements of a chain and of its hosts may grow together, and what each may take then."""

    factor: Fraction | None
    shares: tuple[PartnerShare, ...]


@dataclass(frozen=True, slots=True)
class ChainBudget:
    """The budget of a chain. `untried` names the figures and hosts for which no try was left."""

    chain: str
    figures: tuple[FigureBudget, ...]
    hosts: tuple[tuple[str, FactorBudget], ...]
    shared: SharedBudget
    untried: tuple[str, ...]


class UnknownBudgetError(ValueError):
    """A chain has no budget: it has no deadline, or its figures are not all written."""


def find_chain_budget(trials: ChangeTrials, result: ChainResult) -> ChainBudget:
    """Find the budget of a chain. Raise UnknownBudgetError where nothing can be found."""
    search = _BudgetSearch(trials, result)
    shared = search.share_out()
    hosts = tuple(search.find_host_budgets())
    figures = tuple(search.find_figure_budgets())
    return ChainBudget(result.id, figures, hosts, shared, tuple(search.untried))


def share_chain_budget(trials: ChangeTrials, result: ChainResult) -> SharedBudget:
    """Find by how much all elements of a chain and of its hosts may grow together, and no more than that."""
    return _BudgetSearch(trials, result).share_out()


class _BudgetSearch:
    def __init__(self, trials: ChangeTrials, result: ChainResult) -> None:
        if result.deadline is None or result.deadline.value is None:
            raise UnknownBudgetError("it has no deadline")
        if result.verdict == "open" or not result.terms:
            raise UnknownBudgetError("figures are missing")
        self.trials, self.result, self.deadline = trials, result, result.deadline.value
        self.slack = result.slack if result.verdict == "met" else None
        architecture, self.elements = trials.architecture, list_chain_elements(trials.analysis, result)
        self.neighbours = list_neighbours(trials.analysis, self.elements)
        self.own_times = _list_figures(find_execution_time(architecture, activity) for activity in self.elements)
        self.other_times = [
            figure
            for figure in _list_figures(find_execution_time(architecture, activity) for activity in self.neighbours)
            if figure.key == "wcet"
        ]
        self.untried: list[str] = []

    def find_figure_budgets(self) -> Iterator[FigureBudget]:
        """Yield the largest execution time of each element, and the longest period of each in the chain."""
        periods = _list_figures(find_own_period(self.trials.architecture, activity) for activity in self.elements)
        for figure in (*self.own_times, *periods, *self._list_concerned()):
            try:
                budget = self._find_figure_budget(figure)
            except TriesSpentError:
                self.untried.append(f"{figure.activity.id}.timing.{figure.key}")
                continue
            # Beside the chain only those count that can make it late.
            if not budget.is_free or figure not in self.other_times:
                yield budget

    def _list_concerned(self) -> list[TriedFigure]:
        """Return the execution times beside the chain, without those that are in nobody's way however long they are.

        Most are: many are looked at together. Where all of them at their limits leave the chain in time, each does.
        """
        concerned: list[TriedFigure] = []
        groups = [self.other_times]
        while groups:
            group = groups.pop(0)
            try:
                is_free = len(group) > 1 and _is_left(
                    self._slack_with(tuple(figure.change_to(self._find_limit(figure)) for figure in group))
                )
            except TriesSpentError:
                is_free = False
            if len(group) <= 1:
                concerned += group
            elif not is_free:
                middle = len(group) // 2
                groups[:0] = [group[:middle], group[middle:]]
        return concerned

    def _find_limit(self, figure: TriedFigure) -> int:
        """Return the largest step at which a figure is tried: the whole deadline."""
        return max(int(self.deadline // figure.tick), figure.written_step + 1)

    def find_host_budgets(self) -> Iterator[tuple[str, FactorBudget]]:
        """Yield by what all execution times on each host of the chain may grow."""
        for host in dict.fromkeys(activity.host for activity in self.elements if activity.host):
            figures = [figure for figure in (*self.own_times, *self.other_times) if figure.activity.host == host]
            if figures:
                try:
                    yield host, self._find_factor(figures)
                except TriesSpentError:
                    self.untried.append(host)

    def share_out(self) -> SharedBudget:
        """Return by what all may grow together, and what each may take then."""
        figures = [*self.own_times, *self.other_times]
        try:
            factor = self._find_factor(figures).factor
        except TriesSpentError:
            self.untried.append("the common factor")
            return SharedBudget(None, ())
        if factor is None:
            return SharedBudget(None, ())
        shares = [
            PartnerShare(
                self._find_owners(figure),
                figure.activity.id,
                figure.key,
                figure.written,
                figure.grow_by(factor),
                is_own,
            )
            for is_own, own_figures in ((True, self.own_times), (False, self.other_times))
            for figure in own_figures
        ]
        return SharedBudget(factor, tuple(shares))

    def _find_owners(self, figure: TriedFigure) -> tuple[str, ...]:
        architecture = self.trials.architecture
        component = architecture.components.get(figure.activity.component or "")
        return architecture.nodes[figure.activity.node].owners or (component.owners if component else ())

    def _find_figure_budget(self, figure: TriedFigure) -> FigureBudget:
        limit = self._find_limit(figure)
        rate = self.trials.analysis.paces[figure.activity.id].rate.value
        # What computes until it is to begin anew, or longer, never comes to an end: that needs no look.
        full_step = (
            NS_PER_SECOND / rate / figure.tick if figure.key == "wcet" and figure in self.own_times and rate else None
        )

        def find_slack(step: int) -> Fraction | None:
            return None if full_step and step >= full_step else self._slack_with((figure.change_to(step),))

        if figure in self.other_times:
            # Most neighbours are in nobody's way: a single look shows it.
            limit_slack = self._slack_with((figure.change_to(limit),))
            if _is_left(limit_slack):
                return FigureBudget(figure.activity.id, figure.key, figure.written, None, is_free=True)
        step, is_free = self._find_step(
            find_slack, figure.written_step, figure.least_step, limit, Fraction(figure.tick)
        )
        largest = None if step is None else Fraction(step * figure.tick)
        # What is written finer than it is tried in, and leaves nothing, is the largest itself.
        if figure.key != "period" and largest is not None and largest < figure.written and self.slack is not None:
            largest = figure.written
        return FigureBudget(figure.activity.id, figure.key, figure.written, largest, is_free)

    def _find_factor(self, figures: Sequence[TriedFigure]) -> FactorBudget:
        total = sum((figure.written for figure in figures if figure in self.own_times), Fraction(0))

        def find_slack(step: int) -> Fraction | None:
            factor = Fraction(step, FACTOR_STEPS)
            return self._slack_with(tuple(figure.change_to_duration(figure.grow_by(factor)) for figure in figures))

        step, is_free = self._find_step(
            find_slack,
            FACTOR_STEPS,
            1,
            _LARGEST_FACTOR * FACTOR_STEPS,
            (total or self.deadline) / FACTOR_STEPS,
        )
        return FactorBudget(None if step is None else Fraction(step, FACTOR_STEPS), is_free)

    def _find_step(
        self, find_slack: SlackFunction, written: int, least: int, limit: int, fall: Fraction
    ) -> tuple[int | None, bool]:
        """Return the largest step that keeps the deadline, and whether all up to `limit` do."""
        if self.slack is not None:
            step = climb_steps(find_slack, written, limit, self.slack, fall)
            return step, step is None
        if least >= written:
            return None, False
        least_slack = find_slack(least)
        if least_slack is None or least_slack < 0:
            return None, False
        return find_largest_step(find_slack, least, written, least_slack, self.result.slack), False

    def _slack_with(self, changes: Changes) -> Fraction | None:
        return self.trials.find_slack(self.result.id, changes)


def _is_left(slack: Fraction | None) -> bool:
    return slack is not None and slack >= 0


def _list_figures(figures: Iterable[TriedFigure | None]) -> list[TriedFigure]:
    return [figure for figure in figures if figure is not None and figure.written]


_TICK = 1_000
"""What a figure is tried in, in ns: a microsecond."""
_FINE_TICK, _MAX_FINE = 1, 100_000
"""What figures below the latter are tried in: a nanosecond."""


@dataclass(frozen=True, slots=True)
class TriedFigure:
    """A written duration of one activity (`wcet`, `response`, `period`), and what it is counted in; both in ns."""

    activity: Activity
    key: str
    written: Fraction
    tick: int
    least: Fraction = Fraction(0)
    """What it cannot be below: an execution time is not less than the best one."""

    @property
    def written_step(self) -> int:
        """Return the written value in whole ticks, rounded down."""
        return int(self.written // self.tick)

    @property
    def least_step(self) -> int:
        """Return the least value in whole ticks, at least one."""
        return max(1, int(-(-self.least // self.tick)))

    def grow_by(self, factor: Fraction) -> Fraction:
        """Return what is written times a factor, in ns; not less than it can be."""
        return max(self.written * factor, self.least)

    def change_to(self, step: int) -> TriedChange:
        """Return the change that sets the figure to a number of ticks."""
        return self.change_to_duration(Fraction(step * self.tick))

    def change_to_duration(self, duration: Fraction) -> TriedChange:
        """Return the change that sets the figure to a duration in ns."""
        return TriedChange(self.activity.id, f"timing.{self.key}", write_exact_duration(duration).replace(" ", ""))


def find_execution_time(architecture: Architecture, activity: Activity) -> TriedFigure | None:
    """Return the execution time of an activity, or the response that is written instead; None where neither is."""
    timing = architecture.nodes[activity.node].timing.get(activity.component or "")
    if timing is None:
        return None
    if timing.response is not None:
        return _make_figure(activity, "response", timing.response.value)
    least = timing.bcet.value if timing.bcet else Fraction(0)
    return _make_figure(activity, "wcet", timing.wcet.value, least) if timing.wcet else None


def find_own_period(architecture: Architecture, activity: Activity) -> TriedFigure | None:
    """Return the period of an activity that works by its own clock, written as a period or as a rate."""
    timing = architecture.nodes[activity.node].timing.get(activity.component or "")
    period = written_period(timing) if timing and activity.behaviour == "periodic" else None
    return _make_figure(activity, "period", period) if period else None


def _make_figure(activity: Activity, key: str, written: Fraction, least: Fraction = Fraction(0)) -> TriedFigure:
    return TriedFigure(activity, key, written, _FINE_TICK if written < _MAX_FINE else _TICK, least)


def list_chain_elements(analysis: Analysis, result: ChainResult) -> list[Activity]:
    """Return the elements of a chain, the one that adds most first, those without a bound before all."""
    terms = sorted(result.terms, key=_part_order)
    return [analysis.system.activities[name] for name in dict.fromkeys(term.activity for term in terms)]


def _part_order(term: ChainTerm) -> tuple[bool, Fraction]:
    parts = (term.sampling, term.response, term.link)
    return all(part.value is not None for part in parts), -sum(
        (part.value or Fraction(0) for part in parts), Fraction(0)
    )


def list_neighbours(analysis: Analysis, elements: Iterable[Activity]) -> list[Activity]:
    """Return what else works on the hosts of some elements, what takes most of them first."""
    names = {activity.id for activity in elements}
    hosts = dict.fromkeys(activity.host for activity in elements if activity.host)
    shares = [
        (-(share.value or Fraction(0)), name)
        for host in hosts
        for name, share in (analysis.hosts[host].activity_shares if host in analysis.hosts else ())
        if name not in names
    ]
    return [analysis.system.activities[name] for _, name in sorted(shares)]


def find_largest_step(
    slack_at: SlackFunction, low: int, high: int, low_slack: Fraction | None = None, high_slack: Fraction | None = None
) -> int:
    """Return the largest step from `low` to `high` - 1 at which slack is left.

    It is left at `low`, and not at `high`, neither of which is looked at again.
    """
    side, repeats = 0, 0
    while high - low > 1:
        middle = _choose_step(low, high, low_slack, high_slack if repeats < 1 else None)
        slack = slack_at(middle)
        new_side = 1 if _is_left(slack) else -1
        # A secant that always moves the same end comes closer in ever smaller steps: then a half does more.
        repeats = repeats + 1 if new_side == side else 0
        side = new_side
        if new_side > 0:
            low, low_slack = middle, slack
        else:
            high, high_slack = middle, slack
    return low


def climb_steps(slack_at: SlackFunction, start: int, limit: int, start_slack: Fraction, fall: Fraction) -> int | None:
    """Return the largest step from `start` up to `limit` at which slack is left; None where it is left at `limit`.

    `fall` is the slack that each step takes at least, where it takes any: so far the first look goes.
    """
    low, slack, stride = start, start_slack, 0
    while True:
        stride = max(1, 2 * stride, int(slack / fall)) if slack else max(1, 2 * stride)
        step = min(low + stride, limit)
        new_slack = slack_at(step)
        if not _is_left(new_slack):
            return find_largest_step(slack_at, low, step, slack, new_slack)
        if step == limit:
            return None
        # Where the first look was right, nothing is left for another one: the next step decides.
        stride = stride if new_slack == slack else 0
        low, slack = step, new_slack or Fraction(0)


def _choose_step(low: int, high: int, low_slack: Fraction | None, high_slack: Fraction | None) -> int:
    """Return where a straight line through both ends leaves nothing, else the middle."""
    if low_slack is None or high_slack is None or low_slack <= high_slack:
        return (low + high) // 2
    step = low + int(low_slack * (high - low) / (low_slack - high_slack))
    return min(max(step, low + 1), high - 1)
