"""Names of types with what generic ones stand for: `filter<Pose>`, `pair<Pose, Envelope<Twist>>`."""

from __future__ import annotations

import re
from collections.abc import Mapping

from archgen.frozen import NamedTuple
from archgen.model.generic_names import MAX_NAME_LENGTH, read_generic_name

MAX_TYPE_LENGTH = 2 * MAX_NAME_LENGTH
"""So many letters the name of a bound type may have: a generic type that holds itself twice doubles it each time."""
_WORD = re.compile(r"[^<>,]+")
_ARRAY = re.compile(r"\[(?:<=)?[0-9]*\]\Z")


class TypeExpression(NamedTuple):
    """A type's name, and the types that its generic names stand for; none where it is not generic."""

    name: str
    arguments: tuple[str, ...]

    def __str__(self) -> str:
        """Return the expression as it is written."""
        return f"{self.name}<{', '.join(self.arguments)}>" if self.arguments else self.name


def parse_type_expression(text: str) -> TypeExpression | None:
    """Return the parts of `name<A, B<C>>`; None if its brackets do not match or something is missing."""
    generic_name = read_generic_name(text.strip())
    if not generic_name.base or not {"<", ">"}.isdisjoint(generic_name.base):
        return None
    return TypeExpression(generic_name.base, generic_name.arguments)


def bind_type_name(text: str, bindings: Mapping[str, str]) -> str:
    """Return a type's name, or an array of it, with generic names replaced, also those inside of brackets."""
    if text in bindings:
        return bindings[text]
    if (array := _ARRAY.search(text)) is not None:
        return bind_type_name(text[: array.start()], bindings) + array[0]
    if "<" not in text:
        return text
    return _WORD.sub(lambda match: _bind_word(match[0], bindings), text)


def _bind_word(word: str, bindings: Mapping[str, str]) -> str:
    bare = word.strip()
    return word.replace(bare, bindings[bare], 1) if bare in bindings else word
