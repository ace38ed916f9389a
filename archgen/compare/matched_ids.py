"""Which element is which: ids of the first version with the ids that the same elements have in the second."""

from __future__ import annotations

import re

from archgen.frozen import dataclass, field

_BACKTICKED = re.compile(r"`[^`]*`")
_ID_PATH = re.compile(r"[A-Za-z0-9_]+(?:[./-][A-Za-z0-9_]+)*")


@dataclass(slots=True)
class MatchedIds:
    """Pairs of ids by kind: each matched element is in `new_ids` (old -> new) and in `old_ids` (new -> old).

    `confidence` has, by kind and new id, how sure a pair is that was found by likeness. Without pairs, all ids stay as
    they are: an empty `MatchedIds()` stands for the second version itself.
    """

    new_ids: dict[str, dict[str, str]] = field(default_factory=dict)
    old_ids: dict[str, dict[str, str]] = field(default_factory=dict)
    confidence: dict[tuple[str, str], float] = field(default_factory=dict)
    _renamed_paths: dict[str, str] = field(default_factory=dict)

    @property
    def has_renames(self) -> bool:
        """Whether an element of the project has another id now."""
        return bool(self._renamed_paths)

    def add_pair(self, kind: str, old_id: str, new_id: str, confidence: float | None = None) -> None:
        """Record that two ids mean one element, with a confidence if that was recognised only by likeness."""
        self.new_ids.setdefault(kind, {})[old_id] = new_id
        self.old_ids.setdefault(kind, {})[new_id] = old_id
        if confidence is not None:
            self.confidence[kind, new_id] = confidence
        # A project's id is not part of any element's path.
        if old_id != new_id and kind != "project":
            self._remember_rename(old_id, new_id)

    def common_id(self, kind: str, old_id: str) -> str:
        """Return the id in the second version; for a removed element, the id that it had."""
        return self.new_ids.get(kind, {}).get(old_id, old_id)

    def find_new_id(self, kind: str, old_id: str) -> str | None:
        """Return the id in the second version, None for an element without a match (so far)."""
        return self.new_ids.get(kind, {}).get(old_id)

    def is_matched(self, kind: str, new_id: str) -> bool:
        """Whether an element of the second version has a match (so far)."""
        return new_id in self.old_ids.get(kind, {})

    def rename_in_text(self, text: str) -> str:
        """Replace renamed ids in a text such as a selector."""
        return _ID_PATH.sub(lambda found: self._rename_path(found[0]), text) if self._renamed_paths else text

    def rename_in_backticks(self, text: str) -> str:
        """Replace renamed ids between the backticks of a text."""
        return _BACKTICKED.sub(lambda found: self.rename_in_text(found[0]), text) if self._renamed_paths else text

    def _rename_path(self, path: str) -> str:
        """Return a path with its longest renamed beginning replaced."""
        # Topics are paths too: `/sensing/camera` follows the rename of `sensing.camera`.
        separator = "/" if "/" in path else "."
        parts = path.split(separator)
        for end in range(len(parts), 0, -1):
            new_path = self._renamed_paths.get(".".join(parts[:end]))
            if new_path:
                return separator.join([*new_path.split("."), *parts[end:]])
        return path

    def _remember_rename(self, old_id: str, new_id: str) -> None:
        """Record the rename of an id and of all its shorter forms."""
        old_parts, new_parts = old_id.split("."), new_id.split(".")
        for cut in range(min(len(old_parts), len(new_parts))):
            if old_parts[cut:] != new_parts[cut:]:
                # The first rename wins where two elements of different groups have one short name. Outer elements are
                # paired first.
                self._renamed_paths.setdefault(".".join(old_parts[cut:]), ".".join(new_parts[cut:]))
