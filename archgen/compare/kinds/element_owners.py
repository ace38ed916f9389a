"""Who owns an element, and who owns it with them."""

from __future__ import annotations

from typing import Any

from archgen.compare.kinds.key_spec import Effect, KeySpec, ReadContext

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
