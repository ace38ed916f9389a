"""Write `archgen/language/comparison_tables.py`: how a comparison of two versions reads, weighs and calls each key."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from language_description import SLICE, Description, Part, PlainData, list_accepted

EFFECTS = ("text", "system", "timing")
"""How far a change reaches, from the least."""
_FORMS = frozenset({"title", "prose", "layout", "properties", "hints", "value", "mapping"})
"""The normal forms that a description names; the others follow from what a part accepts."""
_PLAIN_FORMS = frozenset({"value", "layout"})
"""Forms of mappings that are compared as a whole."""
_CHOICES = {"effect": frozenset(EFFECTS), "worse": frozenset({"less", "more", "always"}), "form": _FORMS}
_SENTENCE_WORDS = ("noun", "verb", "verbs", "new_verb")
_OTHER_KINDS = frozenset({"message"})
"""Kinds of elements that a key may name although no file lists them: they follow from what other elements say."""
_LIST_FORMS = {"counts": "list", "headed": "value"}
_HEAD = '''\
"""How two versions are compared, as tables. Written by `make language` from the description in `language/`: edit that.

Without an `effect` a change reaches as far as timing; without `worse` it makes no figure worse; without a `form` the value
is compared as it is. A name with a dot stands for all keys that begin with it. `language/README.md` explains each word.
"""

# fmt: off
from __future__ import annotations

from collections.abc import Mapping
from typing import Literal, TypedDict


class KeyFacts(TypedDict, total=False):
    """What the comparison of a key needs to know."""

    form: str
    inner: str
    attribute: str
    default: str | int | tuple[str, ...]
    names: str
    effect: Literal["text", "system"]
    worse: Literal["less", "more", "always"]
    noun: str
    verb: str
    verbs: tuple[str, str]
    new_verb: str


'''
Facts = dict[str, PlainData]


def make_comparison_tables(description: Description) -> str:
    """Return the text of the module."""
    compared = _list_compared(description)
    effects = ", ".join(f'"{kind}": "{description.kinds[kind]["effect"]}"' for kind in compared)
    lines = [
        f"{_HEAD}KIND_EFFECTS: Mapping[str, Literal['text', 'system', 'timing']] = {{".replace("'", '"'),
        *_wrap_items(effects.split(", "), "    "),
        "}",
        '"""How far a change of an element of each kind reaches at most."""',
        "KEY_FACTS: Mapping[str, Mapping[str, KeyFacts]] = {",
        *(line for kind in compared for line in _format_kind(kind, list_key_facts(description, kind))),
        "}",
        '"""What is compared of each kind, in the order of its keys."""',
    ]
    return "\n".join([*lines, ""])


def _list_compared(description: Description) -> list[str]:
    """Return the kinds that are compared key by key: those that say how far a change of them reaches."""
    return [kind for kind, part in description.kinds.items() if "effect" in part and "form" not in part]


def list_key_facts(description: Description, kind: str) -> Mapping[str, Facts]:
    """Return what a comparison knows of each key of a kind, but for those whose changes are told elsewhere."""
    return {
        name: facts
        for key_name, key in description.keys_of(kind).items()
        if "told" not in key
        for name, facts in _list_rows(description, kind, key_name, key)
    }


def _list_rows(description: Description, kind: str, name: str, key: Part) -> Iterator[tuple[str, Facts]]:
    """Yield the key, or what stands for all keys below it; both where its value is a mapping or a scalar that is no short form."""
    part = description.type_of(key)
    accepted = set(list_accepted(part))
    limit = EFFECTS.index(description.kinds[kind]["effect"])
    form = key.get("form", part.get("form"))
    has_keys = "object" in accepted and form not in _PLAIN_FORMS
    has_both = has_keys and bool(accepted - {"object", "null"}) and "short" not in part
    if not has_keys or has_both:
        plain_form = _find_plain_form(part, accepted) if form in {None, "mapping"} else form
        yield name, _gather_facts(description, {"form": plain_form, **_without_form(part)}, key, limit)
    if has_keys:
        inner = key.get("type") if key.get("type") in _list_compared(description) else None
        facts: Facts = {"inner": inner} if inner else {"form": form or _find_mapping_form(description, part)}
        own = {word: value for word, value in key.items() if word == "attribute"} if has_both else key
        yield f"{name}.", _gather_facts(description, {**_without_form(part), **facts}, own, limit)


def _without_form(part: Part) -> Part:
    """Return what a part says for the keys at which it stands; a kind's own keys say for themselves what it is called."""
    return {word: part[word] for word in ("effect", "worse", "names", "offers", *_SENTENCE_WORDS) if word in part}


