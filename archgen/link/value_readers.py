"""Read the keys of an element that are written, by the language's tables: one reader for each type of value.

What a reader returns goes into the field of the key's name, or into the fields that the description names (`attribute`). A
reader that finds nothing it can use returns None: then the default of the class stands.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from fractions import Fraction
from functools import cache, partial
from typing import Any

from archgen.diagnostics import Span
from archgen.diagnostics.rule_options import parse_percentage
from archgen.frozen import fields
from archgen.language.language_tables import ATTRIBUTES, DATA_PARTS, KEYS, PART_TYPES, PLACED_KEYS, WORDS
from archgen.link import mapping_values
from archgen.model.component import PerformanceIndicator, RequirementUse
from archgen.model.declared_timing import FairScheduling, SchedulingOrder
from archgen.model.element_annotations import ElementAnnotations
from archgen.model.parameter import Operation
from archgen.model.path_resolver import title_from_id
from archgen.model.use_case_steps import Actor
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode

ValueReader = Callable[[MappingNode, str], Any]
"""Returns what stands at a key of a mapping; of a key with several fields a value for each."""
_KINDS_WITHOUT_WORDS = frozenset({"use_case", "requirement", "frame"})
"""Kinds whose ids cannot be turned into words: `UC-4`, `base_link`."""


def read_element(kind: str, made_class: type, entry: MappingEntry, body: MappingNode) -> dict[str, Any]:
    """Return what an element says by itself as arguments of its class, with its id, a title, and where it is written."""
    title = entry.key if kind in _KINDS_WITHOUT_WORDS else title_from_id(entry.key)
    return {"id": entry.key, "title": title, "at": entry.key_span, **read_values(kind, made_class, body)}


def read_values(kind: str, made_class: type, body: MappingNode) -> dict[str, Any]:
    """Return what the written keys of a mapping say by themselves, as arguments of the class of the kind."""
    readers, places = _list_readers(kind, made_class)
    values: dict[str, Any] = {}
    entries = body.entries
    for key in entries:
        if (reader := readers.get(key)) is not None:
            names, read = reader
            value = read(body, key)
            if value is not None:
                store_value(values, names, value)
    for key, name in places:
        if key in entries:
            values[name] = entries[key].value.span
    return values


def store_value(values: dict[str, Any], names: tuple[str, ...], value: Any) -> None:  # noqa: ANN401 - of any field
    """Put what a reader returned into the fields that it is for."""
    if len(names) == 1:
        values[names[0]] = value
    else:
        values.update(zip(names, value, strict=True))


def list_fields(kind: str, key: str) -> tuple[str, ...]:
    """Return the fields that hold a key."""
    return ATTRIBUTES.get(f"{kind}.{key}") or ATTRIBUTES.get(find_type(kind, key), (key,))


def find_type(kind: str, key: str) -> str:
    """Return the type of what stands at a key, `KIND.KEY` where that has no type of its own."""
    part = KEYS[kind][key]
    return PART_TYPES.get(part, part)


@cache
def _list_readers(
    kind: str, made_class: type
) -> tuple[Mapping[str, tuple[tuple[str, ...], ValueReader]], tuple[tuple[str, str], ...]]:
    """Return the readers of the keys that a class has fields for, and the fields that keep the places of values."""
    held_keys = list_held_keys(kind, made_class)
    readers = {
        key: (names, reader) for key, names in held_keys.items() if (reader := find_value_reader(kind, key)) is not None
    }
    return readers, tuple((key, f"{key}_at") for key in PLACED_KEYS.get(kind, ()) if key in held_keys)


def list_held_keys(kind: str, made_class: type) -> dict[str, tuple[str, ...]]:
    """Return the keys of a kind for which a class has fields, with these."""
    field_names = {field.name for field in fields(made_class)}
    keys = {key: list_fields(kind, key) for key in KEYS[kind]}
    return {key: names for key, names in keys.items() if field_names.issuperset(names)}


def find_value_reader(kind: str, key: str) -> ValueReader | None:
    """Return what reads a key by itself, None where that takes more than its value."""
    part = find_type(kind, key)
    for name in (f"{kind}.{key}", part):
        if name in VALUE_READERS:
            return VALUE_READERS[name]
    if part in WORDS:
        return partial(_read_word, words=frozenset(WORDS[part]))
    return mapping_values.get_data if part in DATA_PARTS else None


def _read_word(mapping: MappingNode, key: str, words: frozenset[str]) -> str | None:
    word = mapping_values.get_text(mapping, key)
    return word if word in words else None


def _read_filled_text(mapping: MappingNode, key: str) -> str | None:
    return mapping_values.get_text(mapping, key) or None


def _read_percentage(mapping: MappingNode, key: str) -> Fraction | None:
    return parse_percentage(mapping_values.get_text(mapping, key) or "")


def _read_type_name(mapping: MappingNode, key: str) -> str | None:
    text = mapping_values.get_text(mapping, key)
    return mapping_values.normalise_type_name(text) if text else None


def _read_distinct_texts(mapping: MappingNode, key: str) -> tuple[str, ...]:
    return tuple(dict.fromkeys(mapping_values.get_texts(mapping, key)))


def _read_node_kinds(mapping: MappingNode, key: str) -> tuple[str, ...] | None:
    """Return each kind once, None where none is known."""
    known_kinds = WORDS["node_kind_item"]
    return tuple(kind for kind in _read_distinct_texts(mapping, key) if kind in known_kinds) or None


def _read_annotations(mapping: MappingNode, _key: str) -> ElementAnnotations:
    """Return an element's properties and hints, whichever of the two keys is read."""
    properties = {entry.key: entry.value for entry in mapping_values.get_mapping(mapping, "properties")}
    return ElementAnnotations(
        properties=mapping_values.get_text_mapping(mapping, "properties"),
        hints=mapping_values.get_data(mapping, "hints"),
        property_places={name: value.span for name, value in properties.items()},
        hint_places=dict(mapping_values.list_hint_places(mapping_values.get_mapping(mapping, "hints"))),
    )


