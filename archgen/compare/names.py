"""Which element is which: ids of the first version with the ids that the same elements have in the second."""

from __future__ import annotations

import re
from dataclasses import dataclass, field

_TICKED = re.compile(r"`[^`]*`")
_PATH = re.compile(r"[A-Za-z0-9_]+(?:[./-][A-Za-z0-9_]+)*")


@dataclass(slots=True)
class Names:
    """Pairs of ids by kind: each matched element is in `new_ids` (old -> new) and in `old_ids` (new -> old).

    `confidence` has, by kind and new id, how sure a pair is that was found by likeness. Without pairs, all ids stay as
    they are: an empty `MatchedIds()` stands for the second version itself.
    """

    ahead: dict[str, dict[str, str]] = field(default_factory=dict)
    back: dict[str, dict[str, str]] = field(default_factory=dict)
    confidence: dict[tuple[str, str], float] = field(default_factory=dict)
    _renamed: dict[str, str] = field(default_factory=dict)

    def pair(self, sort: str, before: str, after: str, confidence: float | None = None) -> None:
        """Record that two ids mean one element, with a confidence if that was recognised only by likeness."""
        self.ahead.setdefault(sort, {})[before] = after
        self.back.setdefault(sort, {})[after] = before
        if confidence is not None:
            self.confidence[sort, after] = confidence
        # A project's id is not part of any element's path.
        if before != after and sort != "project":
            self._remember(before, after)

    def to(self, sort: str, before: str) -> str:
        """Return the id in the second version; for a removed element, the id that it had."""
        return self.ahead.get(sort, {}).get(before, before)

    def known(self, sort: str, before: str) -> str | None:
        """Return the id in the second version, None for an element without a match (so far)."""
        return self.ahead.get(sort, {}).get(before)

    def has(self, sort: str, after: str) -> bool:
        """Whether an element of the second version has a match (so far)."""
        return after in self.back.get(sort, {})

    def words(self, text: str) -> str:
        """Replace renamed ids in a text such as a selector."""
        return _PATH.sub(lambda found: self._path(found[0]), text) if self._renamed else text

    def ticked(self, text: str) -> str:
        """Replace renamed ids between the backticks of a text."""
        return _TICKED.sub(lambda found: self.words(found[0]), text) if self._renamed else text

    def _path(self, path: str) -> str:
        """Return a path with its longest renamed beginning replaced."""
        # Topics are paths too: `/sensing/camera` follows the rename of `sensing.camera`.
        separator = "/" if "/" in path else "."
        parts = path.split(separator)
        for end in range(len(parts), 0, -1):
            renamed = self._renamed.get(".".join(parts[:end]))
            if renamed:
                return separator.join([*renamed.split("."), *parts[end:]])
        return path

    def _remember(self, before: str, after: str) -> None:
        """Record the rename of an id and of all its shorter forms."""
        old, new = before.split("."), after.split(".")
        for cut in range(min(len(old), len(new))):
            if old[cut:] != new[cut:]:
                # The first rename wins where two elements of different groups have one short name. Outer elements are
                # paired first.
                self._renamed.setdefault(".".join(old[cut:]), ".".join(new[cut:]))
