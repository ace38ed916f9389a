"""Describe renames, changed keys and owners, ports of nodes and rewired inputs in words, and whom they concern."""

from __future__ import annotations

from archgen.compare.comparison import Change
from archgen.compare.element_sentences import (
    describe_field_changes,
    describe_lost_effects,
    describe_outer_messages,
    describe_output_timing,
    describe_readers,
)
from archgen.compare.key_phrases import (
    describe_key_change,
    limit_effects,
    name_partner,
    shorten_text,
    shown_id,
    tick_names,
)
from archgen.compare.kinds import ELEMENT_KINDS
from archgen.compare.version_pair import ComparedElement, RewiredInput, VersionPair
from archgen.derivation import ros_names
from archgen.model.quantity import Quantity

SURE_CONFIDENCE = 0.85
"""From here on a rename is stated without its confidence."""
READERS_LEAD = "it is read by"
"""Begins the part of a sentence that names who reads what changed; other views say that in their own way."""


def note_confidence(confidence: float) -> str:
    """Return what stands behind a sentence that is not sure, empty for one that is."""
    return "" if confidence >= SURE_CONFIDENCE else f" (recognised with {round(confidence * 100)} % confidence)"


def describe_rename(change: Change, versions: VersionPair) -> str:
    """Describe a rename or a move, and the names on the robot that follow it."""
    kind_word = ELEMENT_KINDS[change.element_kind].element_word
    old_id = change.old_id or ""
    if change.kind == "moved":
        old_path, new_path = old_id.rpartition("."), change.element_id.rpartition(".")
        name_note = "" if old_path[2] == new_path[2] else f" and is called `{new_path[2]}` now"
        sentence = f"{kind_word} `{old_id}` moved {_describe_place(old_path[0], new_path[0])}{name_note}"
    elif change.element_kind in {"composed", "component", "input", "output"}:
        sentence = f"{kind_word} `{old_id}` is called `{change.element_id.rpartition('.')[2]}` now"
    else:
        sentence = f"{kind_word} `{shorten_text(old_id)}` is called `{shorten_text(change.element_id)}` now"
    return sentence + note_confidence(change.confidence) + _describe_following_names(change, versions)


def _describe_place(old_parent: str, new_parent: str) -> str:
    """Return where a component moved to: a group or a composed component, by their ids."""
    if "." in new_parent:
        return f"into the composed component `{new_parent}`"
    if old_parent.partition(".")[0] == new_parent:
        return f"out of the composed component `{old_parent}`"
    return f"to the group `{new_parent}`"


def _describe_following_names(change: Change, versions: VersionPair) -> str:
    """Describe which topics, services and actions get another name because nobody named them."""
    if change.element_kind not in {"group", "composed", "component", "output"}:
        return ""
    inner_outputs = {
        port
        for port in versions.unnamed_outputs
        if port == change.element_id or port.startswith(f"{change.element_id}.")
    }
    renamed_outputs = sorted(port for port in inner_outputs if ("output", port) in versions.elements_before)
    if not renamed_outputs:
        return ""
    old_output = versions.elements_before["output", renamed_outputs[0]].own_id
    surplus_note = f", and {len(renamed_outputs) - 1} more such names follow" if len(renamed_outputs) > 1 else ""
    return f"; `{ros_names.default_port_name(old_output)}` becomes `{ros_names.default_port_name(renamed_outputs[0])}`{surplus_note}"


def describe_port_change(change_kind: str, element: ComparedElement, versions: VersionPair) -> str:
    """Describe that a node carries a port, or no longer does."""
    node_id, _, name = element.own_id.partition(".")
    topic_names = (
        ", ".join(sorted(map(str, topics))) if isinstance(topics := element.values.get("topic"), frozenset) else ""
    )
    if name.startswith("internal."):
        return _describe_internal_port(change_kind, node_id, name, topic_names, element.values.get("message"))
    topic_note = f" on {topic_names}" if topic_names else ""
    verb = "now has" if change_kind == "added" else "no longer has"
    same_port_elements = (
        candidate
        for candidate in versions.elements_after.values()
        if candidate.kind == "port" and candidate.component_refs and candidate.component_refs == element.component_refs
    )
    heir_nodes = sorted(
        {
            candidate.own_id.partition(".")[0]
            for candidate in same_port_elements
            if candidate.parent_key != element.parent_key
        }
    )
    heir_note = f": `{heir_nodes[0]}` has it now" if change_kind == "removed" and len(heir_nodes) == 1 else ""
    return f"node `{node_id}` {verb} `{name}`{topic_note}{heir_note}"


_USE_VERBS = {
    "publishes": "publishes",
    "subscribes": "subscribes to",
    "serves": "serves",
    "calls": "calls",
}
"""What a node does, by the key that says it."""


