"""Calls of git: what fails is a result, and nothing of the user's environment points git elsewhere."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.git import git_call
from archgen.git.git_call import GitResult, git_environment, run_git
from tests.repositories import repository, trap


def test_output_that_is_not_utf8_comes_back_as_the_same_bytes() -> None:
    assert GitResult(0, b"a\xff", "").text.encode("utf-8", "surrogateescape") == b"a\xff"


def test_a_command_that_fails_has_a_status_and_a_text(tmp_path: Path) -> None:
    result = run_git(repository(tmp_path), "rev-parse", "--verify", "HEAD")
    assert (result.status, result.output) == (128, b"")
    assert result.error_text.startswith("fatal: ")


def test_what_is_written_to_git_arrives(tmp_path: Path) -> None:
    hash_of_hello = "ce013625030ba8dba906f756967f9e9ca394464a"
    assert run_git(tmp_path, "hash-object", "--stdin", stdin=b"hello\n").text.strip() == hash_of_hello


@pytest.mark.parametrize("argument", ["a\0b", "x" * 10_000_000])
def test_arguments_that_no_system_takes_are_a_result(tmp_path: Path, argument: str) -> None:
    result = run_git(tmp_path, "log", argument)
    assert result.status == 127
    assert result.error_text.startswith("git cannot be run: ")


def test_without_git_the_result_says_so(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    assert run_git(tmp_path, "--version") == GitResult(127, b"", "git is not installed")


def test_a_git_that_does_not_end_is_given_up(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    program = tmp_path / "git"
    program.write_text("#!/bin/sh\nexec sleep 5\n")
    program.chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}:/usr/bin:/bin")
    monkeypatch.setattr(git_call, "ANSWER_SECONDS", 0.1)
    assert "timed out after 0.1 seconds" in run_git(tmp_path, "log").error_text


def test_variables_of_git_are_dropped_and_the_safe_ones_set() -> None:
    environment = git_environment(
        {"GIT_DIR": "/elsewhere", "GIT_ALLOW_PROTOCOL": "ext", "HOME": "/home/a", "LC_ALL": "de"}
    )
    assert "GIT_DIR" not in environment
    assert environment["HOME"] == "/home/a"
    assert (environment["GIT_ALLOW_PROTOCOL"], environment["LC_ALL"]) == ("", "C")


def test_a_hook_of_the_repository_is_not_run(tmp_path: Path) -> None:
    folder = repository(tmp_path / "work", {"a": "1"})
    program, mark = trap(tmp_path)
    (folder / ".git" / "hooks" / "post-checkout").symlink_to(program)
    assert run_git(folder, "checkout", "-q", "-b", "other").status == 0
    assert not mark.exists()