def read_operations(mapping: MappingNode, key: str) -> dict[str, Operation]:
    """Return what can be called at a component, by id."""
    return _make_elements(mapping, key, "operation", Operation)


def _read_actors(mapping: MappingNode, key: str) -> dict[str, Actor]:
    return _make_elements(mapping, key, "actor", Actor)


def _read_performance(mapping: MappingNode, key: str) -> tuple[PerformanceIndicator, ...]:
    return tuple(_make_elements(mapping, key, "indicator", PerformanceIndicator).values())


def _make_elements(mapping: MappingNode, key: str, kind: str, made_class: type[Any]) -> dict[str, Any]:
    elements = mapping_values.iterate_elements(mapping, key)
    return {name: made_class(**read_element(kind, made_class, entry, body)) for name, entry, body in elements}


def _read_text_lists(mapping: MappingNode, key: str) -> Mapping[str, tuple[str, ...]]:
    lists = mapping_values.get_mapping(mapping, key)
    return {entry.key: mapping_values.get_texts(lists, entry.key) for entry in lists}


def _read_operation_types(mapping: MappingNode, key: str) -> str | Mapping[str, str] | None:
    """Return one type, or types by the names of fields."""
    node = mapping.get(key)
    if isinstance(node, ScalarNode):
        return mapping_values.normalise_type_name(node.text) if node.value is not None else None
    names = mapping_values.get_text_mapping(mapping, key)
    return {name: mapping_values.normalise_type_name(text) for name, text in names.items()} or None


def _read_requirement_uses(mapping: MappingNode, key: str) -> tuple[RequirementUse, ...]:
    """Return the entries of `requirements`: one that contains a blank is free text, any other is an id."""
    scalars = ((scalar.text.strip(), scalar.span) for scalar in mapping_values.get_scalars(mapping, key))
    return tuple(RequirementUse(text, not any(letter.isspace() for letter in text), span) for text, span in scalars)


def _read_placed_texts(mapping: MappingNode, key: str) -> tuple[tuple[str, ...], tuple[Span, ...]]:
    """Return the texts of a list, and where each is written."""
    scalars = mapping_values.get_scalars(mapping, key)
    return tuple(scalar.text for scalar in scalars), tuple(scalar.span for scalar in scalars)


