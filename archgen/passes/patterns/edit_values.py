"""What a rule writes, worked out under the bindings of a match: plain data in the language's normal form."""

from __future__ import annotations

from collections.abc import Mapping

from archgen.model.generic_names import write_generic_name
from archgen.passes.patterns.pattern_shapes import (
    TYPE_KEYS,
    Anything,
    Bindings,
    Constant,
    ListPattern,
    MappingPattern,
    Pattern,
    ScalarText,
    TextPattern,
    Variable,
    ViewValue,
)
from archgen.passes.patterns.text_matching import resolve_text
from archgen.schema.short_forms import ElementForm


class EditError(Exception):
    """What a rule writes cannot be written. Carries what is wrong, and what to do."""

    def __init__(self, message: str, help_line: str | None = None) -> None:
        """Take what to say."""
        super().__init__(message)
        self.help_line = help_line


def fill_pattern(pattern: Pattern, bindings: Bindings, key: str = "") -> ViewValue:
    """Return what a pattern is with its variables bound; None for what is left empty."""
    if isinstance(pattern, Anything):
        return None
    if isinstance(pattern, Variable):
        return bindings[pattern.name]
    if isinstance(pattern, Constant):
        # Without its place: what is made carries that of what it is made from.
        return ScalarText(pattern.text, pattern.text.value)
    if isinstance(pattern, ListPattern):
        return [fill_pattern(item, bindings, key) for item in pattern.items]
    text = resolve_text(pattern, bindings)
    if isinstance(pattern, TextPattern) and text is not None:
        return text
    if not isinstance(pattern, MappingPattern):
        message = "a text is made of texts, and one of these variables stands for a list or a mapping"
        raise EditError(message)
    return _fill_mapping(pattern, bindings, key)


def _fill_mapping(pattern: MappingPattern, bindings: Bindings, key: str) -> ViewValue:
    entries = {fill_key(entry.key, bindings): entry.value for entry in pattern.entries}
    if key in TYPE_KEYS and len(entries) == 1:
        return _fill_term(*next(iter(entries.items())), bindings)
    return {name: fill_pattern(value, bindings, name) for name, value in entries.items()}


def fill_key(pattern: Pattern, bindings: Bindings) -> str:
    """Return the text that stands as a key."""
    text = resolve_text(pattern, bindings)
    if text is None:
        message = "a key is a text, and this variable stands for a list or a mapping"
        raise EditError(message)
    if not text:
        message = "a key is empty"
        raise EditError(message, "leave out in `where` what gives no text")
    return str(text)


def _fill_term(name: str, argument: Pattern, bindings: Bindings) -> str:
    """Return `Envelope<Pose>` of `{Envelope: $t}`."""
    items = argument.items if isinstance(argument, ListPattern) else (argument,)
    words = [fill_pattern(item, bindings, "type") for item in items]
    if not all(isinstance(word, str) for word in words):
        message = f"`{name}` is made of the names of types, and one of these is none"
        raise EditError(message)
    return write_generic_name(f"{name}<{', '.join(map(str, words))}>")


def expand_value(value: ViewValue, form: ElementForm) -> ViewValue:
    """Return what is written with its short forms written out, as a file's are."""
    if not isinstance(value, dict):
        if value is None:
            return {}
        return {key: _expand_leaf(key, value, form) for key in form.short_keys} if form.short_keys else value
    return {key: _expand_entry(key, each, form) for key, each in value.items()}


def _expand_entry(key: str, value: ViewValue, form: ElementForm) -> ViewValue:
    if key in form.part_forms and value is not None:
        return expand_value(value, form.part_forms[key])
    if key in form.keyed_forms and isinstance(value, Mapping):
        return {name: expand_value(each, form.keyed_forms[key]) for name, each in value.items()}
    return _expand_leaf(key, value, form)


def _expand_leaf(key: str, value: ViewValue, form: ElementForm) -> ViewValue:
    return [value] if key in form.list_keys and isinstance(value, str) else value
