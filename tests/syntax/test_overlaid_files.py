"""A project's files with some contents replaced."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.syntax.folder_files import FolderFiles
from archgen.syntax.project_files import MAX_BYTES, TOO_LARGE, FileRefusal, OverlaidFiles


@pytest.fixture
def files(tmp_path: Path) -> OverlaidFiles:
    (tmp_path / "groups").mkdir()
    (tmp_path / "groups" / "a.yaml").write_text("old")
    (tmp_path / "groups" / "b.yaml").write_text("kept")
    new = {"groups/a.yaml": b"new", "nodes/n.yaml": b"", ".archgen/schema.json": b""}
    return OverlaidFiles(tmp_path, new, FolderFiles(tmp_path))


def test_new_contents_win_and_the_rest_is_as_it_was(files: OverlaidFiles) -> None:
    assert [files.fetch_bytes(path) for path in ("groups/a.yaml", "groups/b.yaml", "nodes/n.yaml")] == [
        b"new",
        b"kept",
        b"",
    ]
    assert [files.has_path(path) for path in ("groups/b.yaml", "nodes/n.yaml", "nodes/x.yaml")] == [True, True, False]


def test_walking_meets_both(files: OverlaidFiles) -> None:
    assert sorted((folder, names) for folder, _, names in files.walk_folders("") if names) == [
        (".archgen", ["schema.json"]),
        ("groups", ["a.yaml", "b.yaml"]),
        ("nodes", ["n.yaml"]),
    ]
    assert [(folder, names) for folder, _, names in files.walk_folders("groups")] == [("", ["a.yaml", "b.yaml"])]


def test_without_a_folder_below_there_is_only_what_is_laid_over() -> None:
    files = OverlaidFiles(Path("robot"), {"a.yaml": b"x"})
    assert list(files.walk_folders("")) == [("", [], ["a.yaml"])]
    assert files.fetch_bytes("b.yaml") == FileRefusal("the file does not exist")


def test_the_limit_of_size_holds_for_new_contents_too() -> None:
    files = OverlaidFiles(Path("robot"), {"a.yaml": b"x" * MAX_BYTES, "b.yaml": b"x" * (MAX_BYTES + 1)})
    assert isinstance(files.fetch_bytes("a.yaml"), bytes)
    assert files.fetch_bytes("b.yaml") == TOO_LARGE
