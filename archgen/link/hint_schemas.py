"""Judge data by the schema of a backend: types, choices, keys, items and ranges, each in words for who wrote the data."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from decimal import Decimal
from typing import NamedTuple

from archgen.diagnostics.common_wording import join_words
from archgen.diagnostics.suggestions import did_you_mean
from archgen.link import mapping_values
from archgen.model.element_annotations import shorten_value
from archgen.syntax.yaml_tree import MappingNode, ScalarNode

_TYPE_WORDS: Mapping[str, str] = {
    "object": "a mapping",
    "array": "a list",
    "string": "text",
    "number": "a number",
    "integer": "a whole number",
    "boolean": "`true` or `false`",
}
_IS_OF_TYPE: Mapping[str, Callable[[object], bool]] = {
    "object": lambda value: isinstance(value, Mapping),
    "array": lambda value: isinstance(value, (list, tuple)),
    "string": lambda value: isinstance(value, str),
    "number": lambda value: isinstance(value, (int, float)) and not isinstance(value, bool),
    "integer": lambda value: isinstance(value, int) and not isinstance(value, bool),
    "boolean": lambda value: isinstance(value, bool),
}


class HintFault(NamedTuple):
    """What is wrong with a part of the data: the keys and positions that lead to it, words behind its name, and help."""

    path: tuple[str | int, ...]
    words: str
    help: str | None = None


def list_hint_faults(schema: MappingNode, value: object, path: tuple[str | int, ...] = ()) -> Iterator[HintFault]:
    """Yield what a schema refuses. The data is walked once, the schema beside it; both are of limited depth."""
    types = [word for word in mapping_values.get_texts(schema, "type") if word in _TYPE_WORDS]
    if types and not any(_IS_OF_TYPE[word](value) for word in types):
        yield HintFault(
            path, f"is {_name_value(value)}, but must be {join_words([_TYPE_WORDS[t] for t in types], 'or')}"
        )
        return
    yield from _judge_choice(schema, value, path)
    if isinstance(value, Mapping):
        yield from _judge_keys(schema, value, path)
    elif isinstance(value, (list, tuple)):
        items = schema.get("items")
        if isinstance(items, MappingNode):
            for number, item in enumerate(value):
                yield from list_hint_faults(items, item, (*path, number))
    elif isinstance(value, (int, float)) and not isinstance(value, bool):
        yield from _judge_size(schema, value, path)


def _judge_choice(schema: MappingNode, value: object, path: tuple[str | int, ...]) -> Iterator[HintFault]:
    choices = mapping_values.get_texts(schema, "enum")
    if choices and _write_value(value) not in choices:
        quoted = join_words([f"`{each}`" for each in choices], "or")
        guess = did_you_mean(value, choices) if isinstance(value, str) else None
        yield HintFault(path, f"is {_name_value(value)}, but must be {quoted}", guess)


def _judge_keys(
    schema: MappingNode, value: Mapping[object, object], path: tuple[str | int, ...]
) -> Iterator[HintFault]:
    properties = mapping_values.get_mapping(schema, "properties")
    further = schema.get("additionalProperties")
    is_closed = isinstance(further, ScalarNode) and further.text == "false"
    for key, inner in value.items():
        name = str(key)
        inner_schema = properties.get(name)
        if isinstance(inner_schema, MappingNode):
            yield from list_hint_faults(inner_schema, inner, (*path, name))
        elif name not in properties.entries and is_closed:
            names = tuple(properties.entries)
            help_line = did_you_mean(name, names) or (
                f"it reads {join_words([f'`{n}`' for n in names])}" if names else None
            )
            yield HintFault((*path, name), "is no key that the backend reads", help_line)
        elif name not in properties.entries and isinstance(further, MappingNode):
            yield from list_hint_faults(further, inner, (*path, name))
    for name in mapping_values.get_texts(schema, "required"):
        if name not in value:
            yield HintFault(path, f"lacks `{name}`")


def _judge_size(schema: MappingNode, value: float, path: tuple[str | int, ...]) -> Iterator[HintFault]:
    for key, word in (("minimum", "least"), ("maximum", "most")):
        limit = mapping_values.get_scalar(schema, key)
        if limit is None or not _IS_OF_TYPE["number"](limit.value):
            continue
        number, end = Decimal(value), Decimal(limit.value)  # type: ignore[arg-type]
        if end.is_nan():
            continue
        # What is no number at all is neither below nor above.
        if number.is_nan() or not (number >= end if key == "minimum" else number <= end):
            yield HintFault(path, f"is {_name_value(value)}, but must be at {word} {limit.text}")


def _name_value(value: object) -> str:
    if value is None:
        return "empty"
    if isinstance(value, Mapping):
        return "a mapping"
    return "a list" if isinstance(value, (list, tuple)) else f"`{shorten_value(_write_value(value))}`"


def _write_value(value: object) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    # Python writes no whole number of more than 4,300 digits.
    return str(Decimal(value)) if isinstance(value, int) else str(value)
