"""List nodes in normal form: what they say of themselves, of their ports, and of timing."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction

from archgen.compare.names import Names
from archgen.compare.values import known, leaves, prose, title, words
from archgen.model.architecture import Architecture
from archgen.model.component import Component
from archgen.model.node import Node, PortUse, Qos
from archgen.model.quantity import Quantity
from archgen.model.timing import Timing
from archgen.timing.wording import rate as hertz
from archgen.transform import ros_names

Row = tuple[str, str, str, Mapping[str, object], tuple[str, str] | None, str | None, bool, tuple[str, ...]]
"""The positional arguments of a `ComparedElement` (a tuple because compared_elements imports this module)."""
QOS = ("reliability", "durability", "history", "depth", "deadline", "lifespan", "liveliness", "lease_duration")
_DEFAULT = Qos()
_SECOND = 10**9


def nodes(found: Architecture, names: Names, split: frozenset[str]) -> Iterator[Row]:
    """Yield the written nodes, and what they say of their ports.

    `split` are components with one node in one version and several in the other: both versions describe them by their
    nodes.
    """
    whole = alone(found)
    sole = frozenset(component for component in whole if names.to("component", component) not in split)
    for node in found.nodes.values():
        if not node.written:
            continue
        name = names.to("node", node.id)
        owner = names.to("partner", node.owner) if node.owner else None
        components = tuple(names.to("component", component) for component in node.implements)
        yield "node", name, node.id, known(_node(found, node, names, sole)), None, owner, True, components
        for use in (*node.uses, *_implied(found, node, whole - sole)):
            values = known(_use(use, node, stated=use.internal or not _whole(use, sole)))
            if values:
                key, own = _port_id(use, node, names)
                yield (
                    "port",
                    f"{name}.{key}",
                    f"{node.id}.{own}",
                    values,
                    ("node", name),
                    owner,
                    True,
                    _port(use, names),
                )


def alone(found: Architecture) -> frozenset[str]:
    """Return the components that have exactly one node: it exposes all their ports, whether or not it says so."""
    once, twice = set[str](), set[str]()
    for node in found.nodes.values():
        for component in node.implements:
            (twice if component in once else once).add(component)
    return frozenset(once - twice)


def _implied(found: Architecture, node: Node, components: frozenset[str]) -> Iterator[PortUse]:
    """Yield the ports of some of its components that a node carries without writing them."""
    written = {use.port for use in node.uses}
    for end in found.endpoints if components.intersection(node.implements) else ():
        if end.node == node.id and end.port not in written and end.port and end.port.rpartition(".")[0] in components:
            yield PortUse(end.use, end.port.rpartition(".")[2], end.port)


def _whole(use: PortUse, alone: frozenset[str]) -> bool:
    return use.port is not None and use.port.rpartition(".")[0] in alone


def _port_id(use: PortUse, node: Node, names: Names) -> tuple[str, str]:
    """Return a port's id below its node, with the common name and with the name in this version."""
    if use.internal:
        return f"internal.{use.use}.{use.key}", f"internal.{use.use}.{use.key}"
    if use.port is None:
        return f"{use.use}.{use.key}", f"{use.use}.{use.key}"
    common = _port(use, names)[0]
    # Two components may have ports of one name: with several components the id names the component as well.
    parts = 1 if len(node.implements) <= 1 else 2
    return f"{use.use}.{_end(common, parts)}", f"{use.use}.{_end(use.port, parts)}"


def _port(use: PortUse, names: Names) -> tuple[str, ...]:
    """Return the common id of the component's port behind a use, nothing for an internal one."""
    return (names.to("output" if use.use in {"publishes", "serves"} else "input", use.port),) if use.port else ()


def _end(path: str, parts: int) -> str:
    return ".".join(path.split(".")[-parts:])


def _further(found: Architecture, node: Node) -> tuple[str, ...]:
    """Return a node's further owners, unless they are exactly those of its components."""
    inherited = {owner for component in node.implements for owner in found.components[component].owners}
    return () if set(node.owners) == inherited else node.co_owners


