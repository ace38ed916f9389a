"""Describe inputs that read something else than before."""

from __future__ import annotations

from archgen.compare.connection_maps import RewiredInput
from archgen.compare.element_sentences import describe_lost_effects
from archgen.compare.key_phrases import limit_effects, shown_id, tick_names
from archgen.compare.version_pair import VersionPair


def describe_connection(rewired_input: RewiredInput, versions: VersionPair) -> str:
    """Describe what an input reads now, and what that leaves unread."""
    reader = f"`{shown_id('input', rewired_input.input_id, versions)}`"
    if versions.is_removed("input", rewired_input.input_id):
        return _describe_removed_reader(rewired_input, reader, versions)
    sentence = _describe_reading(rewired_input, reader, versions)
    # Nobody wrote it: `autoconnect` joined it.
    if versions.connections_after.is_made(rewired_input.input_id, rewired_input.gained_sources):
        sentence += ", joined by itself"
    unread_outputs = [
        output_id
        for output_id in sorted(rewired_input.lost_sources)
        if ("output", output_id) in versions.elements_after
        and not versions.connections_after.readers_by_output.get(output_id)
    ]
    newly_read_outputs = [
        output_id
        for output_id in sorted(rewired_input.gained_sources)
        if ("output", output_id) in versions.elements_before
        and not versions.connections_before.readers_by_output.get(output_id)
    ]
    sentence += f"; nobody reads {tick_names(unread_outputs)} any more" if unread_outputs else ""
    sentence += f"; nobody read {tick_names(newly_read_outputs)} before" if newly_read_outputs else ""
    return "; ".join((sentence, *limit_effects(list(describe_lost_effects([rewired_input.input_id], versions)))))


def _describe_reading(rewired_input: RewiredInput, reader: str, versions: VersionPair) -> str:
    """Describe which sources an input gained and lost."""
    lost_outputs = [shown_id("output", name, versions) for name in sorted(rewired_input.lost_sources)]
    gained_outputs = sorted(rewired_input.gained_sources)
    # A reference to what has no output yet stands for itself in the map of connections (`map_connections`).
    if (
        lost_outputs
        and gained_outputs
        and not any(("output", name) in versions.elements_after for name in gained_outputs)
    ):
        return f"{reader} no longer reads {tick_names(lost_outputs)}: {tick_names(gained_outputs)} {'has' if len(gained_outputs) == 1 else 'have'} no output any more"
    if lost_outputs and gained_outputs:
        return f"{reader} now reads {tick_names(gained_outputs)} instead of {tick_names(lost_outputs)}"
    if lost_outputs:
        lost_outputs = [_old_name(name, versions) for name in sorted(rewired_input.lost_sources)]
        all_removed = all(versions.is_removed("output", name) for name in rewired_input.lost_sources)
        removal_note = f", which {'was' if len(lost_outputs) == 1 else 'were'} removed" if all_removed else ""
        was_made = versions.connections_before.is_made(rewired_input.input_id, rewired_input.lost_sources)
        removal_note = removal_note or (", joined by itself before" if was_made else "")
        return f"{reader} no longer reads {tick_names(lost_outputs)}{removal_note}{'' if rewired_input.sources_after else '; it has no source any more'}"
    if versions.is_added("input", rewired_input.input_id):
        return f"{reader} reads {tick_names(gained_outputs)}"
    if rewired_input.sources_before:
        return f"{reader} now also reads {tick_names(gained_outputs)}"
    return f"{reader} now reads {tick_names(gained_outputs)}, its first source{'s' if len(gained_outputs) > 1 else ''}"


def _old_name(output_id: str, versions: VersionPair) -> str:
    """Return the name under which an output was read: what it is called now it may never have been read as."""
    element = versions.elements_before.get(("output", output_id))
    return element.own_id if element else output_id


def _describe_removed_reader(rewired_input: RewiredInput, reader: str, versions: VersionPair) -> str:
    """Describe what the removal of a reader means to each of its sources."""
    sentences = []
    for source in sorted(rewired_input.lost_sources):
        if versions.is_removed("output", source) or versions.connections_after.readers_by_output.get(source):
            continue
        other_reader_count = len(versions.connections_before.readers_by_output[source]) - 1
        explanation = (
            f"its only reader {reader} was removed"
            if not other_reader_count
            else f"{reader} was removed, and nobody else reads it now"
        )
        sentences.append(f"`{source}` is no longer read by anybody: {explanation}")
    return (
        "; ".join(limit_effects(sentences))
        or f"{reader}, which read {tick_names(shown_id('output', output_id, versions) for output_id in sorted(rewired_input.lost_sources))}, was removed"
    )
