"""File patterns of a project: `*` within a name, `**` for any number of folders, never outside the project's folder.

Not `pathlib.glob`: a project may lie in a commit, and some folders are never searched.
"""

from __future__ import annotations

import re
from pathlib import PurePosixPath
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

    from archgen.syntax.files import Files

_WILD = re.compile(r"[*?\[]")
OUTPUT = "archgen-out"


def is_inside(pattern: str) -> bool:
    """Whether a pattern is relative and stays in the folder that it starts from."""
    parts = PurePosixPath(pattern).parts
    return (
        bool(pattern)
        and "\\" not in pattern
        and not pattern.startswith("/")
        and ".." not in parts
        and "\0" not in pattern
    )


def expand(files: Files, pattern: str, skip: frozenset[str] = frozenset()) -> tuple[str, ...]:
    """Return the files that match a pattern, sorted by path.

    Wildcards never find hidden files and folders, output folders, links to folders, folders named in `skipped_folders`,
    or other projects below this one. A pattern that spells such a folder out does.
    """
    parts = PurePosixPath(pattern).parts
    # The part before the first wildcard is walked to directly; without any wildcard the pattern is a path.
    fixed = next((i for i, part in enumerate(parts) if _WILD.search(part)), len(parts))
    prefix = "/".join(parts[:fixed])
    if fixed == len(parts):
        return (prefix,) if files.exists(prefix) else ()
    wanted = re.compile(_regex(parts[fixed:]))
    found = (name for name in _walk(files, prefix, skip) if wanted.fullmatch(name))
    # Sorted name by name, not as strings: `a/b` comes before `a-b/c`, as in a listing of folders.
    return tuple(sorted((f"{prefix}/{name}" if prefix else name for name in found), key=lambda name: name.split("/")))


def matches(pattern: str, file: str) -> bool:
    """Whether a pattern matches a path, whether or not the file exists."""
    return is_inside(pattern) and re.fullmatch(_regex(PurePosixPath(pattern).parts), file) is not None


def _walk(files: Files, top: str, skip: frozenset[str]) -> Iterator[str]:
    for below, folders, names in files.walk(top):
        if below and "archgen.yaml" in names:  # a project of its own
            folders.clear()
            continue
        folders[:] = sorted(name for name in folders if name[0] != "." and name != OUTPUT and name not in skip)
        start = f"{below}/" if below else ""
        yield from (f"{start}{name}" for name in names if name[0] != ".")
        # A folder called `x.yaml` is yielded too: reading it then reports that it is a folder, instead of silently
        # leaving out what somebody may take for a file.
        yield from (f"{start}{name}" for name in folders if name.endswith(".yaml"))


def _regex(parts: tuple[str, ...]) -> str:
    out = ""
    for position, part in enumerate(parts):
        last = position == len(parts) - 1
        if part == "**":
            out += ".*" if last else "(?:[^/]+/)*"
        else:
            out += _name(part) + ("" if last else "/")
    return out


def _name(part: str) -> str:
    """Translate one name of a pattern with `*`, `?` and `[abc]` into a regular expression."""
    out, rest = "", part
    while rest:
        match = re.match(r"\[(!?)([^\]/]+)\]", rest)
        if match:
            # `[!a]` must not match a slash; re.escape also escapes `-`, which means a range here as it does in a shell.
            out += f"[{'^/' if match[1] else ''}{re.escape(match[2]).replace(chr(92) + '-', '-')}]"
            rest = rest[match.end() :]
        else:
            out += {"*": "[^/]*", "?": "[^/]"}.get(rest[0]) or re.escape(rest[0])
            rest = rest[1:]
    return out
