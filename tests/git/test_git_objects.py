"""Trees and blobs, as git's objects hold them."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.git import find_repository, object_reader
from archgen.git.object_reader import LINK_MODE, GitObjects
from tests.repositories import git, repository


@pytest.fixture
def objects(tmp_path: Path) -> GitObjects:
    (tmp_path / "robot").mkdir()
    (tmp_path / "robot" / "link").symlink_to("a.yaml")
    repository(tmp_path, {"robot/a.yaml": b"one\n", "robot/deep/b c.yaml": b"", "other": b"x"})
    return GitObjects(find_repository(tmp_path))


def test_a_tree_lists_what_is_below_a_folder_with_links_as_such(objects: GitObjects) -> None:
    tree = objects.list_tree("HEAD", "robot")
    assert tree is not None
    assert {path: entry.mode for path, entry in tree.items()} == {
        "a.yaml": "100644",
        "deep/b c.yaml": "100644",
        "link": LINK_MODE,
    }


def test_a_folder_that_a_commit_does_not_have_has_no_tree(objects: GitObjects) -> None:
    assert objects.list_tree("HEAD", "gone") is None


def test_blobs_come_with_their_sizes_in_any_order(objects: GitObjects, tmp_path: Path) -> None:
    one, empty = git(tmp_path, "rev-parse", "HEAD:robot/a.yaml"), git(tmp_path, "rev-parse", "HEAD:robot/deep/b c.yaml")
    for _ in range(2):  # the second time from memory
        assert (objects.blob_size(one), objects.read_blob(one)) == (4, b"one\n")
        assert (objects.blob_size(empty), objects.read_blob(empty)) == (0, b"")


@pytest.mark.parametrize("name", ["0" * 40, "HEAD:robot", "nonsense"])
def test_what_is_no_blob_has_no_size_and_ends_nothing(objects: GitObjects, tmp_path: Path, name: str) -> None:
    assert objects.blob_size(name) is None
    one = git(tmp_path, "rev-parse", "HEAD:robot/a.yaml")
    assert (objects.blob_size(one), objects.read_blob(one)) == (4, b"one\n")


def test_a_blob_that_this_clone_does_not_have_has_no_content(objects: GitObjects) -> None:
    assert objects.read_blob("0" * 40) is None


def test_large_blobs_are_read_and_not_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(object_reader, "_SMALL_BYTES", 3)
    repository(tmp_path, {"large": b"1234", "small": b"123"})
    objects = GitObjects(find_repository(tmp_path))
    for name, content in (("large", b"1234"), ("small", b"123")):
        assert objects.read_blob(git(tmp_path, "rev-parse", f"HEAD:{name}")) == content
    assert list(objects._cached_blobs.values()) == [b"123"]  # noqa: SLF001 - what is kept shows nowhere else
