"""What describing and judging changes needs to look up in both versions, and their elements in normal form; who reads what
in each.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterator, Mapping

from archgen.compare.matched_ids import MatchedIds
from archgen.frozen import dataclass, field
from archgen.model.architecture import Architecture
from archgen.model.latest_result import remember_latest

_OppositeEnds = Mapping[str, frozenset[str]]


@dataclass(frozen=True, slots=True)
class ConnectionMap:
    """One version: the sources of each input, and the readers of each output."""

    sources_by_input: _OppositeEnds
    readers_by_output: _OppositeEnds
    made_pairs: frozenset[tuple[str, str]] = frozenset()
    """The outputs and inputs that nobody joined: `autoconnect` did."""
    group_pairs: frozenset[tuple[str, str]] = frozenset()
    """The outputs and inputs of which the input names the group alone: it reads whatever is in that."""

    def is_made(self, input_id: str, outputs: Collection[str]) -> bool:
        """Whether an input and all of these outputs are joined by themselves."""
        return bool(outputs) and all((output, input_id) in self.made_pairs for output in outputs)


@dataclass(frozen=True, slots=True)
class RewiredInput:
    """An input whose sources changed."""

    input_id: str
    sources_before: frozenset[str]
    sources_after: frozenset[str]

    @property
    def lost_sources(self) -> frozenset[str]:
        """Return the sources that it no longer has."""
        return self.sources_before - self.sources_after

    @property
    def gained_sources(self) -> frozenset[str]:
        """Return the sources that are new."""
        return self.sources_after - self.sources_before


def map_connections(architecture: Architecture, matched_ids: MatchedIds) -> ConnectionMap:
    """Return the connections of a version. A reference to something without an output yet is kept under its own id."""
    sources: dict[str, set[str]] = defaultdict(set)
    readers: dict[str, set[str]] = defaultdict(set)
    made_pairs, group_pairs = set[tuple[str, str]](), set[tuple[str, str]]()
    for connection in architecture.connections:
        reader = matched_ids.common_id("input", connection.input)
        for output in connection.outputs:
            output_id = matched_ids.common_id("output", output)
            sources[reader].add(output_id)
            readers[output_id].add(reader)
            if connection.is_made:
                made_pairs.add((output_id, reader))
            elif connection.kind == "group":
                group_pairs.add((output_id, reader))
        if not connection.outputs:
            sources[reader].add(matched_ids.common_id(connection.kind, connection.target))
    return ConnectionMap(_freeze_ends(sources), _freeze_ends(readers), frozenset(made_pairs), frozenset(group_pairs))


def _freeze_ends(ends: Mapping[str, set[str]]) -> _OppositeEnds:
    return {name: frozenset(opposite_ids) for name, opposite_ids in ends.items()}


def find_rewired_inputs(old_map: ConnectionMap, new_map: ConnectionMap) -> Iterator[RewiredInput]:
    """Yield the inputs whose sources changed, sorted by id."""
    no_sources = frozenset[str]()
    for input_id in sorted(old_map.sources_by_input.keys() | new_map.sources_by_input.keys()):
        old_sources = old_map.sources_by_input.get(input_id, no_sources)
        new_sources = new_map.sources_by_input.get(input_id, no_sources)
        if old_sources != new_sources:
            yield RewiredInput(input_id, old_sources, new_sources)


SOME_PORTS = "some"
"""Value of the keys "inputs" and "outputs" of a component that has ports: these are elements of their own."""
MAPPED_KEY = "mapped"
"""Key of a component that says whether somebody wrote a node for it."""
ElementKey = tuple[str, str]
"""A kind of element and a common id."""


@dataclass(frozen=True, slots=True)
class ComparedElement:
    """One element. `id` is the common id, `own_id` the one in its version; `parent_key` is the element that it is added
    and removed with.

    `owner` is a partner; `is_declared` is False for what exists without a declaration (a type that is only used).
    """

    kind: str
    id: str
    own_id: str
    values: Mapping[str, object]
    parent_key: ElementKey | None = None
    owner: str | None = None
    is_declared: bool = True
    component_refs: tuple[str, ...] = ()
    """Common ids of the components behind it; for a port of a node, the id of the component's port."""
    file: str = field(default="", compare=False)
    """Where it is declared: an element that moves between files has not changed."""


ElementsByKey = Mapping[ElementKey, ComparedElement]
_COMPONENT_KINDS = frozenset({"component", "composed", "input", "output"})


