"""File patterns of a project: `*` within a name, `**` for any number of folders, never outside the project's folder.

Not `pathlib.glob`: a project may lie in a commit, and some folders are never searched.
"""

from __future__ import annotations

import re
from pathlib import PurePosixPath
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

    from archgen.syntax.project_files import ProjectFiles

_WILDCARD = re.compile(r"[*?\[]")
OUTPUT_FOLDER = "archgen-out"


def is_inside_project(pattern: str) -> bool:
    """Whether a pattern is relative and stays in the folder that it starts from."""
    parts = PurePosixPath(pattern).parts
    return (
        bool(pattern)
        and "\\" not in pattern
        and not pattern.startswith("/")
        and ".." not in parts
        and "\0" not in pattern
    )


def expand_pattern(files: ProjectFiles, pattern: str, skipped_folders: frozenset[str] = frozenset()) -> tuple[str, ...]:
    """Return the files that match a pattern, sorted by path.

    Wildcards never find hidden files and folders, output folders, links to folders, folders named in `skipped_folders`,
    or other projects below this one. A pattern that spells such a folder out does.
    """
    parts = PurePosixPath(pattern).parts
    # The part before the first wildcard is walked to directly; without any wildcard the pattern is a path.
    fixed_count = next((i for i, part in enumerate(parts) if _WILDCARD.search(part)), len(parts))
    prefix = "/".join(parts[:fixed_count])
    if fixed_count == len(parts):
        return (prefix,) if files.has_path(prefix) else ()
    name_pattern = re.compile(_pattern_to_regex(parts[fixed_count:]))
    matching_names = (name for name in _walk_files(files, prefix, skipped_folders) if name_pattern.fullmatch(name))
    # Sorted name by name, not as strings: `a/b` comes before `a-b/c`, as in a listing of folders.
    return tuple(
        sorted((f"{prefix}/{name}" if prefix else name for name in matching_names), key=lambda name: name.split("/"))
    )


def matches_pattern(pattern: str, file: str) -> bool:
    """Whether a pattern matches a path, whether or not the file exists."""
    return (
        is_inside_project(pattern) and re.fullmatch(_pattern_to_regex(PurePosixPath(pattern).parts), file) is not None
    )


def _walk_files(files: ProjectFiles, top: str, skipped_folders: frozenset[str]) -> Iterator[str]:
    for relative_folder, folders, file_names in files.walk_folders(top):
        if relative_folder and "archgen.yaml" in file_names:  # a project of its own
            folders.clear()
            continue
        folders[:] = sorted(
            name for name in folders if name[0] != "." and name != OUTPUT_FOLDER and name not in skipped_folders
        )
        path_prefix = f"{relative_folder}/" if relative_folder else ""
        yield from (f"{path_prefix}{name}" for name in file_names if name[0] != ".")
        # A folder called `x.yaml` is yielded too: reading it then reports that it is a folder, instead of silently
        # leaving out what somebody may take for a file.
        yield from (f"{path_prefix}{name}" for name in folders if name.endswith(".yaml"))


def _pattern_to_regex(parts: tuple[str, ...]) -> str:
    regex = ""
    for position, part in enumerate(parts):
        is_last = position == len(parts) - 1
        if part == "**":
            regex += ".*" if is_last else "(?:[^/]+/)*"
        else:
            regex += _name_to_regex(part) + ("" if is_last else "/")
    return regex


def _name_to_regex(part: str) -> str:
    """Translate one name of a pattern with `*`, `?` and `[abc]` into a regular expression."""
    regex, remaining = "", part
    while remaining:
        match = re.match(r"\[(!?)([^\]/]+)\]", remaining)
        if match:
            # `[!a]` must not match a slash; re.escape also escapes `-`, which means a range here as it does in a shell.
            regex += f"[{'^/' if match[1] else ''}{re.escape(match[2]).replace(chr(92) + '-', '-')}]"
            remaining = remaining[match.end() :]
        else:
            regex += {"*": "[^/]*", "?": "[^/]"}.get(remaining[0]) or re.escape(remaining[0])
            remaining = remaining[1:]
    return regex
