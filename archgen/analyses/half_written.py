"""Is what the project has begun to write about nodes, links and chains enough to mean something?"""

from __future__ import annotations

from typing import TYPE_CHECKING

from archgen.diagnostics.common_wording import join_words
from archgen.diagnostics.diagnostic import Diagnostic, Label, Severity
from archgen.diagnostics.source_span import NO_SPAN
from archgen.model.ros_distro import is_ros_1

if TYPE_CHECKING:
    from collections.abc import Iterator

    from archgen.model.architecture import Architecture
    from archgen.model.node import Node

_KEY_MEANINGS = {"plugin": "the class in `plugin`", "container": "the container that loads it in `container`"}


def half_written(architecture: Architecture) -> Iterator[Diagnostic]:
    """A node, a link or a chain lacks its other half."""
    # In ROS 1 the kind itself is wrong, which `other-ros-generation` reports.
    for node in architecture.nodes.values() if not is_ros_1(architecture.distro) else ():
        missing_keys = _list_missing_keys(node)
        if missing_keys:
            yield Diagnostic(
                "half-written",
                f"the composable node `{node.id}` has no {' and no '.join(f'`{key}`' for key in missing_keys)}",
                node.kind_at,
                help=f"write {join_words([_KEY_MEANINGS[key] for key in missing_keys])}; while it is not decided, write "
                "`status: planned`",
                element=node.id,
            )
    for link in architecture.links.values():
        ends = (*link.connects, *link.devices)
        if len(ends) == 1 and not link.unresolved:
            yield Diagnostic(
                "half-written",
                f"the link `{link.id}` connects only one {'host' if link.connects else 'device'}, `{ends[0]}`",
                link.connects_at,
                help="name what is at both of its ends in `connects`",
                element=link.id,
            )
    for chain in architecture.chains.values():
        if len(chain.through) == 1 and not chain.unresolved:
            yield Diagnostic(
                "half-written",
                f"the chain `{chain.id}` goes through one element only, `{chain.through[0].id}`",
                chain.through[0].at,
                help="name where it begins and where it ends in `through`; how long one component may take stands in its "
                "`performance`",
                element=chain.id,
            )


def _list_missing_keys(node: Node) -> list[str]:
    """Return what a composable node lacks: nothing while it is planned, or if a program of its own starts it."""
    if "composable" not in node.kinds or node.status == "planned" or node.executable:
        return []
    # A container that is written, but not declared, is reported by the linker.
    missing_keys = {"plugin": node.plugin is None, "container": node.container_at == NO_SPAN}
    return [key for key, is_missing in missing_keys.items() if is_missing]


def uncomposable_node(architecture: Architecture) -> Iterator[Diagnostic]:
    """A node stands in a container that loads composable nodes, and is none itself."""
    loaded_nodes = {node.container: node for node in architecture.nodes.values() if _is_loadable(node)}
    for node in architecture.nodes.values():
        loaded_node = loaded_nodes.get(node.container) if node.container else None
        if loaded_node is not None and not _is_loadable(node) and not node.plugin and node.status != "planned":
            kind = "nodelet" if "nodelet" in loaded_node.kinds else "composable"
            yield Diagnostic(
                "uncomposable-node",
                f"`{node.id}` is not `{kind}`, but its container `{node.container}` loads nodes that are, such as "
                f"`{loaded_node.id}`",
                node.at,
                labels=(Label(loaded_node.at, "loaded there"),),
                help=f"write `kind: {kind}` and its `plugin`, or leave `container` out",
                element=node.id,
            )


def _is_loadable(node: Node) -> bool:
    return not {"composable", "nodelet"}.isdisjoint(node.kinds)


RULES = (
    (half_written, Severity.WARNING),
    (uncomposable_node, Severity.WARNING),
)
