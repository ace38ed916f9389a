"""Find in two versions which connections break another partner, and whom."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping

from archgen.compare import Comparison
from archgen.compare.agreements import find_partner_id
from archgen.frozen import dataclass
from archgen.model.architecture import Architecture
from archgen.views.changes.breaking_items import is_break_shown
from archgen.views.changes.named_elements import name_each, name_partners
from archgen.views.graphs.changes.merged_versions import MergedEdge

_NAMES = re.compile(r"`([^`]+)`")


@dataclass(frozen=True, slots=True)
class PartnerLosses:
    """What a partner loses by a change: the outputs that it is about; inputs where no output is named; a type."""

    partner: str
    outputs: frozenset[str]
    inputs: frozenset[str]
    type_name: str | None

    def are_about(self, edge: MergedEdge, old_input_id: str) -> bool:
        """Return whether what is lost runs along a connection."""
        if self.type_name is not None:
            return self.type_name == edge.label
        # An input may read many outputs, of which one changed.
        return edge.output_id in self.outputs or (
            not self.outputs and not self.inputs.isdisjoint((edge.input_id, old_input_id))
        )


class BrokenReaders:
    """Tells for each connection which partners it breaks."""

    def __init__(self, comparison: Comparison) -> None:
        self._partner_names: Mapping[str, str] = name_partners(comparison)
        self._losses = tuple(_list_losses(comparison))
        # Those of the later version win: who reads it now is who is broken.
        self._owners = _collect_owners(comparison.before.architecture) | _collect_owners(comparison.after.architecture)

    def find_partners(self, edge: MergedEdge, old_input_id: str) -> tuple[str, ...]:
        """Return what people call the partners for whom a connection breaks."""
        owners = self._owners.get(edge.input_id) or self._owners.get(old_input_id, ())
        partners = [
            losses.partner
            for losses in self._losses
            if losses.partner in owners and losses.are_about(edge, old_input_id)
        ]
        return name_each(dict.fromkeys(partners), self._partner_names)


def _list_losses(comparison: Comparison) -> Iterator[PartnerLosses]:
    architectures = (comparison.before.architecture, comparison.after.architecture)
    outputs = {name for architecture in architectures for name in architecture.outputs}
    inputs = {name for architecture in architectures for name in architecture.inputs}
    for change in comparison.changes:
        for partner_break in change.breaks:
            if is_break_shown(partner_break.category, comparison):
                names = {change.element_id, *_NAMES.findall(partner_break.reason)}
                yield PartnerLosses(
                    find_partner_id(partner_break.partner, comparison.matched_ids),
                    frozenset(names & outputs),
                    frozenset(names & inputs),
                    change.element_id if change.element_kind == "type" else None,
                )


def _collect_owners(architecture: Architecture) -> dict[str, tuple[str, ...]]:
    """Return the owners of the component of each input."""
    return {name: tuple(architecture.components[port.component].owners) for name, port in architecture.inputs.items()}
