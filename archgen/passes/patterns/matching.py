"""Match patterns against values and a view of an architecture: pattern and view in, bindings out. Nothing else is known
here.

Which pattern of a component is tried next is decided by how few components it can mean, from an index of what components
hold. All work is counted in steps, so that the same input ends at the same place on every computer.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Protocol

from archgen.frozen import NamedTuple
from archgen.model.generic_names import read_generic_name
from archgen.passes.patterns.pattern_shapes import (
    ANY_NAME,
    INNER_KEY,
    TYPE_KEYS,
    Bindings,
    Constant,
    ListPattern,
    MappingPattern,
    Pattern,
    PatternEntry,
    PortReference,
    TextPattern,
    Variable,
    ViewValue,
)

MAX_TEXT = 10_000
"""How long a text may be that is put together of others: one of which each is the one before twice soon fills the memory."""


class BudgetExceededError(Exception):
    """Matching took more steps than it may take, or a text is longer than `MAX_TEXT`."""


class MatchBudget:
    """Counts the steps of matching down."""

    def __init__(self, steps: int) -> None:
        self.steps = steps
        self.remaining = steps

    def spend(self, steps: int = 1) -> None:
        """Take steps away. Raise BudgetExceededError when there are none left."""
        self.remaining -= steps
        if self.remaining < 0:
            raise BudgetExceededError


def _match_value(pattern: Pattern, value: ViewValue, bindings: Bindings, budget: MatchBudget) -> Iterator[Bindings]:
    """Yield the bindings under which a value is what a pattern asks for."""
    budget.spend()
    if not isinstance(pattern, _BRANCHING_PATTERNS):
        bound = _match_leaf(pattern, value, bindings)
        if bound is not None:
            yield bound
    elif isinstance(pattern, ListPattern):
        if isinstance(value, list) and (pattern.items or not value):
            yield from _match_items(pattern.items, value, frozenset(), bindings, budget)
    elif isinstance(value, dict):
        yield from _match_entries(pattern.entries, value, bindings, budget)
    elif isinstance(value, str):
        yield from _match_term(pattern, value, bindings, budget)


_BRANCHING_PATTERNS = (ListPattern, MappingPattern)
"""Patterns that a value may match in several ways."""


def _match_leaf(pattern: Pattern, value: ViewValue, bindings: Bindings) -> Bindings | None:
    """Return the bindings under which a value is what a pattern asks for, None where it is not."""
    if isinstance(pattern, Variable):
        if pattern.name not in bindings:
            return {**bindings, pattern.name: value}
        return bindings if bindings[pattern.name] == value else None
    if isinstance(pattern, Constant):
        return bindings if pattern.text == value else None
    if isinstance(pattern, TextPattern):
        return match_text(pattern, value, bindings)
    return bindings


def _match_entries(
    entries: tuple[PatternEntry, ...], mapping: dict[str, ViewValue], bindings: Bindings, budget: MatchBudget
) -> Iterator[Bindings]:
    while entries:
        # Keys that are known first: they leave the fewest ways.
        chosen, key = 0, None
        for index, entry in enumerate(entries):
            key = resolve_text(entry.key, bindings)
            if key is not None:
                chosen = index
                break
        entry, rest = entries[chosen], entries[:chosen] + entries[chosen + 1 :]
        if key is None:
            yield from _match_each_key(entry, rest, mapping, bindings, budget)
            return
        if key not in mapping:
            return
        if isinstance(entry.value, _BRANCHING_PATTERNS):
            for bound in _match_value(entry.value, mapping[key], bindings, budget):
                yield from _match_entries(rest, mapping, bound, budget)
            return
        budget.spend()
        matched = _match_leaf(entry.value, mapping[key], bindings)
        if matched is None:
            return
        entries, bindings = rest, matched
    yield bindings


def _match_each_key(
    entry: PatternEntry,
    rest: tuple[PatternEntry, ...],
    mapping: dict[str, ViewValue],
    bindings: Bindings,
    budget: MatchBudget,
) -> Iterator[Bindings]:
    for name, value in mapping.items():
        for with_key in _match_value(entry.key, name, bindings, budget):
            for bound in _match_value(entry.value, value, with_key, budget):
                yield from _match_entries(rest, mapping, bound, budget)


def _match_items(
    items: tuple[Pattern, ...],
    values: list[ViewValue],
    taken_places: frozenset[int],
    bindings: Bindings,
    budget: MatchBudget,
) -> Iterator[Bindings]:
    if not items:
        yield bindings
        return
    for index, value in enumerate(values):
        if index not in taken_places:
            for bound in _match_value(items[0], value, bindings, budget):
                yield from _match_items(items[1:], values, taken_places | {index}, bound, budget)


def _match_term(pattern: MappingPattern, text: str, bindings: Bindings, budget: MatchBudget) -> Iterator[Bindings]:
    """Match `{Envelope: $t}` against the name of a type."""
    generic_name = read_generic_name(text)
    if len(pattern.entries) != 1 or not generic_name.arguments:
        return
    entry = pattern.entries[0]
    arguments = entry.value.items if isinstance(entry.value, ListPattern) else (entry.value,)
    if len(arguments) != len(generic_name.arguments):
        return
    for bound in _match_value(entry.key, generic_name.base, bindings, budget):
        yield from _match_arguments(arguments, generic_name.arguments, bound, budget)


def _match_arguments(
    patterns: tuple[Pattern, ...], names: tuple[str, ...], bindings: Bindings, budget: MatchBudget
) -> Iterator[Bindings]:
    if not patterns:
        yield bindings
        return
    for bound in _match_value(patterns[0], names[0], bindings, budget):
        yield from _match_arguments(patterns[1:], names[1:], bound, budget)


def resolve_text(pattern: Pattern, bindings: Bindings) -> str | None:
    """Return the text that a pattern stands for, None where it is none or a variable of it is not bound yet."""
    if isinstance(pattern, Constant):
        return pattern.text
    if isinstance(pattern, Variable):
        value = bindings.get(pattern.name)
        return value if isinstance(value, str) else None
    if isinstance(pattern, TextPattern):
        words: list[str] = []
        for part in pattern.parts:
            word = part if isinstance(part, str) else bindings.get(part.name)
            if not isinstance(word, str):
                return None
            words.append(word)
        return join_words(words)
    return None


def join_words(words: Sequence[str]) -> str:
    """Return a text of several. Raise BudgetExceededError for one that is too long."""
    if sum(map(len, words)) > MAX_TEXT:
        raise BudgetExceededError
    return "".join(words)


def match_text(pattern: TextPattern, value: ViewValue, bindings: Bindings) -> Bindings | None:
    """Return the bindings under which a text is what a pattern asks for, None where it is not.

    It is taken apart in one way only: the last ids of a path stand for one id each; elsewhere the first text that fits
    ends a variable.
    """
    if not isinstance(value, str):
        return None
    whole = resolve_text(pattern, bindings)
    if whole is not None:
        return bindings if whole == value else None
    # A whole component is not a port of the one around it.
    if isinstance(value, PortReference) and value.port is None:
        return None
    words = _split_path(pattern, value) if pattern.is_path else _split_text(pattern, value, bindings)
    return None if words is None else _bind_words(pattern, words, bindings)


def _bind_words(pattern: TextPattern, words: list[str], bindings: Bindings) -> Bindings | None:
    bound = dict(bindings)
    for part, word in zip(pattern.parts, words, strict=True):
        if isinstance(part, Variable):
            if not word or (part.name in bound and bound[part.name] != word):
                return None
            if part.name != ANY_NAME:
                bound[part.name] = word
        elif part != word:
            return None
    return bound


def _split_path(pattern: TextPattern, value: str) -> list[str] | None:
    """Return the parts of a path: the first variable takes what the others leave."""
    words: list[str] = []
    rest = value
    for index in range(len(pattern.parts) - 1, -1, -1):
        part = pattern.parts[index]
        if isinstance(part, str):
            if not rest.endswith(part):
                return None
            words.append(part)
            rest = rest[: len(rest) - len(part)]
        else:
            cut = rest.rfind(".") + 1 if any(isinstance(each, Variable) for each in pattern.parts[:index]) else 0
            if index == 1 and isinstance(pattern.parts[0], str):
                cut = len(pattern.parts[0])
            words.append(rest[cut:])
            rest = rest[:cut]
    return None if rest else words[::-1]


def _split_text(pattern: TextPattern, value: str, bindings: Bindings) -> list[str] | None:
    words: list[str] = []
    rest = value
    for index, part in enumerate(pattern.parts):
        known = part if isinstance(part, str) else bindings.get(part.name)
        if isinstance(known, str):
            if not rest.startswith(known):
                return None
            words.append(known)
            rest = rest[len(known) :]
            continue
        following = pattern.parts[index + 1] if index + 1 < len(pattern.parts) else None
        if following is None:
            end = len(rest)
        elif isinstance(following, str):
            end = rest.rfind(following) if index + 2 == len(pattern.parts) else rest.find(following, 1)
        else:
            end = 1
        if end < 1:
            return None
        words.append(rest[:end])
        rest = rest[end:]
    return None if rest else words


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
            for inner in _match_value(entry.value, body, bound, self.budget):
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
        return next(_match_value(key, name, bindings, self.budget), None)

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
