"""What changed at the boundaries between partners: the figures of the interfaces that an agreement would show as changed, and which interfaces changed hands."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping

from archgen.analyses.qos_compatibility import find_qos_conflicts
from archgen.compare.architecture_version import ArchitectureVersion
from archgen.compare.asked_limits import TimingPair
from archgen.compare.comparison import BoundaryChange, BoundaryKind, FigureChange, FigureKey, WireNames
from archgen.compare.interface_figures import (
    RECEIVER_NAMES,
    FigureReader,
    InterfaceFigures,
    concerns_nobody,
    is_same_figure,
)
from archgen.compare.matched_ids import MatchedIds
from archgen.compare.version_pair import VersionPair
from archgen.frozen import dataclass, replace
from archgen.grouping import group_pairs
from archgen.model.node import Qos
from archgen.model.partner_interfaces import PartnerPair, find_all_interfaces
from archgen.timing.figures.timing_values import TimingValue

_ASKED_QOS = "QoS asked"


@dataclass(frozen=True, slots=True)
class _InterfaceVersion:
    """An interface of one version: its id there, its figures, what it is called on the wire, and who of both ends has
    nodes that somebody wrote.
    """

    own_id: str
    figures: InterfaceFigures
    wire: WireNames
    has_sender: bool
    has_receiver: bool
    is_replaced: bool = False
    """Whether it is an old one, and its takers read another output now."""


_BoundaryKey = tuple[str, PartnerPair]


def find_boundary_changes(
    before: ArchitectureVersion,
    after: ArchitectureVersion,
    matched_ids: MatchedIds,
    timing_pair: TimingPair | None,
    versions: VersionPair,
) -> tuple[BoundaryChange, ...]:
    """Return what changed at the interfaces of partners, sorted by id; nothing where a version could not be read whole."""
    # Of an interface that seems gone nobody knows whether it stands in the part that was not read.
    if before.architecture.unread_keys or after.architecture.unread_keys:
        return ()
    # Where no change can affect timing, the figures are those that the rules judged; what is new has some too.
    old_analysis, new_analysis = (
        (timing_pair.before, timing_pair.after) if timing_pair else (before.analysis, after.analysis)
    )
    old_reader = FigureReader(before.architecture, old_analysis, matched_ids)
    new_reader = FigureReader(after.architecture, new_analysis)
    new_versions = _list_interfaces(new_reader)
    old_versions = _follow_topics(_list_interfaces(old_reader), new_versions, matched_ids)
    old_versions = _follow_readers(old_versions, new_versions, versions)
    changes = _merge_pairs(join_handovers(_compare_interfaces(old_versions, new_versions)))
    if before.waiting_rules or after.waiting_rules:
        # With errors of linking an interface may seem gone that only has an unknown owner or type.
        return tuple(change for change in changes if change.kind == "changed" and not change.old_givers)
    return tuple(changes)


def _list_interfaces(reader: FigureReader) -> dict[_BoundaryKey, _InterfaceVersion]:
    common_id = reader.matched_ids.common_id
    versions = {}
    for interface in find_all_interfaces(reader.architecture):
        giver, taker = interface.pair
        key = common_id("output", interface.key) if interface.output else interface.key
        pair = common_id("partner", giver), common_id("partner", taker)
        versions[key, pair] = _InterfaceVersion(
            interface.key,
            reader.read_figures(interface),
            WireNames(interface.flow, tuple(sorted(interface.topic_names))),
            reader.is_written(interface.giver_endpoints),
            reader.is_written(interface.taker_endpoints),
        )
    return versions


def _follow_topics(
    old_versions: Mapping[_BoundaryKey, _InterfaceVersion],
    new_versions: Mapping[_BoundaryKey, _InterfaceVersion],
    matched_ids: MatchedIds,
) -> dict[_BoundaryKey, _InterfaceVersion]:
    """Return the old interfaces; topics without an output that are called after a renamed element under their new names."""
    followed = {}
    for (name, pair), version in old_versions.items():
        new_name = matched_ids.rename_in_text(name) if name.startswith("/") else name
        is_renamed = (name, pair) not in new_versions and (new_name, pair) in new_versions
        followed[new_name if is_renamed else name, pair] = version
    return followed


def _follow_readers(
    old_versions: Mapping[_BoundaryKey, _InterfaceVersion],
    new_versions: Mapping[_BoundaryKey, _InterfaceVersion],
    versions: VersionPair,
) -> dict[_BoundaryKey, _InterfaceVersion]:
    """Return the old interfaces; an output that is gone under the id of the new one that all its readers read instead."""
    followed: dict[_BoundaryKey, _InterfaceVersion] = {}
    for (name, pair), version in old_versions.items():
        successor = _find_successor(name, versions) if versions.is_removed("output", name) else None
        if successor and (successor, pair) in new_versions and (successor, pair) not in followed:
            followed[successor, pair] = replace(version, is_replaced=True)
        else:
            followed[name, pair] = version
    return followed


def _find_successor(output: str, versions: VersionPair) -> str | None:
    """Return the one new output that the readers of an output have instead of it, None if there is not exactly one."""
    gained_outputs = [
        versions.connections_after.sources_by_input[reader]
        - versions.connections_before.sources_by_input.get(reader, frozenset())
        for reader in versions.connections_before.readers_by_output.get(output, ())
        if reader in versions.connections_after.sources_by_input
    ]
    successors = frozenset[str]().union(*gained_outputs)
    (successor,) = successors if len(successors) == 1 else (None,)
    return successor if successor and versions.is_added("output", successor) else None


def _compare_interfaces(
    old_versions: Mapping[_BoundaryKey, _InterfaceVersion], new_versions: Mapping[_BoundaryKey, _InterfaceVersion]
) -> Iterator[BoundaryChange]:
    for key in sorted({*old_versions, *new_versions}):
        (name, (giver, taker)), old, new = key, old_versions.get(key), new_versions.get(key)
        new_figures = _known_figures(old, new) if new else {}
        all_figures = tuple(_compare_figures(old.figures if old else {}, new_figures))
        kind: BoundaryKind = "changed" if old and new else "added" if new else "removed"
        missed_deadline = _find_missed_deadline(all_figures, new.figures) if new and kind == "changed" else None
        figures = all_figures if missed_deadline else tuple(each for each in all_figures if not _says_the_same(each))
        old_id = old.own_id if old and new and old.own_id != name else None
        if old and new and old.is_replaced and old.wire != new.wire:
            figures = (FigureChange(FigureKey(new.wire.flow), old.wire, new.wire), *figures)
        if figures or kind != "changed":
            is_for_both = kind != "changed" or missed_deadline
            concerned = {giver, taker} if is_for_both else _find_concerned(figures, giver, taker, new)
            yield BoundaryChange(
                kind,
                name,
                old_id,
                (giver,),
                (taker,),
                figures,
                frozenset(concerned),
                missed_deadline=missed_deadline,
            )


def _find_missed_deadline(changes: Iterable[FigureChange], figures: InterfaceFigures) -> TimingValue | None:
    """Return the shortest deadline that a subscriber asks for, if the largest gap kept it before and does no longer."""
    deadlines = [
        figure.deadline.value
        for key, figure in figures.items()
        if key.name == _ASKED_QOS and isinstance(figure, Qos) and figure.deadline
    ]
    for change in changes if deadlines else ():
        before, after = change.before, change.after
        if change.key.name == "largest gap" and isinstance(before, TimingValue) and isinstance(after, TimingValue):
            limit = min(deadlines)
            was_kept = before.value is not None and before.value <= limit
            if was_kept and after.value is not None and after.value > limit:
                return TimingValue(limit)
    return None


def _known_figures(old: _InterfaceVersion | None, new: _InterfaceVersion) -> InterfaceFigures:
    """Return the figures of a new version without those that became guesses, since the nodes of an end are gone."""
    if old and old.has_sender and not new.has_sender:
        return {}
    if old and old.has_receiver and not new.has_receiver:
        return {key: figure for key, figure in new.figures.items() if key.name not in RECEIVER_NAMES}
    return new.figures


def _compare_figures(old_figures: InterfaceFigures, new_figures: InterfaceFigures) -> Iterator[FigureChange]:
    # One node on each side is the same end, whatever it is called; of several each is compared with itself.
    counts = (Counter(key.name for key in figures) for figures in (old_figures, new_figures))
    several = {name for count in counts for name, number in count.items() if number > 1}
    old_figures, new_figures = (
        {key if key.name in several else FigureKey(key.name): figure for key, figure in figures.items()}
        for figures in (old_figures, new_figures)
    )
    for key in dict.fromkeys((*new_figures, *old_figures)):
        before, after = old_figures.get(key), new_figures.get(key)
        if before != after:
            yield FigureChange(key, before, after)


def _says_the_same(figure: FigureChange) -> bool:
    return is_same_figure(figure.key.name, figure.before, figure.after)


def _find_concerned(
    figures: Iterable[FigureChange], giver: str, taker: str, new: _InterfaceVersion | None
) -> Iterable[str]:
    """Return both partners, nobody where it is too little; the taker alone where it asks for another QoS that is offered
    as well.
    """
    names = {figure.key.name for figure in figures if not concerns_nobody(figure)}
    if names == {_ASKED_QOS} and new and not _has_conflict(new.figures):
        return (taker,)
    return (giver, taker) if names else ()


def _has_conflict(figures: InterfaceFigures) -> bool:
    qos_by_side: dict[str, list[Qos]] = {"QoS offered": [], _ASKED_QOS: []}
    for key, figure in figures.items():
        if isinstance(figure, Qos):
            qos_by_side[key.name].append(figure)
    offered, asked = qos_by_side.values()
    return any(True for writer in offered for reader in asked for _ in find_qos_conflicts(writer, reader))


def _merge_pairs(changes: Iterable[BoundaryChange]) -> Iterator[BoundaryChange]:
    """Yield one change for all pairs of partners for whom the same of one interface changed."""
    merged: dict[object, BoundaryChange] = {}
    for change in changes:
        key = (
            *(change.kind, change.interface_id, change.old_givers, change.old_takers, change.figures),
            change.missed_deadline,
        )
        known = merged.get(key)
        merged[key] = (
            replace(
                known,
                givers=tuple(dict.fromkeys((*known.givers, *change.givers))),
                takers=tuple(dict.fromkeys((*known.takers, *change.takers))),
                concerned_partners=known.concerned_partners | change.concerned_partners,
            )
            if known
            else change
        )
    yield from merged.values()


def join_handovers(changes: Iterable[BoundaryChange]) -> Iterator[BoundaryChange]:
    """Yield the changes; an interface that went from one partner to another, at either end, as one change."""
    return _follow_takers(_follow_givers(changes))


def _follow_givers(changes: Iterable[BoundaryChange]) -> Iterator[BoundaryChange]:
    """Yield the changes; what one partner gave a third one before, and another does now, is one change."""
    change_list = list(changes)
    lost, gained = (
        {(change.interface_id, change.takers): change for change in change_list if change.kind == kind}
        for kind in ("removed", "added")
    )
    for change in change_list:
        key = change.interface_id, change.takers
        if change.kind == "added" and key in lost:
            yield _hand_over(lost[key], change)
        elif change.kind != "removed":
            yield change
        elif key not in gained:
            # What it was like interests nobody any more, and would keep pairs of partners apart.
            yield replace(change, figures=())


def _hand_over(lost: BoundaryChange, gained: BoundaryChange) -> BoundaryChange:
    """Return what another partner gives now, with the figures that are others since."""
    old_figures = {figure.key: figure.before for figure in lost.figures}
    figures = [
        FigureChange(figure.key, old_figures.get(figure.key), figure.after)
        for figure in gained.figures
        if not is_same_figure(figure.key.name, old_figures.get(figure.key), figure.after)
    ]
    return replace(
        gained,
        kind="changed",
        old_givers=lost.givers,
        figures=tuple(figures),
        concerned_partners=gained.concerned_partners | lost.concerned_partners,
    )


def _follow_takers(changes: Iterable[BoundaryChange]) -> Iterator[BoundaryChange]:
    """Yield the changes; what one partner took from another one before, and a third one does now, is one change."""
    change_list = list(changes)
    lost, gained = (
        {
            key: changes_of_key[0]
            for key, changes_of_key in group_pairs(
                ((change.interface_id, change.givers), change) for change in change_list if change.kind == kind
            ).items()
            if len(changes_of_key) == 1
        }
        for kind in ("removed", "added")
    )
    for change in change_list:
        key = change.interface_id, change.givers
        if lost.get(key) is None or gained.get(key) is None or change.kind == "changed":
            yield change
        elif change.kind == "added":
            concerned = change.concerned_partners | lost[key].concerned_partners
            takers = lost[key].takers
            yield replace(change, kind="changed", old_takers=takers, figures=(), concerned_partners=concerned)
