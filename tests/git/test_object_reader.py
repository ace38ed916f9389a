"""Lists of a commit's files, and a commit that holds far too many."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.git import GitError, find_repository
from archgen.git.object_reader import MAX_LIST_BYTES, GitObjects
from tests.repositories import commit, git, repository


def test_the_files_below_a_folder(tmp_path: Path) -> None:
    repository(tmp_path, {"a/b.yaml": "x", "a/c/d.yaml": "y", "e.yaml": "z"})
    objects = GitObjects(find_repository(tmp_path))
    listed = objects.list_tree("HEAD", "a")
    assert listed is not None
    assert [(path, entry.mode) for path, entry in listed.items()] == [("b.yaml", "100644"), ("c/d.yaml", "100644")]
    assert objects.list_tree("HEAD", "nowhere") is None


def test_a_tree_that_names_itself_ten_times_a_level_is_refused(tmp_path: Path) -> None:
    """Six levels: a million files from seven objects."""
    repository(tmp_path, {"archgen.yaml": "archgen: 1\nproject: {id: x}\n"})
    entry = f"100644 blob {git(tmp_path, 'hash-object', '-w', '--stdin', stdin=b'x')}"
    for _ in range(6):
        lines = "".join(f"{entry}\td{number}{'x' * 8}\n" for number in range(10))
        entry = f"040000 tree {git(tmp_path, 'mktree', stdin=lines.encode())}"
    tree = entry.rpartition(" ")[2]
    bomb = git(tmp_path, "commit-tree", tree, "-p", "HEAD", "-m", "bomb")
    with pytest.raises(GitError, match=rf"the commit {bomb[:10]} holds more files .* {MAX_LIST_BYTES // 1_000_000} MB"):
        GitObjects(find_repository(tmp_path)).list_tree(bomb)
    commit(tmp_path, {"b.yaml": ""})
