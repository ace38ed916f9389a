"""How many bytes values take on the wire, one behind the other, wherever the first of them begins.

ROS 2 sends CDR (XCDR1): each value begins at a multiple of its own size. ROS 1 leaves no gaps. Where a value begins
matters only modulo 8, the largest alignment; so the bytes that it takes are kept for each of the eight offsets, and a
million elements in a row need no million steps. Source: OMG DDS-XTypes 1.3, 7.4.1 (`PLAIN_CDR`).
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import reduce

from archgen.frozen import dataclass

_ALIGNMENT = 8
_LENGTH_PREFIX_BYTES = 4
"""Bytes of the number that precedes a sequence or a text."""
WireRoom = tuple[int, ...]
"""The bytes that a value takes, padding before it included, for each offset modulo 8 at which it may begin."""
EMPTY_ROOM: WireRoom = (0,) * _ALIGNMENT
NUMBER_WIDTHS = {
    **dict.fromkeys(("bool", "byte", "char", "octet", "int8", "uint8"), 1),
    **dict.fromkeys(("int16", "uint16"), 2),
    **dict.fromkeys(("int32", "uint32", "float32"), 4),
    **dict.fromkeys(("int64", "uint64", "float64"), 8),
}
"""The bytes of each builtin number."""


@dataclass(frozen=True, slots=True)
class WireShape:
    """The bytes of a value, None where unknown; with `exact` False an upper bound. `why` names the field."""

    room: WireRoom | None
    exact: bool = True
    why: str = ""


def room_of_number(width: int, *, aligned: bool) -> WireRoom:
    """Return the room of a number of some bytes."""
    # -start % width is the padding up to the next multiple of the width.
    return tuple((-start % width if aligned else 0) + width for start in range(_ALIGNMENT))


def room_of_text(length: int, *, wide: bool) -> WireRoom:
    """Return the largest room of a text of bounded length, in ROS 2.

    A wide character takes 4 bytes in the older of the two encodings in use, 2 in the newer.
    """
    # Texts of bytes end with a zero byte, wide ones do not.
    characters = 4 * length if wide else length + 1
    return append_room(room_of_number(_LENGTH_PREFIX_BYTES, aligned=True), (characters,) * _ALIGNMENT)


def room_of_sequence(element: WireRoom, length: int) -> WireRoom:
    """Return the largest room of a sequence of bounded length, in ROS 2."""
    return append_room(room_of_number(_LENGTH_PREFIX_BYTES, aligned=True), room_of_array(element, length))


def room_of_array(element: WireRoom, count: int) -> WireRoom:
    """Return the room of `count` elements in a row, by doubling, since counts may be large."""
    total = EMPTY_ROOM
    # Binary exponentiation: `append_room` is associative, so that the total so far can be doubled for each bit.
    for bit in f"{count:b}":
        total = append_room(total, total)
        if bit == "1":
            total = append_room(total, element)
    return total


def room_of_row(rooms: Iterable[WireRoom]) -> WireRoom:
    """Return the room of values in a row."""
    return reduce(append_room, rooms, EMPTY_ROOM)


def append_room(first: WireRoom, second: WireRoom) -> WireRoom:
    """Return the room of one value behind another."""
    # The second value begins where the first one ends: at its offset plus its bytes.
    return tuple(byte_count + second[(start + byte_count) % _ALIGNMENT] for start, byte_count in enumerate(first))
