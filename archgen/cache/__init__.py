"""Folders of files that a later run may use again: safe to delete, never part of the output."""

from __future__ import annotations

import os

TYPE_CHECKING = False
if TYPE_CHECKING:  # as type checkers read it, without loading `typing`
    from typing import Any

KEPT_VERBS: tuple[str, ...] = ("check", "generate", "build")
"""Verbs whose runs are kept: their words follow from what they read and what git says, not from the time, nor from somebody at the keyboard."""
note_git: Any = None
"""What notes each question to git and its answer while a run is noted: takes what asks git, the folder and the words."""
SETTLED_NANOSECONDS = 2_000_000_000
"""File systems have clocks that tick as slowly as this: what changed later may change again at the same tick."""


def find_cache_path() -> str | None:
    """Return the path of the cache folder, None where the system has no place for it."""
    base = os.environ.get("XDG_CACHE_HOME") or os.path.expanduser("~/.cache")  # noqa: PTH111 - pathlib takes longer to load than a run that is repeated takes
    return None if base.startswith("~") else os.path.join(base, "archgen")  # noqa: PTH118 - as above
