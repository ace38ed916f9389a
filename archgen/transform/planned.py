"""Planned nodes: one for each component that no node implements, so that the low level can be drawn from day one."""

from __future__ import annotations

from collections.abc import Container, Iterator
from itertools import count

from archgen.model.architecture import Architecture
from archgen.model.component import Component
from archgen.model.node import Node


def planned_nodes(architecture: Architecture) -> Iterator[Node]:
    """Yield the nodes to add, in the order of components."""
    implemented = {component for node in architecture.nodes.values() for component in node.implements}
    taken = set(architecture.nodes)
    for component in architecture.components.values():
        if component.id not in implemented:
            name = _free_name(component, taken)
            taken.add(name)
            yield _planned(component, name)


def _free_name(component: Component, taken: Container[str]) -> str:
    """Return an unused name: the component's own, else `group_component`, else that with a number behind it."""
    long = component.id.replace(".", "_")
    for name in (component.name, long):
        if name not in taken:
            return name
    return next(name for number in count(2) if (name := f"{long}_{number}") not in taken)


def _planned(component: Component, name: str) -> Node:
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
