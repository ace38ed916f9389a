"""The smallest change that would prove a chain, found by trying: fewest changes, then what changes least.

Settings (priority, core, threads) come before figures: they change how programs are run, and not what they do. Of figures that one
counts which changes by the smallest share of what is written.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from fractions import Fraction

from archgen.frozen import dataclass
from archgen.timing.analysis import ChainResult
from archgen.timing.figures.timing_values import TimingValue
from archgen.timing.search.chain_surroundings import list_chain_elements, list_neighbours, list_waiting_elements
from archgen.timing.search.change_candidates import list_settings
from archgen.timing.search.change_trials import Changes, ChangeTrials, TriedChange, TriesSpentError
from archgen.timing.search.largest_step import find_largest_step
from archgen.timing.search.tried_figures import TriedFigure, find_execution_time, find_own_period
from archgen.timing.system.timing_system import Activity

MAX_TRIES = 60
"""How many changes are tried for all chains of a project together."""
_MAX_ELEMENTS = 6
"""How many elements of a chain, and how many of their neighbours, are looked at: those that add most."""
_MAX_SETTINGS = 3
"""How many settings are combined."""
_LARGEST_RATE_CHANGE = 2
"""By which factor a rate is changed at most: what works a tenth as often does something else."""


@dataclass(frozen=True, slots=True)
class ChainRemedy:
    """What would prove a chain, and what it takes then; without changes nothing of what was tried would.

    `tried` are the kinds of changes with the elements whose were tried. `is_cut` says that more could have been tried.
    """

    chain: str
    changes: Changes
    bound: TimingValue
    tried: tuple[tuple[str, tuple[str, ...]], ...]
    is_cut: bool
    ran_out: bool = False
    """Whether no try was left before the search was through."""


@dataclass(frozen=True, slots=True)
class _FigureRange:
    """A figure, the last step at which it is tried, and in which direction that is."""

    figure: TriedFigure
    last_step: int

    @property
    def direction(self) -> int:
        """Return 1 where the figure grows, -1 where it shrinks."""
        return 1 if self.last_step > self.figure.written_step else -1

    def reach_within(self, share: Fraction) -> int:
        """Return by how many steps the figure may change, for less than a share of what is written."""
        steps = -(-share * self.figure.written_step // 1) - 1
        return max(0, min(int(steps), self.direction * (self.last_step - self.figure.written_step)))

    def change_by(self, steps: int) -> TriedChange:
        """Return the change that changes the figure by some steps."""
        return self.figure.change_to(self.figure.written_step + self.direction * steps)


def find_remedies(trials: ChangeTrials, results: Iterable[ChainResult]) -> list[ChainRemedy]:
    """Return what would prove each chain that is not proven, or is missed though its best case is not too late.

    Each has an equal share of the tries; what some do not need goes to those that needed more.
    """
    late_results = [result for result in results if _can_be_helped(result)]
    remedies: dict[str, ChainRemedy] = {}
    tries_left = trials.tries_left
    for number, result in enumerate(late_results):
        share = trials.tries_left = tries_left // (len(late_results) - number)
        remedies[result.id] = _RemedySearch(trials, result).run()
        tries_left -= share - trials.tries_left
    trials.tries_left = tries_left
    for result in late_results:
        # What was tried before is remembered: that costs no try again.
        if trials.tries_left > 0 and remedies[result.id].ran_out:
            remedies[result.id] = _RemedySearch(trials, result).run()
    return list(remedies.values())


def _can_be_helped(result: ChainResult) -> bool:
    if result.verdict not in {"missed", "not proven"} or result.deadline is None or not result.terms:
        return False
    best, deadline = result.best.value, result.deadline.value
    return best is None or deadline is None or best <= deadline


class _RemedySearch:
    def __init__(self, trials: ChangeTrials, result: ChainResult) -> None:
        self.trials, self.result = trials, result
        self.elements = list_chain_elements(trials.analysis, result)
        self.neighbours = list_neighbours(trials.analysis, self.elements)
        self.figure_changes: Changes = ()
        self.tried: dict[str, dict[str, None]] = {}

    def run(self) -> ChainRemedy:
        """Look for the smallest change that proves the chain."""
        elements, neighbours = self.elements[:_MAX_ELEMENTS], self.neighbours[:_MAX_ELEMENTS]
        is_cut = len(elements) < len(self.elements) or len(neighbours) < len(self.neighbours)
        ran_out = False
        waiting_elements = list_waiting_elements(self.trials.analysis, self.result)[:_MAX_ELEMENTS]
        try:
            changes = (
                self._find_setting(waiting_elements)
                or self._find_figure(elements, neighbours)
                or self._combine(waiting_elements)
            )
        except TriesSpentError:
            changes, ran_out = self.figure_changes, True
        bound = self.trials.bound_chain(self.result.id, changes).bound
        tried = tuple((kind, tuple(names)) for kind, names in self.tried.items())
        return ChainRemedy(self.result.id, changes, bound, tried, is_cut or ran_out, ran_out)

    def _try(self, changes: Changes) -> Fraction | None:
        """Return the slack that some changes leave, and note the last one as tried."""
        slack = self.trials.find_slack(self.result.id, changes)
        self.tried.setdefault(changes[-1].kind, {})[changes[-1].element] = None
        return slack

    def _proves(self, slack: Fraction | None, changes: Changes) -> bool:
        """Whether some changes prove the chain, and make no other one worse."""
        return slack is not None and slack >= 0 and not self.trials.harms_others(self.result.id, changes)

    def _find_setting(self, elements: list[Activity], base: Changes = ()) -> Changes:
        """Return the first setting that proves the chain, on top of others; empty where none does."""
        for setting in list_settings(self.trials.architecture, self.trials.analysis, elements):
            changes = (*base, *setting)
            if base[-len(setting) :] != setting and self._proves(self._try(changes), changes):
                return changes
        return ()

    def _combine(self, elements: list[Activity]) -> Changes:
        """Return several settings that prove the chain: each on top of the one that helps most; empty where none do."""
        base: Changes = ()
        for _ in range(1, _MAX_SETTINGS):
            settings = list_settings(self.trials.architecture, self.trials.analysis, elements)
            tried_changes = [(*base, *setting) for setting in settings if not set(setting) & set(base)]
            slacks = [(slack, changes) for changes in tried_changes if (slack := self._try(changes)) is not None]
            if not slacks:
                break
            base = max(slacks, key=lambda pair: pair[0])[1]
            changes = self._find_setting(elements, base)
            if changes:
                return changes
        return ()

    def _find_figure(self, elements: list[Activity], neighbours: list[Activity]) -> Changes:
        """Return the figure that has to change by the smallest share of what is written; empty where none does it."""
        best_share = Fraction(_LARGEST_RATE_CHANGE)
        for figure_range in self._list_ranges(elements, neighbours):
            figure, reach = figure_range.figure, figure_range.reach_within(best_share)
            changes = (figure_range.change_by(reach),)
            slack = self._try(changes) if reach else None
            if not self._proves(slack, changes):
                continue
            self.figure_changes = changes
            distance = self._find_distance(figure_range, reach, slack)
            changes = (figure_range.change_by(distance),)
            if self._proves(self._try(changes), changes):
                self.figure_changes, best_share = changes, Fraction(distance, figure.written_step)
        return self.figure_changes

    def _find_distance(self, figure_range: _FigureRange, reach: int, reach_slack: Fraction | None) -> int:
        """Return by how many steps a figure has to change at least; `reach` is enough."""

        def find_slack(step: int) -> Fraction | None:
            changes = (figure_range.change_by(-step),)
            slack = self._try(changes)
            if self._proves(slack, changes):
                self.figure_changes = changes  # the best so far, should no try be left
            return slack

        return -find_largest_step(find_slack, -reach, 0, reach_slack, self.result.slack)

    def _list_ranges(self, elements: list[Activity], neighbours: list[Activity]) -> Iterator[_FigureRange]:
        """Yield the figures to try: shorter execution times, quicker clocks in the chain, and slower ones beside it."""
        architecture = self.trials.architecture
        for activity in (*elements, *neighbours):
            figure = find_execution_time(architecture, activity)
            if figure is not None and (figure.key == "wcet" or activity in elements):
                yield _FigureRange(figure, figure.least_step)
        for activity in (*elements, *neighbours):
            figure = find_own_period(architecture, activity)
            if figure is not None:
                written = figure.written_step
                yield _FigureRange(
                    figure,
                    written // _LARGEST_RATE_CHANGE if activity in elements else written * _LARGEST_RATE_CHANGE,
                )
