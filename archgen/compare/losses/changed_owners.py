"""Elements that change hands: nobody takes over, or hands over, a part of another partner without its agreement."""

from __future__ import annotations

from collections.abc import Iterator

from archgen.compare.losses.change_context import ChangeContext, PartnerLoss, tick_name


def find_changed_owners(context: ChangeContext) -> Iterator[PartnerLoss]:
    """Find elements that had an owner and have another one, or none.

    Otherwise two changes would do what one may not: the first takes the reader from its partner, or gives that partner
    what it reads; to the second one nobody but the author owns anything.
    """
    for index, change in enumerate(context.changes):
        old_owner, new_owner = change.before, change.after
        if change.key != "owner" or not isinstance(old_owner, str):
            continue
        name = tick_name(change.element_id)
        new_holder = f"it belongs to {new_owner} now" if new_owner else "it belongs to nobody now"
        yield from context.losses_of_partner([index], old_owner, f"takes {name} from {old_owner}; {new_holder}")
        if isinstance(new_owner, str):
            reason_text = f"makes {new_owner} answer for {name}, which belonged to {old_owner}"
            yield from context.losses_of_partner([index], new_owner, reason_text)
