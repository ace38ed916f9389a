"""Describe elements that were added or removed, and what a change means to those who read an output."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence

from archgen.compare.comparison import Change
from archgen.compare.key_phrases import (
    format_value,
    limit_effects,
    name_partner,
    read_field_types,
    shorten_text,
    shown_id,
    tick_names,
)
from archgen.compare.kinds import ELEMENT_KINDS
from archgen.compare.normal_values import ElementTitle, to_plain_data
from archgen.compare.version_pair import ComparedElement, ElementKey, VersionPair
from archgen.diagnostics import join_words
from archgen.model.graph_search import find_reachable
from archgen.model.project_settings import agreement_file


def describe_element_change(change: Change, element: ComparedElement, versions: VersionPair) -> str:
    """Describe an element that was added or removed, with the effects of its connections on others."""
    verb = "is added" if change.kind == "added" else "is removed"
    kind_word = ELEMENT_KINDS[change.element_kind].element_word
    sentence = f"{kind_word} `{shorten_text(change.element_id)}`{_title_note(element)} {verb}{_count_parts(change)}"
    if change.kind == "added":
        sentence += _describe_new_element(element)
    effects = list(_describe_effects(change, element, versions))
    return "; ".join((sentence, *limit_effects(effects)))


def _title_note(element: ComparedElement) -> str:
    title = element.values.get("title")
    return f" ({shorten_text(title.text)})" if isinstance(title, ElementTitle) and not title.generated else ""


def _describe_policy(element: ComparedElement) -> Iterator[str]:
    """Yield what a policy forbids, and what it asks for."""
    values = {key: f"`{shorten_text(str(value))}`" for key, value in element.values.items() if value is not None}
    if "forbid.from" in values:
        yield f"nothing may lead from {values['forbid.from']} to {values['forbid.to']}"
    if "require.of" in values:
        yield f"{values['require.of']} may take inputs from {values['require.inputs_from']} only"


def _describe_new_element(element: ComparedElement) -> str:
    """Describe what matters most of a new element, such as a node's place or the way of a chain."""
    if element.kind == "policy":
        return "".join(f"; {clause}" for clause in _describe_policy(element))
    if element.kind == "partner":
        return f"; what it agrees on stands in `{agreement_file(element.own_id)}`"
    clauses = [
        f"{key.new_verb} {tick_names(referred_names)}"
        for key in ELEMENT_KINDS[element.kind].keys
        if key.new_verb and (referred_names := _value_names(element.values.get(key.name)))
    ]
    return f"; it {join_words(clauses)}" if clauses else ""


def _count_parts(change: Change) -> str:
    """Count the components and ports that were added or removed with it."""
    counts = {"component": 0, "input": 0, "output": 0}
    for part in _walk_parts(change):
        if part.element_kind in counts and part.kind == change.kind:
            counts[part.element_kind] += 1
    words = [f"{count} {kind}{'s' if count > 1 else ''}" for kind, count in counts.items() if count]
    return f" with {join_words(words)}" if words else ""


def _walk_parts(change: Change) -> Iterator[Change]:
    for part in change.parts:
        yield part
        yield from _walk_parts(part)


def _describe_effects(change: Change, element: ComparedElement, versions: VersionPair) -> Iterator[str]:
    """Describe who lost the last reader or source or gained the first, and which requirements are served no more."""
    changed_keys = {(part.element_kind, part.element_id) for part in (change, *_walk_parts(change))}
    # A connection is known by its input.
    reader_ids = {common_input for kind, common_input in changed_keys if kind == "connection"}
    own_connections, other_connections = (
        (versions.connections_before, versions.connections_after)
        if change.kind == "removed"
        else (versions.connections_after, versions.connections_before)
    )
    if change.kind == "added" or change.element_kind == "input":
        yield from _describe_sources(reader_ids, changed_keys, versions, change.kind)
    for reader in sorted(reader_ids):
        common_input = _common_input(reader, versions)
        for source in sorted(
            own_connections.sources_by_input.get(common_input, frozenset())
            - other_connections.sources_by_input.get(common_input, frozenset())
        ):
            # A source that came or went itself has a change of its own.
            source_stays = ("output", source) in versions.elements_before and (
                "output",
                source,
            ) in versions.elements_after
            if source_stays and not other_connections.readers_by_output.get(source):
                yield _describe_open_end(source, "read", change.kind)
        if ("input", reader) not in changed_keys and not other_connections.sources_by_input.get(common_input):
            yield _describe_open_end(common_input, "fed", change.kind)
        elif ("input", reader) not in changed_keys:
            yield f"`{common_input}` {'loses one of its sources' if change.kind == 'removed' else 'gets another source'}"
    if (
        element.kind == "node"
        and change.kind == "removed"
        and isinstance(implemented_ids := element.values.get("implements"), frozenset)
    ):
        still_implemented = {
            common_input
            for key, candidate in versions.elements_after.items()
            if key[0] == "node"
            for common_input in _value_names(candidate.values.get("implements"))
        }
        unimplemented = [
            common_input
            for common_input in sorted(implemented_ids)
            if common_input not in still_implemented and ("component", common_input) in versions.elements_after
        ]
        yield from [f"no node implements {tick_names(unimplemented)} any more"] if unimplemented else []
    yield from _describe_unserved(element, versions)
    if element.kind == "requirement" and change.kind == "removed":
        serving_components = sorted(versions.serving_components[0].get(element.id, ()))
        yield from [f"it was served by {tick_names(serving_components)}"] if serving_components else []


