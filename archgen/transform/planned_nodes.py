"""Planned nodes: one for each component that no node implements, so that the low level can be drawn from day one."""

from __future__ import annotations

from collections.abc import Container, Iterator
from itertools import count

from archgen.model.architecture import Architecture
from archgen.model.component import Component
from archgen.model.node import Node


def make_planned_nodes(architecture: Architecture) -> Iterator[Node]:
    """Yield the nodes to add, in the order of components."""
    implemented_ids = {component for node in architecture.nodes.values() for component in node.implements}
    used_names = set(architecture.nodes)
    for component in architecture.components.values():
        if component.id not in implemented_ids:
            name = _find_free_name(component, used_names)
            used_names.add(name)
            yield _make_planned_node(component, name)


def _find_free_name(component: Component, used_names: Container[str]) -> str:
    """Return an unused name: the component's own, else `group_component`, else that with a number behind it."""
    long_name = component.id.replace(".", "_")
    for name in (component.name, long_name):
        if name not in used_names:
            return name
    return next(name for number in count(2) if (name := f"{long_name}_{number}") not in used_names)


def _make_planned_node(component: Component, name: str) -> Node:
    return Node(
        id=name,
        title=component.title,
        implements=(component.id,),
        owner=component.owner,
        co_owners=component.co_owners,
        name=name,
        status="planned",
        timing={component.id: component.timing} if component.timing else {},
        written=False,
    )