def _node(found: Architecture, node: Node, names: Names, alone: frozenset[str]) -> dict[str, object]:
    container = names.to("container", node.container) if node.container else None
    held = found.containers.get(node.container) if node.container else None
    # A host that is the container's own adds nothing, and would change with it.
    host = None if held and held.host == node.host else node.host
    return {
        "title": title(node.id, node.title),
        "implements": words(names.to("component", component) for component in node.implements),
        "description": prose(node.description),
        "owner": names.to("partner", node.owner) if node.owner else None,
        "co_owners": words(names.to("partner", other) for other in _further(found, node)),
        "name": None if node.name == node.id else node.name,
        "namespace": None if node.namespace == "/" else node.namespace,
        "kind": words(() if node.kinds == ("node",) else node.kinds),
        "package": node.package,
        "executable": node.executable,
        "plugin": node.plugin,
        "container": container,
        "host": names.to("host", host) if host else None,
        "status": node.status,
        "parameter_files": node.parameter_files,
        "tags": words(node.tags),
        **{f"urls.{name}": url for name, url in node.urls.items()},
        **{key: value for name, below in node.parameters.items() for key, value in leaves(f"parameters.{name}", below)},
        **_node_timing(node, names, alone),
    }


def _use(use: PortUse, node: Node, *, stated: bool) -> dict[str, object]:
    values: dict[str, object] = {
        "carried": True if stated else None,
        "topic": words(ros_names.absolute(topic, node) for topic in use.topics),
        "message": use.message,
    }
    qos = use.qos or _DEFAULT
    return values | {f"qos.{key}": getattr(qos, key) for key in QOS if getattr(qos, key) != getattr(_DEFAULT, key)}


def default_qos(key: str) -> object:
    """Return the value of a key of `qos` that nobody wrote."""
    return getattr(_DEFAULT, key)


def behind(found: Architecture) -> Mapping[str, list[Node]]:
    """Return for each component its nodes, planned ones included."""
    made: dict[str, list[Node]] = defaultdict(list)
    for node in found.nodes.values():
        for component in node.implements:
            made[component].append(node)
    return made


def timing_values(
    component: Component, nodes_of: Sequence[Node], names: Names, split: frozenset[str]
) -> dict[str, object]:
    """Return a component's timing: that of its node if it has exactly one, else what it says itself."""
    alone = len(nodes_of) == 1 and names.to("component", component.id) not in split
    timing = nodes_of[0].timing.get(component.id) if alone else component.timing
    return dict(_timing("timing", timing, names)) if timing else {}


def _node_timing(node: Node, names: Names, alone: frozenset[str]) -> dict[str, object]:
    """Return the timing that no component reports: of components with several nodes, and of a node without any."""
    values: dict[str, object] = {}
    for component, timing in node.timing.items():
        if component not in alone:
            below = "" if len(node.implements) <= 1 else f".{names.to('component', component)}"
            values |= _timing(f"timing{below}", timing, names)
    return values


def _timing(prefix: str, timing: Timing, names: Names) -> Iterator[tuple[str, object]]:
    """Yield the timing by key; a period is given as the rate it amounts to."""
    rate = timing.rate
    if timing.period is not None and timing.period.value:
        # Periods are in ns. `period: 100 ms` and `rate: 10 Hz` mean the same and must compare equal.
        rate = Quantity(Fraction(_SECOND) / timing.period.value, hertz(Fraction(_SECOND) / timing.period.value))
    yield f"{prefix}.behaviour", timing.behaviour
    yield f"{prefix}.rate", rate
    for key in ("jitter", "wcet", "bcet", "every", "throttle", "priority", "core", "response"):
        yield f"{prefix}.{key}", getattr(timing, key)
    trigger = timing.trigger
    if trigger:
        yield f"{prefix}.trigger", trigger.mode
        yield f"{prefix}.trigger.inputs", words(names.to("input", port) for port in trigger.inputs or ())
    for port, told in timing.outputs.items():
        name = _end(names.to("output", port), 1)
        yield f"{prefix}.outputs.{name}.conditional", told.conditional or None
        yield f"{prefix}.outputs.{name}.max_gap", told.max_gap
    for port, count in timing.calls.items():
        yield f"{prefix}.calls.{_end(names.to('input', port), 1)}", count
