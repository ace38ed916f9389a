"""Guess which path was meant by one that names nothing: a slip in one part, or an element that was moved."""

from __future__ import annotations

import re
from collections.abc import Collection, Sequence

from archgen.diagnostics import find_closest, join_words
from archgen.frozen import dataclass, field
from archgen.model.path_resolver import PathResolver

# How many parts the complete path of each kind has where no component holds others: a reference with more parts cannot
# mean that kind.
_PATH_LENGTHS = {"group": 1, "node": 1, "component": 2, "output": 3, "input": 3}
_GUESS_BUDGET = 300_000
"""How many names may be compared with mistyped ones in one run: some dozen guesses among the names of 10,000
components, as many as anybody needs in a project of usual size. What comes later is reported without a guess. Without
the limit, thousands of unknown references would take time that grows with the square of the project.
"""


@dataclass(slots=True)
class PathGuesser:
    """Guesses paths among all that can be named. `extra_depth` is how many more parts the longest ids have than usual."""

    names: PathResolver
    extra_depth: int = 0
    _guesses_left: int = _GUESS_BUDGET
    _candidate_paths: dict[tuple[str, int], tuple[str, ...]] = field(default_factory=dict)

    def guess_name(self, word: str, candidates: Collection[str]) -> str | None:
        """Return the candidate that a name most likely stands for, as long as the budget for guesses lasts."""
        # Set to zero, not left as it is: from here on no reference gets a guess, not even one with a smaller pool.
        if len(candidates) > self._guesses_left:
            self._guesses_left = 0
            return None
        self._guesses_left -= len(candidates)
        return find_closest(word, candidates)

    def guess_path(self, dotted_path: str, kinds: Sequence[str]) -> str | None:
        """Return the path that was most likely meant, or None.

        First among paths with the same last part (few, and a slip is usually in one part only), then among all paths of
        the same length; at last without leading parts, in case an element was moved to another group.
        """
        if not self._guesses_left:
            return None
        plain_path = re.sub(r"::|/", ".", dotted_path)
        if plain_path != dotted_path and self.names.resolve_path(plain_path, kinds).unique_element:
            return plain_path
        length = dotted_path.count(".") + 1
        fitting_kinds = [kind for kind in kinds if _PATH_LENGTHS[kind] + self.extra_depth >= length]
        last = dotted_path.rpartition(".")[2]
        # A set of ends: two complete paths with the same end are one candidate, since the guess has the length of the
        # reference that somebody wrote.
        near_paths = {
            take_path_end(path, length) for kind in fitting_kinds for path in self.names.ids_ending_in(kind, last)
        }
        guess = self.guess_name(dotted_path, near_paths) if length > 1 and near_paths else None
        if guess is None:
            candidates = (
                set().union(*(self._list_candidate_paths(kind, length) for kind in fitting_kinds))
                if fitting_kinds
                else ()
            )
            guess = self._guess_last_part(dotted_path, candidates)
        while guess is None and "." in dotted_path:
            dotted_path = dotted_path.partition(".")[2]
            moved_element = self.names.resolve_path(dotted_path, kinds).unique_element
            guess = moved_element.id if moved_element else None
        return guess

    def _guess_last_part(self, dotted_path: str, candidates: Collection[str]) -> str | None:
        """Return the nearest path; what has the same leading parts is near by its last one alone: `eye.debug` is no `eye.apples`."""
        start = dotted_path[: dotted_path.rfind(".") + 1]
        siblings = {path for path in candidates if start and path.startswith(start)}
        last_part = (
            self.guess_name(dotted_path[len(start) :], {path[len(start) :] for path in siblings}) if siblings else None
        )
        return start + last_part if last_part else self.guess_name(dotted_path, set(candidates) - siblings)

    def _list_candidate_paths(self, kind: str, length: int) -> tuple[str, ...]:
        key = (kind, length)
        if key not in self._candidate_paths:
            self._candidate_paths[key] = tuple(
                path for path in self.names.path_endings(kind) if path.count(".") == length - 1
            )
        return self._candidate_paths[key]


def list_possible_kinds(kinds: Sequence[str], length: int) -> str:
    """Return the kinds that a path of some length can mean, as words: "component or output"."""
    possible = [kind for kind in kinds if _PATH_LENGTHS[kind] >= length] or [kinds[-1]]
    return join_words(possible, "or")


def take_path_end(path: str, length: int) -> str:
    """Return the last parts of a path."""
    return ".".join(path.split(".")[-length:])
