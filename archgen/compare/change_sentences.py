"""Describe changes in words: what happened, and what it means for those at the other end."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence

from archgen.compare.compared_elements import ComparedElement, ElementKey
from archgen.compare.comparison import Change
from archgen.compare.connection_maps import RewiredInput
from archgen.compare.key_phrases import describe_key_change, shorten_text
from archgen.compare.normal_values import ElementTitle, to_plain_data
from archgen.compare.version_pair import VersionPair
from archgen.diagnostics.common_wording import join_words
from archgen.transform import ros_names

_SURE_CONFIDENCE = 0.85
"""From here on a rename is stated without its confidence."""

_KIND_WORDS = {
    "use_case": "use case",
    "message": "message definition",
    "port": "port",
}
_NEW_ELEMENT_VERBS: Mapping[str, Mapping[str, str]] = {
    "node": {"implements": "implements", "host": "runs on", "container": "runs in the container"},
    "type": {"message": "is"},
    "requirement": {"use_cases": "belongs to"},
    "link": {"connects": "connects"},
    "chain": {"through": "leads through", "deadline": "must end within"},
}
"""For each kind, the keys reported of a new element, each with a verb."""
_MAX_EFFECTS = 3
"""Maximal number of effects in one sentence; all of them are in the parts."""


def describe_element_change(change: Change, element: ComparedElement, versions: VersionPair) -> str:
    """Describe an element that was added or removed, with the effects of its connections on others."""
    verb = "is added" if change.kind == "added" else "is removed"
    kind_word = _KIND_WORDS.get(change.element_kind, change.element_kind)
    sentence = f"{kind_word} `{shorten_text(change.element_id)}`{_title_note(element)} {verb}{_count_parts(change)}"
    if change.kind == "added":
        sentence += _describe_new_element(element)
    effects = list(_describe_effects(change, element, versions))
    return "; ".join((sentence, *_limit_effects(effects)))


def _title_note(element: ComparedElement) -> str:
    title = element.values.get("title")
    return f" ({shorten_text(title.text)})" if isinstance(title, ElementTitle) and not title.generated else ""


def _describe_new_element(element: ComparedElement) -> str:
    """Describe what matters most of a new element, such as a node's place or the way of a chain."""
    if element.kind == "policy":
        return f"; nothing may lead from `{shorten_text(str(element.values['forbid.from']))}` to `{shorten_text(str(element.values['forbid.to']))}`"
    clauses = [
        f"{verb} {_tick_names(referred_names)}"
        for key, verb in _NEW_ELEMENT_VERBS.get(element.kind, {}).items()
        if (referred_names := _value_names(element.values.get(key)))
    ]
    return f"; it {join_words(clauses)}" if clauses else ""


def _value_names(value: object) -> list[str]:
    if isinstance(value, (frozenset, tuple)):
        return sorted(map(str, value)) if isinstance(value, frozenset) else [*map(str, value)]
    return [] if value is None else [str(to_plain_data(value))]


def _limit_effects(effects: Sequence[str]) -> Sequence[str]:
    surplus = len(effects) - _MAX_EFFECTS
    return effects if surplus <= 0 else (*effects[:_MAX_EFFECTS], f"and {surplus} more such effects")


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
        yield from [f"no node implements {_tick_names(unimplemented)} any more"] if unimplemented else []
    yield from _describe_unserved(element, versions)
    if element.kind == "requirement" and change.kind == "removed":
        serving_components = sorted(versions.serving_components[0].get(element.id, ()))
        yield from [f"it was served by {_tick_names(serving_components)}"] if serving_components else []


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
    staying_sources = {
        name
        for name in source_ids
        if ("output", name) in versions.elements_before and ("output", name) in versions.elements_after
    }
    told_anyway = {name for name in staying_sources if not other_connections.readers_by_output.get(name)}
    shown_ids = [_shown_id("output", name, versions) for name in source_ids if name not in told_anyway]
    outside_ids = [name for name in shown_ids if ("output", name) not in changed_keys]
    if outside_ids:
        yield f"it {'reads' if change_kind == 'added' else 'read'} {_tick_names(outside_ids)}"


def _common_input(own_id: str, versions: VersionPair) -> str:
    """Return the common id of an input that may be given by its old one."""
    if ("input", own_id) in versions.elements_before or ("input", own_id) in versions.elements_after:
        return own_id
    return next(
        (
            name
            for (kind, name), old_element in versions.elements_before.items()
            if kind == "input" and old_element.own_id == own_id
        ),
        own_id,
    )


def _shown_id(kind: str, name: str, versions: VersionPair) -> str:
    element = None if (kind, name) in versions.elements_after else versions.elements_before.get((kind, name))
    return element.own_id if element else name


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


def describe_rename(change: Change, versions: VersionPair) -> str:
    """Describe a rename or a move, and the names on the robot that follow it."""
    kind_word = _KIND_WORDS.get(change.element_kind, change.element_kind)
    old_id = change.old_id or ""
    if change.kind == "moved":
        old_path, new_path = old_id.rpartition("."), change.element_id.rpartition(".")
        name_note = "" if old_path[2] == new_path[2] else f" and is called `{new_path[2]}` now"
        sentence = f"{kind_word} `{old_id}` moved to the group `{new_path[0]}`{name_note}"
    elif change.element_kind in {"component", "input", "output"}:
        sentence = f"{kind_word} `{old_id}` is called `{change.element_id.rpartition('.')[2]}` now"
    else:
        sentence = f"{kind_word} `{shorten_text(old_id)}` is called `{shorten_text(change.element_id)}` now"
    confidence_note = (
        ""
        if change.confidence >= _SURE_CONFIDENCE
        else f" (recognised with {round(change.confidence * 100)} % confidence)"
    )
    return sentence + confidence_note + _describe_following_names(change, versions)


