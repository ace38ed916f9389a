"""Which systems are launch files, which classifiers become component types, and what is written in place."""

from __future__ import annotations

from archgen.plugin.importing import make_id, make_unique_id
from archgen.plugins.aadl.classifier_names import KnownClassifier, find_only_implementations
from archgen.plugins.aadl.property_values import fold_value, read_first_text
from archgen.plugins.aadl.resolved_classifiers import ClassifierResolver
from archgen.plugins.aadl.structures import ClassifierStructure, StructureFinder

_TYPE_CATEGORIES = frozenset({"system", "process", "device", "abstract"})


class ModelRoots:
    """The systems that are part of no other, and the component types by id."""

    def __init__(self, resolver: ClassifierResolver, finder: StructureFinder) -> None:
        self.roots: list[ClassifierStructure] = []
        self.types: dict[str, ClassifierStructure] = {}
        self._resolver, self._finder = resolver, finder
        self._uses: dict[int, int] = {}
        self._used_structures: dict[int, ClassifierStructure] = {}
        self._extended: set[int] = set()
        self._part_keys: set[str] = set()
        self._type_ids: dict[int, str] = {}
        self._only: dict[str, KnownClassifier] = {}
        self._root_ids: set[int] = set()
        self._find_all()

    def find_type_id(self, structure: ClassifierStructure) -> str:
        """Return the id of the component type that a structure is, or nothing."""
        return self._type_ids.get(id(structure), "")

    def find_base_id(self, structure: ClassifierStructure) -> str:
        """Return the component type from which another one is made, or nothing."""
        known = structure.resolved.known
        name = known.classifier.extends
        if not name and known.classifier.is_implementation:
            own_type = self._resolver.names.find(known.classifier.name.partition(".")[0], known.package)
            name, known = (own_type.classifier.extends, own_type) if own_type else ("", known)
        base = self._resolver.names.find(name, known.package) if name else None
        # Where more extend one another than are followed, it is none of the ancestors.
        if base is None or base is structure.resolved.known or base not in structure.resolved.ancestors:
            return ""
        return self._type_ids.get(id(self._find_structure(base)), "")

    def is_single(self, structure: ClassifierStructure) -> bool:
        """Whether something stands in one place alone, and is no component type."""
        return self._uses.get(id(structure), 0) == 1 and id(structure) not in self._type_ids

    def _find_all(self) -> None:
        known_classifiers = list(self._resolver.names.known.values())
        self._only = find_only_implementations(self._resolver.names)
        implemented = {entry.key.partition(".")[0] for entry in known_classifiers if entry.classifier.is_implementation}
        extended_keys = self._list_named(known_classifiers)
        for known in known_classifiers:
            if known.classifier.category != "system" or not known.classifier.is_implementation:
                continue
            # What is neither a part nor extended stands for itself: AADL does not say which systems are instantiated.
            if known.key not in self._part_keys and known.key not in extended_keys:
                self.roots.append(self._find_structure(known))
        self._root_ids = {id(root) for root in self.roots}
        for root in self.roots:
            self._count_uses(root)
        for known in known_classifiers:
            if known.classifier.category in _TYPE_CATEGORIES and not known.is_of_library:
                self._add_unused(known, implemented, extended_keys)
        for structure in list(self._used_structures.values()):
            self._name_type(structure)

    def _add_unused(self, known_classifier: KnownClassifier, implemented: set[str], extended_keys: set[str]) -> None:
        """Count what stands in no system: it becomes a component type, too."""
        structure = self._find_structure(known_classifier)
        is_told_otherwise = known_classifier.key in implemented and known_classifier.key not in self._part_keys
        if is_told_otherwise or id(structure) in self._root_ids or not _has_content(structure):
            return
        if known_classifier.key in extended_keys and known_classifier.key not in self._only:
            self._extended.add(id(structure))
        if id(structure) not in self._uses:
            self._uses[id(structure)] = 0
            self._count_uses(structure)
            self._used_structures[id(structure)] = structure

    def _find_structure(self, known_classifier: KnownClassifier) -> ClassifierStructure:
        return self._finder.find(self._resolver.resolve_known(known_classifier))

    def _list_named(self, known_classifiers: list[KnownClassifier]) -> set[str]:
        """Return the keys of what is extended; remember those of what is a part."""
        extended: set[str] = set()
        names = self._resolver.names
        for known in known_classifiers:
            classifier = known.classifier
            if classifier.extends and (base := names.find(classifier.extends, known.package)):
                extended.add(base.key)
            for part in classifier.subcomponents:
                if part.classifier and (found := names.find(part.classifier, known.package)):
                    self._part_keys.add(found.key)
        return extended

    def _count_uses(self, structure: ClassifierStructure) -> None:
        # Without recursion: parts may nest as deep as the file likes, and many stand in the same structure.
        waiting = [structure]
        while waiting:
            for part in waiting.pop().parts.values():
                inner = part.structure
                if inner is None:
                    continue
                self._uses[id(inner)] = self._uses.get(id(inner), 0) + 1
                # Each structure is entered once: doubled parts, twenty levels deep, would be a million ways.
                if id(inner) not in self._used_structures:
                    self._used_structures[id(inner)] = inner
                    waiting.append(inner)

    def _name_type(self, structure: ClassifierStructure) -> None:
        """Give a structure an id as a component type, if it is one."""
        category = structure.resolved.category
        if category not in _TYPE_CATEGORIES and category != "thread group":
            return
        written = structure.resolved.properties.get(((), "archgen::component_type"))
        wanted = read_first_text(fold_value(written.value, self._resolver.names)) if written else ""
        is_reused = self._uses.get(id(structure), 0) != 1 or id(structure) in self._extended
        if not (wanted or is_reused or self._has_reused_base(structure)):
            return
        known = structure.resolved.known
        type_key = known.key.partition(".")[0]
        name = known.classifier.name
        if self._only.get(type_key) is known and type_key not in self._part_keys:
            name = name.partition(".")[0]
        self._type_ids[id(structure)] = make_unique_id(make_id(wanted or name, "type"), self.types.keys())
        self.types[self._type_ids[id(structure)]] = structure

    def _has_reused_base(self, structure: ClassifierStructure) -> bool:
        """Whether it extends what is a component type: then it is one, made from that."""
        return any(
            entry.classifier.category in _TYPE_CATEGORIES and id(self._find_structure(entry)) in self._extended
            for entry in structure.resolved.ancestors
        )


def _has_content(structure: ClassifierStructure) -> bool:
    """Whether a classifier says anything that a component type can have; bases of a library often do not."""
    return bool(structure.ports.ports or structure.parts or structure.thread)
