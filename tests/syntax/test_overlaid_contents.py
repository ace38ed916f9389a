"""New contents laid over the files of a project: what is there, what is read, what is walked."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.syntax.folder_files import FolderFiles
from archgen.syntax.project_files import MAX_BYTES, TOO_LARGE, FileRefusal, OverlaidFiles

NEW = {"a.yaml": b"new", "sub/c.yaml": b"c", "extra/d.yaml": b"d", "extra/.hidden/e.yaml": b"e"}


@pytest.fixture
def files(tmp_path: Path) -> OverlaidFiles:
    (tmp_path / "a.yaml").write_text("old")
    (tmp_path / "b.yaml").write_text("b")
    (tmp_path / "sub").mkdir()
    (tmp_path / "sub" / "z.yaml").write_text("z")
    return OverlaidFiles(tmp_path, NEW, FolderFiles(tmp_path))


def test_the_new_contents_win(files: OverlaidFiles) -> None:
    assert [files.fetch_bytes(path) for path in ("a.yaml", "b.yaml", "sub/c.yaml")] == [b"new", b"b", b"c"]
    assert isinstance(files.fetch_bytes("absent.yaml"), FileRefusal)
    assert [files.has_path(path) for path in ("a.yaml", "b.yaml", "extra/d.yaml", "absent.yaml")] == [
        True,
        True,
        True,
        False,
    ]


def test_both_are_walked(files: OverlaidFiles) -> None:
    walked = sorted((folder, names) for folder, _, names in files.walk_folders("") if "/." not in f"/{folder}")
    assert walked == [
        ("", ["a.yaml", "b.yaml"]),
        ("extra", ["d.yaml"]),
        ("sub", ["c.yaml", "z.yaml"]),
    ]
    assert [(folder, names) for folder, _, names in files.walk_folders("sub")] == [("", ["c.yaml", "z.yaml"])]


def test_an_empty_folder_below(tmp_path: Path) -> None:
    files = OverlaidFiles(
        tmp_path, {"a.yaml": b"a", "large.yaml": b"x" * (MAX_BYTES + 1), "full.yaml": b"x" * MAX_BYTES}
    )
    assert files.fetch_bytes("large.yaml") is TOO_LARGE
    assert files.fetch_bytes("full.yaml") == b"x" * MAX_BYTES
    assert files.fetch_bytes("b.yaml") == FileRefusal("the file does not exist")
    assert (files.has_path("a.yaml"), files.has_path("b.yaml")) == (True, False)
    assert list(files.walk_folders("")) == [("", [], ["a.yaml", "full.yaml", "large.yaml"])]
