"""What the table of kinds says of each kind of element, and by what elements of several kinds are recognised.

The keys of kinds as the description of the language has them, each with what reads it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cache
from operator import attrgetter
from typing import Any

from archgen.compare.architecture_version import ArchitectureVersion
from archgen.compare.element_likeness import letter_pairs, word_set
from archgen.compare.element_relations import ElementRelations
from archgen.compare.kinds.key_readers import READERS
from archgen.compare.kinds.key_spec import Effect, KeySpec, ReadContext, Reader, Worsening, key_values
from archgen.compare.normal_values import (
    freeze_value,
    list_data_leaves,
    normalize_text,
    normalize_title,
    parameter_leaves,
    unordered_values,
)
from archgen.compare.version_pair import ElementKey
from archgen.frozen import dataclass, field
from archgen.language.language_tables import KEY_FACTS, KIND_EFFECTS, SECTION_KINDS, KeyFacts
from archgen.model.component import Component, list_component_ports
from archgen.model.parameter import format_parameter
from archgen.model.path_resolver import title_from_id


@cache
def derive_keys(kind: str, without: frozenset[str] = frozenset()) -> tuple[KeySpec, ...]:
    """Return the described keys of a kind in their order, but for those that it is to be without."""
    rows = ((name, facts) for name, facts in KEY_FACTS.get(kind, {}).items() if name not in without)
    return tuple(_make_key(name, facts, READERS.get((kind, name))) for name, facts in rows)


def _make_key(name: str, facts: KeyFacts, own_reader: Reader | None) -> KeySpec:
    attribute = facts.get("attribute", name.removesuffix("."))
    inner = derive_keys(facts["inner"]) if "inner" in facts else ()
    read = _read_below(attribute, own_reader, inner) if inner else own_reader or make_form_reader(attribute, facts)
    return KeySpec(
        name,
        read,
        Effect[facts.get("effect", "timing").upper()],
        Worsening[facts.get("worse", "never").upper()],
        facts.get("names"),
        facts.get("noun", ""),
        facts.get("verb", ""),
        facts.get("verbs"),
        facts.get("new_verb", ""),
        is_prose=facts.get("form") == "prose",
        inner=inner,
        attribute="" if own_reader or facts.get("form") in _FORMS_ELSEWHERE else attribute,
    )


_FORMS_ELSEWHERE = frozenset({"properties", "hints", "entries"})
"""The forms whose values stand in no attribute of their own."""


def _read_below(attribute: str, find_holder: Reader | None, keys: tuple[KeySpec, ...]) -> Reader:
    """Return what reads the keys below another: off its value, or off what `find_holder` returns for an element; off several
    by what stands before the keys of each.
    """

    def read(element: object, context: ReadContext) -> Mapping[str, object]:
        holder = find_holder(element, context) if find_holder else getattr(element, attribute)
        if holder is None:
            return {}
        holders = holder if isinstance(holder, Mapping) else {"": holder}
        return {
            f"{prefix}{key}": value
            for prefix, each in holders.items()
            for key, value in key_values(keys, each, context).items()
        }

    return read


_Default = str | int | tuple[str, ...] | None


def make_form_reader(attribute: str, facts: KeyFacts) -> Reader:
    """Return what reads an attribute of the model in the normal form of its type."""
    if "names" in facts:
        return _NAME_READERS[facts.get("form", "value")](attribute, facts["names"])
    return _READERS[facts.get("form", "value")](attribute, facts.get("default"))


def _read_value(attribute: str, default: _Default) -> Reader:
    if default is None:
        return lambda element, _: getattr(element, attribute)
    # What counts where nothing is written is not told apart from nothing.
    return lambda element, _: None if (value := getattr(element, attribute)) == default else value


def _refuse_elements(attribute: str, _default: _Default) -> Reader:
    def read(_element: object, _context: ReadContext) -> object:
        # Not before something is read: else `make language` could not mend it.
        raise LookupError(f"`{attribute}` holds elements, and no function in READERS reads them")

    return read


def _read_data(attribute: str, _default: _Default) -> Reader:
    """Return what reads the leaves of data by their path."""
    return lambda element, _: dict(
        leaf for name, value in getattr(element, attribute).items() for leaf in parameter_leaves(name, value)
    )


def _read_properties(_attribute: str, _default: _Default) -> Reader:
    return lambda element, _: element.annotations.properties


def _read_hints(_attribute: str, _default: _Default) -> Reader:
    return _list_hints


def _list_hints(element: Any, _context: ReadContext) -> Mapping[str, object]:  # noqa: ANN401 - any element
    """Return the leaves of the hints by their path, which begins with the program that they are for; lists as a whole."""
    return {
        path: format_parameter(data) if isinstance(data, list) else freeze_value(data)
        for program, hints in element.annotations.hints.items()
        for path, data in list_data_leaves(program, hints)
    }


_READERS: Mapping[str, Callable[[str, _Default], Reader]] = {
    **dict.fromkeys(("value", "list", "mapping"), _read_value),
    "flag": lambda attribute, _: lambda element, _: getattr(element, attribute) or None,
    "set": lambda attribute, default: (
        lambda element, _: unordered_values(() if (values := getattr(element, attribute)) == default else values)
    ),
    "title": lambda attribute, _: lambda element, _: normalize_title(element.id, getattr(element, attribute)),
    "prose": lambda attribute, _: lambda element, _: normalize_text(getattr(element, attribute)),
    "layout": lambda attribute, _: lambda element, _: getattr(element, attribute).direction,
    "data": _read_data,
    "properties": _read_properties,
    "hints": _read_hints,
    "entries": _refuse_elements,
}
"""What reads each form of values that name no elements."""


def _read_name(attribute: str, kind: str) -> Reader:
    return lambda element, context: context.common_id(kind, getattr(element, attribute))


_NAME_READERS: Mapping[str, Callable[[str, str], Reader]] = {
    "value": _read_name,
    "set": lambda attribute, kind: lambda element, context: context.common_ids(kind, getattr(element, attribute)),
    "list": lambda attribute, kind: (
        lambda element, context: tuple(str(context.common_id(kind, each)) for each in getattr(element, attribute))
    ),
}
"""What reads values that name elements: by their common ids."""


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
    is_declared: Callable[[Any], bool] = lambda _: True
    """False for what exists without a declaration (a type that is only used)."""
    surroundings: Callable[[Any, ReadContext], object] | None = None
    """Returns what else of a version is read of an element than the element itself; None where anything may be."""
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


def mark_values(*values: object) -> frozenset[str]:
    """Return the values that are known as marks of a feature."""
    return frozenset(str(value) for value in values if value not in {None, ""})


def name_features(find_name: Callable[[Any], str]) -> tuple[FeatureSpec, FeatureSpec]:
    """Return the features of a name, and of the title, which may be made from it."""

    def is_generated(element: Any) -> bool:  # noqa: ANN401 - any element with a title
        return element.title in {title_from_id(find_name(element)), find_name(element)}

    return (
        FeatureSpec("name", 2, lambda _, element: letter_pairs(find_name(element))),
        FeatureSpec("title", 2, lambda _, element: word_set(element.title), is_generated),
    )


NAME_FEATURES = name_features(attrgetter("id"))


def make_section_kind(kind: str, *features: FeatureSpec, names: tuple[FeatureSpec, ...] = NAME_FEATURES) -> KindSpec:
    """Make the kind of what a section lists by id: its heading and its elements are the section's."""
    section = next(section for section, section_kind in SECTION_KINDS.items() if section_kind == kind)
    heading = section.replace("_", " ").capitalize()
    all_features = (*names, *features)
    return KindSpec(
        kind,
        heading,
        elements=lambda version: getattr(version.architecture, section),
        features=all_features,
        word=kind.replace("_", " "),
    )


