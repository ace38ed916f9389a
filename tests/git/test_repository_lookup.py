"""Which repository, which commit, where a branch left its main line."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen import git
from tests.repositories import commit, repository
from tests.repositories import git as run

PROJECT: dict[str, str | bytes] = {"robot/archgen.yaml": "archgen: 1\n"}


def test_the_root_and_the_prefix(tmp_path: Path) -> None:
    repository(tmp_path, PROJECT)
    found = git.find_repository(tmp_path / "robot")
    assert (found.top, found.prefix, found.is_bare, found.is_shallow) == (tmp_path, "robot", False, False)
    assert found.folder == tmp_path / "robot"
    assert git.find_repository(tmp_path).prefix == ""
    assert git.find_repository(tmp_path / "robot" / "gone" / "deep").prefix == "robot/gone/deep"


def test_no_repository(tmp_path: Path) -> None:
    with pytest.raises(git.NoRepositoryError, match="is not in a git repository: run `git init` first"):
        git.find_repository(tmp_path)


def test_a_repository_without_commits(tmp_path: Path) -> None:
    found = git.find_repository(repository(tmp_path))
    with pytest.raises(git.NoCommitsError, match="nothing was committed in this repository yet"):
        git.find_branch_base(found)


def test_revisions(tmp_path: Path) -> None:
    repository(tmp_path, PROJECT)
    first = run(tmp_path, "rev-parse", "HEAD")
    second = commit(tmp_path, {"a": "1"})
    run(tmp_path, "tag", "-a", "-m", "x", "v1")
    found = git.find_repository(tmp_path)
    assert [git.resolve_revision(found, name) for name in ("HEAD~1", "v1", "main", second[:9])] == [
        first,
        second,
        second,
        second,
    ]


@pytest.mark.parametrize(
    "name", ["mian", "-x", "--help", "HEAD:robot", "a b", "a\nb", "a\0b", "", "v1..v2", "$(touch x)"]
)
def test_unknown_revisions(tmp_path: Path, name: str) -> None:
    found = git.find_repository(repository(tmp_path, PROJECT))
    with pytest.raises(git.UnknownRevisionError, match="there is no revision `"):
        git.resolve_revision(found, name)


def test_a_guess_for_a_mistyped_branch(tmp_path: Path) -> None:
    repository(tmp_path, PROJECT)
    run(tmp_path, "branch", "arm-camera")
    with pytest.raises(git.UnknownRevisionError, match="did you mean `arm-camera`"):
        git.resolve_revision(git.find_repository(tmp_path), "arm-camrea")


def test_a_branch_is_compared_with_where_it_left_the_main_line(tmp_path: Path) -> None:
    repository(tmp_path, PROJECT)
    left = run(tmp_path, "rev-parse", "HEAD")
    run(tmp_path, "checkout", "-q", "-b", "arm")
    commit(tmp_path, {"a": "1"})
    run(tmp_path, "checkout", "-q", "main")
    commit(tmp_path, {"b": "1"})
    run(tmp_path, "checkout", "-q", "arm")
    assert git.find_branch_base(git.find_repository(tmp_path)) == (left, "where this branch left main")


def test_on_the_main_line_it_is_head(tmp_path: Path) -> None:
    repository(tmp_path, PROJECT)
    second = commit(tmp_path, {"a": "1"})
    assert git.find_branch_base(git.find_repository(tmp_path)) == (second, "HEAD")
    run(tmp_path, "branch", "-m", "trunk")  # the only line there is
    assert git.find_branch_base(git.find_repository(tmp_path)) == (second, "HEAD")


def test_the_remote_says_what_its_main_line_is(tmp_path: Path) -> None:
    origin = repository(tmp_path / "origin", PROJECT)
    run(origin, "branch", "-m", "develop")
    run(tmp_path, "clone", "-q", str(origin), "clone")
    clone = tmp_path / "clone"
    left = run(clone, "rev-parse", "HEAD")
    here = commit(clone, {"a": "1"})
    assert git.find_branch_base(git.find_repository(clone)) == (here, "HEAD")
    run(clone, "checkout", "-q", "-b", "arm")
    commit(clone, {"b": "1"})
    assert git.find_branch_base(git.find_repository(clone)) == (left, "where this branch left origin/develop")


def test_the_project_says_what_the_main_line_is(tmp_path: Path) -> None:
    repository(tmp_path, PROJECT)
    run(tmp_path, "checkout", "-q", "-b", "develop")
    left = commit(tmp_path, {"a": "1"})
    run(tmp_path, "checkout", "-q", "-b", "arm")
    commit(tmp_path, {"b": "1"})
    found = git.find_repository(tmp_path)
    assert git.find_branch_base(found, "develop") == (left, "where this branch left develop")
    with pytest.raises(git.UnknownRevisionError, match="there is no revision `devlop`: did you mean `develop`"):
        git.find_branch_base(found, "devlop")


def test_unrelated_lines(tmp_path: Path) -> None:
    repository(tmp_path, PROJECT)
    run(tmp_path, "checkout", "-q", "--orphan", "other")
    commit(tmp_path, {"a": "1"})
    with pytest.raises(git.GitError, match="`main` and `HEAD` have no commit in common"):
        git.find_branch_base(git.find_repository(tmp_path))


def test_shallow_clones_say_what_to_do(tmp_path: Path) -> None:
    origin = repository(tmp_path / "origin", PROJECT)
    first = run(origin, "rev-parse", "HEAD")
    for number in "123":
        commit(origin, {"a": number})
    run(origin, "checkout", "-q", "-b", "arm")
    commit(origin, {"b": "1"})
    run(origin, "checkout", "-q", "main")
    commit(origin, {"a": "4"})
    run(tmp_path, "clone", "-q", "--depth", "1", "--branch", "arm", f"file://{origin}", "one")
    found = git.find_repository(tmp_path / "one")
    assert found.is_shallow
    with pytest.raises(git.ShallowError, match=r"holds no main line.*--unshallow.*fetch-depth: 0"):
        git.find_branch_base(found)
    with pytest.raises(git.ShallowError, match="in this shallow clone"):
        git.resolve_revision(found, first)
    run(tmp_path, "clone", "-q", "--depth", "1", "--no-single-branch", "--branch", "arm", f"file://{origin}", "all")
    with pytest.raises(
        git.ShallowError, match="the commit at which `HEAD` left `origin/main` is not in this shallow clone"
    ):
        git.find_branch_base(git.find_repository(tmp_path / "all"))


def test_bare_repositories_and_worktrees(tmp_path: Path) -> None:
    origin = repository(tmp_path / "origin", PROJECT)
    run(tmp_path, "clone", "-q", "--bare", str(origin), "bare.git")
    for path, prefix in (("bare.git", ""), ("bare.git/robot", "robot"), ("bare.git/refs", "refs")):
        found = git.find_repository(tmp_path / path)
        assert (found.top, found.prefix, found.is_bare) == (tmp_path / "bare.git", prefix, True)
    run(origin, "worktree", "add", "-q", "-b", "arm", str(tmp_path / "tree"))
    here = commit(tmp_path / "tree", {"a": "1"})
    found = git.find_repository(tmp_path / "tree" / "robot")
    assert (found.top, found.prefix) == (tmp_path / "tree", "robot")
    assert git.resolve_revision(found, "HEAD") == here


def test_hashes_of_256_bits(tmp_path: Path) -> None:
    repository(tmp_path, PROJECT, "--object-format=sha256")
    objects = git.GitObjects(git.find_repository(tmp_path))
    head = git.resolve_revision(objects.repository, "HEAD")
    tree = objects.list_tree(head)
    assert len(head) == 64
    assert tree is not None
    assert objects.read_blob(tree["robot/archgen.yaml"].object_id) == b"archgen: 1\n"


def test_variables_that_point_elsewhere_are_not_followed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    here = repository(tmp_path / "here", PROJECT)
    other = repository(tmp_path / "other", {"x": "1"})
    monkeypatch.setenv("GIT_DIR", str(other / ".git"))
    monkeypatch.setenv("GIT_WORK_TREE", str(other))
    assert git.find_repository(here).top == here
