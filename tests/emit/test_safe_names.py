"""Names of files that every file system takes."""

from __future__ import annotations

import pytest

from archgen.emit.safe_names import MAX_PART_LENGTH, assign_safe_paths, is_safe_path, make_safe_path, make_slug


@pytest.mark.parametrize(
    ("text", "slug"),
    [
        ("Colour Camera (left)", "colour-camera-left"),
        ("Größe", "groe"),
        ("é", "e"),
        ("a.b", "a.b"),
        ("..", "x-5ec1f7e7"),
        ("", "x-e3b0c442"),
        ("機械", "x-81c946ea"),
        ("CON", "con_"),
        ("nul.txt", "nul_.txt"),
        ("console", "console"),
        ("-a-.b-", "a.b"),
    ],
)
def test_any_text_becomes_one_part_of_a_path(text: str, slug: str) -> None:
    assert make_slug(text) == slug
    assert is_safe_path(slug)


def test_long_names_are_cut_keep_their_ending_and_stay_different() -> None:
    first, second = (make_slug("a" * 200 + end) for end in ("b.yaml", "c.yaml"))
    assert len(first) == len(second) == MAX_PART_LENGTH
    assert first != second
    assert first.endswith(".yaml")


@pytest.mark.parametrize(
    ("path", "safe"),
    [("a/../b", "a/b"), ("\\\\host\\c", "host/c"), ("/etc/x", "etc/x"), ("./A//B", "a/b"), ("..", "x-5ec1f7e7")],
)
def test_no_path_leads_out_of_its_folder(path: str, safe: str) -> None:
    assert make_safe_path(path) == safe


@pytest.mark.parametrize(
    "path", ["", "a/", "/a", "../a", "a/./b", "a\\b", "c:x", "a?", "a\n", "a.", "a ", "Con", "lpt1.txt", 'a"b']
)
def test_what_some_system_cannot_hold_is_not_safe(path: str) -> None:
    assert not is_safe_path(path)


def test_names_that_meet_get_numbers_in_their_order() -> None:
    assert assign_safe_paths(["A.html", "a.html", "a", "a/x", "a.html/y"]) == {
        "A.html": "a.html",
        "a.html": "a-2.html",
        "a": "a",
        "a/x": "a-2/x",
        "a.html/y": "a.html-2/y",
    }
