"""The same bytes mean something else: what is said of outputs, types and components, and the coordinate frames relied on.

A parameter is gone, has another unit or type, or no longer takes a value: partners whose nodes or instances set it lose.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from functools import cached_property

from archgen.compare.comparison import Change
from archgen.compare.key_phrases import format_value
from archgen.compare.losses.change_context import ChangeContext, PartnerLoss, tick_name
from archgen.compare.losses.changed_definitions import MessageUsers
from archgen.compare.losses.lost_connections import find_output_causes
from archgen.compare.text_meaning import differs_in_meaning, differs_in_measures, quote_difference
from archgen.model.architecture import Architecture
from archgen.model.component import Output
from archgen.model.coordinate_frames import index_child_frames
from archgen.model.graph_search import find_reachable
from archgen.model.node import Node
from archgen.model.parameter import Parameter
from archgen.model.parameter_values import find_value_fault
from archgen.model.partner_interfaces import is_set_by_instance, list_set_values
from archgen.model.project_settings import BreakCategory
from archgen.model.quantity import Quantity, parse_quantity


def find_changed_frames(context: ChangeContext) -> Iterator[PartnerLoss]:
    """Find frames that mean something else to the partners who use them, and outputs that are given in another one."""
    yield from _find_turned_outputs(context)
    changes = [
        (index, change)
        for index, whole_change in enumerate(context.changes)
        for change in context.walk_change(whole_change)
        if change.element_kind == "frame"
    ]
    users = _FrameUsers(context) if changes else None
    for index, change in changes:
        lost = _describe_loss(context, change)
        if lost and users:
            reason_text, category, reaches_below = lost
            parts = users.list_users(context.common_id(change), reaches_below=reaches_below)
            yield from context.shared_losses([index], parts, f"{reason_text}; {{}} it", "uses", category)


def _describe_loss(context: ChangeContext, change: Change) -> tuple[str, BreakCategory, bool] | None:
    """Return what is said of a changed frame, what its users lose by it, and whether users of frames below it do, too."""
    name = tick_name(change.old_id or change.element_id)
    if change.kind == "removed":
        return f"takes away the frame {name}", "wire", False
    if change.kind == "renamed":
        # Programs look frames up by their names; files follow, programs do not.
        return f"calls {tick_name(change.element_id)} what was the frame {name}", "wire", False
    if change.kind != "changed" or change.before is None:
        return None
    after = format_value(change.after) if change.after is not None else ""
    instead = f"instead of {format_value(change.before)}"
    losses: dict[str, tuple[str, BreakCategory, bool]] = {
        "parent": (f"places the frame {name} in {after or 'nothing'} {instead}", "meaning", True),
        "by": (f"has the frame {name} written by {after or 'nobody'} {instead}", "promise", False),
        "rate": (f"writes the frame {name} at {after or 'no rate any more'} {instead}", "promise", False),
    }
    # A lower rate takes from the margin alone: nobody has said how old a transform may be.
    is_weakened = change.key != "rate" or (context.guards_margins and _is_rarer(change))
    return losses.get(change.key or "") if is_weakened else None


def _is_rarer(change: Change) -> bool:
    before, after = (parse_quantity(str(value), "frequency") for value in (change.before, change.after))
    return isinstance(before, Quantity) and (after is None or after.value < before.value)


class _FrameUsers:
    """Who used which frame in the first version, by common ids."""

    def __init__(self, context: ChangeContext) -> None:
        self._context = context

    def list_users(self, frame_name: str, *, reaches_below: bool) -> Mapping[str, list[str]]:
        """Return the ports and frames that use a frame, by partner; who looks up a frame below it uses it, too."""
        names: Iterable[str] = [frame_name]
        if reaches_below:
            names = find_reachable(self._frames_below, [frame_name])
        parts_by_partner: dict[str, set[str]] = defaultdict(set)
        for name in names:
            for kind, element_id in self._users_by_frame.get(name, ()):
                partner = self._context.owner_before(kind, element_id)
                if partner:
                    parts_by_partner[partner].add(self._context.old_id(kind, element_id))
        return {partner: sorted(parts) for partner, parts in parts_by_partner.items()}

    @cached_property
    def _frames_below(self) -> Mapping[str, list[str]]:
        common_id = self._context.matched_ids.common_id
        return {
            common_id("frame", name): [common_id("frame", child.id) for child in children]
            for name, children in index_child_frames(self._context.before.frames).items()
        }

    @cached_property
    def _users_by_frame(self) -> Mapping[str, list[tuple[str, str]]]:
        architecture, common_id = self._context.before, self._context.matched_ids.common_id
        users: dict[str, list[tuple[str, str]]] = defaultdict(list)
        for kind, ports in (("output", architecture.outputs), ("input", architecture.inputs)):
            for port in ports.values():
                frame_name = architecture.frame_of(port)
                if frame_name is not None:
                    users[common_id("frame", frame_name)].append((kind, common_id(kind, port.id)))
        for frame in architecture.frames.values():
            if frame.parent is not None:
                users[common_id("frame", frame.parent)].append(("frame", common_id("frame", frame.id)))
        return users


def _find_turned_outputs(context: ChangeContext) -> Iterator[PartnerLoss]:
    """Find outputs whose data is given in another frame: the same numbers mean another place."""
    for output, new_output, inputs_by_partner in context.lasting_outputs:
        before = _find_frame(context.before, context.before.outputs.get(context.old_id("output", output)))
        old_frame = context.matched_ids.common_id("frame", before) if before else None
        new_frame = _find_frame(context.after, context.after.outputs.get(new_output))
        if old_frame is None or old_frame == new_frame:
            continue
        indices = context.change_indices("output", new_output, "frame", "type") or [
            index
            for name in _list_types(context, context.old_id("output", output))
            for index in context.change_indices("type", name, "frame")
        ]
        given = f"in {tick_name(new_frame)}" if new_frame else "in no frame any more"
        reason_text = (
            f"gives {tick_name(context.old_id('output', output))} {given} instead of {tick_name(before)}; {{}} it"
        )
        causes = indices or find_output_causes(context, output)
        yield from context.shared_losses(causes, inputs_by_partner, reason_text, "reads", "meaning")


def _find_frame(architecture: Architecture, port: Output | None) -> str | None:
    return architecture.frame_of(port) if port else None


def _list_types(context: ChangeContext, output_id: str) -> Iterator[str]:
    port = context.before.outputs.get(output_id)
    if port and port.type:
        yield context.matched_ids.common_id("type", port.type)


_MEASURE_PARAMETER = re.compile(r"^parameters\.(?:.*[._])?(?:frame|frame_id|units?)$")
_COMPONENT_TEXTS = ("functionality", "description")


def find_changed_meanings(context: ChangeContext) -> Iterator[PartnerLoss]:
    """Find texts that partners rely on and that say something else, or nothing any more.

    A text where none was tells what was true already; it concerns those who read it, and breaks nobody.
    """
    yield from _find_rewritten_outputs(context)
    yield from _find_rewritten_components(context)
    yield from _find_changed_frames(context)
    yield from _find_rewritten_definitions(context)


def _find_rewritten_outputs(context: ChangeContext) -> Iterator[PartnerLoss]:
    for output, new_output, inputs_by_partner in context.lasting_outputs:
        words = _compare_texts(*_read_texts(context, ("output", output), ("output", new_output), "description"))
        if words:
            indices = context.change_indices("output", new_output, "description") or find_output_causes(context, output)
            reason_text = f"says of {tick_name(context.old_id('output', output))} {words}; {{}} it"
            yield from context.shared_losses(indices, inputs_by_partner, reason_text, "reads", "meaning")


def _find_rewritten_components(context: ChangeContext) -> Iterator[PartnerLoss]:
    """Find components whose text gives other units, frames or numbers: only these say what is in their outputs."""
    for component, readers in _inputs_by_component(context).items():
        key = "component", component
        for text_key in _COMPONENT_TEXTS:
            before, after = _read_texts(context, key, key, text_key)
            words = _compare_texts(before, after) if differs_in_measures(before, after) else ""
            if words:
                indices = context.change_indices(*key, text_key)
                reason_text = f"says of {tick_name(component)} {words}; {{}} it"
                yield from context.shared_losses(indices, readers, reason_text, "reads", "meaning")


def _find_changed_frames(context: ChangeContext) -> Iterator[PartnerLoss]:
    """Find parameters of nodes and components that name a frame or a unit, and have another value."""
    changes = [
        (index, change)
        for index, change in enumerate(context.changes)
        if change.element_kind in {"node", "component"}
        and change.before is not None
        and _MEASURE_PARAMETER.search(change.key or "")
    ]
    inputs_by_component = _inputs_by_component(context) if changes else {}
    for index, change in changes:
        element = context.versions.elements_before.get(("node", change.element_id))
        readers: dict[str, list[str]] = defaultdict(list)
        for component in element.component_refs if element else ():
            for partner, inputs in inputs_by_component.get(component, {}).items():
                readers[partner] += inputs
        name = tick_name((change.key or "").removeprefix("parameters."))
        values = f"{format_value(change.after) if change.after is not None else 'nothing'} instead of {format_value(change.before)}"
        reason_text = f"sets {name} of {tick_name(change.element_id)} to {values}; {{}} what it sends"
        yield from context.shared_losses([index], readers, reason_text, "reads", "meaning")


def _inputs_by_component(context: ChangeContext) -> Mapping[str, Mapping[str, list[str]]]:
    """Return for each component the inputs of other partners that read its outputs, by partner."""
    inputs_by_component: dict[str, dict[str, list[str]]] = {}
    for output, new_output, inputs_by_partner in context.lasting_outputs:
        if output == new_output:
            readers = inputs_by_component.setdefault(output.rpartition(".")[0], {})
            for partner, inputs in inputs_by_partner.items():
                readers.setdefault(partner, []).extend(inputs)
    return inputs_by_component


def _find_rewritten_definitions(context: ChangeContext) -> Iterator[PartnerLoss]:
    """Find comments of types, messages and their fields that say something else, and types with another unit in their
    name.
    """
    users: MessageUsers | None = None
    for index, change in enumerate(context.changes):
        words = _describe_rewriting(context, change)
        if not words:
            continue
        users = users or MessageUsers(context)
        partners = (
            users.partners_using_type(change.element_id)
            if change.element_kind == "type"
            else users.partners_using_message(change.element_id)
        )
        yield from context.losses_of_users([index], partners, f"{words}; {{}} it", "uses", "meaning")


def _describe_rewriting(context: ChangeContext, change: Change) -> str:
    """Return what a change makes of a type or a message in other words; empty if they mean the same."""
    old_id = change.old_id or ""
    if change.kind == "renamed" and change.element_kind == "type" and differs_in_measures(old_id, change.element_id):
        return f"calls {tick_name(change.element_id)} what was {tick_name(old_id)}"
    subject = _commented_subject(context, change)
    before, after = (value if isinstance(value, str) else "" for value in (change.before, change.after))
    words = _compare_texts(before, after) if subject else ""
    return f"says of {subject} {words}" if words else ""


def _commented_subject(context: ChangeContext, change: Change) -> str:
    """Return what the changed comment speaks of; empty where the change is none of a comment, or of what is gone."""
    if change.kind != "changed" or change.element_kind not in {"type", "message"} or not change.key:
        return ""
    name = tick_name(change.element_id)
    if change.key == "comment":
        return name
    section, _, part = change.key.partition(".")
    definition = context.after.interfaces.definitions.get(change.element_id)
    if section != "comments" or definition is None:
        return ""
    present_names = {each.name for group in definition.parts for each in group}
    present_names |= {each.name for group in definition.constants for each in group}
    return f"{tick_name(part)} in {name}" if part.rpartition(".")[2] in present_names else ""


def _read_texts(
    context: ChangeContext, old_key: tuple[str, str], new_key: tuple[str, str], text_key: str
) -> tuple[str, str]:
    """Return a text of both versions; nothing of what is the same in both."""
    old_element = context.versions.elements_before.get(old_key)
    new_element = context.versions.elements_after.get(new_key)
    if old_element is new_element:
        return "", ""
    before, after = (str(each.values.get(text_key) or "") if each else "" for each in (old_element, new_element))
    return before, after


def _compare_texts(before: str, after: str) -> str:
    """Return the old and the new words; empty if nothing was said, or the same is meant."""
    if not before or not differs_in_meaning(before, after):
        return ""
    old_words, new_words = quote_difference(before, after)
    return f"{tick_name(new_words)} instead of {tick_name(old_words)}" if after else f"no longer {tick_name(old_words)}"


_SECTION = "parameters."
_LIMITING_PARTS = frozenset({"type", "range", "choices"})


def find_changed_parameters(context: ChangeContext) -> Iterator[PartnerLoss]:
    """Find parameters that a partner's node sets and that its component no longer has, or means otherwise."""
    nodes_by_component: dict[str, list[Node]] = {}
    for node in context.after.nodes.values():
        for component_id in node.implements:
            nodes_by_component.setdefault(component_id, []).append(node)
    for index, change in enumerate(context.changes):
        if change.element_kind == "component_type":
            yield from _find_lost_settings(context, index, change)
        if change.element_kind != "component" or not (change.key or "").startswith(_SECTION) or change.before is None:
            continue
        name, _, part = (change.key or "").removeprefix(_SECTION).partition(":")
        setting_nodes = [
            node for node in nodes_by_component.get(change.element_id, ()) if list_set_values(context.after, node, name)
        ]
        phrase = _describe_lost_setting(context.after, change, name, part, setting_nodes) if setting_nodes else ""
        if phrase:
            partners = dict.fromkeys(owner for node in setting_nodes for owner in node.owners)
            category: BreakCategory = "meaning" if part == "unit" else "wire"
            yield from context.losses_of_users([index], partners, f"{phrase}; {{}} it", "sets", category)


