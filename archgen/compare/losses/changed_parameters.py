"""A component's parameter is gone, has another unit or type, or no longer takes a value: partners whose nodes set it lose."""

from __future__ import annotations

from collections.abc import Iterator

from archgen.compare.comparison import Change
from archgen.compare.key_phrases import format_value
from archgen.compare.losses.change_context import ChangeContext, PartnerLoss
from archgen.compare.losses.loss_wording import tick_name
from archgen.model.architecture import Architecture
from archgen.model.node import Node
from archgen.model.parameter_values import canonical_name, find_value_fault
from archgen.model.review_settings import BreakCategory
from archgen.model.ros_distro import is_ros_1

_SECTION = "parameters."
_LIMITING_PARTS = frozenset({"type", "range", "choices"})


def find_changed_parameters(context: ChangeContext) -> Iterator[PartnerLoss]:
    """Find parameters that a partner's node sets and that its component no longer has, or means otherwise."""
    for index, change in enumerate(context.changes):
        if change.element_kind != "component" or not (change.key or "").startswith(_SECTION) or change.before is None:
            continue
        name, _, part = (change.key or "").removeprefix(_SECTION).partition(":")
        setting_nodes = list(_list_setting_nodes(context.after, change.element_id, name))
        phrase = _describe_loss(context.after, change, name, part, setting_nodes) if setting_nodes else ""
        if phrase:
            partners = dict.fromkeys(owner for node in setting_nodes for owner in node.owners)
            category: BreakCategory = "meaning" if part == "unit" else "wire"
            yield from context.losses_of_users([index], partners, f"{phrase}; {{}} it", "sets", category)


def _list_setting_nodes(architecture: Architecture, component_id: str, name: str) -> Iterator[Node]:
    ros_1 = is_ros_1(architecture.distro)
    for node in architecture.nodes_implementing(component_id):
        names = (canonical_name(value.name, ros_1=ros_1) for value in (*node.file_values, *node.own_values))
        if canonical_name(name, ros_1=ros_1) in names:
            yield node


def _describe_loss(architecture: Architecture, change: Change, name: str, part: str, setting_nodes: list[Node]) -> str:
    component = architecture.components.get(change.element_id)
    parameter = component.parameters.get(name) if component else None
    place = f"the parameter {tick_name(name)} of {tick_name(change.element_id)}"
    if parameter is None:
        return f"takes away {place}" if not part else ""
    if part == "unit":
        after = format_value(change.after) if change.after is not None else "none"
        return f"gives {place} in {after} instead of {format_value(change.before)}"
    if part in _LIMITING_PARTS:
        ros_1 = is_ros_1(architecture.distro)
        values = [value for node in setting_nodes for value in (*node.file_values, *node.own_values)]
        faults = (
            find_value_fault(parameter, value.value)
            for value in values
            if canonical_name(value.name, ros_1=ros_1) == canonical_name(name, ros_1=ros_1)
        )
        return next((f"no longer takes a value of {place} ({fault})" for fault in faults if fault), "")
    return ""
