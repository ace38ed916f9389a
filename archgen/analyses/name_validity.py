"""Does ROS accept the names of nodes, namespaces, topics and services, and is every node's name unique?"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from archgen.derivation.wire.wire_names import expand_name, find_name_fault, find_node_name_fault
from archgen.diagnostics import NO_SPAN, Diagnostic, Label, Severity, Span
from archgen.model.architecture import Architecture
from archgen.model.deployment import Container
from archgen.model.node import Node, PortUse
from archgen.model.port_media import uses_ros
from archgen.model.ros_distro import is_ros_1


def invalid_ros_name(architecture: Architecture) -> Iterator[Diagnostic]:
    """ROS does not accept the name of a node, a namespace, a topic, a service or an action."""
    ros_1 = is_ros_1(architecture.distro)
    for node in architecture.nodes.values():
        if not node.written:
            continue
        fault = None if node.is_program else find_node_name_fault(node.name)
        if fault:
            yield _report_invalid_name(node, "a node", node.name, node.name_at, fault)
        fault = None if node.is_program else find_name_fault(node.namespace, ros_1=ros_1)
        if fault and node.namespace:
            yield _report_invalid_name(node, "a namespace", node.namespace, node.at, fault)
        for use in node.uses:
            if not _is_ros_use(architecture, use):
                continue
            kind = "a topic" if use.use in {"publishes", "subscribes"} else "a service or action"
            # Only the linker fills in `topic_places`, one span for each topic.
            spans = use.topic_places or (use.at,) * len(use.topics)
            names = list(zip(use.topics, spans, strict=True))
            if use.own_name is not None:
                names.append((use.own_name, use.at))
            yield from _find_invalid_names(node, kind, names, ros_1=ros_1)
    for container in architecture.containers.values():
        yield from _judge_container(container, ros_1=ros_1)


def _find_invalid_names(
    node: Node, kind: str, names: Iterable[tuple[str, Span]], *, ros_1: bool
) -> Iterator[Diagnostic]:
    for name, span in names:
        fault = "it is only a `/`" if name == "/" else find_name_fault(name, ros_1=ros_1)
        if fault is None and "{" in name and expand_name(name, node.namespace, node.name, ros_1=ros_1) is None:
            fault = f"in the namespace `{node.namespace}` two `/` follow one another"
        if fault:
            yield _report_invalid_name(node, kind, name, span, fault)


def _is_ros_use(architecture: Architecture, use: PortUse) -> bool:
    """Whether the names of an entry are names of ROS: over other media, any text is a name."""
    ports = architecture.outputs if use.use in {"publishes", "serves"} else architecture.inputs
    port = ports.get(use.port or "")
    return port is None or uses_ros(port)


def _judge_container(container: Container, *, ros_1: bool) -> Iterator[Diagnostic]:
    fault = find_node_name_fault(container.name) if container.name is not None else None
    if fault:
        yield _report_invalid_name(container, "a node", container.name or "", container.name_at, fault)
    fault = find_name_fault(container.namespace, ros_1=ros_1)
    if fault:
        yield _report_invalid_name(container, "a namespace", container.namespace, container.at, fault)


def _report_invalid_name(node: Node | Container, kind: str, name: str, span: Span, fault: str) -> Diagnostic:
    message = f"`{name}` cannot be the name of {kind}: {fault}"
    better_name = re.sub(r"/{2,}", "/", re.sub(r"[-.]+", "_", re.sub(r"(?<=/)[-.]+", "", name))).removesuffix("/")
    is_better = better_name not in {"", name} and find_name_fault(better_name, ros_1=False) is None
    help_line = f"did you mean `{better_name}`?" if is_better else None
    return Diagnostic(
        "invalid-ros-name", message, node.at if span == NO_SPAN else span, help=help_line, element=node.id
    )


def _name_span(node: Node | Container) -> Span:
    """Return the span of a node's `name`, else of the node."""
    return node.at if node.name_at == NO_SPAN else node.name_at


def duplicate_node_name(architecture: Architecture) -> Iterator[Diagnostic]:
    """Two nodes have one name."""
    first_by_name: dict[str, Node | Container] = {}
    # A container without a name is called by whoever starts it.
    named_containers = [each for each in architecture.containers.values() if each.name is not None]
    nodes: list[Node | Container] = [
        each for each in architecture.nodes.values() if each.written and not each.is_program
    ]
    for node in (*nodes, *named_containers):
        earlier_node = first_by_name.setdefault(node.full_name, node)
        if earlier_node is not node:
            yield Diagnostic(
                "duplicate-node-name",
                f"`{node.id}` has the name `{node.full_name}`, which is the name of `{earlier_node.id}`",
                _name_span(node),
                labels=(Label(_name_span(earlier_node), "the first one"),),
                help="give one of them another `name` or `namespace`",
                element=node.id,
            )


def unknown_name(architecture: Architecture) -> Iterator[Diagnostic]:
    """Of programs that exist, nobody says what they call their topics, services or actions."""
    unnamed = [
        each
        for each in architecture.endpoints
        if each.name is None
        and each.use in {"publishes", "serves"}
        and architecture.nodes[each.node].status == "existing"
    ]
    if not unnamed:
        return
    nodes = list(dict.fromkeys(each.node for each in unnamed))
    first = architecture.nodes[nodes[0]]
    what = f"{len(unnamed)} outputs" if len(unnamed) > 1 else "one output"
    whose = f"{len(nodes)} programs that exist (`{first.id}` is the first)" if len(nodes) > 1 else f"`{first.id}`"
    yield Diagnostic(
        "unknown-name",
        f"the names on ROS of {what} of {whose} are not known: no rule about names judges them"
        if len(unnamed) > 1
        else f"the name on ROS of {what} of {whose} is not known: no rule about names judges it",
        first.at,
        help=f"write it at the node, `{unnamed[0].use}: {{{(unnamed[0].port or '').rpartition('.')[2]}: /its/topic}}`; "
        "`archgen import ros2` takes names over from the running robot",
        element=first.id,
    )


RULES = (
    (invalid_ros_name, Severity.ERROR),
    (duplicate_node_name, Severity.WARNING),
    (unknown_name, Severity.NOTE),
)
