"""Reports written before: taken where nothing changed that they depend on, and nowhere else."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from archgen.emit.picture import Picture
from archgen.products import report_cache
from archgen.views.shapes import Outline

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

OUTLINE = Outline("Robot")
PICTURE = Picture("a", 1, 2, png=b"png", svg_outlines=b"svg")


class Writer:
    """Writes reports that say how many were written before; it asks for one picture of a chapter."""

    def __init__(self) -> None:
        self.count = 0

    def __call__(self, chapter_files: report_cache.ChapterFileReader) -> report_cache.ReportWithWarnings:
        """Write the next one."""
        chapter_files("photo.png")
        self.count += 1
        return b"report %d\nof two lines" % self.count, ("a warning",)


def written(  # noqa: PLR0913 - what a report depends on, each by its name
    folder: Path | None,
    writer: Writer,
    *,
    outline: Outline = OUTLINE,
    picture: Picture = PICTURE,
    template: bytes | None = None,
    files: Mapping[str, bytes] | None = None,
) -> bytes:
    document, warnings = report_cache.get_or_write_report(
        folder, outline, {"a": picture}, template=template, chapter_files=(files or {}).get, write_report=writer
    )
    assert warnings == ("a warning",)
    return document


def test_a_report_is_taken_as_it_was_where_nothing_changed(tmp_path: Path) -> None:
    writer = Writer()
    files = {"photo.png": b"photo"}
    assert written(tmp_path / "new", writer, files=files) == b"report 1\nof two lines"
    assert written(tmp_path / "new", writer, files=files) == b"report 1\nof two lines"


@pytest.mark.parametrize(
    "changed",
    [
        {"outline": Outline("Other robot")},
        {"picture": replace(PICTURE, png=b"other")},
        {"picture": replace(PICTURE, svg_outlines=b"other")},
        {"picture": replace(PICTURE, png=None)},
        {"picture": replace(PICTURE, width=3)},
        {"picture": replace(PICTURE, warning="late")},
        {"template": b""},
        {"files": {"photo.png": b"other"}},
        {"files": {}},
    ],
    ids=lambda changed: ", ".join(f"{name} {value!r:.40}" for name, value in changed.items()),
)
def test_whatever_changes_it_is_written_anew(tmp_path: Path, changed: dict[str, object]) -> None:
    writer = Writer()
    usual: dict[str, object] = {"files": {"photo.png": b"photo"}}
    assert written(tmp_path, writer, **usual) == b"report 1\nof two lines"  # type: ignore[arg-type]
    assert written(tmp_path, writer, **{**usual, **changed}) == b"report 2\nof two lines"  # type: ignore[arg-type]


@pytest.mark.parametrize(
    "damage", [b"", b"{}\nreport", b"[]", b'{"check": 1, "warnings": [], "asked": {}}\nreport', b"\xff"]
)
def test_what_is_damaged_is_written_anew(tmp_path: Path, damage: bytes) -> None:
    writer = Writer()
    written(tmp_path, writer)
    (file,) = tmp_path.glob("*.report")
    file.write_bytes(damage)
    assert written(tmp_path, writer) == b"report 2\nof two lines"


def test_the_newest_four_are_kept(tmp_path: Path) -> None:
    writer = Writer()
    for number in range(6):
        written(tmp_path, writer, template=b"%d" % number)
    assert len(list(tmp_path.iterdir())) == 4


def test_without_a_folder_or_with_one_that_cannot_be_each_report_is_written(tmp_path: Path) -> None:
    writer = Writer()
    (tmp_path / "file").write_text("in the way")
    for folder in (None, tmp_path / "file" / "below"):
        count = writer.count
        written(folder, writer)
        written(folder, writer)
        assert writer.count == count + 2


def test_a_report_that_fails_leaves_nothing(tmp_path: Path) -> None:
    def fail(_files: report_cache.ChapterFileReader) -> report_cache.ReportWithWarnings:
        raise ValueError

    with pytest.raises(ValueError, match=r"\A\Z"):
        report_cache.get_or_write_report(
            tmp_path, OUTLINE, {}, template=None, chapter_files=lambda _path: None, write_report=fail
        )
    assert list(tmp_path.iterdir()) == []
