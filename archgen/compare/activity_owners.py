"""Which partners own the activities of a timing analysis."""

from __future__ import annotations

from collections.abc import Iterable

from archgen.model.architecture import Architecture
from archgen.timing.analysis import Analysis


def find_activity_owners(names: Iterable[str], architecture: Architecture, analysis: Analysis) -> frozenset[str]:
    """Return who owns any of the activities: the owners of their components, else of their nodes."""
    return frozenset(owner for name in names for owner in _owners_of(name, architecture, analysis))


def _owners_of(name: str, architecture: Architecture, analysis: Analysis) -> tuple[str, ...]:
    # A chain of which no way is known names its points as written, and these may be ports.
    activity = analysis.system.activities.get(name)
    component = architecture.components.get(activity.component or "" if activity else name)
    return component.owners if component else architecture.nodes[activity.node].owners if activity else ()
