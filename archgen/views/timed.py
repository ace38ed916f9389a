"""Results of the timing analysis, with the look-ups that views need."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from archgen.model.architecture import Architecture
from archgen.timing.analysis import Analysis, ChainResult
from archgen.timing.system import Activity
from archgen.views import figures


@dataclass(frozen=True, slots=True)
class Timed:
    """A timing analysis with its chains."""

    analysis: Analysis
    chains: tuple[ChainResult, ...] = ()
    origins: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    """Activities that an inferred rate comes from, by activity id; rates that were written have no entry."""
    of_node: Mapping[str, tuple[Activity, ...]] = field(default_factory=dict)
    """Activities of a node, by node id."""


def timed(analysis: Analysis, chains: Iterable[ChainResult] = ()) -> Timed:
    """Build the look-ups of a timing analysis."""
    of_node: dict[str, tuple[Activity, ...]] = {}
    for activity in analysis.system.activities.values():
        of_node[activity.node] = (*of_node.get(activity.node, ()), activity)
    return Timed(analysis, tuple(chains), figures.origins(analysis), of_node)


def timing(architecture: Architecture) -> Timed:
    """Analyse the timing of an architecture, with its chains."""
    # Imported here because the engine takes time to load, and most commands show no timing.
    from archgen.timing.analyse import analyse
    from archgen.timing.chains import chains

    analysis = analyse(architecture)
    return timed(analysis, chains(analysis, architecture).values())
