"""Files laid over a project: what is found is what will be found once they are written."""

from __future__ import annotations

from pathlib import Path

from archgen.syntax.file_patterns import expand_pattern
from archgen.syntax.folder_files import FolderFiles
from archgen.syntax.project_files import OverlaidFiles


def expand(root: Path, contents: dict[str, bytes], pattern: str = "**/*.yaml") -> tuple[str, ...]:
    """Give what a pattern matches with files laid over a folder; writing them must not change it."""
    overlaid = expand_pattern(OverlaidFiles(root, contents, FolderFiles(root)), pattern)
    for path, data in contents.items():
        (root / path).parent.mkdir(parents=True, exist_ok=True)
        (root / path).write_bytes(data)
    assert expand_pattern(FolderFiles(root), pattern) == overlaid
    return overlaid


def test_new_files_are_found_beside_old_ones(tmp_path: Path) -> None:
    (tmp_path / "groups").mkdir()
    (tmp_path / "groups" / "a.yaml").touch()
    contents = {"groups/b.yaml": b"", "nodes/deep/c.yaml": b"", "d.yaml": b""}
    assert expand(tmp_path, contents) == ("d.yaml", "groups/a.yaml", "groups/b.yaml", "nodes/deep/c.yaml")


def test_folders_that_are_skipped_stay_skipped(tmp_path: Path) -> None:
    (tmp_path / "archgen-out").mkdir()
    (tmp_path / "sub").mkdir()
    (tmp_path / "sub" / "archgen.yaml").touch()
    contents = {"archgen-out/x.yaml": b"", "sub/groups/g.yaml": b"", ".hidden/h.yaml": b"", "new/.git/i.yaml": b""}
    assert expand(tmp_path, contents) == ()


def test_a_project_in_a_new_folder_is_another_project(tmp_path: Path) -> None:
    contents = {"other/archgen.yaml": b"", "other/groups/g.yaml": b"", "own/archgen-out/y.yaml": b"", "own/z.yaml": b""}
    assert expand(tmp_path, contents) == ("own/z.yaml",)


def test_a_folder_that_only_the_new_files_have_is_walked(tmp_path: Path) -> None:
    assert expand(tmp_path, {"groups/a/b.yaml": b"", "c.yaml": b""}, "groups/**/*.yaml") == ("groups/a/b.yaml",)
    assert expand_pattern(OverlaidFiles(tmp_path, {"groups/a.yaml": b""}), "*/*.yaml") == ("groups/a.yaml",)
