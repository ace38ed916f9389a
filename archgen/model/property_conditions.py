"""Conditions on properties, as selectors write them: `sil`, `sil>=2`, `mass<12 kg`, `vendor=ac*`.

The page of the site's explorer judges the same conditions itself (backends/site/assets/explorer/properties.js).
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from typing import NamedTuple

from archgen.model.architecture import Architecture
from archgen.model.component import Component
from archgen.model.element_annotations import order_values
from archgen.model.node import Node

_CONDITION = re.compile(r"([a-z0-9_*]++)\s*+(?:(>=|<=|=|>|<)\s*+((?![<=>]).*\S))?")
_ORDERS: Mapping[str, Callable[[int], bool]] = {
    ">=": lambda order: order >= 0,
    "<=": lambda order: order <= 0,
    ">": lambda order: order > 0,
    "<": lambda order: order < 0,
    "=": lambda order: order == 0,
}


class PropertyCondition(NamedTuple):
    """A property's id or a pattern of ids, and how its value compares with another; without `sign` any value fits."""

    name: str
    sign: str | None = None
    value: str = ""

    def is_met(self, properties: Mapping[str, str], matches: Callable[[str, str], bool]) -> bool:
        """Whether one of some properties meets the condition; `matches` tells whether a text fits a pattern with `*`."""
        return any(self._fits(text, matches) for name, text in properties.items() if matches(self.name, name))

    def _fits(self, text: str, matches: Callable[[str, str], bool]) -> bool:
        if self.sign is None:
            return True
        order = order_values(text, self.value)
        if order is not None:
            return _ORDERS[self.sign](order)
        return self.sign == "=" and matches(self.value, text)


def parse_property_condition(text: str) -> PropertyCondition | None:
    """Return the condition that a text is; None for none."""
    match = _CONDITION.fullmatch(text)
    return PropertyCondition(match[1], match[2], match[3] or "") if match else None


def find_component_properties(architecture: Architecture, component: Component) -> Mapping[str, str]:
    """Return the properties of a component: its own before those of what is around it, its group last."""
    group = architecture.groups.get(component.group)
    holders = (component, *architecture.list_around(component), *((group,) if group else ()))
    properties: dict[str, str] = {}
    for holder in holders:
        if holder.annotations.properties:
            properties = {**holder.annotations.properties, **properties}
    return properties


def find_node_properties(architecture: Architecture, node: Node) -> Mapping[str, str]:
    """Return the properties of a node: its own before those of its host."""
    host = architecture.hosts.get(node.host or "")
    own = node.annotations.properties
    return {**host.annotations.properties, **own} if host else own
