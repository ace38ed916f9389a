"""Look up names of classifiers in all packages that were read together."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from archgen.plugin.importing import Span
from archgen.plugins.aadl.aadl_tree import AadlPackage, AadlValue, Classifier, PropertySet

LIBRARY_PACKAGES = frozenset({"cnc", "ros"})
STANDARD_SETS = frozenset(
    [
        *("aadl_project", "aadl_properties", "aadl_contribution", "timing_properties", "thread_properties"),
        *("communication_properties", "memory_properties", "modeling_properties", "deployment_properties"),
        "programming_properties",
    ]
)
"""Property sets that every model has: their properties are written with or without them."""


@dataclass(slots=True, eq=False)
class KnownClassifier:
    """A classifier, the package in which it stands, and its complete name."""

    package: AadlPackage
    classifier: Classifier

    @property
    def full_name(self) -> str:
        """Return `package::name`, or the bare name of one in no package."""
        return "::".join(filter(None, [self.package.name, self.classifier.name]))

    @property
    def is_of_library(self) -> bool:
        """Whether it is of the libraries of components and of nodes of ROS: its name says what it has."""
        return self.package.name.lower() in LIBRARY_PACKAGES

    @property
    def key(self) -> str:
        """Return the complete name as it is compared."""
        return self.full_name.lower()


@dataclass(slots=True)
class ClassifierNames:
    """All that was read, by names in lower case."""

    packages: dict[str, AadlPackage] = field(default_factory=dict)
    property_sets: dict[str, PropertySet] = field(default_factory=dict)
    known: dict[str, KnownClassifier] = field(default_factory=dict)
    repeated: list[tuple[str, Span, Span]] = field(default_factory=list)
    """What is declared again, where, and where it was first."""

    @property
    def is_own(self) -> bool:
        """Whether an export of archgen's made the model: then names in AADL follow from the ids, and are not kept."""
        return "archgen" in self.property_sets

    def add_packages(self, packages: Iterable[AadlPackage]) -> None:
        """Add packages; the same package in several files is one (its public part may stand apart)."""
        for package in packages:
            first = self.packages.setdefault(package.name.lower(), package)
            if first is not package:
                first.renames.update(package.renames)
            for classifier in package.classifiers:
                entry = KnownClassifier(first, classifier)
                earlier = self.known.get(entry.key)
                if earlier is None:
                    self.known[entry.key] = entry
                else:
                    self.repeated.append((entry.full_name, classifier.span, earlier.classifier.span))

    def add_property_sets(self, property_sets: Iterable[PropertySet]) -> None:
        """Add property sets; of two with one name the first counts."""
        for found in property_sets:
            if self.property_sets.setdefault(found.name.lower(), found) is not found:
                first = self.property_sets[found.name.lower()]
                self.repeated.append((f"property set {found.name}", found.span, first.span))

    def find(self, name: str, package: AadlPackage) -> KnownClassifier | None:
        """Return the classifier that a name means in a package, or None."""
        return next((self.known[key] for key in self._list_keys(name.lower(), package) if key in self.known), None)

    def _list_keys(self, name: str, package: AadlPackage) -> Iterator[str]:
        yield f"{package.name.lower()}::{name}" if package.name else name
        yield name
        head, separator, rest = name.rpartition("::")
        if separator and head in package.renames:
            yield f"{package.renames[head]}::{rest}"
        type_name, dot, implementation = rest.partition(".")
        if not separator:
            if type_name in package.renames:
                yield package.renames[type_name] + dot + implementation
            for short, target in package.renames.items():
                if short.startswith("*"):
                    yield f"{target}::{name}"

    def find_constant(self, name: str) -> AadlValue | None:
        """Return the value of a constant `set::name` of a property set, or None."""
        set_name, _, constant = name.lower().rpartition("::")
        found = self.property_sets.get(set_name)
        return found.constants.get(constant) if found else None


def fold_property_name(name: str) -> str:
    """Return a property's name as it is compared: in lower case, without a set that every model has."""
    set_name, _, own_name = name.lower().rpartition("::")
    return own_name if set_name in STANDARD_SETS or not set_name else f"{set_name}::{own_name}"


def find_only_implementations(names: ClassifierNames) -> dict[str, KnownClassifier]:
    """Return the implementation of each type that has a single one, by the type's complete name in lower case."""
    found: dict[str, list[KnownClassifier]] = {}
    for known in names.known.values():
        if known.classifier.is_implementation:
            found.setdefault(known.key.partition(".")[0], []).append(known)
    return {key: entries[0] for key, entries in found.items() if len(entries) == 1}
