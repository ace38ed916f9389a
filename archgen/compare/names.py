"""Who is who: the ids that elements have in the first version, and those of the same elements in the second."""

from __future__ import annotations

import re
from dataclasses import dataclass, field

_TICKED = re.compile(r"`[^`]*`")
_PATH = re.compile(r"[A-Za-z0-9_]+(?:[./-][A-Za-z0-9_]+)*")


@dataclass(slots=True)
class Names:
    """Pairs of ids by sort: every element that both versions have is in `ahead` (before -> after) and `back`.

    `confidence` holds, by sort and id after, how sure a pair is that does not have one id.
    """

    ahead: dict[str, dict[str, str]] = field(default_factory=dict)
    back: dict[str, dict[str, str]] = field(default_factory=dict)
    confidence: dict[tuple[str, str], float] = field(default_factory=dict)
    _renamed: dict[str, str] = field(default_factory=dict)

    def pair(self, sort: str, before: str, after: str, confidence: float | None = None) -> None:
        """Say that two ids mean one element; with a confidence where that was recognised only by likeness."""
        self.ahead.setdefault(sort, {})[before] = after
        self.back.setdefault(sort, {})[after] = before
        if confidence is not None:
            self.confidence[sort, after] = confidence
        if before != after and sort != "project":
            self._remember(before, after)

    def to(self, sort: str, before: str) -> str:
        """Give the id after; of what is gone, the id that it had."""
        return self.ahead.get(sort, {}).get(before, before)

    def known(self, sort: str, before: str) -> str | None:
        """Give the id after, None for what has no partner (yet)."""
        return self.ahead.get(sort, {}).get(before)

    def has(self, sort: str, after: str) -> bool:
        """Say whether an element of the second version has a partner (yet)."""
        return after in self.back.get(sort, {})

    def words(self, text: str) -> str:
        """Put the names of the second version into a text such as a selector."""
        return _PATH.sub(lambda found: self._path(found[0]), text) if self._renamed else text

    def ticked(self, text: str) -> str:
        """Put the names of the second version into what stands between backticks."""
        return _TICKED.sub(lambda found: self.words(found[0]), text) if self._renamed else text

    def _path(self, path: str) -> str:
        """Rename a path, or the longest beginning of it that was renamed."""
        separator = "/" if "/" in path else "."
        parts = path.split(separator)
        for end in range(len(parts), 0, -1):
            renamed = self._renamed.get(".".join(parts[:end]))
            if renamed:
                return separator.join([*renamed.split("."), *parts[end:]])
        return path

    def _remember(self, before: str, after: str) -> None:
        """Keep the id and all shorter ways to write it."""
        old, new = before.split("."), after.split(".")
        for cut in range(min(len(old), len(new))):
            if old[cut:] != new[cut:]:
                self._renamed.setdefault(".".join(old[cut:]), ".".join(new[cut:]))
