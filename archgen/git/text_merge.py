"""Merge three texts line by line, as git does it."""

from __future__ import annotations

import tempfile
from pathlib import Path

from archgen.frozen import dataclass
from archgen.git.git_call import run_git
from archgen.git.git_errors import GitError

_MAX_CONFLICTS = 127
"""`git merge-file` ends with the number of conflicts, at most this, and with more where it fails."""


@dataclass(frozen=True, slots=True)
class LineMerge:
    """Merged lines, with git's markers round each conflict."""

    content: bytes
    conflict_count: int


def merge_lines(
    base: bytes, ours: bytes, theirs: bytes, *, marker_size: int = 7, shows_base: bool = False
) -> LineMerge:
    """Merge what changed between `base` and `theirs` into `ours`. Raise GitError for what git takes for binary.

    With `shows_base` each conflict also shows what stood there before.
    """
    labels = ("-L", "ours", "-L", "base", "-L", "theirs")
    style = ("--diff3",) if shows_base else ()
    with tempfile.TemporaryDirectory(prefix="archgen-") as folder_name:
        folder = Path(folder_name)
        for name, content in (("ours", ours), ("base", base), ("theirs", theirs)):
            (folder / name).write_bytes(content)
        result = run_git(
            folder, "merge-file", "-p", *style, f"--marker-size={marker_size}", *labels, "ours", "base", "theirs"
        )
    if result.status > _MAX_CONFLICTS or result.status < 0:
        msg = f"git cannot merge these texts: {result.error_text}"
        raise GitError(msg)
    return LineMerge(result.output, result.status)
