"""Another distribution of ROS: what was built for the one is built again for the other."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator

from archgen.compare.losses.change_context import ChangeContext, PartnerLoss


def find_changed_distro(context: ChangeContext) -> Iterator[PartnerLoss]:
    """Find the partners whose nodes were built for the distribution that the project had, unless there is only one.

    A distribution that was not written before says what was true already.
    """
    old_distro, new_distro = context.before.distro, context.after.distro
    if old_distro is None or old_distro == new_distro:
        return
    nodes_by_partner: dict[str, list[str]] = defaultdict(list)
    for node in context.before.nodes.values():
        if node.written and node.status != "planned" and node.owner:
            partner = context.matched_ids.common_id("partner", node.owner)
            nodes_by_partner[partner].append(context.matched_ids.common_id("node", node.id))
    if len(nodes_by_partner) < 2:  # noqa: PLR2004 - nobody else has to build anything
        return
    indices = context.change_indices("project", context.after.project.id, "distro")
    reason_text = f"asks for {new_distro or 'no named distribution'} instead of {old_distro}, for which {{}} built"
    yield from context.shared_losses(indices, nodes_by_partner, reason_text, "is", "wire")
