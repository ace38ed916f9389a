"""Connections that a partner loses because the output was removed or has another id than the one it reads."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator

from archgen.compare.losses.change_context import ChangeContext, PartnerLoss, tick_sorted_names


def find_lost_connections(context: ChangeContext) -> Iterator[PartnerLoss]:
    """Find outputs that were removed or renamed while a partner read them, whatever became of the reader.

    A reader that turns away loses nothing as long as its source stays as it is.
    """
    for output, readers in sorted(context.versions.connections_before.readers_by_output.items()):
        new_readers = context.versions.connections_after.readers_by_output.get(output, frozenset())
        if context.versions.may_be_unread(("output", output)):
            continue
        indices = find_output_causes(context, output)
        if not indices:
            continue
        lost_inputs: dict[str, list[str]] = defaultdict(list)
        is_renamed = ("output", output) in context.versions.elements_after
        for reader in readers - new_readers:
            partner = context.owner_before("input", reader)
            if not partner or partner in context.lasting_owners("output", output) or not context.needs_source(reader):
                continue
            # An output that only has another id is still there: who no longer asks for anything turned away by itself.
            if not is_renamed or ("input", reader) in context.versions.elements_after:
                lost_inputs[partner].append(reader)
        for partner, inputs in sorted(lost_inputs.items()):
            yield from context.losses_of_partner(indices, partner, _loss_reason(context, output, inputs, partner))


def find_output_causes(context: ChangeContext, output_id: str) -> list[int]:
    """Return the indices of the changes that removed an output, or renamed it."""
    if ("output", output_id) not in context.versions.elements_after:
        return context.indices_by_change_kind("output", output_id, "removed")
    component_id = output_id.rpartition(".")[0]
    group_id = component_id.partition(".")[0]
    element_keys = (("output", output_id), ("component", component_id), ("group", group_id))
    return [
        index for kind, name in element_keys for index in context.indices_by_change_kind(kind, name, "renamed", "moved")
    ][:1]


def _loss_reason(context: ChangeContext, output_id: str, input_ids: list[str], partner: str) -> str:
    input_names = tick_sorted_names(input_ids)
    old_name = f"`{context.old_id('output', output_id)}`"
    if ("output", output_id) in context.versions.elements_after:
        return f"takes {old_name} from {partner}, who still reads it under that name as {input_names}"
    gone_ids = [name for name in input_ids if context.versions.is_removed("input", name)]
    if gone_ids:
        gone_names = "" if len(gone_ids) == len(input_ids) else f" {tick_sorted_names(gone_ids)}"
        return f"takes {old_name} from {partner}, who read it as {input_names}; the same change takes the reader{gone_names} away"
    current_sources = {
        source for name in input_ids for source in context.versions.connections_after.sources_by_input.get(name, ())
    }
    existing_sources = {source for source in current_sources if ("output", source) in context.versions.elements_after}
    gained_sources = existing_sources - {
        source for name in input_ids for source in context.versions.connections_before.sources_by_input.get(name, ())
    }
    instead_note = f" (and is to read {tick_sorted_names(gained_sources)} instead)" if gained_sources else ""
    return f"takes {old_name} from {partner}, who reads it as {input_names}{instead_note}"
