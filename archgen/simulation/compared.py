"""What was seen beside the bounds of the analysis: which bound stands beside which figure."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction

from archgen.timing.analysis import Analysis, ChainResult
from archgen.timing.chains import data_age
from archgen.timing.network import Network
from archgen.timing.value import Value


def pauses(analysis: Analysis) -> dict[tuple[str, str], Fraction]:
    """Give the largest time between two chances to publish each conditional output, in ns, where it is known."""
    found = {}
    for activity in analysis.system.activities.values():
        gap = known(analysis.paces[activity.id].gap) if activity.id in analysis.paces else None
        response = analysis.responses.get(activity.id)
        worst = known(response.worst) if response else None
        if gap is None or worst is None or response is None:
            continue
        for output in activity.conditional:
            found[activity.id, output] = gap + worst - (response.best.value or 0)
    return found


def ages(analysis: Analysis, chains: Mapping[str, ChainResult]) -> dict[str, Value]:
    """Bound the data age of each chain: where an event is the stimulus, it is larger than the reaction time."""
    network = Network.of(analysis)
    return {key: data_age(network, found) for key, found in chains.items()}


def known(value: Value | None) -> Fraction | None:
    """Give a figure that is a bound from above; a sum with gaps is none."""
    return value.value if value and value.complete and value.side != "at least" else None


def utilisation(analysis: Analysis, host: str) -> Fraction | None:
    """Give the bound on a host's load, as a share of all of its cores."""
    load = analysis.hosts.get(host)
    whole = known(load.utilisation) if load else None
    return None if load is None or whole is None else whole / load.cores
