"""An index of what components hold, so that a rule looks at few of them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from archgen.passes.patterns.matching import IndexToken, list_tokens
from archgen.passes.patterns.pattern_shapes import ViewValue


class ComponentIndex:
    """Finds components by tokens. What is stale is read again when somebody asks."""

    def __init__(self, get_component: Callable[[str], Mapping[str, ViewValue] | None]) -> None:
        """Take what says what a component has, None where there is none any more."""
        self._get_component = get_component
        self._order: dict[str, int] = {}
        self._next_number = 0
        self._tokens: dict[str, tuple[IndexToken, ...]] = {}
        self._postings: dict[IndexToken, dict[str, None]] = {}
        self._sorted: dict[IndexToken, list[str]] = {}
        self._stale: dict[str, None] = {}

    def add(self, path: str) -> None:
        """Take up a component, behind all others."""
        self._order[path] = self._next_number
        self._next_number += 1
        self._stale[path] = None

    def mark_stale(self, path: str) -> None:
        """Read a component again: it has changed, or is gone."""
        self._stale[path] = None

    def find_having(self, token: IndexToken) -> Sequence[str]:
        """Return the components that a token finds, in order."""
        self._renew()
        if token not in self._sorted:
            self._sorted[token] = sorted(self._postings.get(token, ()), key=self._order.__getitem__)
        return self._sorted[token]

    def count_having(self, token: IndexToken) -> int:
        """Return how many components a token finds."""
        self._renew()
        return len(self._postings.get(token, ()))

    def _renew(self) -> None:
        if not self._stale:
            return
        stale_paths, self._stale = self._stale, {}
        for path in stale_paths:
            for token in self._tokens.pop(path, ()):
                del self._postings[token][path]
                self._sorted.pop(token, None)
            body = self._get_component(path)
            if body is not None:
                tokens = tuple(dict.fromkeys(list_tokens(body)))
                self._tokens[path] = tokens
                for token in tokens:
                    self._postings.setdefault(token, {})[path] = None
                    self._sorted.pop(token, None)
