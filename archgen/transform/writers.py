"""What nodes publish and serve: their components' outputs, under the names that count."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping

from archgen.frozen import dataclass
from archgen.model.architecture import Architecture
from archgen.model.component import Component, Output
from archgen.model.mapping import flow_of
from archgen.model.node import Endpoint, Flow, Node, PortUse, Qos, Use
from archgen.transform import ros_names

UNWRITTEN = PortUse("publishes", "", None)
"""What stands for a port about which its node says nothing."""
DEFAULT = Qos()


@dataclass(frozen=True, slots=True)
class Carrier:
    """A node in its part for one component: what it wrote about which port, and whether others share the component."""

    node: Node
    component: Component
    uses: Mapping[str, tuple[PortUse, ...]]
    """By the port's complete id."""
    alone: bool


def carriers(architecture: Architecture) -> dict[str, tuple[Carrier, ...]]:
    """Give the parts that each node plays, by node, in the order of what it implements."""
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
    """Give what a node writes for a component: one endpoint for each output and each name that it stands on."""
    for output in carrier.component.outputs.values():
        uses = side(carrier.uses.get(output.id, ()), {"publishes", "serves"})
        if output.physical or not (uses or carrier.alone):
            continue
        for use in uses or (UNWRITTEN,):
            yield from _of_output(architecture, carrier, output, use)


def side(uses: Iterable[PortUse], kinds: Collection[Use]) -> tuple[PortUse, ...]:
    """Keep the uses of some sections: an input and an output may have one name."""
    return tuple(use for use in uses if use.use in kinds)


def flow(message: str | None, use: PortUse) -> Flow:
    """Say what flows: the message decides; where none is named, the section that the port stands in."""
    if message is None and use.use in {"serves", "calls"}:
        return "service"
    return flow_of(message)


def _of_output(architecture: Architecture, carrier: Carrier, output: Output, use: PortUse) -> Iterator[Endpoint]:
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
