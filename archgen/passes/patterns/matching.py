"""Match patterns against a view of an architecture: a view and a pattern in, bindings out. Nothing else is known here.

Which pattern of a component is tried next is decided by how few components it can mean, from an index of what components
hold. All work is counted in steps, so that the same input ends at the same place on every computer.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Protocol

from archgen.frozen import NamedTuple
from archgen.passes.patterns.pattern_shapes import (
    INNER_KEY,
    TYPE_KEYS,
    Bindings,
    ListPattern,
    MappingPattern,
    Pattern,
    PatternEntry,
    Variable,
    ViewValue,
)
from archgen.passes.patterns.value_matching import MatchBudget, match_value, resolve_text

INDEXED_DEPTH = 3
"""So deep below a component its keys and texts are found by the index: `inputs`, the port, its `type`."""
COMPONENTS = "components"
"""The section of components, the only one with an index."""
IndexToken = tuple[str, ...]
"""What the index knows a component by: `(key,)` for a key that it has, `(key, text)` for a text below a key."""


class PatternView(Protocol):
    """What rules see of an architecture."""

    def list_elements(self, section: str) -> Sequence[str]:
        """Return the paths or names of all that stands in a section (`components`, `types`, ...), in order."""
        ...

    def get_element(self, section: str, name: str) -> dict[str, ViewValue] | None:
        """Return what an element of a section has, None where there is none."""
        ...

    def find_having(self, token: IndexToken) -> Sequence[str]:
        """Return the paths of the components that the index knows by a token, in order."""
        ...

    def count_having(self, token: IndexToken) -> int:
        """Return how many components the index knows by a token."""
        ...

    def is_a(self, name: str, type_name: str) -> bool:
        """Whether a type, or a component, is one, or made from it."""
        ...


class SectionEntry(NamedTuple):
    """What a rule looks for in a section: one element, by its key."""

    section: str
    entry: PatternEntry


class ViewPattern(NamedTuple):
    """What a rule looks for: components first, then conceptual types and the rest."""

    entries: tuple[SectionEntry, ...] = ()


def list_tokens(body: Mapping[str, ViewValue], depth: int = INDEXED_DEPTH) -> Iterator[IndexToken]:
    """Yield what the index knows a component by."""
    for key, value in body.items():
        if key != INNER_KEY or depth < INDEXED_DEPTH:
            yield (key,)
            yield from _list_value_tokens(key, value, depth)


def _list_value_tokens(key: str, value: ViewValue, depth: int) -> Iterator[IndexToken]:
    if isinstance(value, str):
        yield (key, value)
    elif isinstance(value, list):
        for item in value:
            if isinstance(item, str):
                yield (key, item)
    elif isinstance(value, dict) and depth > 1:
        yield from list_tokens(value, depth - 1)


def match_view(
    pattern: ViewPattern, view: PatternView, bindings: Bindings, budget: MatchBudget, distinct: frozenset[str]
) -> Iterator[Bindings]:
    """Yield the bindings under which a view holds what a pattern asks for; `bindings` are those made already.

    The variables in `distinct` bind different components.
    """
    yield from _Search(view, budget, distinct).match_entries(pattern.entries, bindings)


class _Search(NamedTuple):
    view: PatternView
    budget: MatchBudget
    distinct: frozenset[str]

    def match_entries(self, todo: tuple[SectionEntry, ...], bindings: Bindings) -> Iterator[Bindings]:
        if not todo:
            yield bindings
            return
        # Chosen anew at each level: what is bound by then may leave another entry the fewest candidates, and each candidate
        # multiplies the rest of the search.
        chosen, token = self._choose_entry(todo, bindings)
        section, entry = todo[chosen]
        rest = todo[:chosen] + todo[chosen + 1 :]
        for name in self._list_candidates(section, entry, token, bindings):
            self.budget.spend()
            bound = self._bind_key(section, entry.key, name, bindings)
            if bound is None:
                continue
            body = self.view.get_element(section, name)
            if body is None:
                continue
            for inner in match_value(entry.value, body, bound, self.budget):
                yield from self.match_entries(rest, inner)

    def _bind_key(self, section: str, key: Pattern, name: str, bindings: Bindings) -> Bindings | None:
        if isinstance(key, Variable):
            if key.name in bindings:
                if bindings[key.name] != name:
                    return None
            else:
                bindings = {**bindings, key.name: name}
            taken_by_other = section == COMPONENTS and any(
                other != key.name and bindings.get(other) == name for other in self.distinct
            )
            return None if taken_by_other else bindings
        return next(match_value(key, name, bindings, self.budget), None)

    def _choose_entry(self, todo: tuple[SectionEntry, ...], bindings: Bindings) -> tuple[int, IndexToken | None]:
        """Return which entry can mean the fewest elements, and the token of the index that finds these."""
        best: tuple[int, int, IndexToken | None] | None = None
        for index, (section, entry) in enumerate(todo):
            self.budget.spend()
            if resolve_text(entry.key, bindings) is not None:
                return index, None
            token = None
            count = len(self.view.list_elements(section))
            if section == COMPONENTS:
                for each in _list_pattern_tokens(entry.value, bindings, INDEXED_DEPTH):
                    having = self.view.count_having(each)
                    if having < count:
                        count, token = having, each
            if best is None or count < best[0]:
                best = (count, index, token)
        assert best is not None  # noqa: S101 - there is an entry
        return best[1], best[2]

    def _list_candidates(
        self, section: str, entry: PatternEntry, token: IndexToken | None, bindings: Bindings
    ) -> Sequence[str]:
        text = resolve_text(entry.key, bindings)
        if text is not None:
            return (text,)
        return self.view.list_elements(section) if token is None else self.view.find_having(token)


def _list_pattern_tokens(pattern: Pattern, bindings: Bindings, depth: int) -> Iterator[IndexToken]:
    """Yield tokens that the index knows every component by that a pattern can mean."""
    for entry in pattern.entries if isinstance(pattern, MappingPattern) else ():
        key = resolve_text(entry.key, bindings)
        if key is not None:
            yield (key,)
            for value in entry.value.items if isinstance(entry.value, ListPattern) else (entry.value,):
                text = resolve_text(value, bindings)
                if text is not None:
                    yield (key, text)
        # `{Envelope: $t}` is the name of a generic type, and no mapping.
        if depth > 1 and key not in TYPE_KEYS:
            yield from _list_pattern_tokens(entry.value, bindings, depth - 1)
