"""Which of several changes made something fall: those without which it had not happened."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Sequence
from itertools import chain
from typing import NamedTuple

from archgen.compare.comparison import Change
from archgen.compare.key_phrases import name_key
from archgen.compare.losses.loss_wording import tick_name
from archgen.compare.losses.timing_causes import TimingCauses
from archgen.compare.losses.versions_without import VersionsWithout, find_whole
from archgen.compare.timing_pair import can_affect_timing
from archgen.diagnostics.common_wording import join_words
from archgen.frozen import dataclass
from archgen.model.architecture import Architecture
from archgen.timing.analysis import Analysis
from archgen.timing.figures.timing_values import TimingValue

_MAX_CANDIDATES = 8
"""How many changes are taken back one by one."""
_MAX_NAMES = 4

FallTest = Callable[[Architecture, Analysis, frozenset[int]], bool]
"""Whether it also falls in a version without some changes: the architecture, its analysis, the changes' indices."""


@dataclass(frozen=True, slots=True)
class SeparatedCauses:
    """The indices of the changes at which something is laid, and how they do it; the note is empty for a single one."""

    indices: tuple[int, ...]
    note: str = ""


class _ChangeGroup(NamedTuple):
    """Changes that are taken back together, and those of them that are told."""

    indices: tuple[int, ...]
    told: tuple[int, ...]


class CauseSeparator:
    """Separates the changes that made figures worse."""

    def __init__(self, causes: TimingCauses) -> None:
        """Start with the changes that may have made them worse, as `TimingCauses` finds them."""
        self._causes = causes
        self._context = causes.context
        self._versions = VersionsWithout(causes.context)

    def separate(self, activities: Sequence[str], own_indices: Iterable[int], falls: FallTest) -> SeparatedCauses:
        """Return the causes of what happens at some activities of the second version.

        They are the changes without which it does not happen; where any of several is enough, all of which that is
        true; where neither, all that reach it. `own_indices` are the changes of what is asked.
        """
        reach = sorted({*self._causes.find_causes(activities), *own_indices})
        worsening = sorted({*self._causes.all_worsening_changes(), *own_indices}) or [
            # Now and then less work makes a bound longer: then there is nothing else to blame.
            index
            for index, change in enumerate(self._context.changes)
            if any(map(can_affect_timing, self._context.walk_change(change)))
        ]
        reach = reach or worsening
        groups = self._group(worsening)
        if len(groups) > _MAX_CANDIDATES:
            groups = self._group(sorted({*reach, *self._causes.find_reach(activities)}))
        if len(groups) == 1:
            return SeparatedCauses(groups[0].told)
        if len(groups) > _MAX_CANDIDATES:
            return self._name_all(reach)
        return self._separate(groups, reach, falls)

    def _separate(self, groups: Sequence[_ChangeGroup], reach: Sequence[int], falls: FallTest) -> SeparatedCauses:
        everything = frozenset(chain.from_iterable(group.indices for group in groups))
        needed = [(group, self._falls_without(frozenset(group.indices), falls)) for group in groups]
        # What cannot be taken back alone may be the cause as well as any other.
        if any(found is None and set(group.indices) & set(reach) for group, found in needed):
            return self._name_all(reach)
        found_groups = [group for group, found in needed if found is False]
        if found_groups:
            either = "either" if len(found_groups) == 2 else "any one of them"  # noqa: PLR2004
            return self._note(found_groups, f" together: without {either} it holds")
        alone = [(group, self._falls_without(everything - set(group.indices), falls)) for group in groups]
        found_groups = [group for group, found in alone if found]
        if found_groups and self._falls_without(everything, falls) is False:
            return self._note(found_groups, ", each alone")
        return self._name_all(reach)

    def _falls_without(self, indices: frozenset[int], falls: FallTest) -> bool | None:
        version = self._versions.analyse(indices)
        return None if version is None else falls(*version, indices)

    def _group(self, indices: Sequence[int]) -> list[_ChangeGroup]:
        """Group changes that are taken back together: the same key of instances of one type, all of a component that is
        taken back as a whole. Of one that is new those that read it now go along, and are not told.
        """
        context = self._context
        wholes = {find_whole(context, context.changes[index]) for index in indices} - {None}
        groups: dict[object, list[int]] = {}
        for index in indices:
            groups.setdefault(self._find_origin(context.changes[index], wholes) or index, []).append(index)
        return [
            _ChangeGroup(
                tuple(members),
                tuple(
                    index
                    for index in members
                    if (context.changes[index].element_kind, context.changes[index].kind) == ("component", "added")
                )
                or tuple(members),
            )
            for members in groups.values()
        ]

    def _find_origin(self, change: Change, wholes: Collection[str | None]) -> object:
        """Return what the changes of a group have in common, None for a change that stands for itself."""
        component = self._context.after.components.get(change.element_id)
        if isinstance(change.after, list) and change.element_kind == "connection":
            gained = {source.rpartition(".")[0] for source in change.after} - self._context.before.components.keys()
            if whole_sources := sorted(gained.intersection(filter(None, wholes))):
                return whole_sources[0]
        node = self._context.after.nodes.get(change.element_id) if change.element_kind == "node" else None
        parts = [find_whole(self._context, change), *(node.implements if node else (change.element_id,))]
        whole = next((part for part in parts if part in wholes and part), None)
        if whole or component is None or not component.type_name:
            return whole
        return component.type_name, change.key, str(change.before), str(change.after)

    def _name_all(self, indices: Sequence[int]) -> SeparatedCauses:
        return SeparatedCauses(tuple(indices), "; causes not separated" if len(indices) > 1 else "")

    def _note(self, groups: Sequence[_ChangeGroup], ending: str) -> SeparatedCauses:
        indices = tuple(sorted(chain.from_iterable(group.told for group in groups)))
        names = [self._name_change(group.told[0]) for group in groups]
        surplus = [f"{len(names) - _MAX_NAMES} more"] if len(names) > _MAX_NAMES + 1 else []
        named = join_words([*names[: _MAX_NAMES if surplus else None], *surplus])
        return SeparatedCauses(indices, f"; {named}{ending}" if len(names) > 1 else "")

    def _name_change(self, index: int) -> str:
        """Name what a change is of, with its owner: whoever is broken sees his own part in it."""
        change = self._context.changes[index]
        owners = sorted(self._context.owners_of_change(index))
        words = name_key(change.element_kind, change.key) if change.key else change.kind
        owned = f" of {join_words([self._context.name_partner(owner) for owner in owners])}" if owners else ""
        return f"{tick_name(change.element_id)} ({words}){owned}"

    def lacks_new_figures_only(self, causes: SeparatedCauses, bound: TimingValue) -> bool:
        """Whether a bound is unknown only since elements that are new have no figures yet: nobody took one away."""
        activities = self._causes.timing_pair.after.system.activities
        is_new = all(name in activities and self._causes.old_activity(name) is None for name in bound.missing)
        is_added = all(self._context.changes[index].kind == "added" for index in causes.indices)
        return bool(bound.missing) and is_new and is_added
