"""Does each component do what its role says, and is what a composed one has carried by what is inside?"""

from __future__ import annotations

from collections.abc import Iterator

from archgen.diagnostics import Diagnostic, Severity
from archgen.frozen import dataclass
from archgen.model.architecture import Architecture
from archgen.model.component import Component, Connection
from archgen.model.port_media import is_physical


@dataclass(frozen=True, slots=True)
class PortSummary:
    """The properties of a component's ports that its role depends on.

    `is_fed`: an input takes data from another component; answers to the component's own calls do not count.
    `may_be_fed`: an input's source is missing or could not be resolved. `may_serve_calls`: the message of an output is
    unknown, so that it may be a service.
    """

    has_outputs: bool
    is_fed: bool
    may_be_fed: bool
    has_digital_output: bool
    """It has an output that is not physical."""
    acts_outside: bool
    """It has a physical or an external output."""
    sends_messages: bool
    """It has an output that carries messages."""
    serves_calls: bool
    may_serve_calls: bool


def summarise_ports(architecture: Architecture, component: Component) -> PortSummary:
    """Summarise the properties of a component's ports that its role depends on."""
    outputs = component.outputs.values()
    flows = [architecture.flow_of(o) for o in outputs if not is_physical(o)]
    open_inputs = [i for i in component.inputs.values() if not (i.connections or i.external or i.optional)]
    return PortSummary(
        has_outputs=bool(outputs),
        is_fed=any(
            _brings_component_data(architecture, component, c) for i in component.inputs.values() for c in i.connections
        ),
        may_be_fed=bool(open_inputs),
        has_digital_output=bool(flows),
        acts_outside=any(is_physical(o) or o.external for o in outputs),
        sends_messages=any(
            o.type and flow == "topic"
            for o, flow in zip((o for o in outputs if not is_physical(o)), flows, strict=True)
        ),
        serves_calls=any(flow != "topic" for flow in flows),
        may_serve_calls=any(architecture.message_of(o) is None and not is_physical(o) for o in outputs),
    )


def role_mismatch(architecture: Architecture) -> Iterator[Diagnostic]:
    """A component's inputs and outputs do not fit the role that it claims."""
    for component in architecture.components.values():
        if component.role is None or not (component.inputs or component.outputs):
            continue
        port_summary = summarise_ports(architecture, component)
        fault = _find_role_fault(component.role, port_summary)
        if fault is None:
            continue
        fitting_roles = [
            role for role in ("source", "filter", "sink", "reactive") if _find_role_fault(role, port_summary) is None
        ]
        yield Diagnostic(
            "role-mismatch",
            f"`{component.id}` says that its role is `{component.role}`, but {fault}",
            component.role_at,
            help=f"its ports fit the role {' or '.join(f'`{role}`' for role in fitting_roles)}"
            if fitting_roles
            else None,
            element=component.id,
        )


def _find_role_fault(role: str, port_summary: PortSummary) -> str | None:
    """Return what contradicts a role, or None."""
    return next((fault for fits, fault in _role_demands(role, port_summary) if not fits), None)


def _role_demands(role: str, port_summary: PortSummary) -> tuple[tuple[bool, str], ...]:
    """Return the conditions of a role, each with the fault to report where it does not hold."""
    if role == "source":
        return (
            (port_summary.has_outputs, "it has no output"),
            (not port_summary.is_fed, "it takes data from another component"),
        )
    # From here on what may still turn out either way counts in the component's favour.
    may_serve = port_summary.serves_calls or port_summary.may_serve_calls
    if role == "reactive":
        return ((may_serve, "it serves no service and no action"),)
    may_be_fed = port_summary.is_fed or port_summary.may_be_fed
    if role == "filter":
        return (
            (port_summary.has_digital_output, "it has no output that is not physical"),
            (may_be_fed, "it takes no data from another component"),
        )
    return (
        (may_be_fed or may_serve, "no other component feeds it"),
        (
            port_summary.acts_outside or not port_summary.sends_messages,
            "all that it sends stays inside the architecture",
        ),
    )


def _brings_component_data(architecture: Architecture, component: Component, connection: Connection) -> bool:
    """Whether a reference brings data from another component; answers to calls do not count."""
    if connection.kind == "output":
        output = architecture.outputs[connection.target]
        flow = architecture.flow_of(output)
        return output.component != component.id and flow == "topic"
    if connection.outputs:
        return any(architecture.outputs[o].component != component.id for o in connection.outputs)
    # It brings nothing yet. A stub of another component will bring data once it has outputs; no component feeds itself.
    return connection.target != component.id


def unread_input(architecture: Architecture) -> Iterator[Diagnostic]:
    """A composed component has an input that nothing inside reads."""
    for shell in architecture.shells.values():
        for port in shell.inputs.values():
            if not architecture.shell_ports[f"input {port.id}"]:
                yield Diagnostic(
                    "unread-input",
                    f"nothing inside of `{shell.id}` reads its input `{port.name}`",
                    port.at,
                    help=f"write `self.{port.name}` at an input inside, or take it out",
                    element=shell.id,
                )


def unfed_output(architecture: Architecture) -> Iterator[Diagnostic]:
    """A composed component has an output that nothing inside feeds."""
    for shell in architecture.shells.values():
        for port in shell.outputs.values():
            # What only passes on what comes back to itself has nothing behind it either.
            is_unfed = architecture.leaf_ports_of("output", port.id) == (port.id,)
            if is_unfed and port.id not in architecture.suspected_ids:
                yield Diagnostic(
                    "unfed-output",
                    f"nothing inside of `{shell.id}` feeds its output `{port.name}`",
                    port.at,
                    help=f"write `{port.name}: {{from: component.output}}`, or take it out",
                    element=shell.id,
                )


RULES = (
    (role_mismatch, Severity.WARNING),
    (unread_input, Severity.WARNING),
    (unfed_output, Severity.WARNING),
)
