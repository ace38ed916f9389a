"""Features that several kinds of elements have in the same form, and the further owners of an element."""

from __future__ import annotations

from typing import Any

from archgen.compare.element_likeness import letter_pairs, word_set
from archgen.compare.kinds.kind_spec import Effect, FeatureSpec, KeySpec, ReadContext
from archgen.model.path_resolver import title_from_id

# No key of the language: the rest of the list `owner`.
CO_OWNERS = KeySpec(
    "co_owners",
    lambda element, context: context.common_ids("partner", element.co_owners),
    Effect.SYSTEM,
    refers_to="partner",
    noun="further owners",
)


def read_owner(element: Any, context: ReadContext) -> str | None:  # noqa: ANN401 - groups, components and nodes
    """Return the common id of the partner who owns an element."""
    return context.common_id("partner", element.owner)


def last_part(path: str, part_count: int = 1) -> str:
    """Return the last parts of a path."""
    return ".".join(path.split(".")[-part_count:])


def mark_values(*values: object) -> frozenset[str]:
    """Return the values that are known as marks of a feature."""
    return frozenset(str(value) for value in values if value not in {None, ""})


NAME_FEATURES = (
    FeatureSpec("name", 2, lambda _, element: letter_pairs(element.id)),
    FeatureSpec(
        "title",
        2,
        lambda _, element: word_set(element.title),
        lambda element: element.title in {title_from_id(element.id), element.id},
    ),
)


def text_feature(weight: float, *names: str) -> FeatureSpec:
    """Return the feature of the words of some texts."""
    return FeatureSpec(
        "text",
        weight,
        lambda _, element: frozenset[str]().union(*(word_set(getattr(element, name)) for name in names)),
    )
