"""List one version as flat elements in normal form, with the keys that the table of kinds says they have.

The first version is listed under the ids of the second, so that whatever merely follows a rename is equal.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from archgen.compare.architecture_version import ArchitectureVersion
from archgen.compare.kinds import ELEMENT_KINDS
from archgen.compare.kinds.key_spec import ReadContext, key_values
from archgen.compare.kinds.kind_spec import KindSpec
from archgen.compare.kinds.ros_kinds import NODE, PORT, NodePort
from archgen.compare.matched_ids import MatchedIds
from archgen.compare.normal_values import last_part
from archgen.compare.version_pair import ComparedElement, ElementKey
from archgen.diagnostics import NO_SPAN
from archgen.model.architecture import Architecture
from archgen.model.node import Node, PortUse


def list_elements(
    before: ArchitectureVersion, after: ArchitectureVersion, matched_ids: MatchedIds
) -> tuple[dict[ElementKey, ComparedElement], dict[ElementKey, ComparedElement]]:
    """List all elements of both versions under the ids of the second one."""
    single_before, single_after = (
        ReadContext(version, MatchedIds()).single_node_components for version in (before, after)
    )
    # Only what both versions have: a component that was added or removed has nothing to be compared with.
    matched_components = matched_ids.new_ids.get("component", {})
    split_components = frozenset(
        new_id for old_id, new_id in matched_components.items() if (old_id in single_before) != (new_id in single_after)
    )
    before_context = ReadContext(before, matched_ids, split_components)
    after_context = ReadContext(after, MatchedIds(), split_components)
    elements_after = _list_version_elements(after_context)
    # With other ids an element that is the same refers to others.
    listed = None if matched_ids.has_renames else (after_context, elements_after)
    return _list_version_elements(before_context, listed), elements_after


_ListedVersion = tuple[ReadContext, Mapping[ElementKey, ComparedElement]]


def _list_version_elements(
    context: ReadContext, other_version: _ListedVersion | None = None
) -> dict[ElementKey, ComparedElement]:
    # Values hold no spans: elements that move between files have not changed.
    listed = (element for kind in ELEMENT_KINDS.values() for element in _list_kind(kind, context, other_version))
    return {(element.kind, element.id): element for element in (*listed, *_list_node_ports(context))}


def _list_kind(kind: KindSpec, context: ReadContext, other_version: _ListedVersion | None) -> Iterator[ComparedElement]:
    """Yield the elements of a kind; those of which the other version has the very same, as they are listed there."""
    keys, surroundings = kind.keys, kind.surroundings
    other_context, other_listed = other_version or (context, {})
    other_elements = kind.elements(other_context.version) if kind.elements and other_version else {}
    for own_id, element in kind.elements(context.version).items() if kind.elements else ():
        is_same = element is other_elements.get(own_id)
        if is_same and surroundings and surroundings(element, context) == surroundings(element, other_context):
            yield other_listed[kind.name, own_id]
            continue
        yield ComparedElement(
            kind.name,
            context.matched_ids.common_id(kind.name, own_id),
            own_id,
            key_values(keys, element, context),
            kind.parent(element, context),
            kind.owner(element, context),
            kind.is_declared(element),
            kind.components(element, context),
            # Chapters and settings have no place in a slice.
            getattr(element, "at", NO_SPAN).file,
        )


def _list_node_ports(context: ReadContext) -> Iterator[ComparedElement]:
    """Yield the ports of which a written node says more than what its component says already."""
    port_keys = PORT.keys
    untold_components = context.single_node_components - context.told_components
    for node in context.architecture.nodes.values():
        if not node.written:
            continue
        name = context.matched_ids.common_id("node", node.id)
        owner = NODE.owner(node, context)
        for use in (*node.uses, *_implied_uses(context.architecture, node, untold_components)):
            is_stated = use.internal or not (
                use.port is not None and use.port.rpartition(".")[0] in context.told_components
            )
            values = key_values(port_keys, NodePort(use, node, is_stated), context)
            if values:
                key, own_key = _port_ids(use, node, context.matched_ids)
                yield ComparedElement(
                    "port",
                    f"{name}.{key}",
                    f"{node.id}.{own_key}",
                    values,
                    ("node", name),
                    owner,
                    component_refs=_component_port(use, context.matched_ids),
                )


def _implied_uses(architecture: Architecture, node: Node, components: frozenset[str]) -> Iterator[PortUse]:
    """Yield the ports of some of its components that a node carries without writing them."""
    written_ports = {use.port for use in node.uses}
    for endpoint in architecture.endpoints if components.intersection(node.implements) else ():
        if (
            endpoint.node == node.id
            and endpoint.port not in written_ports
            and endpoint.port
            and endpoint.port.rpartition(".")[0] in components
        ):
            yield PortUse(endpoint.use, endpoint.port.rpartition(".")[2], endpoint.port)


def _port_ids(use: PortUse, node: Node, matched_ids: MatchedIds) -> tuple[str, str]:
    """Return a port's id below its node, with the common name and with the name in this version."""
    if use.port is None:
        key = f"{'internal.' if use.internal else ''}{use.use}.{use.key}"
        return key, key
    common_port = _component_port(use, matched_ids)[0]
    # Two components may have ports of one name: with several components the id names the component as well.
    part_count = 1 if len(node.implements) <= 1 else 2
    return f"{use.use}.{last_part(common_port, part_count)}", f"{use.use}.{last_part(use.port, part_count)}"


def _component_port(use: PortUse, matched_ids: MatchedIds) -> tuple[str, ...]:
    """Return the common id of the component's port behind a use, nothing for an internal one."""
    if use.port is None:
        return ()
    return (matched_ids.common_id("output" if use.use in {"publishes", "serves"} else "input", use.port),)