def _describe_sources(
    reader_ids: Iterable[str], changed_keys: Collection[ElementKey], versions: VersionPair, change_kind: str
) -> Iterator[str]:
    """Describe what added or removed inputs read from outside of the change, except what is reported anyway."""
    own_connections, other_connections = (
        (versions.connections_after, versions.connections_before)
        if change_kind == "added"
        else (versions.connections_before, versions.connections_after)
    )
    common_inputs = [_common_input(name, versions) for name in reader_ids if ("input", name) in changed_keys]
    source_ids = sorted(
        {source for port in common_inputs for source in own_connections.sources_by_input.get(port, frozenset())}
    )
    staying_sources = {name for name in source_ids if all(versions.find_both("output", name))}
    told_anyway = {name for name in staying_sources if not other_connections.readers_by_output.get(name)}
    if change_kind == "removed":
        # What is gone as well is an item of its own.
        told_anyway |= {name for name in source_ids if versions.is_removed("output", name)}
    shown_ids = [shown_id("output", name, versions) for name in source_ids if name not in told_anyway]
    outside_ids = [name for name in shown_ids if ("output", name) not in changed_keys]
    if outside_ids:
        yield f"it {'reads' if change_kind == 'added' else 'read'} {tick_names(outside_ids)}"
    if change_kind == "removed":
        yield from describe_lost_effects(common_inputs, versions)


def _common_input(own_id: str, versions: VersionPair) -> str:
    """Return the common id of an input that may be given by its old one."""
    if ("input", own_id) in versions.elements_before or ("input", own_id) in versions.elements_after:
        return own_id
    return versions.find_common_id("input", own_id)


def _describe_open_end(name: str, verb: str, change_kind: str) -> str:
    if change_kind == "removed":
        return f"`{name}` is no longer read by anybody" if verb == "read" else f"`{name}` has no source any more"
    return f"`{name}` is read for the first time" if verb == "read" else f"`{name}` gets its first source"


def _describe_unserved(element: ComparedElement, versions: VersionPair) -> Iterator[str]:
    if element.kind not in {"component", "group"}:
        return
    before, after = versions.serving_components
    for requirement in sorted(before):
        if requirement not in after and ("requirement", requirement) in versions.elements_after:
            first_component = min(before[requirement])  # so that one change of several says it
            if element.id == first_component or first_component.startswith(f"{element.id}."):
                yield f"no component serves `{requirement}` any more"


def _value_names(value: object) -> list[str]:
    if isinstance(value, (frozenset, tuple)):
        return sorted(map(str, value)) if isinstance(value, frozenset) else [*map(str, value)]
    return [] if value is None else [str(to_plain_data(value))]


_OUTPUT_TIMING = "timing.outputs."


def describe_readers(output_id: str, versions: VersionPair) -> str:
    """Return who reads an output, with the partners other than its own: "read by `a.b.c` of Kite"; empty for nobody."""
    readers = versions.connections_after.readers_by_output.get(output_id, frozenset())
    return f"read by {_name_ports(readers, versions)}" if readers else ""


def _name_ports(inputs: Iterable[str], versions: VersionPair) -> str:
    """Return inputs by their partners: "`a.b.c` of Kite and `a.b.d` of Orsa"."""
    inputs_by_owner: dict[str, list[str]] = defaultdict(list)
    for name in sorted(inputs):
        element = versions.find_latest("input", name)
        inputs_by_owner[(element and element.owner) or ""].append(name)
    phrases = [
        tick_names(names) + (f" of {name_partner(owner, versions.partner_names)}" if owner else "")
        for owner, names in sorted(inputs_by_owner.items())
    ]
    return join_words(phrases)


def is_read_by_others(output_id: str, versions: VersionPair) -> bool:
    """Whether another partner than its own reads an output, in either version."""
    output = versions.find_latest("output", output_id)
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
        condition = "when there is something to say"
        phrase = f"is sent only {condition}" if change.after else f"is sent each time now, and not only {condition}"
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
