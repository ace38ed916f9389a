"""The files of a library by their paths from the project."""

from __future__ import annotations

from pathlib import Path

from archgen.syntax.folder_files import FolderFiles
from archgen.syntax.project_files import FileRefusal, LibraryFiles, OverlaidFiles


def test_paths_begin_at_the_project(tmp_path: Path) -> None:
    (tmp_path / "deep").mkdir()
    (tmp_path / "deep" / "a.yaml").write_text("x")
    (tmp_path / "linked.yaml").symlink_to("deep/a.yaml")
    files = LibraryFiles("../common", FolderFiles(tmp_path))
    assert files.root == tmp_path
    assert files.commit == ""
    assert files.has_path("../common/deep/a.yaml")
    assert not files.has_path("../common/b.yaml")
    assert files.fetch_bytes("../common/deep/a.yaml") == b"x"
    assert files.is_behind_link("../common/linked.yaml")
    assert [names for _, _, names in files.walk_folders("../common/deep")] == [["a.yaml"]]
    assert next(iter(files.walk_folders("../common")))[:2] == ("", ["deep"])
    assert files.open_folder("../more") == FileRefusal(
        "a library has no libraries of its own: `../more`", "name it in the project"
    )


def test_what_is_about_to_be_written_into_a_library_counts(tmp_path: Path) -> None:
    (tmp_path / "lib").mkdir()
    (tmp_path / "lib" / "a.yaml").write_text("old")
    overlay = {"lib/a.yaml": b"new", "lib/b.yaml": b"b", "library.yaml": b"no"}
    files = OverlaidFiles(tmp_path, overlay, FolderFiles(tmp_path)).open_folder("./lib/")
    assert isinstance(files, OverlaidFiles)
    assert files.fetch_bytes("a.yaml") == b"new"
    assert dict(files.contents) == {"a.yaml": b"new", "b.yaml": b"b"}
    refusal = OverlaidFiles(tmp_path, overlay).open_folder("lib")
    assert isinstance(refusal, FileRefusal)
    assert refusal.message == "there is no such folder"
