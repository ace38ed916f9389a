"""Set up a hook of git that checks the project after each merge: the driver merges files, and nobody looked at the whole."""

from __future__ import annotations

import os
import shlex
from pathlib import Path
from typing import Literal, NamedTuple

from archgen import git
from archgen.emit import file_tree
from archgen.git.git_call import run_git
from archgen.start.merge_driver_setup import find_program

_HOOK = "post-merge"
_HEADER = "#!/bin/sh\n# archgen init --merge-driver wrote this: git merges files, here the whole is checked.\n"


class MergeHook(NamedTuple):
    """The hook of a clone, and the lines in it that check a project: written now, there already, or still to be written by
    people, since the hook is theirs.
    """

    path: Path
    lines: str
    state: Literal["written", "kept", "missing"]


def install_merge_hook(folder: Path) -> MergeHook:
    """Write the lines into the hook, unless git looks elsewhere for hooks or somebody wrote one: that is left alone.

    Raise `git.NoRepositoryError`, OutputError or OSError.
    """
    repository = git.find_repository(folder)
    lines = _write_check(repository.prefix or ".")
    path = _find_hook(repository.top)
    content = path.read_bytes().decode("utf-8", "replace") if path.is_file() else ""
    is_ours = content.startswith(_HEADER) and not path.is_symlink()
    if lines in content:
        return MergeHook(path, lines, state="kept")
    if _has_own_hook_folder(repository.top) or (os.path.lexists(path) and not is_ours):
        return MergeHook(path, lines, state="missing")
    path.parent.mkdir(exist_ok=True)
    file_tree.replace_file(path, (f"{content or _HEADER}{lines}").encode())
    path.chmod(0o755)
    return MergeHook(path, lines, state="written")


def _write_check(project: str) -> str:
    # ORIG_HEAD is what was there before the merge: only what came with it is said.
    return (
        f"{find_program()} check {shlex.quote(project)} --quiet --changed-since ORIG_HEAD >&2\n"
        '[ $? -ne 1 ] || echo "archgen: git merged, and the architecture has errors" >&2\n'
    )


def _find_hook(top: Path) -> Path:
    # Worktrees share the hooks of their repository.
    return top / run_git(top, "rev-parse", "--git-common-dir").text.removesuffix("\n") / "hooks" / _HOOK


def _has_own_hook_folder(top: Path) -> bool:
    """Whether a setting names another folder for hooks, such as one that is shared. archgen's calls of git overrule it."""
    return any(
        run_git(top, "config", scope, "--get", "core.hooksPath").status == 0
        for scope in ("--local", "--global", "--system")
    )
