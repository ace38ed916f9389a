"""Set up the merge driver: a line in .gitattributes for everybody, two settings of git for this clone."""

from __future__ import annotations

import shlex
import shutil
import sys
from pathlib import Path

from archgen import git
from archgen.emit import file_tree
from archgen.git.git_call import run_git
from archgen.project.project_loading import load_project
from archgen.syntax.file_patterns import YAML_ENDINGS

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
    merge_lines = [words for words in lines if words[:1] == [pattern] and _sets_merge(words)]
    return bool(merge_lines) and _ATTRIBUTE in merge_lines[-1]


def _sets_merge(words: list[bytes]) -> bool:
    return any(word.lstrip(b"-!").partition(b"=")[0] == b"merge" for word in words[1:])


def configure_git(folder: Path) -> None:
    """Make the settings in the repository around a folder. Raise `git.NoRepositoryError` or `git.GitError`."""
    repository = git.find_repository(folder)
    for name, value in list_driver_settings().items():
        result = run_git(repository.top, "config", "--local", name, value)
        if result.status:
            msg = f"git does not take the setting {name}: {result.error_text}"
            raise git.GitError(msg)
