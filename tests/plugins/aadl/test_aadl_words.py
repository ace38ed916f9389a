"""Names, texts and durations as AADL writes them."""

from __future__ import annotations

from fractions import Fraction

import pytest

from archgen.model.quantity import parse_quantity
from archgen.plugins.aadl.views.aadl_words import (
    NameSpace,
    can_be_written,
    make_aadl_name,
    make_duration_property,
    make_named_properties,
    write_aadl_duration,
    write_aadl_string,
    write_range,
    write_texts,
)


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("pose", "pose"),
        ("Robot pose", "Robot_pose"),
        ("Envelope<Pose>", "Envelope_Pose"),
        ("_a__b_", "a_b"),
        ("3d", "x3d"),
        ("end", "end_x"),
        ("Flow", "Flow_x"),
        ("Höhe", "Hoehe"),
        ("дом", "x_f5b3d7"),
    ],
)
def test_names(name: str, expected: str) -> None:
    assert make_aadl_name(name) == expected


def test_a_long_name_is_cut_and_stays_its_own() -> None:
    names = {make_aadl_name("a" * 500), make_aadl_name("a" * 501)}
    assert {len(name) for name in names} == {80}
    assert len(names) == 2


def test_names_that_differ_in_case_alone_get_numbers() -> None:
    names = NameSpace(["tf"])
    assert [names.take_name(each) for each in ("TF", "State", "state", "STATE", "other")] == [
        *("TF_2", "State", "state_2", "STATE_3", "other"),
    ]


def test_texts_hold_no_quote_no_backslash_and_ascii_alone() -> None:
    assert write_aadl_string('a "b" \\ 100 %\nö') == '"a %22b%22 %5C 100 %25%0A%C3%B6"'
    assert write_texts(["a", "b"]) == '("a", "b")'


@pytest.mark.parametrize(
    ("duration", "expected"),
    [
        (Fraction(0), "0 ns"),
        (Fraction(10**9), "1 sec"),
        (Fraction(2_500_000), "2500 us"),
        (Fraction(7), "7 ns"),
        (Fraction(1, 3), "333 ps"),
    ],
)
def test_durations(duration: Fraction, expected: str) -> None:
    assert write_aadl_duration(duration) == expected


def test_a_range_is_rounded_outwards() -> None:
    assert write_range(Fraction(1, 3), Fraction(1, 3)) == "333 ps .. 334 ps"


def test_what_is_longer_than_the_longest_is_left_out() -> None:
    assert can_be_written(Fraction(1000 * 3600 * 10**9))
    assert make_duration_property("Period", parse_quantity("1001 h", "duration")) == []
    assert make_duration_property("Period", None) == []


def test_an_id_that_is_the_name_is_not_said_again() -> None:
    assert make_named_properties("arm", "arm", "Arm") == []
    assert [each["value"] for each in make_named_properties("end_x", "end", "The end")] == ['"end"', '"The end"']
