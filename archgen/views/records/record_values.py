"""Values as the resolved record writes them: only what is known, quantities with number and unit."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction

from archgen.model.element_annotations import read_figure
from archgen.model.quantity import Quantity


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


def record_property(text: str) -> dict[str, object]:
    """Return a property as text, number and unit, as far as it is such."""
    figure = read_figure(text)
    number = {"value": to_number(Fraction(figure.value))} if figure else {}
    return {"text": text, **number, **({"unit": figure.unit} if figure and figure.unit else {})}


def to_plain(value: object) -> object:
    """Copy nested parameters into dicts and lists."""
    if isinstance(value, Mapping):
        return {str(key): to_plain(item) for key, item in value.items()}
    return [to_plain(item) for item in value] if isinstance(value, (list, tuple)) else value
