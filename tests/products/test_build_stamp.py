"""Stamps of builds: what is still there as it was written is not made again."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from archgen.emit import file_tree
from archgen.products import full_build

KEY = full_build.make_stamp_key(["a"])


def _photo(path: str) -> bytes | None:
    return {"photo.png": b"photo"}.get(path)


@pytest.fixture
def built(tmp_path: Path) -> Path:
    """Build a document and a site that asked for two pictures, one of which is not there; give their folder."""
    target = tmp_path / "out"
    file_tree.write_file(target / "report.docx", b"report")
    file_tree.write_tree(file_tree.make_file_tree([("index.html", b"page")]), target / "site")
    for name in ("report.docx", "site"):
        asked_files = {"photo.png": b"photo", "gone": None}
        full_build.store_stamp(tmp_path / "cache", f"{KEY}-{name}", target / name, asked_files)
    return target


def _fresh_products(folder: Path | None, target: Path, read_file: Callable[[str], bytes | None]) -> tuple[str, ...]:
    names = ("report.docx", "site")
    return tuple(name for name in names if full_build.is_fresh(folder, f"{KEY}-{name}", target / name, read_file))


def test_a_build_that_nobody_touched_is_fresh(built: Path) -> None:
    assert _fresh_products(built.parent / "cache", built, _photo) == ("report.docx", "site")


def _replace_by_link(built: Path) -> None:
    (built / "report.docx").rename(built / "other.docx")
    (built / "report.docx").symlink_to("other.docx")


@pytest.mark.parametrize(
    ("product", "change"),
    [
        ("report.docx", lambda built: (built / "report.docx").write_bytes(b"other")),
        ("report.docx", lambda built: (built / "report.docx").unlink()),
        ("report.docx", _replace_by_link),
        ("site", lambda built: (built / "site" / "index.html").write_bytes(b"other")),
        ("site", lambda built: (built / "site" / "mine.html").touch()),
        ("site", lambda built: (built.parent / "cache" / f"{KEY}-site.stamp").write_bytes(b"{}")),
        ("site", lambda built: (built.parent / "cache" / f"{KEY}-site.stamp").write_bytes(b"\xff")),
        (
            "site",
            lambda built: (built.parent / "cache" / f"{KEY}-site.stamp").write_bytes(b'{"made": {}, "asked": {}}'),
        ),
    ],
)
def test_whatever_changed_is_made_again_and_nothing_else(
    built: Path, product: str, change: Callable[[Path], object]
) -> None:
    change(built)
    assert {product, *_fresh_products(built.parent / "cache", built, _photo)} == {"report.docx", "site"}
    assert product not in _fresh_products(built.parent / "cache", built, _photo)


@pytest.mark.parametrize("read_file", [lambda _: None, lambda _: b"photo"])
def test_a_picture_that_changed_came_or_went_is_a_change(built: Path, read_file: Callable[[str], bytes | None]) -> None:
    assert _fresh_products(built.parent / "cache", built, read_file) == ()


def test_other_inputs_and_another_program_have_another_name(monkeypatch: pytest.MonkeyPatch) -> None:
    assert full_build.make_stamp_key(["a"]) == KEY
    assert full_build.make_stamp_key(["b"]) != KEY
    assert full_build.make_stamp_key(["a", "b"]) != full_build.make_stamp_key(["b", "a"])
    monkeypatch.setattr(full_build, "stamp_program", lambda: "another")
    assert full_build.make_stamp_key(["a"]) != KEY


def test_without_a_folder_or_with_one_that_cannot_be_nothing_is_kept(built: Path, tmp_path: Path) -> None:
    for folder in (None, tmp_path / "out" / "report.docx"):
        full_build.store_stamp(folder, f"{KEY}-site", built / "site", {})
        assert _fresh_products(folder, built, _photo) == ()
