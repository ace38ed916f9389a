"""What a component can be set to (parameters) and asked for (operations), and the values that nodes are given."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Literal

from archgen.diagnostics import NO_SPAN, Span
from archgen.frozen import dataclass, field

Visibility = Literal["public", "protected", "private"]
CallMode = Literal["synchronous", "asynchronous"]
MAX_NAME_LENGTH = 200
"""The longest name of a parameter in characters. Names of nested sets are joined: without a bound a small file of deep
sets would have gigabytes of names."""
_NAME_PATTERN = re.compile(r"[^\s.]+(?:\.[^\s.]+)*\Z")


def is_parameter_name(name: str) -> bool:
    """Whether the language takes a dotted name of a parameter."""
    return len(name) <= MAX_NAME_LENGTH and _NAME_PATTERN.match(name) is not None


def describe_types(types: str | Mapping[str, str]) -> str:
    """Return a type, or types with the names of their fields, on one line."""
    return types if isinstance(types, str) else ", ".join(f"{name}: {type_name}" for name, type_name in types.items())


@dataclass(frozen=True, slots=True)
class Parameter:
    """One parameter that a component declares. `name` has the names of its sets before it: `localiser.particles`.

    `value` is None while nobody gave one. `type` is as written, None where it follows from the value. `handed_from` is
    the reference in `from`: the parameter of the component around it that hands the value in.
    """

    name: str
    type: str | None = None
    value: object = None
    unit: str | None = None
    range: tuple[float, float] | None = None
    choices: tuple[object, ...] | None = None
    description: str | None = None
    read_only: bool = False
    visibility: Visibility | None = None
    handed_from: str | None = None
    hints: Mapping[str, object] = field(default_factory=dict)
    hint_places: Mapping[tuple[str | int, ...], Span] = field(default_factory=dict, compare=False, repr=False)
    """Where each part of the hints is written, by the keys and positions that lead there, the program first."""
    at: Span = field(default=NO_SPAN, compare=False, repr=False)
    value_at: Span = field(default=NO_SPAN, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Operation:
    """What can be called at a component and is no connection. `request` and `response` are a type, or types by name."""

    id: str
    title: str
    request: str | Mapping[str, str] | None = None
    response: str | Mapping[str, str] | None = None
    call: CallMode | None = None
    visibility: Visibility | None = None
    description: str | None = None
    at: Span = field(default=NO_SPAN, compare=False, repr=False)

    @property
    def type_names(self) -> tuple[str, ...]:
        """The types that its request and its response name."""
        sides = (self.request, self.response)
        return tuple(
            name
            for side in sides
            if side is not None
            for name in ([side] if isinstance(side, str) else list(side.values()))
        )


@dataclass(frozen=True, slots=True)
class ParameterValue:
    """The value that one place gives to a parameter, by its dotted name."""

    name: str
    value: object
    at: Span = field(default=NO_SPAN, compare=False, repr=False)
    name_at: Span = field(default=NO_SPAN, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class FileRemark:
    """What is odd about a parameter file that a node names, with what to do about it."""

    message: str
    at: Span
    help: str | None = None


def format_parameter(value: object) -> str:
    """Format the value of a parameter in YAML's spelling."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{key}: {format_parameter(item)}" for key, item in value.items()) + "}"
    if isinstance(value, Sequence) and not isinstance(value, str):
        return f"[{', '.join(format_parameter(item) for item in value)}]"
    return "" if value is None else str(value)
