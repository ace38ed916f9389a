"""The stamps by which outputs are kept: whatever of archgen changes, they change."""

from __future__ import annotations

import os
import sys
from typing import TYPE_CHECKING

import pytest

from archgen import resources
from archgen.cache import program_stamp

if TYPE_CHECKING:
    from collections.abc import Sequence
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


def _recall(top: Path, monkeypatch: pytest.MonkeyPatch, settled_nanoseconds: int) -> tuple[str, int]:
    """Return the digest of files that changed so long ago, and how many were read for it."""
    digested: list[Path] = []

    def digest(tops: Sequence[Path]) -> str:
        digested.extend(tops)
        return digest_files(tops)

    digest_files = program_stamp.digest_files
    with monkeypatch.context() as patch:
        patch.setenv("XDG_CACHE_HOME", str(top.parent / "cache"))
        patch.setattr(program_stamp, "SETTLED_NANOSECONDS", settled_nanoseconds)
        patch.setattr(program_stamp, "digest_files", digest)
        return program_stamp.recall_digest((top,)), len(digested)


@pytest.mark.skipif(sys.platform == "win32", reason="no date tells there that a file was written")
def test_a_program_that_is_as_it_was_is_not_read_again(top: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    digest = program_stamp.digest_files((top,))
    assert _recall(top, monkeypatch, -10_000_000_000) == (digest, 1)
    assert _recall(top, monkeypatch, -10_000_000_000) == (digest, 0)
    # Files that are this young may change again at the same tick of the clock.
    assert _recall(top, monkeypatch, 10_000_000_000) == (digest, 1)
    # Same size, and the date that can be set by hand as before.
    file = top / "room" / "a.py"
    status = file.stat()
    file.write_text("9")
    os.utime(file, ns=(status.st_atime_ns, status.st_mtime_ns))
    changed = program_stamp.digest_files((top,))
    assert changed != digest
    assert _recall(top, monkeypatch, -10_000_000_000) == (changed, 1)
    # A damaged file of the cache counts as missing.
    for kept in (top.parent / "cache" / "archgen").glob("*.stamp"):
        kept.write_bytes(b"\xff")
    assert _recall(top, monkeypatch, -10_000_000_000) == (changed, 1)


def test_libraries_and_graphviz_itself_are_named() -> None:
    for stamp in (program_stamp.stamp_writers(), program_stamp.stamp_program()):
        assert "pygraphviz 2." in stamp
        assert "_graphviz" in stamp
        assert "lxml " in stamp
    assert program_stamp.stamp_writers().split()[0] != program_stamp.stamp_program().split()[0]


def test_the_pages_of_rules_are_part_of_the_program(monkeypatch: pytest.MonkeyPatch) -> None:
    # The site shows them: one that was edited is written again.
    digested: list[Path] = []
    monkeypatch.setattr(program_stamp, "recall_digest", digested.extend)
    program_stamp.stamp_program.__wrapped__()
    assert resources.resource_path("docs", "rules") in digested


def _describe_with(monkeypatch: pytest.MonkeyPatch, *places: Path) -> str:
    monkeypatch.setattr("sys.path", [*map(str, places), *sys.path])
    try:
        return program_stamp._describe_libraries.__wrapped__()  # noqa: SLF001 - what stamps have of the libraries
    finally:
        monkeypatch.undo()


@pytest.mark.parametrize(
    ("before", "after"),
    [
        (["lxml-1.0.dist-info"], ["lxml-1.1.dist-info"]),
        # What an update left there hides nothing.
        (["lxml-1.0.dist-info", "lxml-1.1.dist-info"], ["lxml-1.0.dist-info", "lxml-1.2.dist-info"]),
        # Debian's packages, before a newer one of another place.
        (["lxml-1.0-py3.12.egg-info"], ["lxml-1.1-py3.12.egg-info"]),
        (["python_docx-1.0.dist-info"], ["python_docx-1.1.dist-info"]),
    ],
)
def test_another_version_of_a_library_changes_the_stamp(
    before: list[str], after: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    stamps = []
    for number, names in enumerate((before, before, after)):
        for name in names:
            (tmp_path / str(number) / name).mkdir(parents=True)
        stamps.append(_describe_with(monkeypatch, tmp_path / str(number)))
    assert stamps[0] == stamps[1] != stamps[2]


def test_a_version_that_no_folder_tells_is_found_all_the_same(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A library that is installed for changing it has a folder without a version."""
    (tmp_path / "lxml.egg-info").mkdir()
    (tmp_path / "lxml.egg-info" / "PKG-INFO").write_text("Metadata-Version: 2.1\nName: lxml\nVersion: 0.0.7\n")
    assert "'lxml 0.0.7'" in _describe_with(monkeypatch, tmp_path)
    (tmp_path / "broken.zip").touch()
    assert "'lxml 6." in _describe_with(monkeypatch, tmp_path / "broken.zip", tmp_path / "nowhere")
