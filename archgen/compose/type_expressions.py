"""Names of types with what generic ones stand for: `filter<Pose>`, `Envelope<Pair<Pose, Twist>>`."""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import lru_cache
from typing import NamedTuple

MAX_TYPE_LENGTH = 1000
"""So many letters the name of a bound type may have: a generic type that holds itself twice doubles it each time."""
_WORD = re.compile(r"[^<>,]+")


class TypeExpression(NamedTuple):
    """A type's name, and the types that its generic names stand for; none where it is not generic."""

    name: str
    arguments: tuple[str, ...]

    def __str__(self) -> str:
        """Return the expression as it is written."""
        return f"{self.name}<{', '.join(self.arguments)}>" if self.arguments else self.name


@lru_cache(1024)
def parse_type_expression(text: str) -> TypeExpression | None:
    """Return the parts of `name<A, B<C>>`; None if its brackets do not match or something is missing."""
    name, bracket, rest = text.strip().partition("<")
    if not bracket:
        return TypeExpression(name.strip(), ()) if ">" not in name and name.strip() else None
    if not rest.endswith(">"):
        return None
    arguments = _split_arguments(rest[:-1])
    if not name.strip() or not arguments or not all(arguments):
        return None
    return TypeExpression(name.strip(), arguments)


def _split_arguments(text: str) -> tuple[str, ...] | None:
    """Return the parts between commas that stand in no further brackets; None if brackets do not match."""
    parts, depth, start = [], 0, 0
    for position, letter in enumerate(text):
        depth += (letter == "<") - (letter == ">")
        if depth < 0:
            return None
        if letter == "," and depth == 0:
            parts.append(text[start:position].strip())
            start = position + 1
    return None if depth else (*parts, text[start:].strip())


def bind_type_name(text: str, bindings: Mapping[str, str]) -> str:
    """Return a type's name with generic names replaced, also those inside of brackets."""
    if text in bindings:
        return bindings[text]
    if "<" not in text:
        return text
    return _WORD.sub(lambda match: _bind_word(match[0], bindings), text)


def _bind_word(word: str, bindings: Mapping[str, str]) -> str:
    bare = word.strip()
    return word.replace(bare, bindings[bare], 1) if bare in bindings else word
