"""The second version without some of its changes: what would be, had they not been made.

Figures and places are taken back one by one in the architecture itself. Where ports, connections or whole elements
changed, a component stands with its nodes as it did, and what follows is derived anew. What cannot be taken back alone is
None: nobody knows what would be without it.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from archgen.compare.comparison import Change
from archgen.compare.losses.change_context import ChangeContext
from archgen.derivation import derive_low_level
from archgen.diagnostics.source_span import NO_SPAN
from archgen.frozen import replace
from archgen.model.architecture import Architecture, PortEdge
from archgen.model.component import Component, Output
from archgen.model.declared_timing import Timing
from archgen.timing.analysis import Analysis
from archgen.timing.run_analysis import analyse_for_chains

_MAX_ANALYSED = 20_000
"""How many activities are analysed for one comparison in all: those of a large robot with a few changes."""
_NODE_KEYS = frozenset({"host", "container", "threads", "scheduling", "reentrant", "callback_groups"})
"""What a node says of itself alone; other keys say what it does for whom, and with whom."""
_TIMING_FIELDS = {"rate": ("rate", "period"), "wcet": ("wcet", "measured_times"), "core": ("core", "cores")}
"""The fields of `timing` that one compared key stands for, where they are several."""


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
            self._left -= len(self._context.after.nodes)
            architecture = _take_all_back(self._context, indices) if self._left >= 0 else None
            self._known[indices] = (architecture, analyse_for_chains(architecture)) if architecture else None
        return self._known[indices]


def find_whole(context: ChangeContext, change: Change) -> str | None:
    """Return the component that is taken back as a whole with a change; None where a figure or a place alone is."""
    kind, own_id = change.element_kind, context.common_id(change)
    if kind in {"input", "output", "connection"}:
        return own_id.rpartition(".")[0]
    is_figure = change.kind == "changed" and ((change.key or "").startswith("timing.") or change.key in _NODE_KEYS)
    if is_figure or kind not in {"component", "node"}:
        return None
    node = context.after.nodes.get(own_id) or context.before.nodes.get(own_id)
    return own_id if kind == "component" else next(iter(node.implements), None) if node else None


def _take_all_back(context: ChangeContext, indices: frozenset[int]) -> Architecture | None:
    architecture: Architecture | None = context.after
    wholes: dict[str, None] = {}
    is_type_changed = False
    for change in (context.changes[index] for index in sorted(indices)):
        is_type_changed |= change.element_kind == "type"
        if change.kind in {"renamed", "moved"} or architecture is None:
            continue
        # The parts of what came or went are connections of others, too.
        own_wholes = filter(None, (find_whole(context, each) for each in context.walk_change(change)))
        if find_whole(context, change):
            wholes |= dict.fromkeys(own_wholes)
        elif change.kind == "changed":
            architecture = take_back_figure(context, architecture, change)
        elif change.kind == "removed":
            return None  # of anything else that is new, figures are touched by what names it
    if architecture is not None and wholes:
        architecture = _swap_components(context, architecture, wholes)
    return architecture if architecture is None or not (wholes or is_type_changed) else _derive_again(architecture)


def _derive_again(architecture: Architecture) -> Architecture:
    """Return an architecture with planned nodes, endpoints and topics as they follow from the rest."""
    # A planned node with a place is written: somebody says where it will run.
    nodes = {name: node for name, node in architecture.nodes.items() if node.written or node.at != NO_SPAN}
    return derive_low_level(replace(architecture, nodes=nodes))


def take_back_figure(context: ChangeContext, architecture: Architecture, change: Change) -> Architecture | None:
    """Return an architecture with a figure or a place as it was; None where it cannot be taken back."""
    kind, key = change.element_kind, change.key or ""
    if key.startswith("timing."):
        return _take_back_timing(context, architecture, change)
    section = f"{kind}s"
    elements: Mapping[str, Any] = getattr(architecture, section, {})
    old_element = getattr(context.before, section, {}).get(context.old_id(kind, change.element_id))
    name = key.removeprefix("latency.").partition(".")[0]
    if change.element_id not in elements or not hasattr(old_element, name):
        return None
    value = getattr(old_element, name)
    if isinstance(value, str):
        # A host or a container, which may have another name now.
        value = context.matched_ids.common_id(name, value)
    if name == "through" and any(context.matched_ids.common_id(each.kind, each.id) != each.id for each in value):
        return None
    changed: dict[str, Any] = {
        section: {**elements, change.element_id: replace(elements[change.element_id], **{name: value})}
    }
    return replace(architecture, **changed)


def _take_back_timing(context: ChangeContext, architecture: Architecture, change: Change) -> Architecture | None:
    """Return an architecture with one key below `timing` as it was, at all nodes of a component or at a node."""
    nodes = dict(architecture.nodes)
    for node in architecture.nodes.values():
        old_node = context.before.nodes.get(context.old_id("node", node.id))
        for part, timing in node.timing.items() if old_node else ():
            lead = f"timing.{part}." if change.element_id == node.id and len(node.implements) > 1 else "timing."
            is_meant = change.element_id == (node.id if change.element_kind == "node" else part)
            if old_node and is_meant and (change.key or "").startswith(lead):
                old_part = context.old_id("component", part)
                name = (change.key or "").removeprefix(lead).partition(".")[0]
                values: dict[str, Any] = {
                    each: getattr(old_node.timing.get(old_part, Timing()), each, ...)
                    for each in _TIMING_FIELDS.get(name.removesuffix("s"), (name,))
                }
                # Mappings and triggers name ports by their ids.
                has_ids = any(isinstance(value, Mapping) or hasattr(value, "inputs") for value in values.values())
                if ... in values.values() or (part != old_part and has_ids):
                    return None
                own_node = nodes[node.id]
                nodes[node.id] = replace(own_node, timing={**own_node.timing, part: replace(timing, **values)})
    return None if nodes == architecture.nodes else replace(architecture, nodes=nodes)


def _swap_components(
    context: ChangeContext, architecture: Architecture, ids: Mapping[str, None]
) -> Architecture | None:
    """Return an architecture with some components and their nodes as they were, or without those that are new."""
    before = context.before
    components = {name: each for name, each in architecture.components.items() if name not in ids}
    components |= {name: before.components[name] for name in ids if name in before.components}
    nodes = {name: each for name, each in architecture.nodes.items() if ids.keys().isdisjoint(each.implements)}
    swapped = [each for each in before.nodes.values() if not ids.keys().isdisjoint(each.implements)]
    names = [*ids, *(name for node in swapped for name in (node.id, node.host, node.container) if name)]
    known = components.keys()
    if any(context.matched_ids.rename_in_text(name) != name for name in names) or any(
        node.id in nodes or not known >= set(node.implements) for node in swapped
    ):
        return None
    return _connect(replace(architecture, nodes=nodes | {node.id: node for node in swapped}), components)


def _connect(architecture: Architecture, components: Mapping[str, Component]) -> Architecture:
    """Return an architecture with these components, connected as their inputs say."""
    outputs = {port.id: port for each in components.values() for port in each.outputs.values()}
    components = {name: _cut_lost_sources(each, outputs) for name, each in components.items()}
    inputs = {port.id: port for each in components.values() for port in each.inputs.values()}
    connections = tuple(connection for port in inputs.values() for connection in port.connections)
    known = {**architecture.shells, **components}
    groups = {
        name: replace(
            group, components={key: known[each.id] for key, each in group.components.items() if each.id in known}
        )
        for name, group in architecture.groups.items()
    }
    edges = tuple(PortEdge(output, each.input, each.at) for each in connections for output in each.outputs)
    return replace(
        architecture,
        components=components,
        groups=groups,
        inputs=inputs,
        outputs=outputs,
        connections=connections,
        edges=edges,
    )


def _cut_lost_sources(component: Component, outputs: Mapping[str, Output]) -> Component:
    """Return a component whose inputs read nothing that is not there."""
    if all(outputs.keys() >= set(each.outputs) for port in component.inputs.values() for each in port.connections):
        return component
    inputs = {}
    for name, port in component.inputs.items():
        kept = ((each, tuple(output for output in each.outputs if output in outputs)) for each in port.connections)
        inputs[name] = replace(port, connections=tuple(replace(each, outputs=names) for each, names in kept if names))
    return replace(component, inputs=inputs)
