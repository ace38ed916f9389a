"""What editors show on a key: the kind of its value, its words and an example; and that a key may be left empty."""

from __future__ import annotations

import json
import re
from typing import Any

from archgen.diagnostics.common_wording import join_words

SchemaPart = dict[str, Any]
OFFERED_EXAMPLES = frozenset(
    {"bandwidth", "duration", "frequency", "size", "percentage", "latency", "execution_time", "timing_use"}
    | {"constant_type", "field_type"}
)
"""Definitions whose examples are offered: they show the form, and mean no element of another project."""
_WORD_PATTERN = re.compile(r"\^\(\?:([a-z0-9_|]+)\)\$\Z")
"""A pattern that lists words, as in the short form of `qos`."""
_PLAIN_TEXT = re.compile(r"(?![0-9.]+\Z)[A-Za-z0-9/](?:[^:#,\[\]{}\n]|:(?=\S))*\Z")
"""Text that needs no quotes in YAML, in lists neither."""
_TYPE_PHRASES = {
    "object": "a mapping",
    "array": "a list",
    "string": "text",
    "number": "a number",
    "integer": "a whole number",
    "boolean": "`true` or `false`",
}
NEVER_VALID: SchemaPart = {"not": {}}
"""What makes an alternative an offer only: editors list its words, but do not take it for what a value is. Else a hover
over one name would list all of them."""


def explain_part(part: SchemaPart, *, keeps_examples: bool) -> None:
    """Move the examples into the explanation, where they explain and are not offered as values."""
    examples = part.pop("examples", []) if not keeps_examples else []
    examples = [*examples, *(snippet["body"] for snippet in part.pop("defaultSnippets", []))]
    if "offers" in part:
        part["defaultSnippets"] = part.pop("offers")
    if "description" not in part:
        return
    if part.get("$ref", "").rpartition("/")[2] in OFFERED_EXAMPLES:
        examples = []
    blocks = [f"```yaml\n{_write_example(example)}\n```" for example in examples if example not in ({}, [])]
    part["markdownDescription"] = "\n\n".join((part["description"], *(f"Example:\n\n{block}" for block in blocks)))


def _write_example(value: object) -> str:
    """Return an example as YAML, in block style as far as a person would write it so."""
    if isinstance(value, dict):
        return "\n".join(_write_entry(key, below) for key, below in value.items())
    return _write_flow(value)


def _write_entry(key: str, value: object) -> str:
    if isinstance(value, dict):
        return "\n".join((f"{key}:", *(f"  {line}" for line in _write_example(value).splitlines())))
    return f"{key}: {_write_flow(value)}"


def _write_flow(value: object) -> str:
    if isinstance(value, list):
        return f"[{', '.join(map(_write_flow, value))}]"
    if isinstance(value, dict):
        return f"{{{', '.join(f'{key}: {_write_flow(below)}' for key, below in value.items())}}}"
    is_plain = isinstance(value, str) and _PLAIN_TEXT.match(value)
    return str(value) if is_plain else json.dumps(value, ensure_ascii=False)


def allow_empty(part: SchemaPart) -> None:
    """Take an empty value as it is, without offering `null` for it, and say in words which kinds of value are right.

    Language servers offer what `type` names: `null` everywhere, and `true` for a title. Below `else` they do not look
    for offers.
    """
    types = list_types(part)
    if "null" not in types:
        if "boolean" in types:
            part |= {"if": {}, "then": {"type": part.pop("type")}}
        return
    del part["type"]
    words = [word for word in part.pop("enum", []) if word is not None]
    kinds = [kind for kind in types if kind != "null"]
    # What stands outside of `else` decides what an editor writes behind the key: a value, or a list or mapping below it.
    moved_keys = ("if", "then", *(("items", "properties", "additionalProperties") if kinds[0] == "string" else ()))
    rest = {key: part.pop(key) for key in moved_keys if key in part}
    if kinds[0] == "array":
        # Else the entries of a list would be offered as the value behind the key.
        rest["items"], part["items"] = part["items"], {}
    part["if"] = {"type": "null"}
    part["else"] = {"type": kinds, "errorMessage": _describe_types(part, kinds, words), **rest}
    if words:
        part["else"]["enum"] = words
    _show_kind(part, kinds, words or _list_pattern_words(part, rest))


def _show_kind(part: SchemaPart, kinds: list[str], words: list[str]) -> None:
    """Give a part without `type` what editors need to write its key: `key:`, then a value or a new line."""
    offers = part.pop("anyOf", [{}])
    if kinds == ["boolean"]:
        offers.append({"enum": [True, False], **NEVER_VALID})
    if words:
        offers.append({"type": "string", "enum": words, **NEVER_VALID})
    if kinds[0] == "object":
        part.setdefault("properties", {})
    # A second alternative at least: with one that always holds, a hover would show it in place of the part.
    part["anyOf"] = offers if len(offers) > 1 else [*offers, dict(NEVER_VALID)]


def _list_pattern_words(part: SchemaPart, rest: SchemaPart) -> list[str]:
    """Return the words of a pattern that lists them, or of the enumeration that a text is held against."""
    match = _WORD_PATTERN.match(part.get("pattern", ""))
    return match[1].split("|") if match else rest.get("then", {}).get("enum", [])


def _describe_types(part: SchemaPart, kinds: list[str], words: list[str]) -> str:
    if words:
        return f"write {join_words([f'`{word}`' for word in words], 'or')}"
    explanation = part.get("patternErrorMessage")
    if explanation and "unit" in explanation:
        return f"write the unit, too: {explanation}"
    phrases = [_TYPE_PHRASES[kind] for kind in kinds if kind != "boolean" or "string" not in kinds]
    return explanation or f"write {join_words(phrases, 'or')}"


def list_types(part: SchemaPart) -> list[str]:
    """Return the types that a value of a part may have, in the words of JSON Schema."""
    types = part.get("type", [])
    return [types] if isinstance(types, str) else types