def _read_host_orders(
    mapping: MappingNode, key: str
) -> tuple[SchedulingOrder | None, Mapping[int, SchedulingOrder], Mapping[int, Span], FairScheduling | None]:
    """Return the order on all cores; that on single cores, and where these are written; and the figures of `fair`."""
    orders = mapping_values.get_mapping(mapping, key)
    # A key that is no number is reported by the schema.
    entries = {
        int(entry.key): (order, entry.key_span)
        for entry in orders
        if entry.key.isascii() and entry.key.isdigit() and (order := mapping_values.get_order(orders, entry.key))
    }
    is_fair = "fair" in orders.entries
    figures = mapping_values.get_mapping(orders, "fair")
    return (
        "fair" if is_fair else mapping_values.get_order(mapping, key),
        {core: order for core, (order, _) in entries.items()},
        {core: span for core, (_, span) in entries.items()},
        FairScheduling(
            mapping_values.get_quantity(figures, "slice", "duration"),
            mapping_values.get_quantity(figures, "tick", "duration"),
            mapping_values.get_integer(figures, "lead"),
            _read_percentage(figures, "other_load"),
            orders.entries["fair"].key_span,
        )
        if is_fair
        else None,
    )


def _read_placed_mapping(mapping: MappingNode, key: str) -> tuple[Mapping[str, str], Mapping[str, Span]]:
    places = {each.name: each.at for each in mapping_values.list_placed_texts(mapping, key)}
    return mapping_values.get_text_mapping(mapping, key), places


VALUE_READERS: Mapping[str, ValueReader | None] = {
    # What takes more than its value.
    **dict.fromkeys(("chain_deadline", "component_type.abstract", "input.freshness", "frame.rate"), None),
    **dict.fromkeys(("property_declaration.required", "start_ready.within", "timing.deadline"), None),
    **dict.fromkeys(("text", "prose", "requirement_word", "topic_name_or_nothing"), mapping_values.get_text),
    **dict.fromkeys(
        (
            *("system_user", "frame_name", "report.date", "project.id", "parameter_declaration.from", "forge"),
            *("repository_address", "host_address", "signature.revision", "version_digits"),
        ),
        mapping_values.get_text,
    ),
    **dict.fromkeys(
        ("project.title", "requirement.title", "use_case.title", "frame.title", "node.name", "site.branch"),
        _read_filled_text,
    ),
    **dict.fromkeys(
        ("texts", "listed_texts", "tags", "reviewers", "open_sets", "variant_ids"), mapping_values.get_texts
    ),
    **dict.fromkeys(("key_paths", "property_declaration.choices", "report.authors"), mapping_values.get_texts),
    **dict.fromkeys(("count", "port_number", "index", "view.depth"), mapping_values.get_integer),
    **dict.fromkeys(("flag", "report.large_paper"), mapping_values.get_flag),
    "duration": partial(mapping_values.get_quantity, dimension="duration"),
    "frequency": partial(mapping_values.get_quantity, dimension="frequency"),
    "size": partial(mapping_values.get_quantity, dimension="size"),
    **dict.fromkeys(("executor_order", "resource_order"), mapping_values.get_order),
    **dict.fromkeys(("urls", "remaps", "start_environment", "inner_nodes"), mapping_values.get_text_mapping),
    **dict.fromkeys(("project.middleware", "link.protocol"), mapping_values.get_medium),
    **dict.fromkeys(("node.namespace", "container.namespace"), mapping_values.get_absolute_name),
    "percentage": _read_percentage,
    "layout": mapping_values.get_layout,
    "message": mapping_values.get_message,
    **dict.fromkeys(("properties", "hints"), _read_annotations),
    **dict.fromkeys(("type_name", "message_part"), _read_type_name),
    "declared_of": _read_distinct_texts,
    "node_kinds": _read_node_kinds,
    "parameter_commands": _read_text_lists,
    "actors": _read_actors,
    "operations": read_operations,
    "operation_fields": _read_operation_types,
    "performance": _read_performance,
    "component_requirements": _read_requirement_uses,
    "host_scheduling": _read_host_orders,
    "host.environment": _read_placed_mapping,
    "chain.requirements": _read_placed_texts,
}
"""What reads a value, by its type; and single keys (`KIND.KEY`) that are read otherwise, or have no type of their own."""
