"""Budgets of searches: one for each group of activities that depend on one another, so that no other group spends it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from archgen.model.graph_search import find_strong_components
from archgen.timing.load.busy_windows import SearchBudget
from archgen.timing.system.timing_system import TimingSystem

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