def _describe_following_names(change: Change, versions: VersionPair) -> str:
    """Describe which topics, services and actions get another name because nobody named them."""
    if change.element_kind not in {"group", "component", "output"}:
        return ""
    inner_outputs = (
        port
        for port in versions.unnamed_outputs
        if port == change.element_id or port.startswith(f"{change.element_id}.")
    )
    renamed_outputs = sorted(port for port in inner_outputs if ("output", port) in versions.elements_before)
    if not renamed_outputs:
        return ""
    old_output = versions.elements_before["output", renamed_outputs[0]].own_id
    surplus_note = f", and {len(renamed_outputs) - 1} more such names follow" if len(renamed_outputs) > 1 else ""
    return f"; `{ros_names.default_port_name(old_output)}` becomes `{ros_names.default_port_name(renamed_outputs[0])}`{surplus_note}"


def describe_connection(rewired_input: RewiredInput, versions: VersionPair) -> str:
    """Describe what an input reads now, and what that leaves unread."""
    reader = f"`{_shown_id('input', rewired_input.input_id, versions)}`"
    if versions.is_removed("input", rewired_input.input_id):
        return _describe_removed_reader(rewired_input, reader, versions)
    sentence = _describe_reading(rewired_input, reader, versions)
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
    sentence += f"; nobody reads {_tick_names(unread_outputs)} any more" if unread_outputs else ""
    return sentence + (f"; nobody read {_tick_names(newly_read_outputs)} before" if newly_read_outputs else "")


def _describe_reading(rewired_input: RewiredInput, reader: str, versions: VersionPair) -> str:
    """Describe which sources an input gained and lost."""
    lost_outputs = [_shown_id("output", name, versions) for name in sorted(rewired_input.lost_sources)]
    gained_outputs = sorted(rewired_input.gained_sources)
    # A reference to what has no output yet stands for itself in the map of connections (`map_connections`).
    if (
        lost_outputs
        and gained_outputs
        and not any(("output", name) in versions.elements_after for name in gained_outputs)
    ):
        return f"{reader} no longer reads {_tick_names(lost_outputs)}: {_tick_names(gained_outputs)} {'has' if len(gained_outputs) == 1 else 'have'} no output any more"
    if lost_outputs and gained_outputs:
        return f"{reader} now reads {_tick_names(gained_outputs)} instead of {_tick_names(lost_outputs)}"
    if lost_outputs:
        all_removed = all(versions.is_removed("output", name) for name in rewired_input.lost_sources)
        removal_note = f", which {'was' if len(lost_outputs) == 1 else 'were'} removed" if all_removed else ""
        return f"{reader} no longer reads {_tick_names(lost_outputs)}{removal_note}{'' if rewired_input.sources_after else '; it has no source any more'}"
    if versions.is_added("input", rewired_input.input_id):
        return f"{reader} reads {_tick_names(gained_outputs)}"
    if rewired_input.sources_before:
        return f"{reader} now also reads {_tick_names(gained_outputs)}"
    return f"{reader} now reads {_tick_names(gained_outputs)}, its first source{'s' if len(gained_outputs) > 1 else ''}"


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
        "; ".join(_limit_effects(sentences))
        or f"{reader}, which read {_tick_names(_shown_id('output', output_id, versions) for output_id in sorted(rewired_input.lost_sources))}, was removed"
    )


def describe_port_change(change_kind: str, element: ComparedElement, versions: VersionPair) -> str:
    """Describe that a node carries a port, or no longer does."""
    node_id, _, name = element.own_id.partition(".")
    topic_names = (
        ", ".join(sorted(map(str, topics))) if isinstance(topics := element.values.get("topic"), frozenset) else ""
    )
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


def describe_change(change: Change, versions: VersionPair) -> str:
    """Describe the old and new value of a key, and whom that concerns."""
    return "; ".join(filter(None, (describe_key_change(change), _describe_concerned(change, versions))))


def _describe_concerned(change: Change, versions: VersionPair) -> str:
    """Describe who is at the other end of a change: readers, carriers, requirements that nothing serves any more."""
    element_id = change.element_id
    match change.element_kind, change.key:
        case "output", "type":
            readers = sorted(versions.connections_after.readers_by_output.get(element_id, frozenset()))
            return f"it is read by {_tick_names(readers)}" if readers else ""
        case "type", "message" | "size":
            outputs = versions.find_elements_with("output", "type", element_id)
            return f"{_tick_names(outputs)} {'carry' if len(outputs) > 1 else 'carries'} it" if outputs else ""
        case "message", _:
            types = versions.find_elements_with("type", "message", element_id)
            return f"it carries {_tick_names(types)}" if types else ""
        case "component", "requirements":
            before, after = versions.serving_components
            lost_requirements = [
                requirement
                for requirement in sorted(before)
                if requirement not in after and element_id == min(before[requirement])
            ]
            unserved = [
                requirement
                for requirement in lost_requirements
                if ("requirement", requirement) in versions.elements_after
            ]
            return f"no component serves {_tick_names(unserved)} any more" if unserved else ""
    return ""


def _tick_names(names: Iterable[str]) -> str:
    """Return element names in backticks, the surplus counted."""
    ticked_names = [f"`{shorten_text(name)}`" for name in names]
    limit = 2 * _MAX_EFFECTS
    return (
        join_words(ticked_names)
        if len(ticked_names) <= limit
        else join_words([*ticked_names[: limit - 1], f"{len(ticked_names) - limit + 1} more"])
    )
