"""Whether git ignores a file."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.git.work_tree import ignores_file
from tests.repositories import git, repository


@pytest.mark.parametrize(
    ("patterns", "is_ignored"),
    [
        ("sub/a.json", True),
        ("sub/", True),
        ("*.json", True),
        ("*.json\n!a.json", False),
        ("b.json", False),
        ("", False),
    ],
)
def test_patterns_decide(patterns: str, is_ignored: bool, tmp_path: Path) -> None:  # noqa: FBT001 - expected
    root = repository(tmp_path / "r", {".gitignore": patterns})
    (root / "sub").mkdir()
    (root / "sub/a.json").touch()
    assert ignores_file(root, "sub/a.json") == is_ignored
    assert ignores_file(root / "sub", "a.json") == is_ignored


def test_what_git_keeps_it_does_not_ignore(tmp_path: Path) -> None:
    root = repository(tmp_path / "r", {".gitignore": "*.json"})
    (root / "a.json").touch()
    git(root, "add", "-f", "a.json")
    assert not ignores_file(root, "a.json")


def test_outside_of_a_repository_nothing_is_ignored(tmp_path: Path) -> None:
    (tmp_path / "a.json").touch()
    assert not ignores_file(tmp_path, "a.json")
