"""What timing found of an architecture, with the look-ups that views need."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from archgen.model.architecture import Architecture
from archgen.timing.analysis import Analysis, ChainResult
from archgen.timing.system import Activity
from archgen.views import figures


@dataclass(frozen=True, slots=True)
class Timed:
    """An analysis and its chains. `origins` says where an inferred pace comes from, by activity."""

    analysis: Analysis
    chains: tuple[ChainResult, ...] = ()
    origins: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    of_node: Mapping[str, tuple[Activity, ...]] = field(default_factory=dict)


def timed(analysis: Analysis, chains: Iterable[ChainResult] = ()) -> Timed:
    """Make the look-ups of timing."""
    of_node: dict[str, tuple[Activity, ...]] = {}
    for activity in analysis.system.activities.values():
        of_node[activity.node] = (*of_node.get(activity.node, ()), activity)
    return Timed(analysis, tuple(chains), figures.origins(analysis), of_node)


def timing(architecture: Architecture) -> Timed:
    """Analyse an architecture. The engine is loaded only here: most that is shown needs no timing."""
    from archgen.timing.analyse import analyse
    from archgen.timing.chains import chains

    analysis = analyse(architecture)
    return timed(analysis, chains(analysis, architecture).values())