def _find_lost_settings(context: ChangeContext, index: int, change: Change) -> Iterator[PartnerLoss]:
    """Find the instances of a changed type that set the parameter: they are their owners', whoever owns the type."""
    if change.kind != "changed" or not (change.key or "").startswith(_SECTION) or change.before is None:
        return
    name, _, part = (change.key or "").removeprefix(_SECTION).partition(":")
    # As it was before: what is gone now nobody sets.
    instances = [
        component
        for component in context.before.list_described_components()
        if context.matched_ids.common_id("component_type", component.type_name) == change.element_id
        and is_set_by_instance(context.before, component, name)
    ]
    component_type = context.after.component_types.get(change.element_id)
    if not instances or component_type is None:
        return
    place = f"the parameter {tick_name(name)} of the type {tick_name(change.element_id)}"
    values = [component.parameters[name].value for component in instances]
    phrase = _describe_change(component_type.parameters.get(name), change, part, place, values)
    if phrase:
        partners = {context.matched_ids.common_id("partner", owner) for each in instances for owner in each.owners}
        partners -= {component_type.owner}
        category: BreakCategory = "meaning" if part == "unit" else "wire"
        yield from context.losses_of_users([index], partners, f"{phrase}; {{}} it", "sets", category)


def _describe_lost_setting(
    architecture: Architecture, change: Change, name: str, part: str, setting_nodes: list[Node]
) -> str:
    component = architecture.components.get(change.element_id)
    parameter = component.parameters.get(name) if component else None
    place = f"the parameter {tick_name(name)} of {tick_name(change.element_id)}"
    values = [value for node in setting_nodes for value in list_set_values(architecture, node, name)]
    return _describe_change(parameter, change, part, place, values)


def _describe_change(
    parameter: Parameter | None, change: Change, part: str, place: str, values: Iterable[object]
) -> str:
    """Say what is lost by a change of a parameter that is given these values; empty where nothing is."""
    if parameter is None:
        return f"takes away {place}" if not part else ""
    if part == "unit":
        after = format_value(change.after) if change.after is not None else "none"
        return f"gives {place} in {after} instead of {format_value(change.before)}"
    if part in _LIMITING_PARTS:
        faults = (find_value_fault(parameter, value) for value in values)
        return next((f"no longer takes a value of {place} ({fault})" for fault in faults if fault), "")
    return ""
