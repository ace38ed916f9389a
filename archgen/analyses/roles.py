"""Does each component do what its role says?"""

from __future__ import annotations

from typing import TYPE_CHECKING

from archgen.diagnostic import Diagnostic, Severity
from archgen.frozen import dataclass
from archgen.model.mapping import flow_of

if TYPE_CHECKING:
    from collections.abc import Iterator

    from archgen.model.architecture import Architecture
    from archgen.model.component import Component, Connection


@dataclass(frozen=True, slots=True)
class Shape:
    """The properties of a component's ports that its role depends on.

    `is_fed`: an input takes data from another component; answers to the component's own calls do not count.
    `may_be_fed`: an input's source is missing or could not be resolved. `may_serve_calls`: the message of an output is
    unknown, so that it may be a service.
    """

    outputs: bool
    fed: bool
    maybe_fed: bool
    digital: bool
    """It has an output that is not physical."""
    acts: bool
    """It has a physical or an external output."""
    sends: bool
    """It has an output that carries messages."""
    serves: bool
    maybe_serves: bool


def shape(architecture: Architecture, component: Component) -> Shape:
    """Summarise the properties of a component's ports that its role depends on."""
    outputs = component.outputs.values()
    flows = [flow_of(architecture.message(o)) for o in outputs if not o.physical]
    open_inputs = [i for i in component.inputs.values() if not (i.connections or i.external or i.optional)]
    return Shape(
        outputs=bool(outputs),
        fed=any(_from_inside(architecture, component, c) for i in component.inputs.values() for c in i.connections),
        maybe_fed=bool(open_inputs),
        digital=bool(flows),
        acts=any(o.physical or o.external for o in outputs),
        sends=any(
            o.type and flow == "topic" for o, flow in zip((o for o in outputs if not o.physical), flows, strict=True)
        ),
        serves=any(flow != "topic" for flow in flows),
        maybe_serves=any(architecture.message(o) is None and not o.physical for o in outputs),
    )


def role_mismatch(architecture: Architecture) -> Iterator[Diagnostic]:
    """A component's inputs and outputs do not fit the role that it claims.

    Why: The role tells readers what to expect, and policies and pictures rest on it. A source has an output and takes
    nothing from other components. A filter takes data from another component and has an output that is not physical. A sink
    is fed by others (or serves a service or action), and acts on the world outside or sends nothing. A reactive component
    serves a service or an action. A call that a component makes does not count as data from others.

    Bad:
        groups:
          sensing:
            components:
              camera: {role: source, outputs: {image: sensor_msgs/msg/Image}}
              detector:
                role: source
                inputs: {image: camera.image}
                outputs: {found: {type: vision_msgs/msg/Detection2DArray, external: The operator's tablet}}
        nodes:
          camera: {implements: camera}
          detector: {implements: detector}

    Good:
        groups:
          sensing:
            components:
              camera: {role: source, outputs: {image: sensor_msgs/msg/Image}}
              detector:
                role: filter
                inputs: {image: camera.image}
                outputs: {found: {type: vision_msgs/msg/Detection2DArray, external: The operator's tablet}}
        nodes:
          camera: {implements: camera}
          detector: {implements: detector}
    """
    for component in architecture.components.values():
        if component.role is None or not (component.inputs or component.outputs):
            continue
        seen = shape(architecture, component)
        fault = _fault(component.role, seen)
        if fault is None:
            continue
        better = [role for role in ("source", "filter", "sink", "reactive") if _fault(role, seen) is None]
        yield Diagnostic(
            "role-mismatch",
            f"`{component.id}` says that its role is `{component.role}`, but {fault}",
            component.role_at,
            help=f"its ports fit the role {' or '.join(f'`{role}`' for role in better)}" if better else None,
            element=component.id,
        )


def _fault(role: str, seen: Shape) -> str | None:
    """Return what contradicts a role, or None."""
    return next((fault for fits, fault in _demands(role, seen) if not fits), None)


def _demands(role: str, seen: Shape) -> tuple[tuple[bool, str], ...]:
    """Return the conditions of a role, each with the fault to report where it does not hold."""
    if role == "source":
        return ((seen.outputs, "it has no output"), (not seen.fed, "it takes data from another component"))
    # From here on what may still turn out either way counts in the component's favour.
    serves = seen.serves or seen.maybe_serves
    if role == "reactive":
        return ((serves, "it serves no service and no action"),)
    fed = seen.fed or seen.maybe_fed
    if role == "filter":
        return (
            (seen.digital, "it has no output that is not physical"),
            (fed, "it takes no data from another component"),
        )
    return (
        (fed or serves, "no other component feeds it"),
        (seen.acts or not seen.sends, "all that it sends stays inside the architecture"),
    )


def _from_inside(architecture: Architecture, component: Component, connection: Connection) -> bool:
    """Whether a reference brings data from another component; answers to calls do not count."""
    if connection.kind == "output":
        output = architecture.outputs[connection.target]
        flow = "topic" if output.physical else flow_of(architecture.message(output))
        return output.component != component.id and flow == "topic"
    if connection.outputs:
        return any(architecture.outputs[o].component != component.id for o in connection.outputs)
    # It brings nothing yet. A stub of another component will bring data once it has outputs; no component feeds itself.
    return connection.target != component.id


RULES = ((role_mismatch, Severity.WARNING),)
