"""A configuration in which all chains meet their deadlines, or the one in which they are least late; each is analysed.

Bounded by a number of tries, in a fixed order: the same files give the same proposal everywhere.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction

from archgen.frozen import dataclass
from archgen.timing.analysis import ChainResult
from archgen.timing.search.chain_floors import find_floors, find_hopeless_chains
from archgen.timing.search.change_trials import Changes, ChangeTrials, TriesSpentError
from archgen.timing.search.run_configurations import ORDERS, ConfigurationSpace, RunConfiguration, TriggerChoice

MAX_TRIES = 60
"""How many configurations are tried for a project."""
_KEPT_TRIES = 15
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
    changes_triggers: bool = False

    @property
    def rank(self) -> tuple[Fraction, int]:
        """Return what configurations are compared by: lateness, and then how much is to be changed."""
        return self.lateness, len(self.changes)


@dataclass(frozen=True, slots=True)
class Proposal:
    """What was tried for the chains that are not met, in its order: what is written is the first.

    `best` is that itself where nothing is better; `kept_triggers` is the best one that changes no trigger.
    """

    deadlines: Mapping[str, Fraction]
    hopeless: Mapping[str, Fraction]
    """The floors that are above the deadline of their chain, in ns."""
    tried: tuple[TriedConfiguration, ...]
    best: TriedConfiguration
    kept_triggers: TriedConfiguration
    is_cut: bool = False
    """Whether more could have been tried."""


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
        self.keeps_triggers = keep_triggers
        self.hopeless: dict[str, Fraction] = {}
        self.tried: dict[Changes, TriedConfiguration] = {}
        self.configurations: dict[Changes, RunConfiguration] = {}
        self.written = self.best = self._try(RunConfiguration())
        self.kept_triggers = self.written
        self.is_cut = False

    def run(self) -> Proposal:
        """Search until all chains are proven, or no try is left."""
        if self.written.late:
            architecture = self.trials.architecture
            floors = find_floors(self.trials.analysis, architecture)
            self.hopeless = find_hopeless_chains(
                {name: floor for name, floor in floors.items() if name in self.deadlines}, architecture
            )
            try:
                self._search()
                self._leave_out_needless()
            except TriesSpentError:
                self.is_cut = True
        tried = tuple(self.tried.values())
        return Proposal(self.deadlines, self.hopeless, tried, self.best, self.kept_triggers, self.is_cut)

    def _search(self) -> None:
        if self._try_orders():
            return
        if self.hopeless and not self.keeps_triggers:
            triggers = self._choose_triggers()
            if triggers and self._try_orders(triggers):
                return
        if not self._move_elements() and not self.hopeless and not self.keeps_triggers:
            self._add_triggers()

    def _try(self, configuration: RunConfiguration) -> TriedConfiguration:
        """Analyse a configuration, and keep it where it is the best so far and makes no other chain late."""
        changes = self.space.list_changes(configuration)
        if changes not in self.tried:
            slacks = {name: self.trials.find_slack(name, changes) for name in self.deadlines}
            bounds = {n: None if slack is None else self.deadlines[n] - slack for n, slack in slacks.items()}
            late = tuple(name for name, slack in slacks.items() if slack is None or slack < 0)
            lateness = sum((self._count_lateness(name, bounds[name]) for name in late), Fraction(0))
            result = TriedConfiguration(
                self.space.describe(configuration), changes, bounds, late, lateness, bool(configuration.triggers)
            )
            self.tried[changes], self.configurations[changes] = result, configuration
            if changes and set(result.late) <= set(self.written.late):
                self.best = min(self.best, result, key=lambda each: each.rank)
                if not result.changes_triggers:
                    self.kept_triggers = min(self.kept_triggers, result, key=lambda each: each.rank)
        return self.tried[changes]

    def _count_lateness(self, name: str, bound: Fraction | None) -> Fraction:
        if bound is None:
            return _UNBOUNDED_LATENESS
        return min(_UNBOUNDED_LATENESS, bound / self.deadlines[name] - 1)

    def _is_proven(self) -> bool:
        return not self.best.late

    def _try_orders(self, triggers: Sequence[TriggerChoice] = ()) -> bool:
        """Try each order, with the processes as they are and with one for each node: nothing but these first."""
        for order in ("", *ORDERS):
            for own_processes in dict.fromkeys(((), self.space.separable_nodes)):
                base = RunConfiguration(own_processes=own_processes, triggers=tuple(triggers))
                self._try(self.space.rank(base, order) if order else base)
                if self._is_proven():
                    return True
        return False

    def _choose_triggers(self) -> tuple[TriggerChoice, ...]:
        """Return the fewest triggers with which no chain's floor is above its deadline; empty where none do."""
        chosen: list[TriggerChoice] = []
        for choice in self.space.list_triggers(list(self.hopeless)):
            chosen.append(choice)
            changes = self.space.list_changes(RunConfiguration(triggers=tuple(chosen)))
            floors = self.trials.find_floors(changes)
            if all(name in floors and floors[name] <= self.deadlines[name] for name in self.hopeless):
                return tuple(chosen)
        return ()

    def _move_elements(self) -> bool:
        """Move one element at a time to an end of its host's order, from the best on, as long as that helps."""
        start = None
        orders = {self.space.find_order(configuration) for configuration in self.configurations.values()}
        while start is not self.best:
            start = self.best
            for configuration in self.space.list_moves(self.configurations[start.changes], start.late):
                if self.trials.tries_left <= _KEPT_TRIES:
                    self.is_cut = True
                    return False
                order = self.space.find_order(configuration)
                if order not in orders:
                    orders.add(order)
                    if self._try(configuration) is self.best:
                        break
            if self._is_proven():
                return True
        return False

    def _add_triggers(self) -> None:
        """Try triggers on top of the best configuration, one after the other."""
        for choice in self.space.list_triggers(self.best.late):
            configuration = self.configurations[self.best.changes]
            self._try(replace(configuration, triggers=(*configuration.triggers, choice)))
            if self._is_proven():
                return

    def _leave_out_needless(self) -> None:
        """Take back what the best configuration does not need."""
        start: TriedConfiguration | None = None
        while start is not self.best and self.best is not self.written:
            start = self.best
            self._try_any(self.space.list_smaller(self.configurations[start.changes]))

    def _try_any(self, configurations: Iterable[RunConfiguration]) -> None:
        for configuration in configurations:
            best = self.best
            self._try(configuration)
            if self.best is not best:
                return
