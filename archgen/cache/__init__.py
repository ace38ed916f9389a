"""Folders of files that a later run may use again: safe to delete, never part of the output."""

from __future__ import annotations

import os

KEPT_VERBS: tuple[str, ...] = ("check", "generate")
"""Verbs whose runs are kept: their words follow from what they read, not from the time, nor from what git or somebody at the keyboard says."""
SETTLED_NANOSECONDS = 2_000_000_000
"""File systems have clocks that tick as slowly as this: what changed later may change again at the same tick."""


def find_cache_path() -> str | None:
    """Return the path of the cache folder, None where the system has no place for it."""
    base = os.environ.get("XDG_CACHE_HOME") or os.path.expanduser("~/.cache")  # noqa: PTH111 - pathlib takes longer to load than a run that is repeated takes
    return None if base.startswith("~") else os.path.join(base, "archgen")  # noqa: PTH118 - as above
