"""Bytes on the wire (OMG DDS-XTypes 1.3, 7.4.1, `PLAIN_CDR`): padding to a value's own size, wherever it begins."""

from __future__ import annotations

from archgen.timing.system.message_sizes import (
    EMPTY_ROOM,
    NUMBER_WIDTHS,
    WireShape,
    append_room,
    room_of_array,
    room_of_number,
    room_of_row,
    room_of_sequence,
    room_of_text,
)


def test_a_number_begins_at_a_multiple_of_its_size() -> None:
    assert room_of_number(1, aligned=True) == (1, 1, 1, 1, 1, 1, 1, 1)
    assert room_of_number(2, aligned=True) == (2, 3, 2, 3, 2, 3, 2, 3)
    assert room_of_number(4, aligned=True) == (4, 7, 6, 5, 4, 7, 6, 5)
    assert room_of_number(8, aligned=True) == (8, 15, 14, 13, 12, 11, 10, 9)
    assert room_of_number(4, aligned=False) == (4,) * 8


def test_widths_are_those_of_the_names() -> None:
    assert [NUMBER_WIDTHS[name] for name in ("bool", "byte", "char", "octet", "int8", "uint8")] == [1] * 6
    assert [NUMBER_WIDTHS[name] for name in ("int16", "uint16", "int32", "uint32", "float32")] == [2, 2, 4, 4, 4]
    assert [NUMBER_WIDTHS[name] for name in ("int64", "uint64", "float64")] == [8, 8, 8]


def test_values_in_a_row() -> None:
    one, eight = room_of_number(1, aligned=True), room_of_number(8, aligned=True)
    assert append_room(one, eight)[0] == 16  # 1, a gap of 7, 8
    assert append_room(one, eight)[7] == 9  # the byte fills the gap
    assert room_of_row([one, one, eight, one])[0] == 17
    assert room_of_row([]) == EMPTY_ROOM == (0,) * 8


def test_arrays_are_rows_of_equal_values() -> None:
    odd = room_of_row([room_of_number(4, aligned=True), room_of_number(1, aligned=True)])
    for count in (0, 1, 2, 3, 7, 12):
        assert room_of_array(odd, count) == room_of_row([odd] * count)
    assert room_of_array(odd, 10**6)[0] == 8 * 10**6 - 3


def test_sequences_and_texts_begin_with_their_length() -> None:
    eight = room_of_number(8, aligned=True)
    assert room_of_sequence(eight, 2)[0] == 4 + 4 + 16
    assert room_of_sequence(eight, 2)[4] == 4 + 16
    assert room_of_text(3, wide=False)[0] == 4 + 3 + 1  # a zero byte ends it
    assert room_of_text(3, wide=True)[0] == 4 + 12
    assert room_of_text(3, wide=False)[1] == 3 + 4 + 4


def test_a_shape_is_exact_unless_it_says_otherwise() -> None:
    assert WireShape(EMPTY_ROOM) == WireShape(EMPTY_ROOM, exact=True, why="")
