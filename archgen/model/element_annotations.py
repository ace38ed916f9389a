"""What any element may say of itself beside its own keys: properties, and hints for other programs."""

from __future__ import annotations

import re
from collections.abc import Mapping
from decimal import Decimal
from typing import Literal

from archgen.diagnostics import Span
from archgen.frozen import NamedTuple, dataclass, field

PropertyType = Literal["boolean", "integer", "float", "string", "date"]
MAX_DIGITS = 15
"""The most digits of a number that is compared as one, so that a browser comes to the same; what is longer is text."""
_MAX_CHOICES = 8
_MAX_LETTERS = 60
"""Letters of a value that a finding quotes."""
_FIGURE = re.compile(r"([+-]?([0-9]+)(?:\.([0-9]+))?)(?:\s*([^\s\d+.-]\S{0,30}))?")
_DATE = re.compile(r"[0-9]{4}-(?:0[1-9]|1[0-2])-(?:0[1-9]|[12][0-9]|3[01])")


@dataclass(frozen=True, slots=True)
class ElementAnnotations:
    """The properties of an element as written, by id, and its hints: data by the id of the program that they are for."""

    properties: Mapping[str, str] = field(default_factory=dict)
    hints: Mapping[str, object] = field(default_factory=dict)
    property_places: Mapping[str, Span] = field(default_factory=dict, compare=False, repr=False)
    """Where the value of each property is written."""
    hint_places: Mapping[tuple[str | int, ...], Span] = field(default_factory=dict, compare=False, repr=False)
    """Where each part of the hints is written, by the keys and positions that lead there, the program first."""


NO_ANNOTATIONS = ElementAnnotations()


@dataclass(frozen=True, slots=True)
class PropertyDeclaration:
    """What the project says of a property: what has it, and which values it takes. `of` are kinds of elements; empty: all.

    `range` are its smallest and greatest value, in its unit.
    """

    id: str
    title: str
    description: str | None = None
    of: tuple[str, ...] = ()
    type: PropertyType | None = None
    unit: str | None = None
    range: tuple[Decimal, Decimal] | None = None
    choices: tuple[str, ...] = ()
    required: bool = False
    at: Span = field(compare=False, repr=False, kw_only=True)


class NumberWithUnit(NamedTuple):
    """A number with its unit, empty for a bare number."""

    value: Decimal
    unit: str = ""


def read_figure(text: str) -> NumberWithUnit | None:
    """Return the number and unit that a text is: `12 kg`, `5`; None for any other text."""
    match = _FIGURE.fullmatch(text.strip())
    if match is None or len(match[2]) + len(match[3] or "") > MAX_DIGITS:
        return None
    return NumberWithUnit(Decimal(match[1]), match[4] or "")


def is_date(text: str) -> bool:
    """Whether a text is a day such as `2027-03-01`."""
    return _DATE.fullmatch(text) is not None


def order_values(text: str, other_text: str) -> int | None:
    """Return -1, 0 or 1 as the first value is less, equal or greater; None where they have no order.

    Figures are compared only in the same unit, days with days; any other text has no order.
    """
    figure, other_figure = read_figure(text), read_figure(other_text)
    if figure and other_figure:
        if figure.unit != other_figure.unit:
            return None
        return (figure.value > other_figure.value) - (figure.value < other_figure.value)
    if is_date(text) and is_date(other_text):
        return (text > other_text) - (text < other_text)
    return 0 if text == other_text else None


def find_property_fault(declared: PropertyDeclaration, text: str) -> str | None:
    """Return what is wrong with a value of a declared property, as the end of a sentence; None if nothing is."""
    if declared.choices:
        return None if text in declared.choices else f"it is {_name_choices(declared.choices)}"
    if declared.type == "boolean":
        return None if text in {"true", "false"} else "it is `true` or `false`"
    if declared.type == "date":
        return None if is_date(text) else "it is a day such as `2027-03-01`"
    is_text = declared.type == "string" or not (declared.type or declared.unit or declared.range)
    return None if is_text else _find_number_fault(declared, text)


def _name_choices(choices: tuple[str, ...]) -> str:
    quoted = [f"`{shorten_value(each)}`" for each in choices[:_MAX_CHOICES]]
    return f"one of {', '.join(quoted)}{', ...' if len(choices) > _MAX_CHOICES else ''}"


def shorten_value(text: str) -> str:
    """Return a value as a finding quotes it: on one line, not too long, and without backticks."""
    # A backtick inside would end the code span that the message puts the text into.
    line = " ".join(text.replace("`", "'").split())
    return line if len(line) <= _MAX_LETTERS else f"{line[: _MAX_LETTERS - 1]}…"


def _find_number_fault(declared: PropertyDeclaration, text: str) -> str | None:
    figure = read_figure(text)
    if figure is None or figure.unit != (declared.unit or ""):
        number = "a whole number" if declared.type == "integer" else "a number"
        return (
            f"it is {number} in {declared.unit}, such as `12 {declared.unit}`" if declared.unit else f"it is {number}"
        )
    if declared.type == "integer" and figure.value != int(figure.value):
        return "it is a whole number"
    if declared.range and not declared.range[0] <= figure.value <= declared.range[1]:
        return f"it is {describe_range(declared)}"
    return None


def describe_range(declared: PropertyDeclaration) -> str:
    """Describe the smallest and the greatest value of a declared property."""
    if declared.range is None:
        return ""
    least, greatest = declared.range
    unit = f" {declared.unit}" if declared.unit else ""
    if greatest.is_infinite():
        return "any number" if least.is_infinite() else f"at least {least}{unit}"
    return f"at most {greatest}{unit}" if least.is_infinite() else f"{least} to {greatest}{unit}"
