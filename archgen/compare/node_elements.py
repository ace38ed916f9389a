"""List nodes in normal form: what they say of themselves, of their ports, and of timing."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction

from archgen.compare.matched_ids import MatchedIds
from archgen.compare.normal_values import (
    drop_unset_values,
    normalize_text,
    normalize_title,
    parameter_leaves,
    unordered_values,
)
from archgen.model.architecture import Architecture
from archgen.model.component import Component
from archgen.model.declared_timing import Timing
from archgen.model.node import Node, PortUse, Qos
from archgen.model.quantity import Quantity
from archgen.timing.figures.figure_wording import format_rate as hertz
from archgen.transform import ros_names

ElementFields = tuple[str, str, str, Mapping[str, object], tuple[str, str] | None, str | None, bool, tuple[str, ...]]
"""The positional arguments of a `ComparedElement` (a tuple because compared_elements imports this module)."""
QOS_KEYS = ("reliability", "durability", "history", "depth", "deadline", "lifespan", "liveliness", "lease_duration")
_DEFAULT_QOS = Qos()
_NS_PER_SECOND = 10**9


def list_node_elements(
    architecture: Architecture, matched_ids: MatchedIds, split_components: frozenset[str]
) -> Iterator[ElementFields]:
    """Yield the written nodes, and what they say of their ports.

    `split` are components with one node in one version and several in the other: both versions describe them by their
    nodes.
    """
    whole_components = single_node_components(architecture)
    told_by_component = frozenset(
        component
        for component in whole_components
        if matched_ids.common_id("component", component) not in split_components
    )
    for node in architecture.nodes.values():
        if not node.written:
            continue
        name = matched_ids.common_id("node", node.id)
        owner = matched_ids.common_id("partner", node.owner) if node.owner else None
        components = tuple(matched_ids.common_id("component", component) for component in node.implements)
        yield (
            "node",
            name,
            node.id,
            drop_unset_values(_node_values(architecture, node, matched_ids, told_by_component)),
            None,
            owner,
            True,
            components,
        )
        for use in (*node.uses, *_implied_uses(architecture, node, whole_components - told_by_component)):
            values = drop_unset_values(
                _port_values(use, node, stated=use.internal or not _is_port_of(use, told_by_component))
            )
            if values:
                key, own_port_id = _port_ids(use, node, matched_ids)
                yield (
                    "port",
                    f"{name}.{key}",
                    f"{node.id}.{own_port_id}",
                    values,
                    ("node", name),
                    owner,
                    True,
                    _component_port(use, matched_ids),
                )


def single_node_components(architecture: Architecture) -> frozenset[str]:
    """Return the components that have exactly one node: it exposes all their ports, whether or not it says so."""
    seen_once, seen_again = set[str](), set[str]()
    for node in architecture.nodes.values():
        for component in node.implements:
            (seen_again if component in seen_once else seen_once).add(component)
    return frozenset(seen_once - seen_again)


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


def _is_port_of(use: PortUse, components: frozenset[str]) -> bool:
    return use.port is not None and use.port.rpartition(".")[0] in components


def _port_ids(use: PortUse, node: Node, matched_ids: MatchedIds) -> tuple[str, str]:
    """Return a port's id below its node, with the common name and with the name in this version."""
    if use.internal:
        return f"internal.{use.use}.{use.key}", f"internal.{use.use}.{use.key}"
    if use.port is None:
        return f"{use.use}.{use.key}", f"{use.use}.{use.key}"
    common_port = _component_port(use, matched_ids)[0]
    # Two components may have ports of one name: with several components the id names the component as well.
    part_count = 1 if len(node.implements) <= 1 else 2
    return f"{use.use}.{_last_parts(common_port, part_count)}", f"{use.use}.{_last_parts(use.port, part_count)}"


def _component_port(use: PortUse, matched_ids: MatchedIds) -> tuple[str, ...]:
    """Return the common id of the component's port behind a use, nothing for an internal one."""
    return (
        (matched_ids.common_id("output" if use.use in {"publishes", "serves"} else "input", use.port),)
        if use.port
        else ()
    )


def _last_parts(path: str, part_count: int) -> str:
    return ".".join(path.split(".")[-part_count:])


def _further_owners(architecture: Architecture, node: Node) -> tuple[str, ...]:
    """Return a node's further owners, unless they are exactly those of its components."""
    inherited_owners = {owner for component in node.implements for owner in architecture.components[component].owners}
    return () if set(node.owners) == inherited_owners else node.co_owners


