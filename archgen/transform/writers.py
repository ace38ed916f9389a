"""Endpoints that write (publish, serve): the outputs of a node's components, under their written or default names."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping

from archgen.frozen import dataclass
from archgen.model.architecture import Architecture
from archgen.model.component import Component, Output
from archgen.model.mapping import flow_of
from archgen.model.node import Endpoint, Flow, Node, PortUse, Qos, Use
from archgen.transform import ros_names

UNWRITTEN = PortUse("publishes", "", None)
"""The entry of a port that its node does not list. Compared by identity: a written entry may look the same."""
DEFAULT = Qos()


@dataclass(frozen=True, slots=True)
class Carrier:
    """A node as an implementation of one component: its entries for the component's ports.

    `is_only_node`: no other node implements the component, so that the node carries all of its ports.
    """

    node: Node
    component: Component
    uses: Mapping[str, tuple[PortUse, ...]]
    """The entries by the port's complete id. Those of the node's other components are among them."""
    alone: bool


def carriers(architecture: Architecture) -> dict[str, tuple[Carrier, ...]]:
    """Return one `NodePart` for each component that a node implements, by node id, in the order of `implements`."""
    count: dict[str, int] = {}
    for node in architecture.nodes.values():
        for component in node.implements:
            count[component] = count.get(component, 0) + 1
    found: dict[str, tuple[Carrier, ...]] = {}
    for node in architecture.nodes.values():
        uses: dict[str, list[PortUse]] = {}
        for use in node.uses:
            if use.port and not use.internal:
                uses.setdefault(use.port, []).append(use)
        by_port = {port: tuple(several) for port, several in uses.items()}
        found[node.id] = tuple(
            Carrier(node, architecture.components[c], by_port, count[c] == 1) for c in node.implements
        )
    return found


def written_endpoints(architecture: Architecture, carrier: Carrier) -> Iterator[Endpoint]:
    """Yield what a node writes for a component: one endpoint for each output and each of its names."""
    for output in carrier.component.outputs.values():
        uses = side(carrier.uses.get(output.id, ()), {"publishes", "serves"})
        if output.physical or not (uses or carrier.alone):
            continue
        for use in uses or (UNWRITTEN,):
            yield from _of_output(architecture, carrier, output, use)


def side(uses: Iterable[PortUse], kinds: Collection[Use]) -> tuple[PortUse, ...]:
    """Return the entries of some sections: an input and an output may have the same name, and so the same id."""
    return tuple(use for use in uses if use.use in kinds)


def flow(message: str | None, use: PortUse) -> Flow:
    """Return the kind of flow by the message; if unknown, by the section that the entry is written in."""
    if message is None and use.use in {"serves", "calls"}:
        return "service"
    return flow_of(message)


def _of_output(architecture: Architecture, carrier: Carrier, output: Output, use: PortUse) -> Iterator[Endpoint]:
    """Yield the endpoints of one output for one entry."""
    message = use.message or architecture.message(output)
    kind = flow(message, use)
    for name in [ros_names.absolute(topic, carrier.node) for topic in use.topics] or [ros_names.of_port(output.id)]:
        yield Endpoint(
            node=carrier.node.id,
            use="publishes" if kind == "topic" else "serves",
            name=name,
            flow=kind,
            port=output.id,
            component=carrier.component.id,
            message=message,
            type=output.type,
            qos=use.qos or DEFAULT,
            written=use is not UNWRITTEN,
            name_written=bool(use.topics),
            at=use.at,
            message_at=use.message_at,
        )
