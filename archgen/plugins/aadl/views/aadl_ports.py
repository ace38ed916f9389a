"""The ports of a component as features of AADL: a feature has one type, so that an input that reads several has several."""

from __future__ import annotations

from dataclasses import field

from archgen.plugin import dataclass
from archgen.plugin.model import Architecture, Component, Input, Output
from archgen.plugins.aadl.views.aadl_types import TypeBook


@dataclass(frozen=True, slots=True)
class PortPart:
    """A port, or what an input reads of one type. `sources` are the outputs that arrive there; empty for all."""

    port: Input | Output
    name: str
    """The name of the port; of one of several parts with that of what arrives."""
    flow: str
    classifier: str
    kind: str
    """`out data port`, `in event data port`, `provides subprogram access`, ..."""
    sources: frozenset[str] = field(default=frozenset())
    is_call_data: bool = False
    """Whether it is the request or the answer of a call, which `port` is."""

    @property
    def is_output(self) -> bool:
        """Whether it gives data or an answer."""
        return self.kind.startswith(("out ", "provides "))

    @property
    def key(self) -> tuple[bool, str, str]:
        """What tells it from all others: an input and an output may have the same id."""
        return (self.is_output, self.port.id, self.name)

    @property
    def text(self) -> str:
        """The feature as AADL writes it."""
        return f"{self.kind} {self.classifier}"

    @property
    def connection_kind(self) -> str:
        """The word for connections of it."""
        return "port" if self.flow == "topic" else "subprogram access"

    def reads(self, output_id: str) -> bool:
        """Whether what an output sends arrives here."""
        return not self.sources or output_id in self.sources


def find_outer_port(architecture: Architecture, shell: Component, part: PortPart) -> str | None:
    """Return the port of a composed component that passes a port inside on."""
    if part.is_call_data:
        return None
    kind, ports = ("output", shell.outputs) if part.is_output else ("input", shell.inputs)
    return next(
        (name for name, port in ports.items() if part.port.id in architecture.leaf_ports_of(kind, port.id)), None
    )


def list_port_parts(
    architecture: Architecture, types: TypeBook, component: Component, triggers: frozenset[str]
) -> list[PortPart]:
    """Return the parts of all ports; `triggers` are the inputs that activate the component."""
    parts: list[PortPart] = []
    for port in component.inputs.values():
        parts += _split_input(architecture, types, port, is_trigger=port.id in triggers)
    for output in component.outputs.values():
        flow = architecture.flow_of(output)
        kind = f"out {_find_port_kind(output) or 'data'} port" if flow == "topic" else "provides subprogram access"
        parts.append(PortPart(output, output.name, flow, types.name_type(output.type, flow), kind))
    return parts


def _split_input(architecture: Architecture, types: TypeBook, port: Input, *, is_trigger: bool) -> list[PortPart]:
    by_type: dict[tuple[str | None, str], list[Output]] = {}
    for connection in port.connections:
        for output_id in connection.outputs:
            output = architecture.outputs[output_id]
            by_type.setdefault((output.type, architecture.flow_of(output)), []).append(output)
    by_type = by_type or {(port.type, architecture.flow_of(port)): []}
    kind = f"in {_find_port_kind(port) or ('event data' if is_trigger else 'data')} port"
    return [
        PortPart(
            port,
            port.name if len(by_type) == 1 else f"{port.name}_{outputs[0].name}",
            flow,
            types.name_type(type_name, flow),
            kind if flow == "topic" else "requires subprogram access",
            frozenset(each.id for each in outputs),
        )
        for (type_name, flow), outputs in by_type.items()
    ]


def _find_port_kind(port: Input | Output) -> str | None:
    """Return what AADL called the port that this one was read from."""
    hints = port.annotations.hints.get("aadl")
    kind = hints.get("port") if isinstance(hints, dict) else None
    return kind if kind in {"data", "event data"} else None
