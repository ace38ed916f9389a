"""Ids: which texts are ids, and what becomes of names."""

from __future__ import annotations

import pytest

from archgen.model.element_ids import MAX_ID_LENGTH, is_id, make_id, make_unique_id


@pytest.mark.parametrize(
    ("text", "valid"),
    [
        ("camera", True),
        ("object_recognition_3d", True),
        ("a" * 64, True),
        ("a" * 65, False),
        ("", False),
        ("Camera", False),
        ("3d", False),
        ("a__b", False),
        ("a_", False),
        ("_a", False),
        ("a-b", False),
        ("a\n", False),
        ("none", False),
        ("self", False),
    ],
)
def test_an_id_is_lower_case_words(text: str, valid: object) -> None:
    assert is_id(text) is valid


@pytest.mark.parametrize(
    ("name", "element_id"),
    [
        ("Object Recognition (3D)", "object_recognition_3d"),
        ("LaserScanner", "laser_scanner"),
        ("RGBCamera", "rgbcamera"),
        ("Größe & Maß", "groesse_and_mass"),
        ("Łódź", "lodz"),
        ("3D camera", "g_3d_camera"),
        ("None", "g_none"),
        ("x" * 63 + " y", "x" * 63),
        ("9" * 80, "g_" + "9" * 62),
    ],
)
def test_a_name_becomes_an_id(name: str, element_id: str) -> None:
    assert make_id(name, "g") == element_id
    assert is_id(make_id(name, "g"))


def test_a_name_without_a_latin_letter_has_an_id_of_its_own() -> None:
    first, second = make_id("カメラ", "g"), make_id("ロボット", "g")
    assert first != second
    assert (first, is_id(first)) == (make_id("カメラ", "g"), True)


def test_an_id_that_is_used_gets_a_number() -> None:
    assert make_unique_id("a", {"b"}) == "a"
    assert make_unique_id("a", {"a"}) == "a_2"
    assert make_unique_id("a", {"a", "a_2", "a_3"}) == "a_4"
    assert make_unique_id("a" * MAX_ID_LENGTH, {"a" * MAX_ID_LENGTH}) == "a" * 62 + "_2"
    assert make_unique_id("a" * 61 + "_bb", {"a" * 61 + "_bb"}) == "a" * 61 + "_2"
