"""Find the changes that made a figure worse: those of the activities that it consists of, or of what precedes them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

from archgen.compare.asked_limits import TimingPair, can_affect_timing
from archgen.compare.comparison import Change
from archgen.compare.kinds import Worsening, find_key
from archgen.compare.losses.change_context import ChangeContext
from archgen.compare.losses.lost_connections import find_output_causes
from archgen.compare.matched_ids import MatchedIds
from archgen.compare.version_pair import ComparedElement, ElementKey
from archgen.grouping import group_pairs
from archgen.model.architecture import Architecture
from archgen.model.quantity import Quantity
from archgen.timing.analysis import Analysis
from archgen.timing.load.host_loads import activity_share
from archgen.timing.system.timing_system import Activity

ActivityKey = tuple[str, str]
"""An activity in both versions: the common ids of its component and of its node ("" for a planned one)."""


@dataclass
class TimingCauses:
    """Both versions with their timing analyses. Activities have the ids of the second version."""

    context: ChangeContext
    timing_pair: TimingPair

    def activity_key(self, activity: Activity) -> ActivityKey:
        """Return the common key of an activity of the second version."""
        return _activity_key(activity, self.context.after, MatchedIds())

    def old_activity_key(self, activity: Activity) -> ActivityKey:
        """Return the common key of an activity of the first version."""
        return _activity_key(activity, self.context.before, self.context.matched_ids)

    @cached_property
    def old_activities(self) -> Mapping[ActivityKey, str]:
        """Return the activities of the first version by their common keys."""
        activities = self.timing_pair.before.system.activities
        return {self.old_activity_key(activity): name for name, activity in activities.items()}

    def old_activity(self, activity_id: str) -> str | None:
        """Return the id that an activity of the second version had in the first one."""
        return self.old_activities.get(self.activity_key(self.timing_pair.after.system.activities[activity_id]))

    def activity_owner(self, activity_id: str) -> str | None:
        """Return the partner who owned an activity of the second version before, or owns it if it is new."""
        component, node = self.activity_key(self.timing_pair.after.system.activities[activity_id])
        return self.context.owner_before("component", component) or self.context.owner_before("node", node)

    def activities_by_owner(self, activity_ids: Iterable[str]) -> dict[str, list[str]]:
        """Return the given activities of the second version by owner."""
        return _group_by_owner((self.activity_owner(name), name) for name in sorted(set(activity_ids)))

    def old_activities_by_owner(self, activity_ids: Iterable[str]) -> dict[str, list[str]]:
        """Return the given activities of the first version by owner."""
        system = self.timing_pair.before.system
        activity_keys = {
            activity_id: self.old_activity_key(system.activities[activity_id]) for activity_id in activity_ids
        }
        owner_before = self.context.owner_before
        return _group_by_owner(
            (owner_before("component", component_id) or owner_before("node", node_id), activity_id)
            for activity_id, (component_id, node_id) in sorted(activity_keys.items())
        )

    def find_cuts(self, activity_ids: Sequence[str]) -> tuple[list[int], Sequence[str]]:
        """Return the indices of changes that cut a path of the first version, and the activities from there on."""
        indices, first_cut = list[int](), len(activity_ids)
        for number, activity_id in enumerate(activity_ids):
            cutting_indices = list(self._changes_cutting(self.timing_pair.before.system.activities[activity_id]))
            indices += cutting_indices
            first_cut = min(first_cut, number) if cutting_indices else first_cut
        return list(dict.fromkeys(indices or [*self._changes_touching(activity_ids)][:1])), activity_ids[
            first_cut:
        ] if indices else activity_ids

    def _changes_touching(self, activity_ids: Iterable[str]) -> Iterator[int]:
        """Yield the indices of changes of the components and nodes behind activities of the first version."""
        for activity in map(self.timing_pair.before.system.activities.__getitem__, activity_ids):
            component, node = self.old_activity_key(activity)
            yield from self.list_worsening([("component", component), ("node", node)])

    def _changes_cutting(self, activity: Activity) -> Iterator[int]:
        """Yield the indices of changes that removed an activity of the first version, or what it read."""
        component, node = self.old_activity_key(activity)
        yield from self.context.indices_by_change_kind("component", component, "removed")
        yield from self.context.indices_by_change_kind("node", node, "removed")
        for key in activity.inputs:
            reader = self.context.matched_ids.common_id("input", key)
            versions = self.context.versions
            for output in sorted(
                versions.connections_before.sources_by_input.get(reader, frozenset())
                - versions.connections_after.sources_by_input.get(reader, frozenset())
            ):
                own_indices = self.context.indices_by_change_kind("connection", reader, "removed", "changed")
                input_stays = ("input", reader) in versions.elements_after  # else its own partner no longer asks for it
                yield from (find_output_causes(self.context, output) if input_stays else []) or own_indices

    def heavier_activities(self, activity_ids: Iterable[str]) -> list[str]:
        """Return those activities that take more of their core than before."""
        heavier_ids = []
        for activity_id in activity_ids:
            old_id = self.old_activity(activity_id)
            new_share = _core_share(self.timing_pair.after, activity_id)
            old_share = _core_share(self.timing_pair.before, old_id) if old_id else None
            if new_share and (old_share is None or old_share < new_share):
                heavier_ids.append(activity_id)
        return heavier_ids

    def find_causes(self, activity_ids: Sequence[str]) -> list[int]:
        """Return the indices of changes that made activities worse: of their own figures, else of what shares their
        host or feeds them.

        Only if no figure explains it, of what they read.
        """
        return self._follow_upstream(activity_ids, self._figure_changes) or self._follow_upstream(
            activity_ids, self._reading_changes
        )

    def find_reach(self, activity_ids: Iterable[str]) -> list[int]:
        """Return the indices of all changes that can have reached activities, also beyond those that explain it."""

        def find_indices(activity_id: str) -> Iterator[int]:
            yield from self._figure_changes(activity_id)
            yield from self._reading_changes(activity_id)

        return self._follow_upstream(activity_ids, find_indices, is_last=False)

    def _follow_upstream(
        self, activity_ids: Iterable[str], find_indices: Callable[[str], Iterable[int]], *, is_last: bool = True
    ) -> list[int]:
        indices: dict[int, None] = {}
        visited, waiting = set[str](), list(activity_ids)
        # Breadth first, and not beyond an activity whose own figures explain it: the nearest cause is the cause.
        while waiting:
            activity_id = waiting.pop(0)
            if activity_id in visited:
                continue
            visited.add(activity_id)
            own_indices = list(find_indices(activity_id))
            indices.update(dict.fromkeys(own_indices))
            if not (own_indices and is_last):
                waiting += self._upstream_activities(activity_id)
        return sorted(indices)

    def all_worsening_changes(self) -> list[int]:
        """Return the indices of all changes that can make a figure worse. The path of another chain does not."""
        indexed_changes = (
            (index, change) for index, change in enumerate(self.context.changes) if change.element_kind != "chain"
        )
        return [
            index
            for index, change in indexed_changes
            if any(self.can_worsen(inner_change) for inner_change in self.context.walk_change(change))
        ]

    def can_worsen(self, change: Change) -> bool:
        """Whether a change can make a figure worse. A better figure is never blamed."""
        if not can_affect_timing(change):
            return False
        if change.kind != "changed" or not change.key:
            return True
        worsening = find_key(change.element_kind, change.key).worsening
        # Bounds are sums, so each figure makes them worse in one direction only
        # (docs/decisions/0007-breaking-changes.md).
        if worsening in {Worsening.LESS, Worsening.MORE}:
            old_value, new_value = (
                _numeric_value(element, change.key)
                for element in self.context.versions.find_both(change.element_kind, change.element_id)
            )
            if old_value is None or new_value is None:
                return True
            return new_value < old_value if worsening is Worsening.LESS else new_value > old_value
        return worsening is Worsening.ALWAYS

    def _figure_changes(self, activity_id: str) -> Iterator[int]:
        """Yield the indices of changes of an activity's figures or place."""
        activity = self.timing_pair.after.system.activities[activity_id]
        component, node = self.activity_key(activity)
        # A node that was added with its component explains nothing more.
        added_indices = self.context.indices_by_change_kind("component", component, "added")
        element_keys = [
            ("component", component),
            ("host", activity.host or ""),
            ("container", activity.container or ""),
        ]
        # Without a written node it may have had one: what became of that is the cause.
        nodes = (
            [node]
            if node
            else [old_node for old_component, old_node in self.old_activities if old_component == component]
        )
        element_keys += [] if added_indices else [("node", name) for name in nodes]
        yield from added_indices
        yield from self.list_worsening(element_keys)

    def _reading_changes(self, activity_id: str) -> Iterator[int]:
        """Yield the indices of changes of what an activity reads and writes."""
        activity = self.timing_pair.after.system.activities[activity_id]
        reading_component = self.context.after.components.get(self.activity_key(activity)[0])
        input_ids = [port.id for port in reading_component.inputs.values()] if reading_component else []
        element_keys = [("output", key) for key in activity.outputs]
        yield from self.list_worsening(
            [*element_keys, *((kind, key) for key in input_ids for kind in ("input", "connection"))]
        )

    def list_worsening(self, element_keys: Iterable[ElementKey]) -> Iterator[int]:
        """Yield the indices of the changes of some elements that can worsen a figure."""
        for kind, element_id in element_keys:
            yield from self.context.list_indices(kind, element_id, self.can_worsen)

    def _upstream_activities(self, activity_id: str) -> Iterator[str]:
        """Yield what feeds an activity at another rate than before, and what takes more of its host."""
        system = self.timing_pair.after.system
        for arc in system.arcs_into.get(activity_id, ()):
            old_source = self.old_activity(arc.source)
            if (
                old_source is None
                or self.timing_pair.before.paces[old_source].rate.value
                != self.timing_pair.after.paces[arc.source].rate.value
            ):
                yield arc.source
        host = system.activities[activity_id].host
        load = self.timing_pair.after.hosts.get(host) if host else None
        yield from self.heavier_activities(part for part, _ in load.activity_shares) if load else ()


def _activity_key(activity: Activity, architecture: Architecture, matched_ids: MatchedIds) -> ActivityKey:
    node = matched_ids.common_id("node", activity.node) if architecture.nodes[activity.node].written else ""
    return matched_ids.common_id("component", activity.component or ""), node


def _core_share(analysis: Analysis, activity_id: str) -> Fraction | None:
    return activity_share(analysis.system, activity_id, analysis.paces[activity_id]).value


def _numeric_value(element: ComparedElement | None, key: str) -> Fraction | None:
    value = element.values.get(key) if element else None
    return value.value if isinstance(value, Quantity) else Fraction(value) if isinstance(value, int) else None


def _group_by_owner(owned_names: Iterable[tuple[str | None, str]]) -> dict[str, list[str]]:
    return group_pairs((owner, name) for owner, name in owned_names if owner)
