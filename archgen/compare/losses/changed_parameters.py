"""A parameter is gone, has another unit or type, or no longer takes a value: partners whose nodes or instances set it lose."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from archgen.compare.comparison import Change
from archgen.compare.key_phrases import format_value
from archgen.compare.losses.change_context import ChangeContext, PartnerLoss, tick_name
from archgen.model.architecture import Architecture
from archgen.model.node import Node
from archgen.model.parameter import Parameter
from archgen.model.parameter_values import find_value_fault
from archgen.model.project_settings import BreakCategory
from archgen.model.setting_sharing import is_set_by_instance, list_set_values

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
        phrase = _describe_loss(context.after, change, name, part, setting_nodes) if setting_nodes else ""
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


def _describe_loss(architecture: Architecture, change: Change, name: str, part: str, setting_nodes: list[Node]) -> str:
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
