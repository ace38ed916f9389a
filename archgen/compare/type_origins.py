"""Which changes of instances come from a change of their component type: same key, same value before and after.

An instance that says a value itself does not change with its type, or otherwise.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from archgen.compare.comparison import Change, Comparison
from archgen.compare.kinds.component_type_kind import OWN_KEYS, PART_MARK
from archgen.compare.normal_values import to_plain_data
from archgen.model.architecture import Architecture
from archgen.model.component import Component

_PORT_SECTIONS = {"input": "inputs", "output": "outputs"}


class TypeKey(NamedTuple):
    """A key of a component type."""

    component_type: str
    key: str


class OriginFinder:
    """Finds the type that a change comes from."""

    def __init__(self, comparison: Comparison) -> None:
        """Look up what both versions say."""
        self._comparison = comparison
        self._base_chains: dict[str, tuple[str, ...]] = {}
        self._differences: dict[TypeKey, tuple[object, object] | None] = {}
        self._has_types = any(version.architecture.component_types for version in (comparison.before, comparison.after))

    def find_origin(self, change: Change) -> TypeKey | None:
        """Return the key of a component type that a change of an instance, or of a type made from it, follows."""
        if not self._has_types:
            return None
        architecture = (self._comparison.before if change.kind == "removed" else self._comparison.after).architecture
        return next((each for each in self._list_candidates(change, architecture) if self._is_same(change, each)), None)

    def find_difference(self, type_key: TypeKey) -> tuple[object, object] | None:
        """Return the values of a key in both versions as plain data, None where a type does not differ in it."""
        if type_key not in self._differences:
            self._differences[type_key] = self._compare_values(type_key)
        return self._differences[type_key]

    def _compare_values(self, type_key: TypeKey) -> tuple[object, object] | None:
        versions = self._comparison.versions
        element_key = ("component_type", type_key.component_type)
        old, new = versions.elements_before.get(element_key), versions.elements_after.get(element_key)
        before, after = (element.values.get(type_key.key) if element else None for element in (old, new))
        is_other = old is not None and new is not None and before != after
        return (to_plain_data(before), to_plain_data(after)) if is_other else None

    def _is_same(self, change: Change, type_key: TypeKey) -> bool:
        difference = self.find_difference(type_key)
        if difference is None:
            return False
        before, after = difference
        if change.kind == "changed":
            return (before, after) == (change.before, change.after)
        if change.element_kind in _PORT_SECTIONS:
            # What came or went with a port is told with the port.
            return not change.parts and (before if change.kind == "added" else after) is None
        names = [value if isinstance(value, list) else [] for value in (before, after)]
        own_names, other_names = names if change.kind == "removed" else reversed(names)
        name = change.element_id.rpartition(".")[2]
        return name in own_names and name not in other_names

    def _list_candidates(self, change: Change, architecture: Architecture) -> Iterator[TypeKey]:
        """Yield the keys that may be where a change comes from, those of the types that others are made from first."""
        if change.kind not in {"changed", "added", "removed"}:
            return
        match change.element_kind:
            case "component" | "composed":
                yield from self._list_component_keys(change, architecture)
            case "input" | "output":
                component_id, _, name = change.element_id.rpartition(".")
                port_key = f"{_PORT_SECTIONS[change.element_kind]}.{name}"
                suffix = "" if change.key in {None, "type"} else f"{PART_MARK}{change.key}"
                yield from self._list_keys(architecture, component_id, f"{port_key}{suffix}")
            case "node" if change.kind == "changed":
                node = architecture.nodes.get(change.element_id)
                for component_id in (node.wholes or node.implements)[:1] if node else ():
                    yield from self._list_keys(architecture, component_id, f"node.{change.key}")
            case "component_type" if change.kind == "changed":
                yield from self._list_type_keys(change)

    def _list_component_keys(self, change: Change, architecture: Architecture) -> Iterator[TypeKey]:
        if change.key:
            yield from self._list_keys(architecture, change.element_id, change.key)
            return
        component = architecture.find_component(change.element_id)
        if component and component.parent:
            yield from self._list_keys(architecture, component.parent, "components")

    def _list_keys(self, architecture: Architecture, component_id: str, key: str) -> Iterator[TypeKey]:
        """Yield a key of a component at its types, then at the types of the components around it."""
        component = architecture.find_component(component_id)
        holder = component
        while holder:
            path = component_id.removeprefix(holder.id).removeprefix(".")
            if path or key not in OWN_KEYS:
                whole_key = f"components.{path}{PART_MARK}{key}" if path else key
                yield from (TypeKey(name, whole_key) for name in self._list_types(holder, architecture))
            holder = architecture.find_component(holder.parent or "")

    def _list_type_keys(self, change: Change) -> Iterator[TypeKey]:
        """Yield where a key of a type may come from: the type of the part that it is about, or what it is made from."""
        path, _, key = (change.key or "").removeprefix("components.").partition(PART_MARK)
        if key and (change.key or "").startswith("components."):
            yield from self._list_part_keys(change.element_id, path, key)
        own_chain = self._list_bases(change.element_id)
        if change.key not in OWN_KEYS:
            yield from (TypeKey(name, change.key or "") for name in own_chain if name != change.element_id)

    def _list_part_keys(self, type_id: str, path: str, key: str) -> Iterator[TypeKey]:
        """Yield a key of a part inside of a type at the part's own types, then at those of the parts around it."""
        patterns, outer_path, inner_path = self._comparison.after.type_patterns.components, path, ""
        while outer_path:
            part = patterns.get(f"{type_id}.{outer_path}")
            if part and (inner_path or key not in OWN_KEYS):
                whole_key = f"components.{inner_path}{PART_MARK}{key}" if inner_path else key
                yield from (
                    TypeKey(name, whole_key) for name in self._list_types(part, self._comparison.after.architecture)
                )
            outer_path = outer_path.rpartition(".")[0]
            inner_path = path.removeprefix(outer_path).removeprefix(".")

    def _list_types(self, component: Component, architecture: Architecture) -> Sequence[str]:
        name = component.type_name
        if architecture is self._comparison.before.architecture:
            name = self._comparison.matched_ids.common_id("component_type", name)
        return self._list_bases(name)

    def _list_bases(self, name: str) -> tuple[str, ...]:
        """Return a type with all that it is made from, the outermost base first."""
        if name not in self._base_chains:
            bases = self._comparison.after.architecture.list_bases(name)
            self._base_chains[name] = tuple(each.id for each in reversed(list(bases)))
        return self._base_chains[name]


def trace_origins(comparison: Comparison, changes: Sequence[Change]) -> Mapping[int, TypeKey]:
    """Return where changes come from, by the identity of each change that comes from a type."""
    finder = OriginFinder(comparison)
    return {id(change): origin for change in changes if (origin := finder.find_origin(change))}
