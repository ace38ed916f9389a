"""The keys of kinds as the description of the language has them, each with what reads it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cache
from typing import Any

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
from archgen.language.comparison_tables import KEY_FACTS, KeyFacts
from archgen.model.parameter import format_parameter


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
        message = f"`{attribute}` holds elements, and no function in READERS reads them"
        raise LookupError(message)

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
