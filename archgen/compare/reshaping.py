"""A component that was split, merged or copied, and which changes are nothing but a part of that."""

from __future__ import annotations

from typing import Literal

from archgen.compare.comparison import Change
from archgen.compare.output_heirs import OutputHeir, component_of
from archgen.compare.version_pair import ComparedElement, VersionPair
from archgen.frozen import dataclass

_FOLLOWING_KEYS = {
    "component": ("requirements", "functionality", "title", "description", "tags", "timing.wcet", "timing.bcet"),
    "node": ("implements",),
}
"""Keys that a split or a merger shares out or adds up, by kind of element."""


@dataclass(frozen=True, slots=True)
class Reshaping:
    """A component that was split or copied, or that others were merged into, with all components that take part."""

    kind: Literal["split", "merged", "copied"]
    component_id: str
    related_ids: tuple[str, ...]
    text: str
    confidence: float
    component_ids: frozenset[str]
    heirs: tuple[OutputHeir, ...]
    versions: VersionPair

    def brought_about(self, change: Change) -> bool:
        """Whether a change is nothing but a part of this one."""
        if self.kind == "copied":
            return (change.kind, change.element_kind, change.element_id) == ("added", "component", self.component_id)
        common_id = _common_id(change, self.versions)
        if change.element_kind == "connection":
            return self._only_follows_heirs(common_id)
        if change.element_kind == "chain":
            return change.key == "through" and self._only_other_waypoints(change)
        component_ids = self._component_ids_of(change.element_kind, common_id)
        is_inside = bool(component_ids) and component_ids <= self.component_ids
        if is_inside and change.element_kind == "node" and change.kind == "added":
            return self._has_known_place(common_id)
        return is_inside and (change.kind != "changed" or _follows_reshaping(change))

    def _has_known_place(self, node_id: str) -> bool:
        """Whether a new node runs where those ran that it is a part of: another computer is news."""
        old_places = {
            _place_of(element)
            for (kind, _), element in self.versions.elements_before.items()
            if kind == "node" and not self.component_ids.isdisjoint(element.component_refs)
        }
        return _place_of(self.versions.elements_after["node", node_id]) in old_places

    def _component_ids_of(self, kind: str, common_id: str) -> frozenset[str]:
        """Return the components behind a component, a port, a node or what a node says of a port; else nothing."""
        key = (kind, common_id)
        elements = (self.versions.elements_before.get(key), self.versions.elements_after.get(key))
        if kind in {"component", "output", "input", "node", "port"}:
            refs = frozenset(ref for element in elements if element for ref in element.component_refs)
            return refs if kind != "port" else _components_of_ports(refs, self.versions)
        return frozenset()

    def _only_follows_heirs(self, input_id: str) -> bool:
        """Whether an input reads nothing else than before, but the heirs of what it read."""
        heirs = {heir.old_id: heir.new_id for heir in self.heirs}
        before, after = (
            connections.sources_by_input.get(input_id, frozenset())
            for connections in (self.versions.connections_before, self.versions.connections_after)
        )
        is_inside = component_of(("input", input_id), self.versions) in self.component_ids
        # What was one component may have become a pipeline: one part reads the other.
        outer_sources = (
            {
                source
                for source in side
                if not is_inside or component_of(("output", source), self.versions) not in self.component_ids
            }
            for side in ({heirs.get(source, source) for source in before}, after)
        )
        return bool(before or is_inside) and frozenset(next(outer_sources)) == frozenset(next(outer_sources))

    def _only_other_waypoints(self, change: Change) -> bool:
        old_points, new_points = (
            set(value) if isinstance(value, list) else set[object]() for value in (change.before, change.after)
        )
        waypoints = sorted(map(str, old_points ^ new_points))
        return bool(waypoints) and all(map(self._is_waypoint_inside, waypoints))

    def _is_waypoint_inside(self, waypoint: str) -> bool:
        """Whether what a chain leads through is a component that takes part, an output or a node of it."""
        keys = [(kind, waypoint) for kind in ("component", "output", "node")]
        elements = [
            element
            for key in keys
            for element in (self.versions.elements_before.get(key), self.versions.elements_after.get(key))
            if element
        ]
        return any(
            element.component_refs and self.component_ids.issuperset(element.component_refs) for element in elements
        )


def _place_of(node: ComparedElement) -> tuple[object, object]:
    return node.values.get("host"), node.values.get("container")


def _follows_reshaping(change: Change) -> bool:
    """Whether a key is one that a split or a merger shares out or adds up."""
    key = change.key or ""
    return key in _FOLLOWING_KEYS.get(change.element_kind, ()) or (
        change.element_kind == "component" and key.startswith("performance.")
    )


def _components_of_ports(ports: frozenset[str], versions: VersionPair) -> frozenset[str]:
    components = {component_of((kind, port), versions) for port in ports for kind in ("output", "input")}
    return frozenset(components - {""})


def _common_id(change: Change, versions: VersionPair) -> str:
    """Return the common id of what changed; what was removed is known by its own id."""
    kind = "input" if change.element_kind == "connection" else change.element_kind
    if change.kind != "removed":
        return change.element_id
    return next(
        (
            name
            for (other_kind, name), element in versions.elements_before.items()
            if other_kind == kind and element.own_id == change.element_id
        ),
        change.element_id,
    )


def truncate_confidence(confidence: float) -> float:
    """Return a confidence with two digits, below 1: nothing is certain that was recognised by likeness."""
    return int(min(confidence, 0.99) * 100) / 100
