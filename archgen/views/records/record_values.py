"""Values as the resolved record writes them: only what is known, quantities with number and unit."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import Protocol

from archgen.model.element_annotations import ElementAnnotations, read_figure
from archgen.model.quantity import Quantity


class HasAnnotations(Protocol):
    """An element of any kind."""

    @property
    def annotations(self) -> ElementAnnotations:
        """What it says of itself beside its own keys."""


def pick_fields(element: object, *keys: str) -> dict[str, object]:
    """Return the named fields of an element that are known; tuples become lists."""
    values = {key: getattr(element, key) for key in keys}
    return drop_unknown({key: list(value) if isinstance(value, tuple) else value for key, value in values.items()})


def drop_unknown(data: dict[str, object]) -> dict[str, object]:
    """Drop what is not known: None, empty lists and empty mappings."""
    # 0, False and "" stay: they are values that somebody wrote. Flags that are rarely true are given as `flag or None`.
    return {key: value for key, value in data.items() if value is not None and value not in ([], {})}


def record_quantity(quantity: Quantity | None, unit: str) -> dict[str, object] | None:
    """Return a quantity as text, number and unit; `value` is in that unit."""
    return None if quantity is None else {"text": quantity.text, "value": to_number(quantity.value), "unit": unit}


def to_number(value: Fraction) -> int | float:
    """Return an int where that is exact, else the nearest float (JSON and YAML have no fractions)."""
    return int(value) if value.denominator == 1 else float(value)


def record_annotations(element: HasAnnotations) -> dict[str, object]:
    """Return the properties of an element (text, number and unit, as far as they are such), and its hints as they are."""
    annotations = element.annotations
    if not annotations.properties and not annotations.hints:
        return {}
    properties = {name: _record_property(text) for name, text in annotations.properties.items()}
    return drop_unknown({"properties": properties, "hints": to_plain(annotations.hints)})


def _record_property(text: str) -> dict[str, object]:
    figure = read_figure(text)
    number = {"value": to_number(Fraction(figure.value))} if figure else {}
    return {"text": text, **number, **({"unit": figure.unit} if figure and figure.unit else {})}


def to_plain(value: object) -> object:
    """Copy nested parameters into dicts and lists."""
    if isinstance(value, Mapping):
        return {str(key): to_plain(item) for key, item in value.items()}
    return [to_plain(item) for item in value] if isinstance(value, (list, tuple)) else value
