"""Which measured execution times a chain's bound rests on: they are the longest that were seen, and prove nothing."""

from __future__ import annotations

from collections.abc import Iterable

from archgen.model.graph_search import find_reachable
from archgen.timing.analysis import Analysis
from archgen.timing.chains.trigger_arrivals import TriggerArrivals
from archgen.timing.figures.figure_wording import join_first_names


def describe_measured_basis(analysis: Analysis, through: Iterable[str]) -> str:
    """Say which measured execution times the bound of a chain rests on; empty for none."""
    activities = analysis.system.activities
    if not any(activity.wcet_measured for activity in activities.values()):
        return ""
    names = tuple(name for name in _find_basis(analysis, through) if activities[name].wcet_measured)
    return f"the execution time of {join_first_names(names)} is the longest that was seen, not proven" if names else ""


def _find_basis(analysis: Analysis, through: Iterable[str]) -> list[str]:
    """Return the activities on which the figures of some rest: what fires them, what shares a host or a resource."""
    arrivals, activities = TriggerArrivals(analysis), analysis.system.activities
    neighbours: dict[str, list[str]] = {
        name: [arc.source for arc in analysis.system.arcs_into.get(name, ()) if arrivals.fires_reader(arc)]
        for name in activities
    }
    # Places stand between those that share them: two joined activities are two steps apart. Ids have no blanks.
    for name, activity in activities.items():
        if activity.response is not None:
            continue
        places = [f"host {activity.host}"] if activity.host else []
        for place in (*places, *(f"resource {key}" for key in activity.uses)):
            neighbours[name].append(place)
            neighbours.setdefault(place, []).append(name)
    reached = set(find_reachable(neighbours, through))
    return [name for name in activities if name in reached]
