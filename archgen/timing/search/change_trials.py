"""Trying changes of figures: the whole analysis of each, remembered, and no more of them than were allowed."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction

from archgen.frozen import dataclass, replace
from archgen.model.architecture import Architecture
from archgen.timing.analysis import Analysis
from archgen.timing.chains.chain_bounds import find_chain_slack
from archgen.timing.chains.cost_network import CostNetwork
from archgen.timing.run_analysis import analyse_for_chains, analyse_system
from archgen.timing.system.timing_system import Activity, TimingSystem

OverrideLayer = Callable[[Architecture, Sequence[str]], Architecture]
"""Lays changes over an architecture, as `--set` writes them."""
_TERMS_PER_TRY = 250_000
"""Terms of a search that count as one more try: an analysis of a large host costs as much as many of small ones."""


@dataclass(frozen=True, slots=True)
class TriedChange:
    """A change of one key of an element, as `--set` writes it: `obstacle_boxes.timing.core=3`."""

    element: str
    key: str
    value: str

    @property
    def kind(self) -> str:
        """Return what is changed: `core`, `threads`, `callback_groups`."""
        return self.key.removeprefix("timing.").partition(".")[0]

    def __str__(self) -> str:
        return f"{self.element}.{self.key}={self.value}"


Changes = tuple[TriedChange, ...]


class TriesSpentError(Exception):
    """As many changes were tried as were allowed."""


class SenselessChangeError(ValueError):
    """A change cannot be made: with it the figures would contradict one another."""


class ChangeTrials:
    """Tries changes of an architecture. `tries_left` counts tries and not seconds, so that results can be repeated."""

    def __init__(
        self, architecture: Architecture, analysis: Analysis, lay_overrides: OverrideLayer, tries: int
    ) -> None:
        """Start with the analysis of the architecture as it is written."""
        self.architecture = architecture
        self.analysis = analysis
        self.tries_left = tries
        self._lay_overrides = lay_overrides
        self._networks: dict[Changes, tuple[Architecture, CostNetwork]] = {
            (): (architecture, CostNetwork.of_analysis(analysis))
        }
        self._slacks: dict[tuple[Changes, str], Fraction | None] = {}

    def find_slack(self, chain_id: str, changes: Changes) -> Fraction | None:
        """Return what some changes leave of a chain's deadline, in ns; None where nothing proves that it is kept."""
        if (changes, chain_id) not in self._slacks:
            try:
                changed_architecture, network = self._analyse(changes)
            except SenselessChangeError:
                return None
            asked_chain = changed_architecture.chains[chain_id]
            self._slacks[changes, chain_id] = find_chain_slack(network, changed_architecture, asked_chain)
        return self._slacks[changes, chain_id]

    def find_floors(self, changes: Changes) -> dict[str, Fraction]:
        """Return the floors of the chains with some changes, in ns."""
        try:
            changed_architecture, network = self._analyse(changes)
        except SenselessChangeError:
            return {}
        return find_floors(network.steps.analysis, changed_architecture)

    def _analyse(self, changes: Changes) -> tuple[Architecture, CostNetwork]:
        """Analyse an architecture with some changes, or recall how it was."""
        if changes not in self._networks:
            if self.tries_left <= 0:
                raise TriesSpentError
            try:
                changed_architecture = self._lay_overrides(self.architecture, list(map(str, changes)))
            except ValueError as error:
                raise SenselessChangeError(*error.args) from error
            analysis = analyse_for_chains(changed_architecture)
            self.tries_left -= 1 + analysis.searched_terms // _TERMS_PER_TRY
            self._networks[changes] = changed_architecture, CostNetwork.of_analysis(analysis)
        return self._networks[changes]


def find_floors(analysis: Analysis, architecture: Architecture) -> dict[str, Fraction]:
    """Return the floor of each chain that has a deadline, in ns, where all figures that it rests on are known.

    It is the bound of the chain where each activity has a core and a thread of its own, so that it takes its execution
    time alone: the sum of the gaps, execution times and links. Whatever else runs only adds to each of these.
    """
    asked_chains = [chain for chain in architecture.chains.values() if chain.deadline is not None]
    if not asked_chains:
        return {}
    network = CostNetwork.of_analysis(analyse_system(_clear_the_way(analysis.system), judging=True))
    floors: dict[str, Fraction] = {}
    for chain in asked_chains:
        slack = find_chain_slack(network, architecture, chain)
        if chain.deadline is not None and slack is not None:
            floors[chain.id] = chain.deadline.value - slack
    return floors


def _clear_the_way(system: TimingSystem) -> TimingSystem:
    """Return a system in which nothing waits for anything else to be done; links stay as they are."""
    activities = {name: _give_own_core(activity) for name, activity in system.activities.items()}
    return replace(system, activities=activities, executors={}, resources={})


def _give_own_core(activity: Activity) -> Activity:
    uses = sum(use.worst for use in activity.uses.values())
    return replace(
        activity,
        host=None,
        container=None,
        executor="",
        cores=(),
        priority=None,
        storing={},
        uses={},
        wcet=None if activity.wcet is None else activity.wcet + uses,
        bcet=None if activity.bcet is None else activity.bcet + sum(use.best for use in activity.uses.values()),
    )
