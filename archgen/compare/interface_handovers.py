"""Interfaces between partners that changed hands: what another partner gives, or takes, than before is one change."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace

from archgen.compare.figure_changes import BoundaryChange, FigureChange
from archgen.compare.interface_figures import is_same_figure


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
            for key, changes_of_key in _group_by_giver(change_list, kind).items()
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


def _group_by_giver(
    changes: Iterable[BoundaryChange], kind: str
) -> Mapping[tuple[str, tuple[str, ...]], list[BoundaryChange]]:
    groups: dict[tuple[str, tuple[str, ...]], list[BoundaryChange]] = {}
    for change in changes:
        if change.kind == kind:
            groups.setdefault((change.interface_id, change.givers), []).append(change)
    return groups