def _node_values(
    architecture: Architecture, node: Node, matched_ids: MatchedIds, told_components: frozenset[str]
) -> dict[str, object]:
    container = matched_ids.common_id("container", node.container) if node.container else None
    own_container = architecture.containers.get(node.container) if node.container else None
    # A host that is the container's own adds nothing, and would change with it.
    host = None if own_container and own_container.host == node.host else node.host
    return {
        "title": normalize_title(node.id, node.title),
        "implements": unordered_values(matched_ids.common_id("component", component) for component in node.implements),
        "description": normalize_text(node.description),
        "owner": matched_ids.common_id("partner", node.owner) if node.owner else None,
        "co_owners": unordered_values(
            matched_ids.common_id("partner", partner_id) for partner_id in _further_owners(architecture, node)
        ),
        "name": None if node.name == node.id else node.name,
        "namespace": None if node.namespace == "/" else node.namespace,
        "kind": unordered_values(() if node.kinds == ("node",) else node.kinds),
        "package": node.package,
        "executable": node.executable,
        "plugin": node.plugin,
        "container": container,
        "host": matched_ids.common_id("host", host) if host else None,
        "status": node.status,
        "parameter_files": node.parameter_files,
        "tags": unordered_values(node.tags),
        **{f"urls.{name}": url for name, url in node.urls.items()},
        **{
            key: value
            for name, parameter in node.parameters.items()
            for key, value in parameter_leaves(f"parameters.{name}", parameter)
        },
        **_node_timing(node, matched_ids, told_components),
    }


def _port_values(use: PortUse, node: Node, *, stated: bool) -> dict[str, object]:
    values: dict[str, object] = {
        "carried": True if stated else None,
        "topic": unordered_values(ros_names.resolve_ros_name(topic, node) for topic in use.topics),
        "message": use.message,
    }
    qos = use.qos or _DEFAULT_QOS
    return values | {
        f"qos.{key}": getattr(qos, key) for key in QOS_KEYS if getattr(qos, key) != getattr(_DEFAULT_QOS, key)
    }


def default_qos(key: str) -> object:
    """Return the value of a key of `qos` that nobody wrote."""
    return getattr(_DEFAULT_QOS, key)


def nodes_by_component(architecture: Architecture) -> Mapping[str, list[Node]]:
    """Return for each component its nodes, planned ones included."""
    nodes_of_component: dict[str, list[Node]] = defaultdict(list)
    for node in architecture.nodes.values():
        for component in node.implements:
            nodes_of_component[component].append(node)
    return nodes_of_component


def timing_values(
    component: Component, component_nodes: Sequence[Node], matched_ids: MatchedIds, split_components: frozenset[str]
) -> dict[str, object]:
    """Return a component's timing: that of its node if it has exactly one, else what it says itself."""
    has_one_node = (
        len(component_nodes) == 1 and matched_ids.common_id("component", component.id) not in split_components
    )
    stated_timing = component_nodes[0].timing.get(component.id) if has_one_node else component.timing
    return dict(_timing_entries("timing", stated_timing, matched_ids)) if stated_timing else {}


def _node_timing(node: Node, matched_ids: MatchedIds, told_components: frozenset[str]) -> dict[str, object]:
    """Return the timing that no component reports: of components with several nodes, and of a node without any."""
    values: dict[str, object] = {}
    for component, timing in node.timing.items():
        if component not in told_components:
            component_suffix = "" if len(node.implements) <= 1 else f".{matched_ids.common_id('component', component)}"
            values |= _timing_entries(f"timing{component_suffix}", timing, matched_ids)
    return values


def _timing_entries(prefix: str, timing: Timing, matched_ids: MatchedIds) -> Iterator[tuple[str, object]]:
    """Yield the timing by key; a period is given as the rate it amounts to."""
    rate = timing.rate
    if timing.period is not None and timing.period.value:
        # Periods are in ns. `period: 100 ms` and `rate: 10 Hz` mean the same and must compare equal.
        rate = Quantity(
            Fraction(_NS_PER_SECOND) / timing.period.value, hertz(Fraction(_NS_PER_SECOND) / timing.period.value)
        )
    yield f"{prefix}.behaviour", timing.behaviour
    yield f"{prefix}.rate", rate
    for key in ("jitter", "wcet", "bcet", "every", "throttle", "priority", "core", "response"):
        yield f"{prefix}.{key}", getattr(timing, key)
    trigger = timing.trigger
    if trigger:
        yield f"{prefix}.trigger", trigger.mode
        yield (
            f"{prefix}.trigger.inputs",
            unordered_values(matched_ids.common_id("input", port) for port in trigger.inputs or ()),
        )
    for port, output_timing in timing.outputs.items():
        name = _last_parts(matched_ids.common_id("output", port), 1)
        yield f"{prefix}.outputs.{name}.conditional", output_timing.conditional or None
        yield f"{prefix}.outputs.{name}.max_gap", output_timing.max_gap
    for port, count in timing.calls.items():
        yield f"{prefix}.calls.{_last_parts(matched_ids.common_id('input', port), 1)}", count
