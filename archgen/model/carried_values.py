"""What the fields of a message say of the values in it: their units, and what a single number can hold."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import NamedTuple

from archgen.model.known_interfaces import InterfaceField, Interfaces

_UNIT = re.compile(r"\[([^\[\]\s]{1,30})\]")
"""A unit at the beginning of a field's comment: `[m/s] Positive to the left.`"""
_INTEGERS = {f"{sign}int{bits}": (sign, bits) for sign in ("", "u") for bits in (8, 16, 32, 64)}
_NUMBERS = frozenset({*_INTEGERS, "byte", "float32", "float64"})
_MAX_MESSAGES = 200


class CarriedNumber(NamedTuple):
    """A whole number in a message, by the field's name, with what its type can hold."""

    name: str
    type: str
    least: int
    greatest: int


def list_units(interfaces: Interfaces, message: str | None) -> tuple[str, ...]:
    """Return the units that the fields of a message say, to any depth, sorted; none where nobody says one."""
    units = {
        match[1] for field in _list_fields(interfaces, message) if (match := _UNIT.match(field.comment)) is not None
    }
    return tuple(sorted(units))


def find_only_number(interfaces: Interfaces, message: str | None) -> CarriedNumber | None:
    """Return the only number in a message, if it is a single whole one: of others nobody knows which one is meant."""
    fields = [field for field in _list_fields(interfaces, message) if field.type in _NUMBERS]
    if len(fields) != 1 or fields[0].array or fields[0].type not in _INTEGERS:
        return None
    sign, bits = _INTEGERS[fields[0].type]
    least, greatest = (0, 2**bits - 1) if sign else (-(2 ** (bits - 1)), 2 ** (bits - 1) - 1)
    return CarriedNumber(fields[0].name, fields[0].type, least, greatest)


def _list_fields(interfaces: Interfaces, message: str | None) -> Iterator[InterfaceField]:
    """Yield the fields of a message and of all messages in it, each message once."""
    waiting, seen = [message] if message else [], set[str]()
    while waiting and len(seen) < _MAX_MESSAGES:
        name = waiting.pop()
        definition = interfaces.definitions.get(name)
        if name in seen or definition is None:
            continue
        seen.add(name)
        for part in definition.parts:
            for field in part:
                yield field
                if "/" in field.type:
                    waiting.append(field.type)
