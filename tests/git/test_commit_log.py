"""The line of commits that led to one, and the ids of objects in them."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.git import commit_log, find_repository
from tests.repositories import commit, git, repository


def test_a_merge_counts_once_and_the_branch_behind_it_not(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("GIT_COMMITTER_DATE", "2026-03-04T23:30:00+0200")
    first = commit(repository(tmp_path), {"a": "1"})
    git(tmp_path, "checkout", "-q", "-b", "arm")
    commit(tmp_path, {"b": "1"})
    git(tmp_path, "checkout", "-q", "main")
    git(tmp_path, "merge", "-q", "--no-ff", "-m", "m", "arm")
    merge = git(tmp_path, "rev-parse", "HEAD")
    assert commit_log.list_first_parents(find_repository(tmp_path), "main") == (
        (first, "2026-03-04"),
        (merge, "2026-03-04"),
    )


def test_ids_stand_in_the_order_of_the_names_and_are_empty_for_what_is_not_there(tmp_path: Path) -> None:
    repository(tmp_path, {"robot/a.yaml": "1"})
    blob, tree = git(tmp_path, "rev-parse", "HEAD:robot/a.yaml"), git(tmp_path, "rev-parse", "HEAD:robot")
    names = ["HEAD:robot/a.yaml", "HEAD:gone", "HEAD:two\nlines", "HEAD:robot"]
    assert commit_log.find_object_ids(find_repository(tmp_path), names) == (blob, "", "", tree)
