"""Texts with variables in them: what they come to, and how a text is taken apart by one."""

from __future__ import annotations

from archgen.passes.patterns.pattern_shapes import (
    ANY_NAME,
    Bindings,
    Constant,
    Pattern,
    PortReference,
    TextPattern,
    Variable,
    ViewValue,
)


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
        return "".join(words)
    return None


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
