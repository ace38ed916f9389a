"""The keys of kinds as the description of the language has them, each with what reads it."""

from __future__ import annotations

from collections.abc import Collection, Mapping

from archgen.compare.kinds.key_readers import READERS
from archgen.compare.kinds.kind_spec import Effect, KeySpec, KindSpec, ReadContext, Reader, Worsening, key_values
from archgen.compare.kinds.value_readers import make_form_reader
from archgen.frozen import replace
from archgen.language.comparison_tables import KEY_FACTS, KIND_EFFECTS, KeyFacts


def complete_kind(kind: KindSpec, like: str = "", without: Collection[str] = ()) -> KindSpec:
    """Return a kind with its described keys before those that it has beside them, and with its described effect.

    It may have the keys of a kind that it is `like`, but for those that it is `without`.
    """
    described_keys = derive_keys(like or kind.name, without)
    effect = Effect[KIND_EFFECTS[kind.name].upper()] if kind.name in KIND_EFFECTS else kind.effect
    return replace(kind, keys=(*described_keys, *kind.keys), effect=effect)


def derive_keys(kind: str, without: Collection[str] = ()) -> tuple[KeySpec, ...]:
    """Return the described keys of a kind in their order, but for those that it is to be without."""
    rows = ((name, facts) for name, facts in KEY_FACTS[kind].items() if name not in without)
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
