"""Find the processors and buses of a system wherever they stand, what has access to them, and what is bound to them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

from archgen.plugins.aadl.aadl_tree import AadlProperty, Path
from archgen.plugins.aadl.archgen_words import find_own_text
from archgen.plugins.aadl.bus_names import read_bound_path
from archgen.plugins.aadl.classifier_names import fold_property_name
from archgen.plugins.aadl.property_values import PropertyScope, read_references
from archgen.plugins.aadl.resolved_classifiers import ClassifierResolver, ResolvedClassifier, ResolvedPart
from archgen.plugins.aadl.structures import HARDWARE_CATEGORIES, fold_part_path
from archgen.plugins.aadl.system_walk import MAX_INSTANCES, TooManyInstancesError

PROCESSORS = frozenset({"processor", "virtual processor"})
_BUS_ACCESSES = frozenset({"bus access", "virtual bus access"})
_FLAT_CATEGORIES = frozenset({"data", "subprogram", "subprogram group", "thread", "memory"})
_MAX_DEPTH = 40


@dataclass(slots=True)
class HardwarePart:
    """A processor or bus where it stands."""

    part: ResolvedPart
    resolved: ResolvedClassifier | None
    scope: PropertyScope


@dataclass(slots=True)
class HardwareTree:
    """All hardware of a root, what is joined by bus accesses, and what is bound to what."""

    parts: dict[Path, HardwarePart] = field(default_factory=dict)
    joined: dict[Path, Path] = field(default_factory=dict)
    """A forest: paths of accesses and buses, each with another one that it is joined to."""
    devices: dict[Path, Path] = field(default_factory=dict)
    """Accesses of processors and devices, with who has them."""
    device_ids: dict[Path, str] = field(default_factory=dict)
    """The components that devices are of, where an export of archgen's says it, by complete id."""
    bindings: dict[Path, Path] = field(default_factory=dict)
    """What is bound to processors, with the processor."""
    bound_connections: dict[Path, dict[tuple[Path, str], None]] = field(default_factory=dict)
    """By bus: the connections bound to it, as where they stand and what they are called."""
    count: int = 0
    _owners_by_root: dict[Path, list[Path]] | None = None

    def find_root(self, path: Path) -> Path:
        """Return what all paths joined to this one have in common."""
        root = path
        while (above := self.joined.get(root, root)) != root:
            root = above
        while path != root:
            # Long ways are cut short, else a daisy chain takes the square of its length.
            self.joined[path], path = root, self.joined[path]
        return root

    def list_joined_devices(self, path: Path) -> list[Path]:
        """Return who has access to what is joined to a path."""
        if self._owners_by_root is None:
            self._owners_by_root = {}
            for access, owner in self.devices.items():
                self._owners_by_root.setdefault(self.find_root(access), []).append(owner)
        return self._owners_by_root.get(self.find_root(path), [])

    def join(self, one: Path, other: Path) -> None:
        """Join two paths."""
        self.joined[self.find_root(one)] = self.find_root(other)


class HardwareFinder:
    """Goes through all parts of a system."""

    def __init__(self, resolver: ClassifierResolver) -> None:
        self.tree = HardwareTree()
        self._resolver = resolver

    def walk(self, resolved: ResolvedClassifier, scope: PropertyScope, path: Path = ()) -> None:
        """Add all that stands in a classifier at a path."""
        tree = self.tree
        tree.count += 1
        if tree.count > MAX_INSTANCES:
            raise TooManyInstancesError
        self._add_bindings(resolved, scope, path)
        for connection in resolved.connections.values():
            if connection.kind in _BUS_ACCESSES and connection.source:
                tree.join(fold_part_path((*path, *connection.source)), fold_part_path((*path, *connection.target)))
        for name, part in resolved.parts.items():
            inner = self._resolver.resolve(part.use)
            inner_path, inner_scope = (*path, name), scope.go_into(part, inner)
            if part.category in HARDWARE_CATEGORIES and part.category != "memory":
                tree.parts[inner_path] = HardwarePart(part, inner, inner_scope)
            if inner is None or part.category in _FLAT_CATEGORIES:
                continue
            if part.category in PROCESSORS or part.category == "device":
                accesses = (key for key, port in inner.ports.items() if port.kind in _BUS_ACCESSES)
                tree.devices |= {(*inner_path, access): inner_path for access in accesses}
                if component_id := find_own_text(inner_scope, (), "component"):
                    tree.device_ids[inner_path] = component_id
            if len(path) < _MAX_DEPTH:
                self.walk(inner, inner_scope, inner_path)

    def _add_bindings(self, resolved: ResolvedClassifier, scope: PropertyScope, path: Path) -> None:
        # What is written farther out was found before, and counts.
        for (target, name), association in _list_bindings(resolved):
            if name == "actual_processor_binding":
                self._resolver.mark_used(association)
                references = read_references(association.value)
                if references:
                    self.tree.bindings.setdefault((*path, *target), (*path, *references[0]))
                if len(references) > 1:
                    words = "of several processors the first is taken"
                    self._resolver.notes.add("Actual_Processor_Binding", words, association.span, fate="noted")
            elif name == "actual_connection_binding" and target:
                self._resolver.mark_used(association)
                for reference in read_references(association.value)[:1]:
                    self.tree.bound_connections.setdefault((*path, *reference), {})[path, target[-1]] = None
        for connection in resolved.connections.values():
            if connection.properties and (bus := read_bound_path(scope, connection.name)):
                self.tree.bound_connections.setdefault((*path, *bus), {})[path, connection.name.lower()] = None


def _list_bindings(resolved: ResolvedClassifier) -> Iterator[tuple[tuple[Path, str], AadlProperty]]:
    """Yield what is bound in a classifier, in braces of its parts as well; references there begin at the classifier, too."""
    yield from resolved.properties.items()
    for name, part in resolved.parts.items():
        for association in part.written.properties:
            key = fold_property_name(association.name)
            if key in {"actual_processor_binding", "actual_connection_binding"}:
                for path in association.paths or ((),):
                    yield ((name, *fold_part_path(path)), key), association
