"""What the table of kinds says of each key of an element, and how values are read in normal form."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from enum import Enum, IntEnum, auto
from functools import cached_property
from typing import Any

from archgen.compare.architecture_version import ArchitectureVersion
from archgen.compare.matched_ids import MatchedIds
from archgen.compare.normal_values import is_unset
from archgen.frozen import dataclass
from archgen.grouping import group_pairs
from archgen.model.architecture import Architecture
from archgen.model.component import Component, ComponentType, Group
from archgen.model.message_types import ConceptualType
from archgen.model.node import Node


class Effect(IntEnum):
    """How far a change reaches: only texts and pictures, the system, or also its timing."""

    TEXT = 0
    SYSTEM = 1
    TIMING = 2


class Worsening(Enum):
    """Which changes of a value can make a figure of timing worse."""

    NEVER = auto()
    LESS = auto()
    MORE = auto()
    ALWAYS = auto()


class ReadContext:
    """One version while its elements are read. `matched_ids` gives the ids of the second version."""

    def __init__(
        self, version: ArchitectureVersion, matched_ids: MatchedIds, split_components: frozenset[str] = frozenset()
    ) -> None:
        self.version = version
        self.matched_ids = matched_ids
        self.split_components = split_components
        """Components with one node in one version and several in the other, by common ids: both versions compare them
        by their nodes, or else their timing and ports would change their place, not their meaning."""

    @property
    def architecture(self) -> Architecture:
        """Return the architecture of the version."""
        return self.version.architecture

    def common_id(self, kind: str, element_id: str | None) -> str | None:
        """Return the common id of an element that a key names, None for none."""
        return self.matched_ids.common_id(kind, element_id) if element_id else None

    def common_ids(self, kind: str, element_ids: Sequence[str]) -> frozenset[str]:
        """Return the common ids of the elements that a list names; its order says nothing."""
        return frozenset(self.matched_ids.common_id(kind, element_id) for element_id in element_ids)

    @cached_property
    def nodes_by_component(self) -> Mapping[str, list[Node]]:
        """Return for each component its nodes, planned ones included."""
        return group_pairs(
            (component, node) for node in self.architecture.nodes.values() for component in node.implements
        )

    @cached_property
    def owners_by_place(self) -> Mapping[str, frozenset[str]]:
        """Return for each file, and each folder of the project, who owns what stands there."""
        architecture = self.architecture
        nodes = [node for node in architecture.nodes.values() if node.written]
        elements: list[Group | Component | Node] = [
            *architecture.groups.values(),
            *architecture.components.values(),
            *nodes,
        ]
        owners_by_place: dict[str, set[str]] = defaultdict(set)
        for element in elements:
            place = element.at.file
            while place and element.owners:
                owners_by_place[place].update(element.owners)
                place = place.rpartition("/")[0]
        return {place: frozenset(owners) for place, owners in owners_by_place.items()}

    @cached_property
    def instance_owners(self) -> Mapping[str, frozenset[str]]:
        """Return for each component type who owns its instances."""
        owners_by_type: dict[str, set[str]] = defaultdict(set)
        for component in self.architecture.list_described_components():
            for base in self.architecture.list_bases(component.type_name):
                owners_by_type[base.id].update(component.owners)
        return {name: frozenset(owners) for name, owners in owners_by_type.items()}

    @cached_property
    def single_node_components(self) -> frozenset[str]:
        """Return the components that have exactly one node: it exposes all their ports, whether or not it says so."""
        return frozenset(name for name, nodes in self.nodes_by_component.items() if len(nodes) == 1)

    @cached_property
    def told_components(self) -> frozenset[str]:
        """Return the components that say themselves what their only node says of timing and ports."""
        return frozenset(
            name
            for name in self.single_node_components
            if self.matched_ids.common_id("component", name) not in self.split_components
        )


Reader = Callable[[Any, ReadContext], Any]
"""What reads a value off an element, in normal form."""


@dataclass(frozen=True, slots=True)
class KeySpec:
    """One key of a kind, most of them as the description of the language has them (`derive_keys`). A name that ends in
    a dot stands for all keys that begin with it: `read` returns a mapping from the rest of the key to the value.

    `read` returns the value in normal form: equal values mean the same, however they are written. Without it the value
    is the attribute of the same name.
    """

    name: str
    read: Reader | None = None
    effect: Effect = Effect.TIMING
    worsening: Worsening = Worsening.NEVER
    refers_to: str | None = None
    """The kind of the elements that the value names."""
    noun: str = ""
    """What sentences call the key, if not by its own name."""
    verb: str = ""
    """`x` VERB the new value: "belongs to"."""
    list_verbs: tuple[str, str] | None = None
    """What the element does with added and with removed items: ("now implements", "no longer implements")."""
    new_verb: str = ""
    """The verb with which the sentence about a new element reports the key; empty if it does not."""
    is_prose: bool = False
    """Whether the value is a text of several lines, of which sentences only say that it changed."""
    inner: tuple[KeySpec, ...] = ()
    """The keys below a name that ends in a dot, if they are known: without the name in front."""
    attribute: str = ""
    """The attribute that alone is read: where it is None or an empty collection, the key is not set."""

    def value_of(self, element: object, context: ReadContext) -> object:
        """Return the value of the key in normal form."""
        return self.read(element, context) if self.read else getattr(element, self.name)


def key_values(keys: Sequence[KeySpec], element: object, context: ReadContext) -> dict[str, object]:
    """Return the values of all keys of an element by name, without those that are not set."""
    values: dict[str, object] = {}
    for key in keys:
        # Most keys of most elements are not set: then no reader is called.
        if key.attribute and not (written := getattr(element, key.attribute)) and is_unset(written):
            continue
        value = key.value_of(element, context)
        if not value and is_unset(value):
            continue
        if not key.name.endswith("."):
            values[key.name] = value
        elif value:
            # Such a key reads a mapping, whatever its element; of most elements it is empty.
            values |= {f"{key.name}{name}": inner for name, inner in value.items() if not is_unset(inner)}  # type: ignore[attr-defined]
    return values


class KeyValues(Mapping[str, object]):
    """What `key_values` returns, read when somebody asks first: of what is the same in both versions nobody does."""

    __slots__ = ("_arguments", "_values")

    def __init__(self, keys: Sequence[KeySpec], element: object, context: ReadContext) -> None:
        self._arguments = (keys, element, context)
        self._values: dict[str, object] | None = None

    def _read(self) -> dict[str, object]:
        if self._values is None:
            self._values = key_values(*self._arguments)
        return self._values

    def __getitem__(self, name: str) -> object:
        """Return the value of a key. Raise KeyError where it is not set."""
        return self._read()[name]

    def __iter__(self) -> Iterator[str]:
        """Iterate over the names of the keys that are set."""
        return iter(self._read())

    def __len__(self) -> int:
        """Return how many keys are set."""
        return len(self._read())

    def __repr__(self) -> str:
        """Return the values as a dictionary shows them."""
        return repr(self._read())


# No key of the language: the rest of the list `owner`.
CO_OWNERS = KeySpec(
    "co_owners",
    lambda element, context: context.common_ids("partner", element.co_owners),
    Effect.SYSTEM,
    refers_to="partner",
    noun="further owners",
)


def read_owner(element: Any, context: ReadContext) -> str | None:  # noqa: ANN401 - groups, components and nodes
    """Return the common id of the partner who owns an element."""
    return context.common_id("partner", element.owner)


def find_type_owner(element: ComponentType | ConceptualType, context: ReadContext) -> str | None:
    """Return the common id of the partner whose a type is: by its own `owner`, else by what else stands in its file or
    in the nearest folder, else by the instances, if all are of one partner.
    """
    if element.library is not None:
        return None  # those know who check the library by itself
    place = element.at.file
    while place and place not in context.owners_by_place:
        place = place.rpartition("/")[0]
    owners = context.owners_by_place.get(place, frozenset())
    if isinstance(element, ComponentType):
        if element.owner:
            return context.common_id("partner", element.owner)
        owners = owners if len(owners) == 1 else context.instance_owners.get(element.id, frozenset())
    return context.common_id("partner", next(iter(owners))) if len(owners) == 1 else None
