"""Variants: what each is built on, what it takes out, and what it writes over the project."""

from __future__ import annotations

from archgen.compare.kinds.kind_spec import Effect, FeatureSpec, KeySpec, KindSpec, ReadContext
from archgen.compare.kinds.shared_keys import DESCRIPTION, NAME_FEATURES, TITLE, mark_values
from archgen.model.variant import Variant


def _read_selector(variant: Variant, context: ReadContext) -> str | None:
    return context.matched_ids.rename_in_text(" ".join(variant.without.split())) if variant.without else None


def _read_drop(variant: Variant, context: ReadContext) -> frozenset[str]:
    return frozenset(context.matched_ids.rename_in_text(path) for path in variant.drop)


def _read_changes(variant: Variant, context: ReadContext) -> frozenset[str]:
    return frozenset(context.matched_ids.rename_in_text(f"{each.path}: {each.value}") for each in variant.changes)


VARIANT = KindSpec(
    "variant",
    "Variants",
    (
        TITLE,
        DESCRIPTION,
        # The order counts: the later wins.
        KeySpec(
            "of",
            lambda variant, context: tuple(str(context.common_id("variant", each)) for each in variant.of) or None,
            refers_to="variant",
            list_verbs=("is now built on", "is no longer built on"),
            new_verb="is built on",
        ),
        KeySpec("without", _read_selector, verb="is without"),
        KeySpec("drop", _read_drop, list_verbs=("now drops", "no longer drops")),
        KeySpec("changes", _read_changes, list_verbs=("now writes", "no longer writes")),
    ),
    # What a change of a variant does to the robot shows where the project is compared as it stands in the variant.
    Effect.SYSTEM,
    elements=lambda version: version.architecture.variants,
    features=(
        *NAME_FEATURES,
        # Where it writes counts more than what it writes: a variant may be renamed and changed at once.
        FeatureSpec("places", 8, lambda _, variant: mark_values(*(each.path for each in variant.changes))),
        FeatureSpec("changes", 2, lambda _, variant: mark_values(*(f"{c.path}: {c.value}" for c in variant.changes))),
        FeatureSpec("leaves out", 3, lambda _, variant: mark_values(variant.without, *variant.drop)),
        FeatureSpec("base", 0.5, lambda relations, variant: relations.common_ids("variant", variant.of)),
    ),
)
