"""Ids of the first version in texts of the second."""

from __future__ import annotations

import pytest

from archgen.compare.matched_ids import MatchedIds


@pytest.fixture
def matched() -> MatchedIds:
    matched_ids = MatchedIds()
    matched_ids.add_pair("project", "robot", "car")
    matched_ids.add_pair("group", "sensing", "eyes", 0.8)
    matched_ids.add_pair("component", "sensing.camera", "eyes.camera")
    matched_ids.add_pair("output", "sensing.camera.image", "eyes.camera.picture", 0.7)
    matched_ids.add_pair("host", "pc", "pc")
    return matched_ids


def test_who_is_who(matched: MatchedIds) -> None:
    assert matched.common_id("group", "sensing") == "eyes"
    assert matched.common_id("group", "gone") == "gone"
    assert matched.find_new_id("group", "gone") is None
    assert matched.find_new_id("host", "pc") == "pc"
    assert matched.is_matched("group", "eyes")
    assert not matched.is_matched("group", "sensing")
    assert matched.confidence == {("group", "eyes"): 0.8, ("output", "eyes.camera.picture"): 0.7}


@pytest.mark.parametrize(
    ("text", "renamed"),
    [
        ("sensing", "eyes"),
        ("sensing.camera+ other", "eyes.camera+ other"),
        ("sensing.camera.image.more", "eyes.camera.picture.more"),
        ("camera.image", "camera.picture"),
        ("image", "picture"),
        ("/sensing/camera/image", "/eyes/camera/picture"),
        ("sensing-x", "sensing-x"),
        ("robot", "robot"),
        ("pc", "pc"),
    ],
)
def test_names_in_texts(matched: MatchedIds, text: str, renamed: str) -> None:
    assert matched.rename_in_text(text) == renamed


def test_only_what_stands_in_backticks(matched: MatchedIds) -> None:
    assert matched.rename_in_backticks("sensing `sensing` and `sensing.lidar`") == "sensing `eyes` and `eyes.lidar`"
    assert MatchedIds().rename_in_backticks("`sensing`") == "`sensing`"
    assert MatchedIds().rename_in_text("sensing") == "sensing"


def test_the_first_rename_of_a_short_name_wins(matched: MatchedIds) -> None:
    matched.add_pair("output", "other.camera.image", "other.camera.photo")
    assert matched.rename_in_text("image") == "picture"
    assert matched.rename_in_text("other.camera.image") == "other.camera.photo"
