"""The keys of kinds as the description of the language has them, each with what reads it."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache

from archgen.compare.kinds.key_readers import READERS
from archgen.compare.kinds.key_spec import Effect, KeySpec, ReadContext, Reader, Worsening, key_values
from archgen.compare.kinds.value_readers import make_form_reader
from archgen.language.comparison_tables import KEY_FACTS, KeyFacts


@cache
def derive_keys(kind: str, without: frozenset[str] = frozenset()) -> tuple[KeySpec, ...]:
    """Return the described keys of a kind in their order, but for those that it is to be without."""
    rows = ((name, facts) for name, facts in KEY_FACTS.get(kind, {}).items() if name not in without)
    return tuple(_make_key(name, facts, READERS.get((kind, name))) for name, facts in rows)


def _make_key(name: str, facts: KeyFacts, own_reader: Reader | None) -> KeySpec:
    attribute = facts.get("attribute", name.removesuffix("."))
    inner = derive_keys(facts["inner"]) if "inner" in facts else ()
    read = _read_below(attribute, own_reader, inner) if inner else own_reader or make_form_reader(attribute, facts)
    return KeySpec(
        name,
        read,
        Effect[facts.get("effect", "timing").upper()],
        Worsening[facts.get("worse", "never").upper()],
        facts.get("names"),
        facts.get("noun", ""),
        facts.get("verb", ""),
        facts.get("verbs"),
        facts.get("new_verb", ""),
        is_prose=facts.get("form") == "prose",
        inner=inner,
    )


def _read_below(attribute: str, find_holder: Reader | None, keys: tuple[KeySpec, ...]) -> Reader:
    """Return what reads the keys below another: off its value, or off what `find_holder` returns for an element; off several
    by what stands before the keys of each.
    """

    def read(element: object, context: ReadContext) -> Mapping[str, object]:
        holder = find_holder(element, context) if find_holder else getattr(element, attribute)
        if holder is None:
            return {}
        holders = holder if isinstance(holder, Mapping) else {"": holder}
        return {
            f"{prefix}{key}": value
            for prefix, each in holders.items()
            for key, value in key_values(keys, each, context).items()
        }

    return read
