"""Analyse the timing of both versions, only if a change can affect it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from archgen.compare.change import Change
from archgen.model.architecture import Architecture
from archgen.timing.analyse import analyse
from archgen.timing.analysis import Analysis, HostLoad, LinkLoad

_TEXT_SORTS = frozenset({"partner", "use_case", "requirement", "chapter", "view", "policy", "project"})
_TEXT_KEYS = frozenset(
    {
        *("title", "description", "functionality", "comment", "owner", "tags", "layout", "role", "requirements"),
        *("external", "optional", "executable", "package", "plugin", "status", "parameter_files"),
    }
)
_TEXT_STARTS = ("urls.", "performance.", "parameters.")


@dataclass(frozen=True, slots=True)
class Timed:
    """The timing analyses of both versions."""

    before: Analysis
    after: Analysis


def timed(before: Architecture, after: Architecture, changes: Sequence[Change]) -> Timed | None:
    """Analyse both versions if there are chains to compare, or an overloaded host or link; else return None."""
    if before.lost or after.lost:  # of what could not be read nobody knows how long it takes
        return None
    asked = before.chains or after.chains
    if not (asked or after.hosts or after.links) or not any(map(matters, changes)):
        return None
    found = analyse(after, judging=True)  # the analysis of the version judged last is still at hand
    loads: list[HostLoad | LinkLoad] = [*found.hosts.values(), *found.links.values()]
    if not asked and not any(map(full, loads)):
        return None
    return Timed(analyse(before, judging=True), found)


def matters(change: Change) -> bool:
    """Whether a change can affect a figure of timing."""
    if change.sort in _TEXT_SORTS:
        return False
    if change.kind == "changed" and change.key:
        return change.key not in _TEXT_KEYS and not change.key.startswith(_TEXT_STARTS)
    # Renames and moves change no figure.
    return change.kind in {"added", "removed", "changed"}


def full(load: HostLoad | LinkLoad) -> bool:
    """Whether a host or a link is asked for more than it has."""
    if isinstance(load, LinkLoad):
        return load.share.value is not None and load.share.value >= 1
    return any(used.value is not None and used.value >= cores for _, cores, used in load.places)
