"""A configuration in which all chains meet their deadlines, or the one in which they are least late; each is analysed.

Bounded by a number of tries, in a fixed order: the same files give the same proposal everywhere.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from fractions import Fraction

from archgen.frozen import dataclass, replace
from archgen.model.architecture import Architecture
from archgen.timing.analysis import Analysis, ChainResult
from archgen.timing.search.change_trials import Changes, ChangeTrials, OverrideLayer, TriesSpentError
from archgen.timing.search.run_configurations import ORDERS, ConfigurationSpace, RunConfiguration, TriggerChoice

MAX_TRIES, _UNASKED_TRIES = 120, 60
"""How many configurations are tried for a project: where somebody asks, and where nobody did and it is small."""
_SMALL_SIZE, _LEAST_TRIES = 150, 12
"""So many activities make a small project; and so many configurations are tried of the largest one that nobody asked for."""
_KEPT_TRIES = 12
"""How many tries moving single elements leaves for what comes after it."""
_UNBOUNDED_LATENESS = Fraction(3)
"""How late a chain without a bound counts, in deadlines; and one with a bound at most."""


@dataclass(frozen=True, slots=True)
class TriedConfiguration:
    """A configuration that was analysed: what is to be written for it, and what its chains take at most then, in ns.

    `lateness` is the sum over the chains of how far each is above its deadline, in deadlines.
    """

    words: str
    changes: Changes
    bounds: Mapping[str, Fraction | None]
    late: tuple[str, ...]
    lateness: Fraction

    @property
    def rank(self) -> tuple[Fraction, int]:
        """Return what configurations are compared by: lateness, and then how much is to be changed."""
        return self.lateness, len(self.changes)

    @property
    def changes_triggers(self) -> bool:
        """Whether it changes what fires an element, and with that a program."""
        return any(change.kind == "trigger" for change in self.changes)


@dataclass(frozen=True, slots=True)
class Proposal:
    """What was tried for the chains that are not met, in its order: what is written is the first."""

    deadlines: Mapping[str, Fraction]
    hopeless: Mapping[str, Fraction]
    """The floors that are above the deadline of their chain, in ns."""
    tried: tuple[TriedConfiguration, ...]
    is_cut: bool = False
    """Whether more could have been tried."""
    unjudged: tuple[str, ...] = ()
    """Chains that have a deadline, and lack figures."""

    @property
    def best(self) -> TriedConfiguration:
        """Return the one that is least late, and makes no chain late that is not so now: what is written, if none is better."""
        return self._find_best(self.tried)

    @property
    def kept_triggers(self) -> TriedConfiguration:
        """Return the best one that changes no trigger."""
        return self._find_best([each for each in self.tried if not each.changes_triggers])

    def _find_best(self, tried: Sequence[TriedConfiguration]) -> TriedConfiguration:
        harmless = [each for each in tried if set(each.late) <= set(self.tried[0].late)]
        return min(harmless, key=lambda each: each.rank)


def find_short_proposal(
    architecture: Architecture, analysis: Analysis, results: Mapping[str, ChainResult], lay_overrides: OverrideLayer
) -> Proposal | None:
    """Look for a configuration in which chains are met, without being asked for it; None where none is late.

    Of a large project fewer are tried: `--propose` tries them all.
    """
    if not any(result.deadline and result.verdict in {"missed", "not proven"} for result in results.values()):
        return None
    tries = max(_LEAST_TRIES, _UNASKED_TRIES * _SMALL_SIZE // max(_SMALL_SIZE, len(analysis.system.activities)))
    return find_proposal(ChangeTrials(architecture, analysis, lay_overrides, tries), results)


def find_proposal(trials: ChangeTrials, chains: Mapping[str, ChainResult], *, keep_triggers: bool = False) -> Proposal:
    """Look for the configuration that proves all chains, or else the one in which they are least late."""
    return _ProposalSearch(trials, chains, keep_triggers=keep_triggers).run()


class _ProposalSearch:
    def __init__(self, trials: ChangeTrials, chains: Mapping[str, ChainResult], *, keep_triggers: bool) -> None:
        self.trials, self.space = trials, ConfigurationSpace(trials.architecture, trials.analysis, chains)
        # What is open stays so, however things are run: its figures are missing.
        judged = [chain for chain in chains.values() if chain.terms and chain.verdict != "open"]
        self.deadlines = {
            chain.id: chain.deadline.value for chain in judged if chain.deadline and chain.deadline.value is not None
        }
        self.unjudged = tuple(
            chain.id for chain in chains.values() if chain.deadline and chain.id not in self.deadlines
        )
        self.keeps_triggers = keep_triggers
        self.hopeless: dict[str, Fraction] = {}
        self.tried: dict[Changes, tuple[TriedConfiguration, RunConfiguration]] = {}
        self._try(RunConfiguration())
        self.written = self.best = self.tried[()][0]
        self.is_cut = False

    def run(self) -> Proposal:
        """Search until all chains are proven, or no try is left."""
        if self.written.late:
            self.hopeless = self._find_hopeless(())
            try:
                self._search()
                self._climb(self.space.list_smaller)
            except TriesSpentError:
                self.is_cut = True
        tried = tuple(each for each, _ in self.tried.values())
        return Proposal(self.deadlines, self.hopeless, tried, self.is_cut, self.unjudged)

    def _search(self) -> None:
        if self._try_orders():
            return
        if self.hopeless and not self.keeps_triggers:
            triggers = self._choose_triggers()
            if triggers and self._try_orders(triggers):
                return
        self._climb(lambda start: self.space.list_moves(start, self.best.late), _KEPT_TRIES)
        if not self.keeps_triggers and self.best.late:
            self._add_triggers()

    def _add_triggers(self) -> None:
        """Try triggers of the late chains: all with each order, and one after the other on top of the best configuration."""
        late = self.best.late
        slow_choices = self.space.list_triggers(late)
        has_room = self.trials.tries_left > 2 * _KEPT_TRIES
        if has_room and slow_choices and not self.hopeless and self._try_orders(slow_choices):
            return
        for choice in (*slow_choices, *self.space.list_triggers(late, by_each_message=True)):
            if self.best.late:
                base = self.tried[self.best.changes][1]
                others = tuple(each for each in base.triggers if each.activity != choice.activity)
                self._try(replace(base, triggers=(*others, choice)))

    def _find_hopeless(self, changes: Changes) -> dict[str, Fraction]:
        """Return the floors that are above their chain's deadline with some changes."""
        floors = self.trials.find_floors(changes)
        return {name: floors[name] for name, limit in self.deadlines.items() if floors.get(name, limit) > limit}

    def _try(self, configuration: RunConfiguration) -> bool:
        """Analyse a configuration; return whether it is the best so far, and makes no other chain late."""
        changes = self.space.list_changes(configuration)
        if changes in self.tried:
            return False
        slacks = {name: self.trials.find_slack(name, changes) for name in self.deadlines}
        bounds = {name: None if slack is None else self.deadlines[name] - slack for name, slack in slacks.items()}
        late = {name: slack for name, slack in slacks.items() if slack is None or slack < 0}
        lateness = [
            _UNBOUNDED_LATENESS if slack is None else min(_UNBOUNDED_LATENESS, -slack / self.deadlines[name])
            for name, slack in late.items()
        ]
        words = self.space.describe(configuration)
        result = TriedConfiguration(words, changes, bounds, tuple(late), sum(lateness, Fraction(0)))
        self.tried[changes] = result, configuration
        is_best = bool(changes) and late.keys() <= set(self.written.late) and result.rank < self.best.rank
        self.best = result if is_best else self.best if changes else result
        return is_best

    def _try_orders(self, triggers: Sequence[TriggerChoice] = ()) -> bool:
        """Try each order, with the processes as they are and with one for each node: nothing but these first."""
        for order in ("", *filter(None, ORDERS)):
            for own_processes in dict.fromkeys(((), self.space.separable_nodes)):
                base = RunConfiguration(own_processes=own_processes, triggers=tuple(triggers))
                self._try(self.space.rank(base, order) if order else base)
                if not self.best.late:
                    return True
        return False

    def _choose_triggers(self) -> tuple[TriggerChoice, ...]:
        """Return the fewest triggers with which no chain's floor is above its deadline; empty where none do.

        Who works oftener than now takes more of its host: only where nothing else is short enough.
        """
        for by_each_message in (False, True):
            choices = self.space.list_triggers(list(self.hopeless), by_each_message=by_each_message)
            for count in range(1, len(choices) + 1):
                triggers = tuple(choices[:count])
                if not self._find_hopeless(self.space.list_changes(RunConfiguration(triggers=triggers))):
                    return triggers
        return ()

    def _climb(self, list_next: Callable[[RunConfiguration], Iterable[RunConfiguration]], kept_tries: int = 0) -> None:
        """Go on to the first configuration after the best one that is better, as long as there is one."""
        is_better = self.best is not self.written or kept_tries > 0
        while is_better and (self.best.late or not kept_tries):
            is_better = False
            for configuration in list_next(self.tried[self.best.changes][1]):
                if self.trials.tries_left <= kept_tries:
                    self.is_cut = True
                    return
                is_better = self._try(configuration)
                if is_better:
                    break
