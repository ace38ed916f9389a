"""Elements of all kinds as the resolved record has them: the keys of `RECORD_KEYS`, each by what stands there."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from archgen.language.record_tables import RECORD_KEYS
from archgen.views.lookup import Lookup
from archgen.views.records.record_sources import SOURCES
from archgen.views.records.record_values import drop_unknown, record_property, record_quantity, to_plain

_KEPT_WHERE_EMPTY = frozenset(
    {
        ("parameter", "value"),
        ("effective_parameter", "value"),
        *(("composed", key) for key in ("components", "behind")),
        *(("part_fields", part) for part in RECORD_KEYS["part_fields"]),
    }
)
"""Keys at which an empty list or mapping is a value: elsewhere nothing is written."""
_KNOWN_ENTRIES = frozenset({("node", "timing")})
"""Mappings in which only entries of which something is known are written."""


def write_record(part: str, element: Any, lookup: Lookup) -> dict[str, object]:  # noqa: ANN401  # any class of the model
    """Return what is known of an element of a kind, or of another part of the record."""
    record: dict[str, object] = {}
    for key, form in RECORD_KEYS[part].items():
        if (source := SOURCES.get((part, key))) is not None:
            value = write_value(form, source(element, lookup), lookup)
        elif form == "annotations":
            value = _write_annotations(key, element.annotations)
        else:
            value = write_value(form, getattr(element, key), lookup)
        if (part, key) in _KNOWN_ENTRIES and isinstance(value, dict):
            value = drop_unknown(value)
        if value is not None and (value not in ([], {}) or (part, key) in _KEPT_WHERE_EMPTY):
            record[key] = value
    return record


def write_value(form: str, value: Any, lookup: Lookup) -> object:  # noqa: ANN401  # any value of the model
    """Return a value in a form of the tables."""
    if value is None:
        return None
    if form.endswith("{}"):
        named = value if isinstance(value, Mapping) else {_name_element(each): each for each in value}
        return {name: write_value(form[:-2], each, lookup) for name, each in named.items()}
    if form.endswith("[]"):
        return [write_value(form[:-2], each, lookup) for each in value]
    if form in RECORD_KEYS:
        return write_record(form, value, lookup)
    if form == "flag":
        return value or None
    return record_quantity(value, form) if form else to_plain(value)


def _name_element(element: Any) -> str:  # noqa: ANN401  # any class of the model
    return str(element.id if hasattr(element, "id") else element.name)


def _write_annotations(key: str, annotations: Any) -> object:  # noqa: ANN401  # read by the key
    """Return the properties of an element (text, number and unit, as far as they are such), or its hints as they are."""
    values: Mapping[str, object] = getattr(annotations, key)
    if key == "properties":
        return {name: record_property(str(text)) for name, text in values.items()}
    return to_plain(values)
