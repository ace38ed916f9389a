"""Ids: which texts are one, and which one a name becomes."""

from __future__ import annotations

import pytest

from archgen.model.element_ids import MAX_ID_LENGTH, is_id, make_id, make_unique_id


@pytest.mark.parametrize("text", ["a", "a1", "a_b", "a_1", "a" * MAX_ID_LENGTH])
def test_lower_case_words_joined_by_underscores_are_ids(text: str) -> None:
    assert is_id(text)


@pytest.mark.parametrize(
    "text", ["", "A", "1a", "a__b", "a_", "_a", "a-b", "a.b", "a\n", "ä", "none", "a" * (MAX_ID_LENGTH + 1)]
)
def test_all_else_is_none(text: str) -> None:
    assert not is_id(text)


@pytest.mark.parametrize(
    ("name", "element_id"),
    [
        ("Object Recognition (3D)", "object_recognition_3d"),
        ("ColourCamera", "colour_camera"),
        ("RGBCamera", "rgbcamera"),
        ("Größe & Straße", "groesse_and_strasse"),
        ("Åse Łódź", "ase_lodz"),
        ("Höhe", "hoehe"),
        ("ÄÖ ÜBERSICHT", "aeoe_uebersicht"),
        ("RoterÖlfilter", "roter_oelfilter"),
        ("Ho\u0308he", "hoehe"),
        ("Entrée du nœud, señal", "entree_du_noeud_senal"),
        ("3D map", "group_3d_map"),
        ("None", "group_none"),
        ("機械", "group_81c946"),
        ("", "group_e3b0c4"),
        ("a" * 63 + " b", "a" * 63),
    ],
)
def test_a_name_becomes_an_id(name: str, element_id: str) -> None:
    assert make_id(name, "group") == element_id
    assert is_id(element_id)


@pytest.mark.parametrize(
    ("wanted", "used", "free"),
    [
        ("a", set(), "a"),
        ("a", {"a"}, "a_2"),
        ("a", {"a", "a_2"}, "a_3"),
        ("a" * 64, {"a" * 64}, "a" * 62 + "_2"),
        ("a" * 61 + "_bc", {"a" * 61 + "_bc"}, "a" * 61 + "_2"),
    ],
)
def test_an_id_that_is_used_gets_a_number_and_stays_one(wanted: str, used: set[str], free: str) -> None:
    assert make_unique_id(wanted, used) == free
    assert is_id(free)
