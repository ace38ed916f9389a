"""Stamps of builds: what is still there as it was written is not made again."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from archgen.emit import file_tree
from archgen.products import build_stamp

KEY = build_stamp.make_stamp_key(["a"])


def _photo(path: str) -> bytes | None:
    return {"photo.png": b"photo"}.get(path)


@pytest.fixture
def built(tmp_path: Path) -> Path:
    """Build a document and a site that asked for two pictures, one of which is not there; give their folder."""
    target = tmp_path / "out"
    file_tree.write_file(target / "report.docx", b"report")
    file_tree.write_tree(file_tree.make_file_tree([("index.html", b"page")]), target / "site")
    build_stamp.store_stamp(
        tmp_path / "cache", KEY, target, ["report.docx", "site"], {"photo.png": b"photo", "gone": None}
    )
    return target


def test_a_build_that_nobody_touched_is_fresh(built: Path) -> None:
    found = build_stamp.find_fresh_parts(built.parent / "cache", KEY, built, _photo)
    assert found == ("report.docx", "site")


def _replace_by_link(built: Path) -> None:
    (built / "report.docx").rename(built / "other.docx")
    (built / "report.docx").symlink_to("other.docx")


@pytest.mark.parametrize(
    "change",
    [
        lambda built: (built / "report.docx").write_bytes(b"other"),
        lambda built: (built / "report.docx").unlink(),
        _replace_by_link,
        lambda built: (built / "site" / "index.html").write_bytes(b"other"),
        lambda built: (built / "site" / "mine.html").touch(),
        lambda built: (built.parent / "cache" / f"{KEY}.stamp").write_bytes(b"{}"),
        lambda built: (built.parent / "cache" / f"{KEY}.stamp").write_bytes(b"\xff"),
        lambda built: (built.parent / "cache" / f"{KEY}.stamp").write_bytes(b'{"made": {}, "asked": {}}'),
    ],
)
def test_whatever_changed_is_made_again(built: Path, change: Callable[[Path], object]) -> None:
    change(built)
    assert build_stamp.find_fresh_parts(built.parent / "cache", KEY, built, _photo) is None


@pytest.mark.parametrize("read_file", [lambda _: None, lambda _: b"photo"])
def test_a_picture_that_changed_came_or_went_is_a_change(built: Path, read_file: Callable[[str], bytes | None]) -> None:
    assert build_stamp.find_fresh_parts(built.parent / "cache", KEY, built, read_file) is None


def test_other_inputs_and_another_program_have_another_name(monkeypatch: pytest.MonkeyPatch) -> None:
    assert build_stamp.make_stamp_key(["a"]) == KEY
    assert build_stamp.make_stamp_key(["b"]) != KEY
    assert build_stamp.make_stamp_key(["a", "b"]) != build_stamp.make_stamp_key(["b", "a"])
    monkeypatch.setattr(build_stamp, "stamp_program", lambda: "another")
    assert build_stamp.make_stamp_key(["a"]) != KEY


def test_without_a_folder_or_with_one_that_cannot_be_nothing_is_kept(built: Path, tmp_path: Path) -> None:
    for folder in (None, tmp_path / "out" / "report.docx"):
        build_stamp.store_stamp(folder, KEY, built, ["report.docx"], {})
        assert build_stamp.find_fresh_parts(folder, KEY, built, _photo) is None
