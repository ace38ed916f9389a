"""Ask git whether it ignores a file."""

from __future__ import annotations

from pathlib import Path

from archgen.git.git_call import run_git


def ignores_file(folder: Path, name: str) -> bool:
    """Whether git ignores a file that is in a folder. It does not where it keeps the file, and outside of a repository."""
    # Not `check-ignore`, which refuses to take names literally.
    return bool(run_git(folder, "ls-files", "--others", "--ignored", "--exclude-standard", "--", name).output)
