"""Who owns an element, and who owns it with them."""

from __future__ import annotations

from typing import Any

from archgen.compare.kinds.key_spec import Effect, KeySpec, ReadContext
from archgen.model.component import ComponentType
from archgen.model.message_types import ConceptualType

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


def find_type_owner(element: ComponentType | ConceptualType, context: ReadContext) -> str | None:
    """Return the common id of the partner whose a type is: by its own `owner`, else by what else stands in its file or
    in the nearest folder, else by the instances, if all are of one partner.
    """
    if element.library is not None:
        return None  # those know who check the library by itself
    place = element.at.file
    while place and place not in context.owners_by_place:
        place = place.rpartition("/")[0]
    owners = context.owners_by_place.get(place, frozenset())
    if isinstance(element, ComponentType):
        if element.owner:
            return context.common_id("partner", element.owner)
        owners = owners if len(owners) == 1 else context.instance_owners.get(element.id, frozenset())
    return context.common_id("partner", next(iter(owners))) if len(owners) == 1 else None
