"""Read values off a mapping in normal form. What is missing, or of an unexpected kind, reads as not written.

Types are compared with `type(...) is`, not isinstance: these functions run for every key of every element.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from functools import lru_cache
from typing import get_args

from archgen.diagnostics import NO_SPAN, Span
from archgen.model import quantity
from archgen.model.component import DiagramLayout
from archgen.model.declared_timing import SchedulingOrder
from archgen.model.message_types import full_message_name
from archgen.model.parameter import ParameterValue
from archgen.model.path_resolver import title_from_id
from archgen.model.port_media import normalise_medium
from archgen.model.quantity import Quantity
from archgen.schema.short_forms import fold_type_name
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode, SequenceNode, YamlNode, node_to_data

_ORDERS = frozenset(get_args(SchedulingOrder))
EMPTY_MAPPING = MappingNode({}, NO_SPAN)


def get_mapping(mapping: MappingNode, key: str) -> MappingNode:
    """Return the mapping at a key, an empty one where there is none."""
    entry = mapping.entries.get(key)
    return entry.value if entry is not None and type(entry.value) is MappingNode else EMPTY_MAPPING


def get_body(entry: MappingEntry) -> MappingNode:
    """Return an element's body: the mapping at its key, an empty one where there is none."""
    return entry.value if type(entry.value) is MappingNode else EMPTY_MAPPING


def get_scalar(mapping: MappingNode, key: str) -> ScalarNode | None:
    """Return the scalar at a key, None where nothing is written."""
    entry = mapping.entries.get(key)
    if entry is None:
        return None
    node = entry.value
    return node if type(node) is ScalarNode and node.value is not None else None


def get_text(mapping: MappingNode, key: str) -> str | None:
    """Return the text at a key as it was written (`1.10` is not 1.1), None where nothing is written."""
    # The same as get_scalar(...).text, without the second call: the most frequent function of linking.
    entry = mapping.entries.get(key)
    if entry is None:
        return None
    node = entry.value
    return node.text if type(node) is ScalarNode and node.value is not None else None


def get_medium(mapping: MappingNode, key: str) -> str | None:
    """Return the word for what something travels over, as it is compared; None for `digital`, which names nothing."""
    return normalise_medium(get_text(mapping, key))


def get_absolute_name(mapping: MappingNode, key: str) -> str:
    """Return a namespace with its leading slash; where none is written, that is the root namespace, `/`."""
    return "/" + (get_text(mapping, key) or "").removeprefix("/")


def get_data(mapping: MappingNode, key: str) -> Mapping[str, object]:
    """Return the mapping at a key as data: values keep the type that YAML gives them."""
    data = node_to_data(get_mapping(mapping, key))
    return data if isinstance(data, dict) else {}


def get_scalars(mapping: MappingNode, key: str) -> tuple[ScalarNode, ...]:
    """Return the scalars of a list; a single scalar counts as a list of one."""
    return list_scalars(mapping.get(key))


def list_scalars(node: YamlNode | None) -> tuple[ScalarNode, ...]:
    """Return the scalars of a list, or the only one."""
    if type(node) is SequenceNode:
        return tuple(item for item in node.items if type(item) is ScalarNode and item.value is not None)
    return (node,) if type(node) is ScalarNode and node.value is not None else ()


def get_texts(mapping: MappingNode, key: str) -> tuple[str, ...]:
    """Return the texts of a list."""
    return tuple(item.text for item in get_scalars(mapping, key))


def get_integer(mapping: MappingNode, key: str) -> int | None:
    """Return a whole number, None for any other value."""
    node = get_scalar(mapping, key)
    return node.value if node and type(node.value) is int else None


def get_flag(mapping: MappingNode, key: str) -> bool:
    """Whether the value at a key is `true`."""
    node = get_scalar(mapping, key)
    return node is not None and node.value is True


def get_quantity(mapping: MappingNode, key: str, dimension: str) -> Quantity | None:
    """Return a quantity of a dimension such as `duration`, None where it is not written or malformed."""
    node = get_scalar(mapping, key)
    return quantity.parse_quantity(node.text, dimension) if node else None


def get_order(mapping: MappingNode, key: str) -> SchedulingOrder | None:
    """Return the scheduling order at a key, None where none is written."""
    word = get_text(mapping, key)
    return word if word in _ORDERS else None  # type: ignore[return-value]


def get_span(mapping: MappingNode, key: str) -> Span:
    """Return the span of the value at a key, `NOWHERE` where it is not written."""
    entry = mapping.entries.get(key)
    return entry.value.span if entry else NO_SPAN


def get_text_mapping(mapping: MappingNode, key: str) -> Mapping[str, str]:
    """Return a mapping of texts, such as `urls`."""
    texts_mapping = get_mapping(mapping, key)
    return {e.key: e.value.text for e in texts_mapping if type(e.value) is ScalarNode and e.value.value is not None}


def list_placed_texts(mapping: MappingNode, key: str) -> Iterator[ParameterValue]:
    """Yield the texts of a mapping, each with its place."""
    for name, text in get_text_mapping(mapping, key).items():
        entry = get_mapping(mapping, key).entries[name]
        yield ParameterValue(name, text, entry.value.span, entry.key_span)


def list_hint_places(hints: MappingNode) -> Iterator[tuple[tuple[str | int, ...], Span]]:
    """Yield where each part of an element's hints is written, by the keys and positions that lead there."""
    waiting: list[tuple[tuple[str | int, ...], object]] = [((), hints)]
    while waiting:
        path, node = waiting.pop()
        if isinstance(node, MappingNode):
            for entry in node:
                yield (*path, entry.key), entry.key_span
                waiting.append(((*path, entry.key), entry.value))
        elif isinstance(node, SequenceNode):
            for number, item in enumerate(node.items):
                yield (*path, number), item.span
                waiting.append(((*path, number), item))


def iterate_elements(mapping: MappingNode, key: str) -> Iterable[tuple[str, MappingEntry, MappingNode]]:
    """Return the elements of a section: id, entry and body."""
    # Nine in ten sections are not there, and a generator for each would take longer than what it finds.
    section = mapping.entries.get(key)
    return (
        [(each.key, each, get_body(each)) for each in section.value]
        if section and type(section.value) is MappingNode
        else ()
    )


def get_layout(mapping: MappingNode, key: str) -> DiagramLayout:
    """Return an element's layout."""
    direction = get_text(get_mapping(mapping, key), "direction")
    return DiagramLayout(direction) if direction in {"left-right", "top-bottom"} else DiagramLayout()  # type: ignore[arg-type]


def get_title(mapping: MappingNode, element_id: str) -> str:
    """Return an element's title, made from its id if it has none: `object_recognition` is "Object Recognition"."""
    title_text = get_text(mapping, "title")
    return title_text if title_text is not None else title_from_id(element_id)


@lru_cache(4096)
def normalise_type_name(text_written: str) -> str:
    """Return a type's name in the form in which names are compared: NFC, blanks folded to one, messages in full."""
    folded = fold_type_name(text_written)
    return full_message_name(folded) or folded


def get_message(mapping: MappingNode, key: str) -> str | None:
    """Return the full name of the message that an element names, None where there is none."""
    message_text = get_text(mapping, key)
    return None if message_text is None else full_message_name(message_text.strip())
