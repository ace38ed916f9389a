"""Analyse the timing of both versions, only if a change can affect it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from archgen.compare.architecture_version import ArchitectureVersion
from archgen.compare.comparison import Change
from archgen.compare.kinds import Effect, find_effect
from archgen.frozen import dataclass
from archgen.model.architecture import Architecture
from archgen.timing.analysis import Analysis, HostLoad, LinkLoad
from archgen.timing.run_analysis import analyse_architecture


@dataclass(frozen=True, slots=True)
class TimingPair:
    """The timing analyses of both versions."""

    before: Analysis
    after: Analysis


def analyse_timing_pair(
    old_version: ArchitectureVersion, new_version: ArchitectureVersion, changes: Sequence[Change]
) -> TimingPair | None:
    """Analyse both versions if there are chains or interfaces of partners to compare, or an overloaded host or link; else
    return None.
    """
    before, after = old_version.architecture, new_version.architecture
    if before.unread_keys or after.unread_keys:  # of what could not be read nobody knows how long it takes
        return None
    has_figures = before.chains or after.chains or before.partners or after.partners
    is_asked = any(can_affect_timing(change) or _asks_for_figures(change) for change in changes)
    if not (has_figures or after.hosts or after.links) or not is_asked:
        return None
    new_analysis = _analysis_of(new_version)
    loads: list[HostLoad | LinkLoad] = [*new_analysis.hosts.values(), *new_analysis.links.values()]
    if not has_figures and not any(map(is_overloaded, loads)):
        return None
    return TimingPair(_analysis_of(old_version), new_analysis)


def _analysis_of(version: ArchitectureVersion) -> Analysis:
    return version.analysis or analyse_architecture(version.architecture, judging=True)


def can_affect_timing(change: Change) -> bool:
    """Whether a change can affect a figure of timing."""
    # Renames and moves change no figure.
    return (
        change.kind in {"added", "removed", "changed"} and find_effect(change.element_kind, change.key) is Effect.TIMING
    )


_WORD_KEYS = frozenset({"title", "functionality", "description"})
"""Not `external`, a text as well: from outside nobody may be served any more."""


def is_rewording(change: Change) -> bool:
    """Whether a change gives an element another title or text: no figure and no connection depends on these."""
    is_text = change.key in _WORD_KEYS and find_effect(change.element_kind, change.key) is Effect.TEXT
    return is_text and change.kind == "changed"


def _asks_for_figures(change: Change) -> bool:
    """Whether a change says what figures have to keep, and changes none of them."""
    return change.key is not None and (change.key == "qos" or "promise." in change.key)


def is_overloaded(load: HostLoad | LinkLoad) -> bool:
    """Whether a host or a link is asked for more than it has."""
    if isinstance(load, LinkLoad):
        return load.share.value is not None and load.share.value >= 1
    return any(used_cores.value is not None and used_cores.value >= cores for _, cores, used_cores in load.core_loads)


def find_activity_owners(names: Iterable[str], architecture: Architecture, analysis: Analysis) -> frozenset[str]:
    """Return who owns any of the activities: the owners of their components, else of their nodes."""
    return frozenset(owner for name in names for owner in _owners_of(name, architecture, analysis))


def _owners_of(name: str, architecture: Architecture, analysis: Analysis) -> tuple[str, ...]:
    # A chain of which no way is known names its points as written, and these may be ports.
    activity = analysis.system.activities.get(name)
    component = architecture.components.get(activity.component or "" if activity else name)
    return component.owners if component else architecture.nodes[activity.node].owners if activity else ()