@dataclass(frozen=True, slots=True)
class VersionPair:
    """Elements and connections of both versions by common ids (those of the second version for all that is in both)."""

    connections_before: ConnectionMap
    connections_after: ConnectionMap
    elements_before: ElementsByKey
    elements_after: ElementsByKey
    lost_keys: tuple[frozenset[str], frozenset[str]] = (frozenset(), frozenset())
    """Keys of what could not be read, before and after: whether that was added or removed is unknown."""

    unnamed_outputs: frozenset[str] = frozenset()
    """Outputs whose topic, service or action is called after them, since no node names it otherwise."""

    sound_files: tuple[frozenset[str], frozenset[str]] = (frozenset(), frozenset())
    """The files that were read without an error, before and after."""

    broken_files: tuple[frozenset[str], frozenset[str]] = (frozenset(), frozenset())
    """The files of which nothing could be read, before and after."""

    library_files: tuple[frozenset[str], frozenset[str]] = (frozenset(), frozenset())
    """The files of libraries, before and after."""

    untyped_components: tuple[frozenset[str], frozenset[str]] = (frozenset(), frozenset())
    """The components whose type is not known, before and after: what they have from it may be there all the same."""

    link_users: Mapping[str, frozenset[str]] | None = None
    """The partners whose data crosses each link in either version; None where timing does not know."""

    policy_partners: Mapping[str, frozenset[str]] = field(default_factory=dict)
    """The partners whose components each policy is about in either version, where one changed."""

    partner_names: Mapping[str, str] = field(default_factory=dict)
    """What people call each partner of either version (see `title_partners`)."""

    @property
    def elements(self) -> tuple[ElementsByKey, ElementsByKey]:
        """Return the elements before and after."""
        return self.elements_before, self.elements_after

    @property
    def serving_components(self) -> tuple[Mapping[str, frozenset[str]], Mapping[str, frozenset[str]]]:
        """Return for each requirement the components that name it, before and after."""
        return _list_serving_components(self)

    def find_both(self, kind: str, name: str) -> tuple[ComparedElement | None, ComparedElement | None]:
        """Return an element as it was before, and as it is after."""
        return self.elements_before.get((kind, name)), self.elements_after.get((kind, name))

    def find_common_id(self, kind: str, own_id: str) -> str:
        """Return the common id of an element of the first version by its id there; that id where there is none."""
        names = (name for (each, name), old in self.elements_before.items() if each == kind and old.own_id == own_id)
        return next(names, own_id)

    def find_owner(self, kind: str, name: str) -> str | None:
        """Return the partner who owned an element before, or owns it if it is new."""
        before, after = self.find_both(kind, name)
        element = before or after
        return element.owner if element else None

    def find_latest(self, kind: str, name: str) -> ComparedElement | None:
        """Return an element as it is after, or was before if it is gone."""
        before, after = self.find_both(kind, name)
        return after or before

    def may_be_unread(self, key: ElementKey) -> bool:
        """Whether an element that is missing in one version may be in a part of it that could not be read."""
        # The version in which it is missing: the first one for an added element, the second one for a removed element.
        side, element = (
            (0, self.elements_after[key]) if key in self.elements_after else (1, self.elements_before.get(key))
        )
        if element and (self._may_be_from_unread(element, side) or self._is_untyped(element, side)):
            return True
        lost_words = self.lost_keys[side]
        # What its own file, which was read well, does not hold is not there.
        if element and element.file in self.sound_files[side]:
            return False
        # Any part of the path may be the lost key; ports of nodes have ids with a use in them.
        return bool(lost_words) and not lost_words.isdisjoint(
            word for part in key[1].split(".") for word in (part, part.rpartition(" ")[2])
        )

    def value_may_be_unread(self, key: ElementKey, before: object, after: object, value_key: str = "") -> bool:
        """Whether a value missing in one version may be in a part of it that could not be read; `value_key` names it."""
        both_elements = self.find_both(*key)
        for number, element in enumerate(both_elements):
            other_element = both_elements[1 - number]
            # Of what comes from a type that is not known, no value says anything: not even one that is there.
            if element and self._is_untyped(element, number):
                return True
            if other_element and self._may_be_from_unread(other_element, number):
                return True
            if self.may_be_written_in_unread(key[1], number):
                return True
        side = 0 if before is None else 1 if after is None else None
        if side is not None and self.key_may_be_unread(key, value_key, side):
            return True
        if isinstance(before, list) or isinstance(after, list):
            return any(self.lost_keys) and self._only_unread_references(before, after)
        lost_words = self.lost_keys[0] if before is None else self.lost_keys[1] if after is None else frozenset()
        present_value = after if before is None else before
        referred_words = (
            present_value.split(".") if isinstance(present_value, str) else []
        )  # what a reference names may be what is not there
        return bool(lost_words) and (
            key[0] in {"project", "group"} or not lost_words.isdisjoint([*key[1].split("."), *referred_words])
        )

    def key_may_be_unread(self, key: ElementKey, value_key: str, side: int) -> bool:
        """Whether a key of an element was taken out of one version, since its value could not be read."""
        element = self.elements[side].get(key)
        if element and element.file and element.file in self.sound_files[side]:
            return False
        name = value_key.rpartition(".")[2]
        # A period is compared as a rate.
        return not self.lost_keys[side].isdisjoint({name, "period"} if name == "rate" else {name})

    def may_be_written_in_unread(self, element_id: str, side: int) -> bool:
        """Whether a file of which nothing could be read in a version may say something of an element: it has its id."""
        return bool(self.broken_files[side]) and element_id.rpartition(".")[2] in self.lost_keys[side]

    def is_of_untyped(self, element_id: str, side: int) -> bool:
        """Whether a component, or something in one, belongs to a component whose type is not known in a version."""
        untyped_components = self.untyped_components[side]
        if not untyped_components:
            return False
        parts = element_id.split(".")
        return any(".".join(parts[:end]) in untyped_components for end in range(1, len(parts) + 1))

    def _may_be_from_unread(self, element: ComparedElement, side: int) -> bool:
        """Whether an element of the other version stands where nothing could be read in this one.

        Where types of components are not known, nobody knows what they use of a library.
        """
        is_unused = bool(self.untyped_components[side]) and element.file in self.library_files[1 - side]
        return is_unused or element.file in self.broken_files[side]

    def _is_untyped(self, element: ComparedElement, side: int) -> bool:
        if element.kind in _COMPONENT_KINDS:
            return self.is_of_untyped(element.id, side)
        # A node, or a port of one, that its component brings along.
        return bool(element.component_refs) and all(self.is_of_untyped(each, side) for each in element.component_refs)

    def _only_unread_references(self, before: object, after: object) -> bool:
        """Whether all that a list gained and lost are references to what could not be read, or to what else has its
        name.
        """
        old_items, new_items = (value if isinstance(value, list) else [] for value in (before, after))
        lost_before, lost_after = self.lost_keys
        items = {str(item): lost_after for item in old_items if item not in new_items}
        items |= {str(item): lost_before for item in new_items if item not in old_items}
        unread_names = {item.rpartition(".")[2] for item, lost in items.items() if not lost.isdisjoint(item.split("."))}
        return bool(items) and all(item.rpartition(".")[2] in unread_names for item in items)

    def find_elements_with(self, element_kind: str, key: str, value: str) -> list[str]:
        """Return the sorted ids of the elements of the second version that have a value at a key."""
        return sorted(
            name
            for (kind, name), element in self.elements_after.items()
            if kind == element_kind and element.values.get(key) == value
        )

    def is_removed(self, kind: str, name: str) -> bool:
        """Whether an element was removed, as far as can be said."""
        is_gone = (kind, name) in self.elements_before and (kind, name) not in self.elements_after
        return is_gone and not self.may_be_unread((kind, name))

    def is_added(self, kind: str, name: str) -> bool:
        """Whether an element was added."""
        return (kind, name) in self.elements_after and (kind, name) not in self.elements_before


@remember_latest
def _list_serving_components(
    versions: VersionPair,
) -> tuple[Mapping[str, frozenset[str]], Mapping[str, frozenset[str]]]:
    servers: tuple[dict[str, set[str]], dict[str, set[str]]] = (defaultdict(set), defaultdict(set))
    for components, elements in zip(servers, versions.elements, strict=True):
        for (kind, component_id), element in elements.items():
            requirements = element.values.get("requirements") if kind == "component" else None
            for requirement in requirements if isinstance(requirements, frozenset) else ():
                components[requirement].add(component_id)
    before, after = ({name: frozenset(each) for name, each in components.items()} for components in servers)
    return before, after
