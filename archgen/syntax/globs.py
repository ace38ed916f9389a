"""File patterns of a project: `*` within a name, `**` for any folders, never out of the project's folder."""

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
    """Say whether a pattern stays in the folder from which it starts."""
    parts = PurePosixPath(pattern).parts
    return (
        bool(pattern)
        and "\\" not in pattern
        and not pattern.startswith("/")
        and ".." not in parts
        and "\0" not in pattern
    )


def expand(files: Files, pattern: str, skip: frozenset[str] = frozenset()) -> tuple[str, ...]:
    """Give the files that match, sorted by path.

    Wildcards never find hidden files and folders, output folders, links to folders, folders named in `skip`, or other
    projects below this one; a pattern that spells such a folder out does.
    """
    parts = PurePosixPath(pattern).parts
    fixed = next((i for i, part in enumerate(parts) if _WILD.search(part)), len(parts))
    prefix = "/".join(parts[:fixed])
    if fixed == len(parts):
        return (prefix,) if files.exists(prefix) else ()
    wanted = re.compile(_regex(parts[fixed:]))
    found = (name for name in _walk(files, prefix, skip) if wanted.fullmatch(name))
    return tuple(sorted((f"{prefix}/{name}" if prefix else name for name in found), key=lambda name: name.split("/")))


def matches(pattern: str, file: str) -> bool:
    """Tell whether a pattern names a file, there or not."""
    return is_inside(pattern) and re.fullmatch(_regex(PurePosixPath(pattern).parts), file) is not None


def _walk(files: Files, top: str, skip: frozenset[str]) -> Iterator[str]:
    for below, folders, names in files.walk(top):
        if below and "archgen.yaml" in names:
            folders.clear()
            continue
        folders[:] = sorted(name for name in folders if name[0] != "." and name != OUTPUT and name not in skip)
        start = f"{below}/" if below else ""
        yield from (f"{start}{name}" for name in names if name[0] != ".")
        # a folder or a link to one that is called like a file is told apart only by reading it
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
    """Translate one name of a pattern: `*`, `?` and `[abc]`."""
    out, rest = "", part
    while rest:
        match = re.match(r"\[(!?)([^\]/]+)\]", rest)
        if match:
            out += f"[{'^/' if match[1] else ''}{re.escape(match[2]).replace(chr(92) + '-', '-')}]"
            rest = rest[match.end() :]
        else:
            out += {"*": "[^/]*", "?": "[^/]"}.get(rest[0]) or re.escape(rest[0])
            rest = rest[1:]
    return out
