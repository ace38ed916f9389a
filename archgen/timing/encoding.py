"""How many bytes values take on the wire, one behind the other, wherever the first of them begins.

ROS 2 sends CDR (XCDR1): each value begins at a multiple of its own size. ROS 1 leaves no gaps. Where a value begins
matters only modulo 8, the largest alignment; so the bytes that it takes are kept for each of the eight offsets, and a
million elements in a row need no million steps. Source: OMG DDS-XTypes 1.3, 7.4.1 (`PLAIN_CDR`).
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import reduce

from archgen.frozen import dataclass

_STEP = 8
_LENGTH = 4
"""Bytes of the number that precedes a sequence or a text."""
Room = tuple[int, ...]
"""The bytes that a value takes, padding before it included, for each offset modulo 8 at which it may begin."""
NOTHING: Room = (0,) * _STEP
WIDTHS = {
    **dict.fromkeys(("bool", "byte", "char", "octet", "int8", "uint8"), 1),
    **dict.fromkeys(("int16", "uint16"), 2),
    **dict.fromkeys(("int32", "uint32", "float32"), 4),
    **dict.fromkeys(("int64", "uint64", "float64"), 8),
}
"""The bytes of each builtin number."""


@dataclass(frozen=True, slots=True)
class Shape:
    """The bytes of a value, None where unknown; with `exact` False an upper bound. `why` names the field."""

    room: Room | None
    exact: bool = True
    why: str = ""


def number(width: int, *, aligned: bool) -> Room:
    """Return the room of a number of some bytes."""
    # -start % width is the padding up to the next multiple of the width.
    return tuple((-start % width if aligned else 0) + width for start in range(_STEP))


def text(length: int, *, wide: bool) -> Room:
    """Return the largest room of a text of bounded length, in ROS 2.

    A wide character takes 4 bytes in the older of the two encodings in use, 2 in the newer.
    """
    # Texts of bytes end with a zero byte, wide ones do not.
    characters = 4 * length if wide else length + 1
    return then(number(_LENGTH, aligned=True), (characters,) * _STEP)


def sequence(element: Room, length: int) -> Room:
    """Return the largest room of a sequence of bounded length, in ROS 2."""
    return then(number(_LENGTH, aligned=True), array(element, length))


def array(element: Room, count: int) -> Room:
    """Return the room of `count` elements in a row, by doubling, since counts may be large."""
    total = NOTHING
    # Binary exponentiation: `append_room` is associative, so that the total so far can be doubled for each bit.
    for bit in f"{count:b}":
        total = then(total, total)
        if bit == "1":
            total = then(total, element)
    return total


def row(rooms: Iterable[Room]) -> Room:
    """Return the room of values in a row."""
    return reduce(then, rooms, NOTHING)


def then(first: Room, second: Room) -> Room:
    """Return the room of one value behind another."""
    # The second value begins where the first one ends: at its offset plus its bytes.
    return tuple(taken + second[(start + taken) % _STEP] for start, taken in enumerate(first))
