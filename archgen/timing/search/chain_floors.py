"""The floor of each chain: what it takes with nobody in its way, which no order, process, thread or core can undercut."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

from archgen.model.architecture import Architecture
from archgen.timing.analysis import Analysis
from archgen.timing.chains.chain_bounds import find_chain_slack
from archgen.timing.chains.cost_network import CostNetwork
from archgen.timing.run_analysis import analyse_system
from archgen.timing.system.timing_system import Activity, TimingSystem


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


def find_hopeless_chains(floors: dict[str, Fraction], architecture: Architecture) -> dict[str, Fraction]:
    """Return the floors that are above their chain's deadline: nothing but rates, triggers and execution times can help."""
    deadlines = {chain.id: chain.deadline.value for chain in architecture.chains.values() if chain.deadline}
    return {name: floor for name, floor in floors.items() if floor > deadlines[name]}


def _clear_the_way(system: TimingSystem) -> TimingSystem:
    """Return a system in which nothing waits for anything else to be done; links stay as they are."""
    activities = {name: _give_own_core(activity) for name, activity in system.activities.items()}
    return replace(system, activities=activities, executors={}, resources={}, threads={})


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
