"""Hosts and links whose load changed so much that people should see it, long before it is too much."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from fractions import Fraction
from typing import Literal

from archgen.compare.activity_owners import find_activity_owners
from archgen.compare.architecture_version import ArchitectureVersion
from archgen.compare.figure_changes import LoadChange
from archgen.compare.matched_ids import MatchedIds
from archgen.compare.timing_pair import TimingPair
from archgen.model.architecture import Architecture
from archgen.timing.analysis import Analysis
from archgen.timing.figures.timing_values import TimingValue

_NOTICEABLE_STEP = Fraction(5, 100)
"""Smaller steps are told only where the load is high already."""
_HIGH_LOAD, _STEP_WHEN_HIGH = Fraction(80, 100), Fraction(1, 100)
"""From four fifths on, one in a hundred counts: the usual margin of those who plan the load of a computer or a bus."""


def find_link_users(
    before: ArchitectureVersion, after: ArchitectureVersion, matched_ids: MatchedIds
) -> Mapping[str, frozenset[str]] | None:
    """Return the partners whose data crosses each link in either version, None where nobody analysed that."""
    if before.analysis is None or after.analysis is None:
        return None
    users: dict[str, frozenset[str]] = {}
    for version, ids in ((before, matched_ids), (after, MatchedIds())):
        for name in version.architecture.links:
            owners = _find_users("link", name, version.architecture, version.analysis) if version.analysis else ()
            common_id = ids.common_id("link", name)
            users[common_id] = users.get(common_id, frozenset()) | {ids.common_id("partner", each) for each in owners}
    return users


def find_load_changes(
    after: Architecture, matched_ids: MatchedIds, timing_pair: TimingPair | None
) -> tuple[LoadChange, ...]:
    """Return the hosts, then the links, whose load changed noticeably."""
    if timing_pair is None or timing_pair.before is timing_pair.after:
        return ()
    old_shares = {
        (kind, matched_ids.common_id(kind, name)): share for kind, name, share in _list_shares(timing_pair.before)
    }
    return tuple(
        LoadChange(kind, name, old_shares.get((kind, name)), share, _find_users(kind, name, after, timing_pair.after))
        for kind, name, share in _list_shares(timing_pair.after)
        if _is_noticeable(old_shares.get((kind, name)), share)
    )


def _list_shares(analysis: Analysis) -> Iterator[tuple[Literal["host", "link"], str, TimingValue]]:
    for name, load in sorted(analysis.hosts.items()):
        # Of a host whose cores nobody counted there is no share.
        if load.share_of_cores is not None:
            yield "host", name, load.share_of_cores
    for name, link_load in sorted(analysis.links.items()):
        yield "link", name, link_load.share


def _is_noticeable(before: TimingValue | None, after: TimingValue) -> bool:
    if after.value is None or (before and before.value is None):
        return False
    old_share = before.value if before and before.value is not None else Fraction(0)
    step = abs(after.value - old_share)
    is_high = max(after.value, old_share) >= _HIGH_LOAD
    return step >= (_STEP_WHEN_HIGH if is_high else _NOTICEABLE_STEP)


def _find_users(kind: str, name: str, architecture: Architecture, analysis: Analysis) -> frozenset[str]:
    return find_activity_owners(_list_activities(kind, name, analysis), architecture, analysis)


def _list_activities(kind: str, name: str, analysis: Analysis) -> Iterable[str]:
    """Return the activities on a host, or those that send or receive over a link."""
    if kind == "host":
        return (activity.id for activity in analysis.system.activities.values() if activity.host == name)
    return (end for arc in analysis.system.arcs if arc.link == name for end in (arc.source, arc.target))