def _describe_internal_port(change_kind: str, node_id: str, name: str, topic_names: str, message: object) -> str:
    """Describe a topic, service or action of a node that no component knows, such as one for finding faults."""
    _, use, key = name.split(".", 2)
    phrase = f"{'now' if change_kind == 'added' else 'no longer'} {_USE_VERBS.get(use, use)}"
    message_note = f", a `{shorten_text(str(message))}`" if message else ""
    return f"node `{node_id}` {phrase} `{shorten_text(topic_names or key)}`{message_note}; no component knows of it"


def describe_change(change: Change, versions: VersionPair) -> str:
    """Describe the old and new value of a key, and whom that concerns."""
    sentence = (
        _describe_new_owner(change, versions) or describe_output_timing(change, versions) or describe_key_change(change)
    )
    return "; ".join(filter(None, (sentence, _describe_concerned(change, versions))))


def _describe_concerned(change: Change, versions: VersionPair) -> str:
    """Describe who is at the other end of a change: readers, carriers, requirements that nothing serves any more."""
    match change.element_kind, change.key:
        case "output", "description":
            return describe_readers(change.element_id, versions)
        case "chain", str(key) if key.startswith("deadline"):
            return _describe_weaker_promise(change, key, versions)
        case "component", "requirements":
            return _describe_unserved(change.element_id, versions)
        case "output" | "type" | "message", _:
            return _describe_carriers(change, versions)
    return ""


def _describe_carriers(change: Change, versions: VersionPair) -> str:
    """Describe who carries what has another form, and for another message in which fields that differs."""
    element_id = change.element_id
    if change.element_kind == "message":
        types = versions.find_elements_with("type", "message", element_id)
        return f"it carries {tick_names(types)}" if types else describe_outer_messages(element_id, versions)
    if change.element_kind == "output" and change.key == "type":
        readers = sorted(versions.connections_after.readers_by_output.get(element_id, frozenset()))
        return f"{READERS_LEAD} {tick_names(readers)}" if readers else ""
    if change.element_kind == "type" and change.key in {"message", "size", "comment"}:
        outputs = versions.find_elements_with("output", "type", element_id)
        carrier_note = f"{tick_names(outputs)} {'carry' if len(outputs) > 1 else 'carries'} it" if outputs else ""
        field_note = describe_field_changes(change.before, change.after, versions) if change.key == "message" else ""
        return "; ".join(filter(None, (carrier_note, field_note)))
    return ""


def _describe_unserved(component_id: str, versions: VersionPair) -> str:
    before, after = versions.serving_components
    unserved = [
        requirement
        for requirement in sorted(before)
        if requirement not in after
        and component_id == min(before[requirement])
        and ("requirement", requirement) in versions.elements_after
    ]
    return f"no component serves {tick_names(unserved)} any more" if unserved else ""


def _describe_weaker_promise(change: Change, key: str, versions: VersionPair) -> str:
    """Describe what a chain no longer promises: its deadline is relaxed, or gone."""
    old_chain, new_chain = versions.find_both("chain", change.element_id)
    old_deadline, new_deadline = (chain and chain.values.get(key) for chain in (old_chain, new_chain))
    if old_chain is None or not isinstance(old_deadline, Quantity):
        return ""
    requirements = old_chain.values.get("requirements")
    served_note = f" to {tick_names(sorted(requirements))}" if isinstance(requirements, frozenset) else ""
    if not isinstance(new_deadline, Quantity) and key == "deadline":
        return f"nothing is promised{served_note} any more"
    is_weaker = not isinstance(new_deadline, Quantity) or new_deadline.value > old_deadline.value
    return f"a weaker promise{served_note} than before" if is_weaker else ""


def _describe_new_owner(change: Change, versions: VersionPair) -> str:
    """Return the sentence on another owner; empty for any other change."""
    if change.key != "owner":
        return ""
    kind_word = "" if "." in change.element_id else f"{ELEMENT_KINDS[change.element_kind].kind_word} "
    new_owner, old_owner = (
        name_partner(str(owner), versions.partner_names) if owner else "nobody"
        for owner in (change.after, change.before)
    )
    sentence = f"{kind_word}{tick_names([change.element_id])} belongs to {new_owner} now, not to {old_owner}"
    readers = _find_outer_readers(change, versions)
    return f"{sentence}; read by {tick_names(readers)}" if readers else sentence


def _find_outer_readers(change: Change, versions: VersionPair) -> list[str]:
    """Return the inputs outside of an element that read an output inside of it."""
    element = versions.elements_after.get((change.element_kind, change.element_id))
    holders = element.component_refs if element and change.element_kind == "node" else (change.element_id,)
    prefixes = tuple(f"{holder}." for holder in holders)
    return sorted(
        {
            reader
            for output, readers in versions.connections_after.readers_by_output.items()
            if prefixes and output.startswith(prefixes)
            for reader in readers
            if not reader.startswith(prefixes)
        }
    )


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
        # What has no output yet is read by nobody.
        readers = versions.connections_before.readers_by_output.get(source)
        if (
            not readers
            or versions.is_removed("output", source)
            or versions.connections_after.readers_by_output.get(source)
        ):
            continue
        other_reader_count = len(readers) - 1
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
