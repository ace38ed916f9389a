"""Classifiers of AADL written out: what each is used for, its ports and parts, and all that it inherits."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from archgen.plugins.aadl.aadl_tree import (
    AadlConnection,
    AadlFeature,
    AadlFlow,
    AadlProperty,
    Path,
    Subcomponent,
)
from archgen.plugins.aadl.classifier_names import KnownClassifier


@dataclass(frozen=True, slots=True)
class ClassifierUse:
    """A classifier as it is used: its name as written, what it is (None if that is in no file), its prototypes' values."""

    name: str = ""
    known: KnownClassifier | None = None
    bindings: Mapping[str, ClassifierUse] = field(default_factory=dict)
    category: str = ""

    @property
    def full_name(self) -> str:
        """Return the complete name, or the one that is written."""
        return self.known.full_name if self.known else self.name


@dataclass(slots=True)
class ResolvedPart:
    """A subcomponent, its classifier looked up, with the package in which it is written."""

    written: Subcomponent
    use: ClassifierUse
    category: str
    owner: KnownClassifier


@dataclass(slots=True)
class ResolvedPort:
    """A feature, its classifier looked up."""

    written: AadlFeature
    use: ClassifierUse
    kind: str
    direction: str
    owner: KnownClassifier


@dataclass(slots=True, eq=False)
class ResolvedClassifier:
    """A classifier with all that it inherits, by names in lower case."""

    known: KnownClassifier
    ancestors: tuple[KnownClassifier, ...] = ()
    """What it extends and what it implements, the nearest first."""
    prototypes: dict[str, ClassifierUse] = field(default_factory=dict)
    """What its prototypes stand for."""
    ports: dict[str, ResolvedPort] = field(default_factory=dict)
    parts: dict[str, ResolvedPart] = field(default_factory=dict)
    connections: dict[str, AadlConnection] = field(default_factory=dict)
    flows: dict[tuple[str, bool], AadlFlow] = field(default_factory=dict)
    """By name, and whether it is a flow of an implementation."""
    properties: dict[tuple[Path, str], AadlProperty] = field(default_factory=dict)
    """The last association of each property, by the path that it applies to."""
    initial_mode: str = ""
    """In lower case; empty where it has no modes."""
    own_type: ResolvedClassifier | None = None
    """The type of an implementation."""
    calls: list[Subcomponent] = field(default_factory=list)
    annexes: list[str] = field(default_factory=list)
    _prefixes: set[Path] | None = None

    def list_prefixes(self) -> set[Path]:
        """Return all beginnings of paths to which associations apply."""
        if self._prefixes is None:
            self._prefixes = {path[:size] for path, _ in self.properties for size in range(len(path) + 1)}
        return self._prefixes

    @property
    def category(self) -> str:
        """Return its category."""
        return self.known.classifier.category

    def is_made_from(self, *names: str) -> bool:
        """Whether it or what it extends is called so (in lower case, without package and implementation)."""
        return any(entry.classifier.name.lower().partition(".")[0] in names for entry in (self.known, *self.ancestors))
