"""What a change means to those who read an output: who they are, when it comes, which fields it has."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence

from archgen.compare.compared_elements import ComparedElement, ElementKey
from archgen.compare.comparison import Change
from archgen.compare.field_changes import read_field_types
from archgen.compare.key_phrases import format_value
from archgen.compare.partner_titles import name_partner
from archgen.compare.sentence_words import tick_names
from archgen.compare.version_pair import VersionPair
from archgen.diagnostics.common_wording import join_words
from archgen.model.graph_search import find_reachable

_OUTPUT_TIMING = "timing.outputs."


def describe_readers(output_id: str, versions: VersionPair) -> str:
    """Return who reads an output, with the partners other than its own: "read by `a.b.c` of Kite"; empty for nobody."""
    readers = versions.connections_after.readers_by_output.get(output_id, frozenset())
    return f"read by {name_ports(readers, versions)}" if readers else ""


def name_ports(inputs: Iterable[str], versions: VersionPair) -> str:
    """Return inputs by their partners: "`a.b.c` of Kite and `a.b.d` of Orsa"."""
    inputs_by_owner: dict[str, list[str]] = defaultdict(list)
    for name in sorted(inputs):
        element = versions.elements_after.get(("input", name)) or versions.elements_before.get(("input", name))
        inputs_by_owner[(element and element.owner) or ""].append(name)
    phrases = [
        tick_names(names) + (f" of {name_partner(owner, versions.partner_names)}" if owner else "")
        for owner, names in sorted(inputs_by_owner.items())
    ]
    return join_words(phrases)


def is_read_by_others(output_id: str, versions: VersionPair) -> bool:
    """Whether another partner than its own reads an output, in either version."""
    output = versions.elements_after.get(("output", output_id)) or versions.elements_before.get(("output", output_id))
    for connections, elements in (
        (versions.connections_before, versions.elements_before),
        (versions.connections_after, versions.elements_after),
    ):
        for name in connections.readers_by_output.get(output_id, ()):
            reader = elements.get(("input", name))
            if output and reader and reader.owner and reader.owner != output.owner:
                return True
    return False


def describe_lost_effects(inputs: Iterable[str], versions: VersionPair) -> Iterator[str]:
    """Describe which outputs of other partners lose their effect on an element that goes on without them."""
    for reader in sorted(inputs):
        input_element = versions.elements_before.get(("input", reader))
        component = input_element.parent_key if input_element else None
        if input_element is None or component is None or component not in versions.elements_after:
            continue
        remaining_sources = {
            source
            for name, sources in versions.connections_after.sources_by_input.items()
            if (element := versions.elements_after.get(("input", name))) and element.parent_key == component
            for source in sources
        }
        for source in sorted(versions.connections_before.sources_by_input.get(reader, ())):
            output = versions.elements_after.get(("output", source))
            if output and output.owner and output.owner != input_element.owner and source not in remaining_sources:
                owner = name_partner(output.owner, versions.partner_names)
                yield f"`{source}` of {owner} has no effect on `{component[1]}` any more"


def describe_output_timing(change: Change, versions: VersionPair) -> str:
    """Describe that an output is sent only now and then, or with other gaps; empty for any other change."""
    if not (change.key or "").startswith(_OUTPUT_TIMING):
        return ""
    output_name, _, key = (change.key or "").removeprefix(_OUTPUT_TIMING).rpartition(".")
    kind = "node" if change.element_kind == "node" else "component"
    element = versions.elements_after.get((kind, change.element_id))
    output_ids = [
        f"{component}.{output_name.rpartition('.')[2]}" for component in (element.component_refs if element else ())
    ]
    output_id = next((name for name in output_ids if ("output", name) in versions.elements_after), "")
    if not output_id:
        return ""
    if key == "conditional":
        phrase = (
            "is sent only when there is something to say"
            if change.after
            else "is sent each time now, and not only when there is something to say"
        )
        sentence = f"`{output_id}` {phrase}"
    elif change.before is None:
        sentence = f"`{output_id}`: largest gap set to {format_value(change.after)}"
    elif change.after is None:
        sentence = f"`{output_id}`: largest gap no longer promised (it was {format_value(change.before)})"
    else:
        sentence = f"`{output_id}`: largest gap {format_value(change.before)} → {format_value(change.after)}"
    return "; ".join(filter(None, (sentence, describe_readers(output_id, versions))))


def describe_field_changes(old_message: object, new_message: object, versions: VersionPair) -> str:
    """Describe in which fields one message differs from another; empty unless the project defines both."""
    old_element = versions.elements_before.get(("message", str(old_message)))
    new_element = versions.elements_after.get(("message", str(new_message)))
    if old_element is None or new_element is None:
        return ""
    old_fields, new_fields = (_types_by_field(element.values.get("fields")) for element in (old_element, new_element))
    phrases = [
        f"`{name}` is {format_value(new_fields[name])} instead of {format_value(field_type)}"
        for name, field_type in old_fields.items()
        if name in new_fields and new_fields[name] != field_type
    ]
    gone, added = ([*old_fields.keys() - new_fields.keys()], [*new_fields.keys() - old_fields.keys()])
    phrases += [f"{tick_names(sorted(gone))} {'is' if len(gone) == 1 else 'are'} gone"] if gone else []
    phrases += [f"{tick_names(sorted(added))} {'is' if len(added) == 1 else 'are'} new"] if added else []
    if phrases:
        return f"of its fields {join_words(phrases)}"
    return "its fields are the same" if [*old_fields] == [*new_fields] else "its fields stand in another order"


def _types_by_field(lines: object) -> dict[str, str]:
    """Return the types of fields by name; those of the parts of a service or action with the part's number."""
    return {
        f"{name} of part {part + 1}" if part else name: field_type
        for (part, name), field_type in read_field_types(lines).items()
    }


def describe_outer_messages(message: str, versions: VersionPair) -> str:
    """Describe through which outputs a message goes that others contain; empty if none does."""
    outer_messages = find_outer_messages(message, versions.elements_after)
    types = [each for name in outer_messages for each in versions.find_elements_with("type", "message", name)]
    outputs = sorted({each for name in types for each in versions.find_elements_with("output", "type", name)})
    if not outer_messages:
        return ""
    inside_note = f"it is inside of {tick_names(sorted(outer_messages))}"
    return (
        f"{inside_note}, which {tick_names(outputs)} {'carries' if len(outputs) == 1 else 'carry'}"
        if outputs
        else inside_note
    )


def find_outer_messages(message: str, elements: Mapping[ElementKey, ComparedElement]) -> list[str]:
    """Return the messages of a version that contain another one, at any depth."""
    containers: dict[str, list[str]] = defaultdict(list)
    for (kind, name), element in elements.items():
        for field_type in _field_types(element.values.get("fields")) if kind == "message" else ():
            containers[field_type].append(name)
    return [name for name in find_reachable(containers, [message]) if name != message]


def _field_types(lines: object) -> Sequence[str]:
    types = [
        line.rpartition(" ")[0].partition("[")[0].partition("<")[0]
        for line in map(str, lines if isinstance(lines, tuple) else ())
    ]
    return [name for name in types if "/" in name]
