"""The stamps by which outputs are kept: whatever of archgen changes, they change."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from archgen.cache import program_stamp

if TYPE_CHECKING:
    from pathlib import Path


@pytest.fixture
def top(tmp_path: Path) -> Path:
    """Give a small program."""
    folder = tmp_path / "program"
    (folder / "room").mkdir(parents=True)
    (folder / "room" / "a.py").write_text("1")
    (folder / "room" / "__pycache__").mkdir()
    (folder / "face.py").write_text("2")
    return folder


@pytest.mark.parametrize(
    ("name", "text", "same"),
    [
        ("room/a.py", "1", True),
        ("room/a.py", "3", False),
        ("room/b.ttf", "", False),
        ("face.py", "", False),
        ("room/__pycache__/a.pyc", "x", True),
    ],
)
def test_code_and_data_count_and_what_python_leaves_does_not(top: Path, name: str, text: str, same: bool) -> None:  # noqa: FBT001
    before = program_stamp.digest_files((top,))
    (top / name).write_text(text)
    assert (program_stamp.digest_files((top,)) == before) is same


def test_it_is_no_matter_where_the_program_lies(top: Path) -> None:
    before = program_stamp.digest_files((top,))
    (top.parent / "other").mkdir()
    assert program_stamp.digest_files((top.rename(top.parent / "other" / "program"),)) == before


def test_libraries_and_graphviz_itself_are_named() -> None:
    for stamp in (program_stamp.stamp_writers(), program_stamp.stamp_program()):
        assert "pygraphviz 2." in stamp
        assert "_graphviz" in stamp
        assert "lxml " in stamp
    assert program_stamp.stamp_writers().split()[0] != program_stamp.stamp_program().split()[0]
