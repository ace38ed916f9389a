"""Topics that belong to no port, such as /tf, and that carry another message for another partner's nodes."""

from __future__ import annotations

from collections.abc import Iterator

from archgen.compare.losses.change_context import ChangeContext, PartnerLoss
from archgen.compare.losses.loss_wording import tick_name
from archgen.compare.losses.renamed_topics import group_users, list_topic_readers


def find_retyped_topics(context: ChangeContext) -> Iterator[PartnerLoss]:
    """Find internal topics with another message; those of outputs are looked at with the outputs."""
    old_endpoints, new_endpoints = context.offered_endpoints
    readers = list_topic_readers(context)
    for node, port in sorted(old_endpoints):
        new_messages = {endpoint.label: endpoint.message for endpoint in new_endpoints.get((node, port), ())}
        for endpoint in old_endpoints[node, port] if not port else ():
            old_message, new_message = endpoint.message, new_messages.get(endpoint.label)
            if not (old_message and new_message):
                continue
            if old_message == new_message:
                continue
            # A message of another name is another message to programs: then its rename is the change.
            indices = context.port_change_indices(node, "", "message") or [
                index
                for index, change in enumerate(context.changes)
                if change.element_kind == "message" and change.old_id == old_message
            ]
            users = [reader for reader in readers.get((endpoint.label, endpoint.flow), ()) if not reader.port]
            reason_text = (
                f"sends {tick_name(new_message)} instead of {tick_name(old_message)} on {tick_name(endpoint.label)}, "
                "to which {}"
            )
            yield from context.shared_losses(indices, group_users(context, users), reason_text, "subscribes", "wire")
