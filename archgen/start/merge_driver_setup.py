"""Set up what merges slices: the driver (a line in .gitattributes, two settings of git), and the hook that checks after a merge."""

from __future__ import annotations

import os
import shlex
import shutil
import sys
from pathlib import Path
from typing import Literal

from archgen import git
from archgen.emit import file_tree
from archgen.frozen import NamedTuple
from archgen.git.git_call import run_git
from archgen.project.project_loading import load_project
from archgen.syntax.file_patterns import YAML_ENDINGS

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


ATTRIBUTES_FILE = ".gitattributes"
_PATTERNS = tuple(f"*{ending}".encode() for ending in YAML_ENDINGS)
_ATTRIBUTE = b"merge=archgen"
_DRIVER_ARGUMENTS = "merge-driver --marker-size=%L %O %A %B %P"


def list_driver_settings() -> dict[str, str]:
    """Return the settings of git that name the driver."""
    return {
        "merge.archgen.name": "slices of archgen by what they say",
        "merge.archgen.driver": f"{find_program()} {_DRIVER_ARGUMENTS}",
    }


def find_program() -> str:
    """Return how the shell that git calls starts archgen: by this Python where it would not find `archgen`.

    git takes a driver that is missing for a conflict, and leaves our side without any marker.
    """
    return "archgen" if shutil.which("archgen") else f"{shlex.quote(Path(sys.executable).as_posix())} -m archgen"


def format_setting(name: str, value: str) -> str:
    """Return the command that makes a setting."""
    return f"git config --local {name} {shlex.quote(value)}"


def list_outer_libraries(folder: Path) -> tuple[Path, ...]:
    """Return the folders of a project's libraries that lie outside of its own: its .gitattributes do not reach them."""
    libraries = load_project(folder).libraries
    return tuple(dict.fromkeys(folder / library.folder for library in libraries if library.folder.startswith("../")))


def add_attribute(folder: Path) -> bool:
    """Add the lines to the .gitattributes of a project or library, behind what is there. Return whether one was missing.

    Raise OutputError for a symbolic link, which git does not read, and OSError.
    """
    path = folder / ATTRIBUTES_FILE
    if path.is_symlink():
        msg = f"{path} is a symbolic link, which git does not read; nothing was written"
        lines = " and ".join(f"`{(pattern + b' ' + _ATTRIBUTE).decode()}`" for pattern in _PATTERNS)
        raise file_tree.OutputError(msg, f"make it a file with the lines {lines}")
    content = path.read_bytes() if path.exists() else b""
    missing_patterns = [pattern for pattern in _PATTERNS if not _is_set(content, pattern)]
    if not missing_patterns:
        return False
    line_end = b"\r\n" if b"\r\n" in content else b"\n"
    separator = b"" if not content or content.endswith(b"\n") else line_end
    new_lines = b"".join(pattern + b" " + _ATTRIBUTE + line_end for pattern in missing_patterns)
    file_tree.replace_file(path, content + separator + new_lines)
    return True


def _is_set(content: bytes, pattern: bytes) -> bool:
    """Whether files of a pattern are merged by archgen. The last line counts: another driver behind ours would be taken."""
    lines = (line.split() for line in content.splitlines())
    merge_lines = [
        words
        for words in lines
        if words[:1] == [pattern] and any(word.lstrip(b"-!").partition(b"=")[0] == b"merge" for word in words[1:])
    ]
    return bool(merge_lines) and _ATTRIBUTE in merge_lines[-1]


def configure_git(folder: Path) -> None:
    """Make the settings in the repository around a folder. Raise `git.NoRepositoryError` or `git.GitError`."""
    repository = git.find_repository(folder)
    for name, value in list_driver_settings().items():
        result = run_git(repository.top, "config", "--local", name, value)
        if result.status:
            raise git.GitError(f"git does not take the setting {name}: {result.error_text}")
