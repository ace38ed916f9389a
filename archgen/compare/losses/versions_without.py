"""The second version without some of its changes: what would be, had they not been made.

Changes of figures, places and wiring are taken back one by one in the architecture itself, and what follows is derived
anew. What cannot be taken back alone is None: nobody knows what would be without it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from typing import Any

from archgen.compare.comparison import Change
from archgen.compare.losses.change_context import ChangeContext
from archgen.derivation import derive_low_level
from archgen.diagnostics.source_span import NO_SPAN
from archgen.frozen import replace
from archgen.model.architecture import Architecture, PortEdge
from archgen.model.component import Component, Input, Output
from archgen.model.declared_timing import Timing
from archgen.model.node import Node
from archgen.timing.analysis import Analysis
from archgen.timing.run_analysis import analyse_for_chains

_MAX_ANALYSED = 20_000
"""How many activities are analysed for one comparison in all: those of a large robot with a few changes."""
_SECTIONS = {
    "node": "nodes", "host": "hosts", "container": "containers", "resource": "resources", "link": "links",
    "type": "types", "chain": "chains",
}  # fmt: skip
_TIMING_GROUPS = {"rate": ("rate", "period"), "wcet": ("wcet", "measured_times"), "core": ("core", "cores"),
                  "cores": ("core", "cores")}  # fmt: skip
"""The fields of `timing` that one compared key stands for, where they are several."""
_NODE_KEYS = frozenset({"host", "container", "threads", "scheduling", "reentrant", "callback_groups"})
"""What a node says of itself alone; other keys say what it does for whom, and with whom."""
_FIGURE_KINDS = frozenset({"component", "node", "host", "container", "resource", "link", "chain"})
"""Kinds whose changed keys say nothing of who is joined with whom."""


class VersionsWithout:
    """The second version without some of its changes, by their indices; each is analysed once."""

    def __init__(self, context: ChangeContext) -> None:
        """Start with nothing analysed."""
        self._context = context
        self._known: dict[frozenset[int], tuple[Architecture, Analysis] | None] = {}
        self._left = _MAX_ANALYSED

    def analyse(self, indices: frozenset[int]) -> tuple[Architecture, Analysis] | None:
        """Return the version without some changes with its analysis; None where one of them cannot be taken back alone,
        or too much was analysed already.
        """
        if indices not in self._known:
            self._known[indices] = self._analyse(indices)
        return self._known[indices]

    def _analyse(self, indices: frozenset[int]) -> tuple[Architecture, Analysis] | None:
        architecture: Architecture | None = self._context.after
        is_rewired = False
        for index in sorted(indices):
            for change in self._context.walk_change(self._context.changes[index]):
                architecture = architecture and take_back(self._context, architecture, change)
                is_rewired |= change.kind != "changed" or change.element_kind not in _FIGURE_KINDS
        self._left -= len(self._context.after.nodes)
        if architecture is None or self._left < 0:
            return None
        architecture = _derive_again(architecture) if is_rewired else architecture
        return architecture, analyse_for_chains(architecture)


def _derive_again(architecture: Architecture) -> Architecture:
    """Return an architecture with planned nodes, endpoints and topics as they follow from the rest."""
    # A planned node with a place is written: somebody says where it will run.
    nodes = {name: node for name, node in architecture.nodes.items() if node.written or node.at != NO_SPAN}
    return derive_low_level(replace(architecture, nodes=nodes))


def take_back(context: ChangeContext, architecture: Architecture, change: Change) -> Architecture | None:
    """Return an architecture without one change, the parts of the change aside; None where that cannot be done."""
    kind, own_id = change.element_kind, context.common_id(change)
    if change.kind in {"renamed", "moved"}:
        return architecture
    if kind in {"input", "output", "connection"}:
        return _take_back_port(context, architecture, "output" if kind == "output" else "input", own_id, change)
    if change.kind == "changed" and change.key:
        take_key = _take_back_timing if change.key.startswith("timing.") else _take_back_key
        return take_key(context, architecture, kind, own_id, change.key)
    if kind in {"component", "node"} and (change.kind == "added" or context.old_id(kind, own_id) == own_id):
        return _take_back_whole(context, architecture, kind, own_id, change)
    # Of anything else that is new, figures are touched by what names it.
    return architecture if change.kind == "added" else None


def _take_back_key(
    context: ChangeContext, architecture: Architecture, kind: str, own_id: str, key: str
) -> Architecture | None:
    """Return an architecture with one key of a node, a host, a link and the like as it was."""
    if kind not in _SECTIONS:
        return None
    elements: Mapping[str, Any] = getattr(architecture, _SECTIONS[kind])
    old_element = getattr(context.before, _SECTIONS[kind]).get(context.old_id(kind, own_id))
    name = key.partition(".")[0]
    if own_id not in elements or old_element is None or name not in {each.name for each in fields(old_element)}:
        return None
    value = getattr(old_element, name)
    if kind == "node" and name not in _NODE_KEYS:
        return None
    if name == "through" and any(context.matched_ids.common_id(each.kind, each.id) != each.id for each in value):
        return None
    if isinstance(value, str):
        # A host or a container, which may have another name now.
        value = context.matched_ids.common_id(name, value)
    changed = {**elements, own_id: replace(elements[own_id], **{name: value})}
    return replace(architecture, **{_SECTIONS[kind]: changed})


def _take_back_timing(
    context: ChangeContext, architecture: Architecture, kind: str, own_id: str, key: str
) -> Architecture | None:
    """Return an architecture with one key below `timing` as it was, at all nodes of a component or at a node."""
    if kind not in {"component", "node"}:
        return None
    nodes = dict(architecture.nodes)
    is_done = False
    for node in architecture.nodes.values():
        old_node = context.before.nodes.get(context.old_id("node", node.id))
        if (node.id != own_id if kind == "node" else own_id not in node.implements) or old_node is None:
            continue
        part = _find_timed_part(node, own_id, kind, key)
        old_part = context.old_id("component", part)
        timing = _restore_key(
            node.timing.get(part, Timing(at=node.at)),
            old_node.timing.get(old_part, Timing()),
            key.removeprefix("timing.").removeprefix(f"{part}.").partition(".")[0],
            is_renamed=part != old_part,
        )
        if timing is None:
            return None
        nodes[node.id] = replace(node, timing={**node.timing, part: timing})
        is_done = True
    return replace(architecture, nodes=nodes) if is_done else None


def _find_timed_part(node: Node, own_id: str, kind: str, key: str) -> str:
    """Return the component of a node whose timing changed."""
    if kind == "component":
        return own_id
    named = (part for part in node.timing if part and key.startswith(f"timing.{part}."))
    return next(named, next(iter(node.implements), "") if len(node.implements) == 1 else "")


def _restore_key(timing: Timing, old_timing: Timing, name: str, *, is_renamed: bool) -> Timing | None:
    values = {each: getattr(old_timing, each, None) for each in _TIMING_GROUPS.get(name, (name,))}
    # Mappings and triggers name ports by their ids.
    has_ids = any(isinstance(value, Mapping) or hasattr(value, "inputs") for value in values.values())
    if (is_renamed and has_ids) or not all(hasattr(old_timing, each) for each in values):
        return None
    return replace(timing, **values)


def _take_back_port(
    context: ChangeContext, architecture: Architecture, kind: str, own_id: str, change: Change
) -> Architecture | None:
    """Return an architecture with a port as it was: with its sources, or without the port where that is new."""
    old_ports: Mapping[str, Any] = context.before.inputs if kind == "input" else context.before.outputs
    old_port = old_ports.get(context.old_id(kind, own_id))
    holder = architecture.components.get(own_id.rpartition(".")[0])
    if holder is None or (old_port is None and change.kind != "added"):
        return architecture if holder is None and change.kind == "added" else None
    if old_port is not None and not _names_same(context, old_port):
        return None
    name, section = own_id.rpartition(".")[2], f"{kind}s"
    ports = {key: port for key, port in getattr(holder, section).items() if key != name}
    ports |= {name: old_port} if old_port is not None else {}
    return _connect(architecture, {**architecture.components, holder.id: replace(holder, **{section: ports})})


def _names_same(context: ChangeContext, port: Input | Output) -> bool:
    """Whether a port of the first version, and what it reads, have the same ids in the second one."""
    outputs = [name for each in getattr(port, "connections", ()) for name in each.outputs]
    kind = "input" if isinstance(port, Input) else "output"
    common_id = context.matched_ids.common_id
    return common_id(kind, port.id) == port.id and all(common_id("output", name) == name for name in outputs)


def _take_back_whole(
    context: ChangeContext, architecture: Architecture, kind: str, own_id: str, change: Change
) -> Architecture | None:
    """Return an architecture without a component or a node that is new, or with one that was removed."""
    nodes, components = dict(architecture.nodes), dict(architecture.components)
    if change.kind == "added":
        nodes = {
            name: each
            for name, each in nodes.items()
            if (name != own_id if kind == "node" else set(each.implements) != {own_id})
        }
        if kind == "component":
            components.pop(own_id, None)
            # A node that implements others besides would have to be divided.
            if any(own_id in each.implements for each in nodes.values()):
                return None
        return _connect(replace(architecture, nodes=nodes), components)
    if kind == "component":
        components[own_id] = context.before.components[own_id]
    for old_node in context.before.nodes.values():
        if old_node.id == own_id if kind == "node" else own_id in old_node.implements:
            if old_node.id in nodes or not components.keys() >= set(old_node.implements):
                return None
            nodes[old_node.id] = old_node
    return _connect(replace(architecture, nodes=nodes), components)


def _connect(architecture: Architecture, components: Mapping[str, Component]) -> Architecture:
    """Return an architecture with these components, connected as their inputs say; what they read that is not there is
    left out.
    """
    outputs = {port.id: port for each in components.values() for port in each.outputs.values()}
    components = {name: _cut_lost_sources(each, outputs) for name, each in components.items()}
    inputs = {port.id: port for each in components.values() for port in each.inputs.values()}
    connections = tuple(connection for port in inputs.values() for connection in port.connections)
    known = {**architecture.shells, **components}
    return replace(
        architecture,
        components=components,
        groups={
            name: replace(
                group, components={key: known[each.id] for key, each in group.components.items() if each.id in known}
            )
            for name, group in architecture.groups.items()
        },
        inputs=inputs,
        outputs=outputs,
        connections=connections,
        edges=tuple(PortEdge(output, each.input, each.at) for each in connections for output in each.outputs),
    )


def _cut_lost_sources(component: Component, outputs: Mapping[str, Output]) -> Component:
    if all(outputs.keys() >= set(each.outputs) for port in component.inputs.values() for each in port.connections):
        return component
    inputs = {
        name: replace(
            port,
            connections=tuple(
                replace(each, outputs=kept)
                for each in port.connections
                if (kept := tuple(output for output in each.outputs if output in outputs))
            ),
        )
        for name, port in component.inputs.items()
    }
    return replace(component, inputs=inputs)
