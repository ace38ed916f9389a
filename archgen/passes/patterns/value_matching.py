"""Match a pattern against one value: mappings, lists, texts, and the names of generic types. All work is counted in steps."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from archgen.model.generic_names import read_generic_name
from archgen.passes.patterns.pattern_shapes import (
    ANY_NAME,
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


def match_value(pattern: Pattern, value: ViewValue, bindings: Bindings, budget: MatchBudget) -> Iterator[Bindings]:
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
            for bound in match_value(entry.value, mapping[key], bindings, budget):
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
        for with_key in match_value(entry.key, name, bindings, budget):
            for bound in match_value(entry.value, value, with_key, budget):
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
            for bound in match_value(items[0], value, bindings, budget):
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
    for bound in match_value(entry.key, generic_name.base, bindings, budget):
        yield from _match_arguments(arguments, generic_name.arguments, bound, budget)


def _match_arguments(
    patterns: tuple[Pattern, ...], names: tuple[str, ...], bindings: Bindings, budget: MatchBudget
) -> Iterator[Bindings]:
    if not patterns:
        yield bindings
        return
    for bound in match_value(patterns[0], names[0], bindings, budget):
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
