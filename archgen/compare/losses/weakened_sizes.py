"""Types whose messages may be larger than their owner said: what a reader has room for may not be enough."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

from archgen.compare.compared_elements import ComparedElement
from archgen.compare.losses.change_context import ChangeContext, PartnerLoss
from archgen.compare.losses.loss_wording import tick_name
from archgen.compare.losses.message_users import MessageUsers
from archgen.model.quantity import Quantity


def find_weakened_sizes(context: ChangeContext) -> Iterator[PartnerLoss]:
    """Find types whose written size grew, or is no longer written: where promises have a severity of their own."""
    if not context.guards_margins:
        return
    changes = [
        (index, change)
        for index, change in enumerate(context.changes)
        if (change.element_kind, change.kind, change.key) == ("type", "changed", "size") and change.before is not None
    ]
    users = MessageUsers(context) if changes else None
    for index, change in changes:
        old_size, new_size = (
            _read_size(elements.get(("type", change.element_id)))
            for elements in (context.versions.elements_before, context.versions.elements_after)
        )
        if old_size is not None and (new_size is None or new_size > old_size):
            promise = (
                f"{change.after} instead of {change.before}"
                if change.after
                else f"no size any more (it was {change.before})"
            )
            partners = users.partners_using_type(change.element_id) if users else []
            reason_text = f"promises for {tick_name(change.element_id)} {promise}; {{}} it"
            yield from context.losses_of_users([index], partners, reason_text, "uses", "promise")


def _read_size(element: ComparedElement | None) -> Fraction | None:
    value = element.values.get("size") if element else None
    return Fraction(value.value) if isinstance(value, Quantity) else None