def values_feature(weight: float, attributes: Iterable[str]) -> FeatureSpec:
    """Return the feature of all that some attributes say, each with its name."""

    def mark(_: ElementRelations, element: object) -> frozenset[str]:
        values = ((name, getattr(element, name, None)) for name in attributes)
        return frozenset(f"{name}: {value}" for name, value in values if value)

    return FeatureSpec("values", weight, mark)


def value_feature(name: str, weight: float, *attributes: str) -> FeatureSpec:
    """Return the feature of some values."""
    return FeatureSpec(
        name, weight, lambda _, element: mark_values(*(getattr(element, attribute) for attribute in attributes))
    )


def reference_feature(name: str, weight: float, kind: str, attribute: str) -> FeatureSpec:
    """Return the feature of the elements of a kind that an attribute names: one, or several."""

    def mark(relations: ElementRelations, element: object) -> frozenset[str]:
        named = getattr(element, attribute)
        return relations.common_ids(kind, named if isinstance(named, tuple) else [named])

    return FeatureSpec(name, weight, mark)


def nodes_feature(kind: str, weight: float) -> FeatureSpec:
    """Return the feature of the nodes that run at an element of a kind, or implement it."""
    return FeatureSpec(
        "nodes",
        weight,
        lambda relations, element: relations.common_ids("node", relations.nodes_by_place[f"{kind}:{element.id}"]),
    )


def users_feature(kind: str, weight: float, user_kind: str) -> FeatureSpec:
    """Return the feature of the elements of a kind that name an element."""
    return FeatureSpec(
        "users",
        weight,
        lambda relations, element: relations.common_ids(user_kind, relations.users_by_element[f"{kind}:{element.id}"]),
    )


def text_feature(weight: float, *names: str) -> FeatureSpec:
    """Return the feature of the words of some texts."""
    return FeatureSpec(
        "text",
        weight,
        lambda _, element: frozenset[str]().union(*(word_set(getattr(element, name)) for name in names)),
    )


def mark_ports(_relations: ElementRelations, component: Component) -> frozenset[str]:
    """Return the names of a component's ports with their direction, and their types."""
    # The direction is part of the mark, so that an input and an output of one name are not alike.
    ports = [f"> {port.name}" for port in component.inputs.values()]
    ports += [f"{port.name} >" for port in component.outputs.values()]
    return mark_values(*ports, *(port.type for port in list_component_ports(component)))


def mark_neighbours(relations: ElementRelations, component: Component) -> frozenset[str]:
    """Return the common ids of the components that a component reads from or is read by."""
    sources = [source for port in component.inputs.values() for source in relations.outputs_by_input[port.id]]
    readers = [reader for port in component.outputs.values() for reader in relations.readers_by_output[port.id]]
    return relations.common_ids("component", list_port_holders([*sources, *readers]))


def list_last_names(component_ids: Sequence[str]) -> list[str]:
    """Return the last part of each component's id."""
    return [component_id.rpartition(".")[2] for component_id in component_ids]


def list_port_holders(ports: Sequence[str]) -> list[str]:
    """Return the id of the component that has each port."""
    return [port.rpartition(".")[0] for port in ports]


def mark_performance(_relations: ElementRelations, component: Component) -> frozenset[str]:
    """Return each performance of a component as one mark."""
    return mark_values(
        *(
            f"{performance.id} {performance.accuracy} {performance.execution_time}"
            for performance in component.performance
        )
    )


def mark_timing(_relations: ElementRelations, component: Component) -> frozenset[str]:
    """Return behaviour, rate and longest execution time of a component."""
    timing = component.timing
    return mark_values(timing.behaviour, timing.rate, timing.wcet) if timing else frozenset()
