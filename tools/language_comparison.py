"""Make the tables by which two versions are compared: how each key is read, weighed and called."""

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
_SHARED_WORDS = frozenset({"effect", "worse", "names", "offers", "form", *_SENTENCE_WORDS})
"""What a key has from its type where it does not say it."""
_OWN_WORDS = frozenset({"attribute", "default"})
_TABLE_WORDS = ("form", "inner", *sorted(_OWN_WORDS), "names", "effect", "worse", *_SENTENCE_WORDS)
_OTHER_KINDS = frozenset({"message"})
"""Kinds of elements that a key may name although no file lists them: they follow from what other elements say."""
_VERB_COUNT = 2
_LIST_FORMS = {"counts": "list", "headed": "value"}
Facts = dict[str, PlainData]


def make_comparison_tables(description: Description) -> dict[str, PlainData]:
    """Return the tables by name."""
    compared = _list_compared(description)
    return {
        "KIND_EFFECTS": {kind: description.kinds[kind]["effect"] for kind in compared},
        "KEY_FACTS": {kind: list_key_facts(description, kind) for kind in compared},
    }


def _list_compared(description: Description) -> list[str]:
    """Return the kinds that are compared key by key: those that say how far a change of them reaches."""
    return [kind for kind, part in description.kinds.items() if "effect" in part and "form" not in part]


def list_key_facts(description: Description, kind: str) -> Mapping[str, Facts]:
    """Return what a comparison knows of each key of a kind, but for those whose changes are told elsewhere."""
    return {
        name: _gather_facts(description, kind, key_name, said)
        for key_name, key in description.keys_of(kind).items()
        if "told" not in key
        for name, said in _list_rows(description, key_name, key)
    }


def _list_rows(description: Description, name: str, key: Part) -> Iterator[tuple[str, Part]]:
    """Yield a key, or what stands for all keys below it, with what is said of it: what it says itself goes over its type.

    It is both where a scalar may stand there that is no short form; those below have no words but the type's.
    """
    part = description.type_of(key)
    shared = {word: part[word] for word in _SHARED_WORDS if word in part}
    said = {**shared, **{word: value for word, value in key.items() if word in {*_SHARED_WORDS, *_OWN_WORDS}}}
    said |= _find_first_field(name, key)
    accepted = set(list_accepted(part)) - {"null"}
    is_mapping = "object" in accepted and said.get("form") not in _PLAIN_FORMS
    is_both = is_mapping and accepted != {"object"} and "short" not in part
    if not is_mapping or is_both:
        form = said.get("form", "mapping")
        yield name, {**said, "form": _find_plain_form(part, accepted) if form == "mapping" else form}
    if is_mapping:
        below = shared if is_both else said
        compared = _list_compared(description)
        form = below.get("form") or _find_form(description, part)
        read = {"inner": key["type"]} if key.get("type") in compared else {"form": form}
        if form == "entries" and isinstance(part.get("entries"), str) and part["entries"] in compared:
            read = {"form": form, "inner": part["entries"]}
        if "inner" in read and isinstance(key.get("attribute"), list):  # several fields: what reads it knows them
            below = {word: value for word, value in below.items() if word != "attribute"}
        yield f"{name}.", {**below, **read}


def _find_first_field(name: str, key: Part) -> Part:
    """Return the field that a comparison reads; nothing to say where that is called as the key."""
    fields = key.get("attribute", name)
    return {"attribute": fields[0] if isinstance(fields, list) else fields}


def _find_plain_form(part: Part, accepted: set[str]) -> str:
    if accepted == {"boolean"}:
        return "flag"
    return _LIST_FORMS.get(part["order"], "set") if "array" in accepted else "value"


def _find_form(description: Description, part: Part) -> str:
    """Return the form of a mapping: data is compared by its leaves; elements in it want a reader of their own."""
    if part.get("data"):
        return "data"
    entries = part.get("entries")
    holds_elements = "keys" in part or (isinstance(entries, str) and "keys" in description.parts[entries])
    return "entries" if holds_elements else "mapping"


def _gather_facts(description: Description, kind: str, name: str, said: Part) -> Facts:
    """Return what stands in the table: what goes without saying is left out."""
    limit = EFFECTS.index(description.kinds[kind]["effect"])
    effect = EFFECTS[min(limit, EFFECTS.index(said.get("effect", EFFECTS[limit])))]
    facts = {**said, "effect": effect, "names": said.get("names") or _find_offered_kind(description, said)}
    unsaid = {"effect": EFFECTS[-1], "names": None, "form": "value", "attribute": name}
    return {word: facts[word] for word in _TABLE_WORDS if word in facts and facts[word] != unsaid.get(word, "")}


def _find_offered_kind(description: Description, said: Part) -> str | None:
    """Return the kind of the elements in the one section that is offered."""
    sections = description.keys_of(SLICE)
    offered = said.get("offers")
    return (
        _find_entry_kind(description, sections[offered]) if isinstance(offered, str) and offered in sections else None
    )


def _find_entry_kind(description: Description, section: Part) -> str | None:
    """Return the kind of the elements that a section lists by id."""
    entries = description.type_of(section).get("entries")
    return entries if isinstance(entries, str) and entries in description.kinds else None


def find_comparison_faults(description: Description) -> Iterator[str]:
    """Yield what the description forgets to say for comparisons, a sentence each."""
    for name, part in (*description.common.items(), *description.parts.items()):
        yield from _find_word_faults(name, part, description)
    for kind in description.kinds:
        for name, key in description.keys_of(kind).items():
            place = f"{kind}.{name}"
            yield from _find_word_faults(place, key, description)
            if kind in _list_compared(description) and not _can_be_read(key, description):
                yield f"{place}: `effect` says how far a change reaches, or `told` where it is told"
    for section in description.keys_of(SLICE).values():
        entry_kind = _find_entry_kind(description, section)
        part = description.kinds[entry_kind] if entry_kind else {}
        if part and part.get("element", True) and "effect" not in part:
            yield f"{entry_kind}: `effect` says how far a change of such an element reaches"


def _find_word_faults(place: str, part: Part, description: Description) -> Iterator[str]:
    for word, choices in _CHOICES.items():
        if part.get(word, next(iter(choices))) not in choices:
            yield f"{place}: `{word}` is one of {', '.join(sorted(choices))}"
    if part.get("names", SLICE) not in description.kinds.keys() | _OTHER_KINDS:
        yield f"{place}: `names` is a kind, and there is no `{part['names']}`"
    verbs = part.get("verbs", [""] * _VERB_COUNT)
    if not isinstance(verbs, list) or len(verbs) != _VERB_COUNT:
        yield f"{place}: `verbs` are two, for what is added and for what is removed"


def _can_be_read(key: Part, description: Description) -> bool:
    """Whether a comparison knows what to do with a key: the keys below it are compared, or it says what is."""
    part = description.type_of(key)
    return "keys" not in part or bool({"form", "effect", "told"} & {*part, *key})