def _find_plain_form(part: Part, accepted: set[str]) -> str:
    if accepted - {"null"} == {"boolean"}:
        return "flag"
    return _LIST_FORMS.get(part["order"], "set") if "array" in accepted else "value"


def _find_mapping_form(description: Description, part: Part) -> str:
    """Return the form of a mapping: data is compared by its leaves; elements in it want a reader of their own."""
    if part.get("data"):
        return "data"
    entries = part.get("entries")
    holds_elements = "keys" in part or (isinstance(entries, str) and "keys" in description.parts[entries])
    return "entries" if holds_elements else "mapping"


def _gather_facts(description: Description, part: Part, key: Part, limit: int) -> Facts:
    said = {**part, **{word: value for word, value in key.items() if word != "form"}}
    effect = min(limit, EFFECTS.index(said.get("effect", EFFECTS[limit])))
    facts = {word: said[word] for word in ("form", "inner", "attribute", "default") if word in said}
    if facts.get("form") == "value":
        del facts["form"]
    if named := _find_named_kind(description, said):
        facts["names"] = named
    if effect < len(EFFECTS) - 1:
        facts["effect"] = EFFECTS[effect]
    return {**facts, **{word: said[word] for word in ("worse", *_SENTENCE_WORDS) if word in said}}


def _find_named_kind(description: Description, said: Part) -> str | None:
    """Return the kind of the elements that a value names: the one it says, or that of the section that it offers."""
    if "names" in said:
        return str(said["names"])
    section = description.keys_of(SLICE).get(said["offers"]) if isinstance(said.get("offers"), str) else None
    return _find_entry_kind(description, section) if section else None


def _find_entry_kind(description: Description, section: Part) -> str | None:
    """Return the kind of the elements that a section lists by id."""
    entries = description.type_of(section).get("entries")
    return entries if isinstance(entries, str) and entries in description.kinds else None


def find_comparison_faults(description: Description) -> Iterator[str]:
    """Yield what the description forgets to say for comparisons, a sentence each."""
    for name, part in (*description.common.items(), *description.parts.items()):
        yield from _find_word_faults(name, part, description)
    for kind, part in description.kinds.items():
        for name, key in description.keys_of(kind).items():
            yield from _find_word_faults(f"{kind}.{name}", key, description)
            if kind in _list_compared(description) and "told" not in key:
                yield from _find_reading_faults(f"{kind}.{name}", key, description)
    for section in description.keys_of(SLICE).values():
        kind = _find_entry_kind(description, section)
        if kind and description.kinds[kind].get("element", True) and "effect" not in description.kinds[kind]:
            yield f"{kind}: `effect` says how far a change of such an element reaches"


def _find_word_faults(place: str, part: Part, description: Description) -> Iterator[str]:
    for word, choices in _CHOICES.items():
        if part.get(word, next(iter(choices))) not in choices:
            yield f"{place}: `{word}` is one of {', '.join(sorted(choices))}"
    if part.get("names", SLICE) not in description.kinds.keys() | _OTHER_KINDS:
        yield f"{place}: `names` is a kind, and there is no `{part['names']}`"
    verbs = part.get("verbs", ("", ""))
    if not isinstance(verbs, (list, tuple)) or len(verbs) != 2:
        yield f"{place}: `verbs` are two, for what is added and for what is removed"


def _find_reading_faults(place: str, key: Part, description: Description) -> Iterator[str]:
    part = description.type_of(key)
    form = key.get("form", part.get("form"))
    if "keys" in part and form is None and "effect" not in {*part, *key}:
        yield f"{place}: `effect` says how far a change reaches, or `told` where it is told"


def _format_kind(kind: str, rows: Mapping[str, Facts]) -> Iterator[str]:
    yield f'    "{kind}": {{'
    for name, facts in rows.items():
        items = [f'"{word}": {_format_fact(value)}' for word, value in facts.items()]
        line = f'        "{name}": {{{", ".join(items)}}},'
        yield from (
            [line] if len(line) <= 120 else [f'        "{name}": {{', *_wrap_items(items, "            "), "        },"]
        )
    yield "    },"


def _format_fact(value: PlainData) -> str:
    if isinstance(value, list):
        return f"({', '.join(map(_format_fact, value))}{',' if len(value) == 1 else ''})"
    return f'"{value}"' if isinstance(value, str) else str(value)


def _wrap_items(items: list[str], indent: str) -> Iterator[str]:
    line = indent
    for item in items:
        if len(line) + len(item) + 1 > 120:
            yield line.rstrip()
            line = indent
        line += f"{item}, "
    yield line.rstrip()
