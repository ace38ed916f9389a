"""What a partner reads is something else now, or is going away: another type, another message, another version."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence

from archgen.compare.comparison import Change
from archgen.compare.losses.change_context import ChangeContext, PartnerLoss, tick_name, tick_sorted_names
from archgen.compare.losses.weakened_demands import compare_lives
from archgen.compare.matched_ids import MatchedIds
from archgen.model.architecture import Architecture
from archgen.model.component import ComponentType
from archgen.model.graph_search import find_reachable
from archgen.model.known_interfaces import Interface
from archgen.model.message_types import ConceptualType
from archgen.model.port_media import describe_carried
from archgen.model.ros_distro import is_ros_1

DefinitionUse = tuple[bool, str]
"""Whether somebody writes what is defined, and the partner."""


class MessageUsers:
    """The users of types and messages in the first version."""

    def __init__(self, context: ChangeContext) -> None:
        self._context = context
        self._uses: dict[tuple[str, str], list[DefinitionUse]] = defaultdict(list)
        for endpoint in context.before.endpoints:
            node = context.before.nodes[endpoint.node]
            component = context.before.components.get(endpoint.component or "")
            partner = (component.owner if component else None) or node.owner
            if not partner:
                continue
            use = endpoint.use in {"publishes", "serves"}, context.matched_ids.common_id("partner", partner)
            if endpoint.message:
                self._uses["message", context.matched_ids.common_id("message", endpoint.message)].append(use)
            if endpoint.type:
                self._uses["type", context.matched_ids.common_id("type", endpoint.type)].append(use)

    def partners_using_type(self, type_name: str) -> list[str]:
        """Return the partners whom another definition of a type breaks, sorted."""
        return _other_partners(self._uses.get(("type", type_name), ()))

    def partners_using_message(self, message_name: str) -> list[str]:
        """Return the partners whom another definition of a message breaks, also inside of other messages, sorted."""
        names = _messages_containing(self._context, message_name)
        return _other_partners([use for name in names for use in self._uses.get(("message", name), ())])


def _other_partners(uses: Sequence[DefinitionUse]) -> list[str]:
    """Return all users but the one who alone writes what is defined, if there is one."""
    writers = {partner for is_writer, partner in uses if is_writer}
    return sorted({partner for _, partner in uses} - (writers if len(writers) == 1 else frozenset()))


def _messages_containing(context: ChangeContext, message_name: str) -> Sequence[str]:
    """Return a message of the second version and all that contain it, at any depth."""
    packages = context.after.interfaces.project_packages
    project_messages = [
        interface_name
        for interface_name in context.after.interfaces.names
        if interface_name.partition("/")[0] in packages
    ]
    containers_by_type: Mapping[str, list[str]] = defaultdict(list)
    for container_name in sorted(project_messages):
        definition = context.after.interfaces.definitions.get(container_name)
        for part in definition.parts if definition else ():
            for field in part:
                containers_by_type[field.type].append(container_name)
    return list(find_reachable(containers_by_type, [message_name]))


_INNER_TYPE_KEYS = ("request", "response", "feedback")


def find_retyped_outputs(context: ChangeContext) -> Iterator[PartnerLoss]:
    """Find outputs that another partner reads and that have another conceptual type or message, or carry none any more."""
    old_messages = _messages_by_output(context.before, context.matched_ids)
    new_messages = _messages_by_output(context.after, MatchedIds())
    for output, readers in sorted(context.versions.connections_before.readers_by_output.items()):
        new_element = context.versions.elements_after.get(("output", output))
        if new_element is None:
            continue
        old_element = context.versions.elements_before["output", output]
        old_type = old_element.values.get("type")
        messages_before, messages_after = old_messages.get(output, frozenset()), new_messages.get(output, frozenset())
        indices, change = _type_change(
            context, output, (old_type, new_element.values.get("type")), (messages_before, messages_after)
        )
        if (medium_change := _medium_change(context, output))[0]:
            indices, change = medium_change
        if change:
            reason_text = f"gives {change} as {tick_name(context.old_id('output', output))}; {{}} it"
            readers_by_partner = context.foreign_readers(output, readers)
            yield from context.shared_losses(indices, readers_by_partner, reason_text, "reads", "wire")


def _medium_change(context: ChangeContext, output_id: str) -> tuple[list[int], str]:
    """Return the indices of changes that put an output onto another medium, and what it gives now; ([], "") if none did."""
    old_port = context.before.outputs.get(context.old_id("output", output_id))
    new_port = context.after.outputs.get(output_id)
    if old_port is None or new_port is None or old_port.medium == new_port.medium:
        return [], ""
    indices = context.change_indices("output", output_id, "medium")
    if not indices and context.before.project.middleware != context.after.project.middleware:
        # What says nothing of its medium goes over the project's.
        indices = context.change_indices("project", context.after.project.id, "middleware")
    return indices, f"{describe_carried(new_port)} instead of {describe_carried(old_port)}"


def _type_change(
    context: ChangeContext,
    output_id: str,
    type_pair: tuple[object, object],
    message_pair: tuple[frozenset[str], frozenset[str]],
) -> tuple[list[int], str]:
    """Return the indices of changes that retyped an output, and what it gives now; ([], "") if nothing changed."""
    (old_type, new_type), (messages_before, messages_after) = type_pair, message_pair
    if old_type is not None and old_type != new_type:
        message_note = (
            f" (the message stays {tick_sorted_names(messages_after)})"
            if messages_before and messages_before == messages_after
            else ""
        )
        replacement = f"{tick_name(new_type) if new_type else 'no type any more'} instead of {tick_name(old_type)}"
        return context.change_indices("output", output_id, "type"), replacement + message_note
    if messages_before & messages_after:
        renaming = _renamed_messages(context, messages_before & messages_after)
        if renaming[0]:
            return renaming
    if not messages_before or messages_before == messages_after:
        return [], ""
    node_ids = [node for node, port in context.offered_endpoints[1] if port == output_id]
    indices = [place for node in node_ids for place in context.port_change_indices(node, output_id, "message")]
    replacement = (
        f"{tick_sorted_names(messages_after) or 'no message any more'} instead of {tick_sorted_names(messages_before)}"
    )
    return indices or (context.change_indices("type", str(new_type), "message") if new_type else []), replacement


def _renamed_messages(context: ChangeContext, message_names: frozenset[str]) -> tuple[list[int], str]:
    """Return the indices of the changes that renamed messages of an output, and what it gives now.

    Files follow; programs do not, since ROS tells messages apart by their names.
    """
    old_names = context.matched_ids.old_ids.get("message", {})
    renamed = sorted(name for name in message_names if old_names.get(name, name) != name)
    indices = [index for name in renamed for index in context.indices_by_change_kind("message", name, "renamed")]
    old_text = tick_sorted_names(old_names[name] for name in renamed)
    return indices, f"{tick_sorted_names(renamed)} instead of {old_text} (by another name it is another message to ROS)"


def _messages_by_output(architecture: Architecture, matched_ids: MatchedIds) -> Mapping[str, frozenset[str]]:
    """Return the messages of each output: those of the nodes that write it, else that of its type."""
    messages_by_port: dict[str, set[str]] = defaultdict(set)
    for endpoint in architecture.endpoints:
        if endpoint.use in {"publishes", "serves"} and endpoint.port and endpoint.message:
            messages_by_port[endpoint.port].add(endpoint.message)
    for output in architecture.outputs.values():
        message = architecture.message_of(output)
        if message and output.id not in messages_by_port:
            messages_by_port[output.id].add(message)
    return {
        matched_ids.common_id("output", port): frozenset(
            matched_ids.common_id("message", message_name) for message_name in message_names
        )
        for port, message_names in messages_by_port.items()
    }


def find_redefined_messages(context: ChangeContext) -> Iterator[PartnerLoss]:
    """Find changed message definitions and inner types, and the partners that are built against them."""
    users = MessageUsers(context)
    for index, change in enumerate(context.changes):
        if change.kind not in {"changed", "removed"}:
            continue
        if change.element_kind == "message":
            common_id = context.common_id(change)
            partners = users.partners_using_message(common_id)
            if partners and (reason_text := _redefinition_reason(context, change, common_id)):
                yield from context.losses_of_users([index], partners, reason_text, "uses")
        elif change.element_kind == "type" and change.key in _INNER_TYPE_KEYS and change.before is not None:
            partners = users.partners_using_type(change.element_id)
            reason_text = f"changes the {change.key} of {tick_name(change.element_id)}, which {{}}"
            yield from context.losses_of_users([index], partners, reason_text, "uses")
        elif change.element_kind == "type" and (change.key or "").startswith("fields."):
            yield from _find_retyped_field(context, users, index, change)


def _find_retyped_field(
    context: ChangeContext, users: MessageUsers, index: int, change: Change
) -> Iterator[PartnerLoss]:
    """Find the users of a field that holds another conceptual type with the same message: other bytes are told above."""
    message = context.after.types[change.element_id].message
    if message is not None and change.before is not None and change.after is not None:
        partners = users.partners_using_message(message)
        field_name = tick_name((change.key or "").removeprefix("fields."))
        reason_text = (
            f"puts {tick_name(change.after)} instead of {tick_name(change.before)} into {field_name} of "
            f"{tick_name(change.element_id)}; {{}} it"
        )
        yield from context.losses_of_users([index], partners, reason_text, "uses", "meaning")


def _redefinition_reason(context: ChangeContext, change: Change, message_name: str) -> str:
    """Return what the users lose by a changed key of a definition, `{}` for who uses it; empty if nothing: what comments
    mean is judged elsewhere, constants that are new break nobody.
    """
    section, _, name = (change.key or "fields").partition(".")
    if section == "fields":
        return _rebuild_reason(context, message_name)
    ticked_name = tick_name(message_name)
    # ROS 1 takes constants into the checksum that two programs compare before they talk.
    if section == "constants" and is_ros_1(context.after.distro):
        return (
            f"changes the constant {tick_name(name)} of {ticked_name}, which {{}}; what was built before "
            "cannot talk to what is built after"
        )
    verb = "takes away" if change.after is None else "changes"
    if section == "constants" and change.before is not None:
        return (
            f"{verb} the constant {tick_name(name)} of {ticked_name}, which {{}}; what was built before means "
            "something else by the same bytes"
        )
    if section == "defaults" and change.before is not None:
        return f"{verb} the default of {tick_name(name)} in {ticked_name}, which {{}}: what does not set it sends something else"
    return ""


def _rebuild_reason(context: ChangeContext, message_name: str) -> str:
    """Describe what is different for partners that were built against a message definition."""
    old_definition = context.before.interfaces.definitions.get(
        context.matched_ids.old_ids.get("message", {}).get(message_name, message_name)
    )
    new_definition = context.after.interfaces.definitions.get(message_name)
    ticked_name = tick_name(message_name)
    if new_definition is None or old_definition is None:
        return f"takes away the definition of {ticked_name}, which {{}}"
    removed, added, retyped_fields = _compare_fields(old_definition, new_definition)
    clauses = [f"removes {tick_sorted_names(removed)}"] if removed else []
    clauses += [f"changes the type of {tick_sorted_names(retyped_fields)}"] if retyped_fields else []
    clauses += [f"adds {tick_sorted_names(added)}"] if added else []
    difference = " and ".join(clauses) or "puts fields in another order"
    # The wire format of ROS has no optional fields; ROS 1 compares checksums and ROS 2 type hashes
    # (docs/decisions/0007-breaking-changes.md).
    addition_note = (
        "even a field more makes another message to ROS: " if added and not (removed or retyped_fields) else ""
    )
    return f"{difference} in {ticked_name}, which {{}}; {addition_note}what was built before cannot talk to what is built after"


def _compare_fields(old_definition: Interface, new_definition: Interface) -> tuple[set[str], set[str], set[str]]:
    """Return the names of the removed, added and changed fields."""
    old_fields, new_fields = (
        {(number, field.name): (field.type, field.array) for number, part in enumerate(each.parts) for field in part}
        for each in (old_definition, new_definition)
    )
    retyped = {key for key in old_fields.keys() & new_fields.keys() if old_fields[key] != new_fields[key]}
    removed, added = old_fields.keys() - new_fields.keys(), new_fields.keys() - old_fields.keys()
    return {name for _, name in removed}, {name for _, name in added}, {name for _, name in retyped}


_Lives = Mapping[str, ConceptualType] | Mapping[str, ComponentType]


def find_deprecated_types(context: ChangeContext) -> Iterator[PartnerLoss]:
    """Find types and component types with another version, or that are deprecated now, and the partners who use them."""
    message_users: MessageUsers | None = None
    before, after = context.before, context.after
    pairs: tuple[tuple[str, _Lives, _Lives], ...] = (
        ("type", before.types, after.types),
        ("component_type", before.component_types, after.component_types),
    )
    for kind, old_types, new_types in pairs:
        for name, old in old_types.items():
            common_id = context.matched_ids.common_id(kind, name)
            new = new_types.get(common_id)
            if new is None or (old.version is None and old.deprecated == new.deprecated):
                continue
            for words, key, category in compare_lives(old, new):
                if kind == "type":
                    message_users = message_users or MessageUsers(context)
                    partners = message_users.partners_using_type(common_id)
                else:
                    partners = _list_instance_owners(context, name)
                indices = context.change_indices(kind, common_id, key) or context.indices_below(
                    kind, common_id, key.partition(".")[0]
                )
                reason_text = f"{words.replace('{}', tick_name(name), 1)}; {{}} it"
                yield from context.losses_of_users(indices, partners, reason_text, "uses", category)


def _list_instance_owners(context: ChangeContext, type_name: str) -> list[str]:
    """Return the partners who own instances of a component type, or of types that are made from it, sorted."""
    owners = {
        context.matched_ids.common_id("partner", component.owner)
        for component in context.before.list_described_components()
        if component.owner and any(base.id == type_name for base in context.before.list_bases(component.type_name))
    }
    return sorted(owners)


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
