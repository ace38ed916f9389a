"""How long composed components take as wholes, which is what their own `timing` and `performance` are compared with."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from archgen.diagnostics.source_span import Span
from archgen.model.architecture import Architecture, Waypoint
from archgen.model.component import Component
from archgen.model.quantity import Quantity
from archgen.timing.analysis import Analysis
from archgen.timing.chains import chain_regions
from archgen.timing.chains.cost_network import CostNetwork
from archgen.timing.chains.extreme_paths import find_extreme_path
from archgen.timing.figures.timing_values import TimingValue

LIMIT_KEYS = ("deadline", "response")
"""The keys of a composed component's `timing` that say how long it may take."""


class WholeLimit(NamedTuple):
    """How long (ns) a composed component may take, as it says itself; `name` is the key, or the indicator's title."""

    name: str
    duration: Quantity
    at: Span


class WholeBound(NamedTuple):
    """The worst way through a composed component: its activities, and how long it takes (ns)."""

    through: tuple[str, ...]
    duration: TimingValue


def list_limits(shell: Component) -> Iterator[WholeLimit]:
    """Yield what a composed component says of how long it takes."""
    for key in LIMIT_KEYS:
        limit: Quantity | None = getattr(shell.timing, key, None)
        if shell.timing and limit:
            yield WholeLimit(key, limit, shell.timing.places[key])
    for indicator in shell.performance:
        if indicator.execution_time:
            yield WholeLimit(indicator.title, indicator.execution_time, indicator.at)


def bound_wholes(analysis: Analysis, architecture: Architecture) -> dict[str, WholeBound]:
    """Return the worst ways through those composed components that say how long they take."""
    shells = [shell for shell in architecture.shells.values() if next(list_limits(shell), None)]
    if not shells:
        return {}
    network = CostNetwork.of_analysis(analysis)
    waypoints = [Waypoint("component", shell.id) for shell in shells]
    bounds = {}
    for shell, point in zip(shells, network.index_elements(architecture).resolve_points(waypoints), strict=True):
        # From the activation on, as a deadline counts: the bound of a chain also has the wait of the first sample.
        extreme_path = find_extreme_path(network, chain_regions.lay_out_chain(network, (point,)), "reduced reaction")
        if extreme_path is not None:
            view, path, duration = extreme_path
            through = (view.names[path.start], *(view.arcs[arc_index].target for arc_index in path.arcs))
            bounds[shell.id] = WholeBound(through, duration)
    return bounds
