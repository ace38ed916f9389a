"""The bounds of the analysis that belong beside the observed figures."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction

from archgen.timing.analysis import Analysis, ChainResult
from archgen.timing.chains.chain_bounds import find_data_age
from archgen.timing.chains.cost_network import CostNetwork
from archgen.timing.figures.timing_values import TimingValue


def find_publish_pauses(analysis: Analysis) -> dict[tuple[str, str], Fraction]:
    """Return the longest time in ns between two chances to publish, by activity and conditional output, where it is
    known.
    """
    longest_pauses = {}
    for activity in analysis.system.activities.values():
        gap = upper_bound(analysis.paces[activity.id].gap) if activity.id in analysis.paces else None
        response = analysis.responses.get(activity.id)
        worst = upper_bound(response.worst) if response else None
        if gap is None or worst is None or response is None:
            continue
        for output in activity.conditional:
            # Two successive job ends are furthest apart when the first job was as quick and the second as slow as
            # possible.
            longest_pauses[activity.id, output] = gap + worst - (response.best.value or 0)
    return longest_pauses


def bound_data_ages(analysis: Analysis, chains: Mapping[str, ChainResult]) -> dict[str, TimingValue]:
    """Return the bound on the data age of each chain, by chain id.

    Where an event is the stimulus of a chain, this is larger than its reaction time.
    """
    network = CostNetwork.of_analysis(analysis)
    return {key: find_data_age(network, result) for key, result in chains.items()}


def upper_bound(value: TimingValue | None) -> Fraction | None:
    """Return a value that bounds from above; None for an incomplete sum or one that only bounds from below."""
    return value.value if value and value.complete and value.side != "at least" else None


def bound_utilisation(analysis: Analysis, host: str) -> Fraction | None:
    """Return the bound on a host's load as a share of all its cores, None where it is unknown."""
    load = analysis.hosts.get(host)
    return upper_bound(load.share_of_cores) if load else None
