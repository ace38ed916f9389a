"""What the table of kinds says of each kind of element."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import field
from typing import Any

from archgen.compare.architecture_version import ArchitectureVersion
from archgen.compare.compared_elements import ElementKey
from archgen.compare.element_relations import ElementRelations
from archgen.compare.kinds.described_keys import derive_keys
from archgen.compare.kinds.key_spec import Effect, KeySpec, ReadContext
from archgen.frozen import dataclass
from archgen.language.comparison_tables import KIND_EFFECTS


@dataclass(frozen=True, slots=True)
class FeatureSpec:
    """One feature by which an element is recognised under another id: its weight, and the marks that are compared.

    If `is_generated` holds in both versions, the feature is made from the id, and does not count.
    """

    name: str
    weight: float
    marks: Callable[[ElementRelations, Any], frozenset[str]]
    is_generated: Callable[[Any], bool] | None = None
    is_decisive: bool = False
    """Whether it decides alone where most marks of both sides are the same: a group is what it holds."""


def _nothing(_element: object, _context: ReadContext) -> None:
    return None


def _no_components(_element: object, _context: ReadContext) -> tuple[str, ...]:
    return ()


def _always(_element: object) -> bool:
    return True


@dataclass(frozen=True, slots=True)
class KindSpec:
    """One kind of element. `elements` lists those of a version by id; None: they are found with other elements."""

    name: str
    heading: str | None
    """The heading of its changes in a report, None for what is inside of groups."""
    own_keys: tuple[KeySpec, ...] = ()
    """What is compared beside the keys that the description of the language has."""
    own_effect: Effect = Effect.TIMING
    """How far a change reaches where the description does not have the kind."""
    elements: Callable[[ArchitectureVersion], Mapping[str, Any]] | None = None
    features: tuple[FeatureSpec, ...] = ()
    """None at all: elements of the kind are never recognised under another id."""
    word: str = ""
    """The kind in sentences, if not its name."""
    whole_word: str = ""
    """The kind in sentences that say what happened to the whole element, if not `word`."""
    has_path_id: bool = False
    """Whether ids are paths (`group.component`) that sentences name without the kind in front."""
    parent_kind: str | None = None
    """The kind of the element whose id is the beginning of the path: elements with one name below it are the same."""
    stays_in_parent: bool = False
    """Whether an element is only recognised below the same parent."""
    parent: Callable[[Any, ReadContext], ElementKey | None] = _nothing
    """Returns the element that one is added and removed with."""
    owner: Callable[[Any, ReadContext], str | None] = _nothing
    """Returns the common id of the partner."""
    components: Callable[[Any, ReadContext], tuple[str, ...]] = _no_components
    """Returns the common ids of the components behind an element."""
    is_declared: Callable[[Any], bool] = _always
    """False for what exists without a declaration (a type that is only used)."""
    like: str = ""
    """The described kind whose keys it has, if not its own."""
    without: frozenset[str] = frozenset()
    """The described keys that it does not have, or that are among its own."""
    key_table: dict[str, KeySpec] = field(default_factory=dict)
    """Filled by `find_key`."""

    @property
    def keys(self) -> tuple[KeySpec, ...]:
        """Return all keys, the described ones first."""
        return (*derive_keys(self.like or self.name, self.without), *self.own_keys)

    @property
    def effect(self) -> Effect:
        """Return how far a change of an element reaches at most; a key reaches no farther."""
        effect = KIND_EFFECTS.get(self.name)
        return Effect[effect.upper()] if effect else self.own_effect

    @property
    def kind_word(self) -> str:
        """Return the kind as sentences about its keys call it."""
        return self.word or self.name

    @property
    def element_word(self) -> str:
        """Return the kind as sentences about whole elements call it."""
        return self.whole_word or self.kind_word

    def find_key(self, name: str) -> KeySpec:
        """Return what the table says of a key of a change."""
        if name not in self.key_table:
            # A comparison made elsewhere may have any key: it may affect everything.
            self.key_table[name] = _find_key(self.keys, name) or KeySpec(name)
        return self.key_table[name]


def _find_key(keys: Sequence[KeySpec], name: str) -> KeySpec | None:
    for key in keys:
        # "qos" stands for all keys below it: their changes are reported as one.
        if name in {key.name, key.name.removesuffix(".")}:
            return key
        if key.name.endswith(".") and name.startswith(key.name):
            return _find_key(key.inner, name.removeprefix(key.name)) or key
    return None
