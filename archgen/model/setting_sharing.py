"""Parameters and operations between partners: what one of them declares, and the other one sets or may call.

Coordinate frames between partners: those that one of them writes and the other one uses.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from archgen.frozen import dataclass
from archgen.model.architecture import Architecture
from archgen.model.component import Component
from archgen.model.coordinate_frames import Frame, index_child_frames
from archgen.model.node import Node
from archgen.model.parameter import Operation, Parameter
from archgen.model.parameter_values import canonical_name
from archgen.model.ros_distro import is_ros_1


@dataclass(frozen=True, slots=True)
class ParameterSetter:
    """What sets a parameter: a node, or (`is_node` False) the instance of a component type, with the value it gives."""

    id: str
    value: object
    is_node: bool


@dataclass(frozen=True, slots=True)
class SharedParameter:
    """A parameter that `giver` declares at a component, and that `taker` sets."""

    component: Component
    parameter: Parameter
    giver: str
    setters: tuple[ParameterSetter, ...]


@dataclass(frozen=True, slots=True)
class SharedOperation:
    """An operation of a component of `giver` that has an interface with the other partner."""

    component: Component
    operation: Operation
    giver: str


def list_declaring_owners(architecture: Architecture, component: Component) -> tuple[str, ...]:
    """Return the partners who answer for what a component can be set to: its type's owner, else its own owners."""
    component_type = architecture.component_types.get(component.type_name)
    return (component_type.owner,) if component_type and component_type.owner else component.owners


def is_set_by_instance(architecture: Architecture, component: Component, name: str) -> bool:
    """Whether an instance gives a parameter of its type a value of its own."""
    component_type = architecture.component_types.get(component.type_name)
    declared = component_type.parameters.get(name) if component_type else None
    parameter = component.parameters.get(name)
    if declared is None or parameter is None or parameter.value is None or parameter.handed_from:
        return False
    # What it has from its type stands where the type writes it.
    return parameter.value_at != declared.value_at


def list_set_values(architecture: Architecture, node: Node, name: str) -> list[object]:
    """Return the values that a node gives to a parameter, by itself or in its files."""
    ros_1 = is_ros_1(architecture.distro)
    wanted_name = canonical_name(name, ros_1=ros_1)
    return [
        value.value
        for value in (*node.file_values, *node.own_values)
        if canonical_name(value.name, ros_1=ros_1) == wanted_name
    ]


def find_shared_parameters(architecture: Architecture, pair: tuple[str, str]) -> tuple[SharedParameter, ...]:
    """Return the parameters between two partners, in the order of components."""
    return tuple(
        SharedParameter(component, parameter, giver, setters)
        for component in architecture.list_described_components()
        if component.parameters
        for giver, taker in _list_directions(list_declaring_owners(architecture, component), pair)
        for parameter in component.parameters.values()
        if (setters := tuple(_find_setters(architecture, component, parameter.name, taker)))
    )


def _list_directions(owners: Iterable[str], pair: tuple[str, str]) -> Iterator[tuple[str, str]]:
    """Yield who declares and who may set; what belongs to both is theirs together."""
    yield from ((giver, taker) for giver, taker in (pair, pair[::-1]) if giver in owners and taker not in owners)


def _find_setters(
    architecture: Architecture, component: Component, name: str, partner: str
) -> Iterator[ParameterSetter]:
    if partner in component.owners and is_set_by_instance(architecture, component, name):
        yield ParameterSetter(component.id, component.parameters[name].value, is_node=False)
    for node in architecture.nodes_implementing(component.id):
        if partner in node.owners:
            values = list_set_values(architecture, node, name)
            if values:
                yield ParameterSetter(node.id, values[-1], is_node=True)


def find_shared_operations(
    architecture: Architecture, component_ids: Iterable[str], pair: tuple[str, str]
) -> tuple[SharedOperation, ...]:
    """Return the operations of these components, and of those around them, that are no partner's private matter."""
    shown: dict[str, Component] = {}
    for component_id in component_ids:
        component = architecture.components[component_id]
        shown |= {each.id: each for each in (component, *architecture.list_around(component))}
    return tuple(
        SharedOperation(component, operation, giver)
        for component in shown.values()
        for giver, _ in _list_directions(list_declaring_owners(architecture, component), pair)
        for operation in component.operations.values()
        if operation.visibility in {None, "public"}
    )


@dataclass(frozen=True, slots=True)
class SharedFrame:
    """A frame that `giver` writes, with the ids of what `taker` uses it for: ports, then frames placed in it."""

    frame: Frame
    giver: str
    taker: str
    ports: tuple[str, ...] = ()
    frames: tuple[str, ...] = ()


def find_shared_frames(architecture: Architecture, first_partner: str, second_partner: str) -> tuple[SharedFrame, ...]:
    """Return the frames between two partners, those that the first one writes before those of the second."""
    pairs = ((first_partner, second_partner), (second_partner, first_partner))
    return tuple(shared for giver, taker in pairs for shared in _find_given_frames(architecture, giver, taker))


def list_frame_owners(architecture: Architecture, frame: Frame) -> tuple[str, ...]:
    """Return the partners who own what writes a frame."""
    writers = architecture.nodes if frame.by_kind == "node" else architecture.components
    writer = writers.get(frame.by or "")
    return writer.owners if writer else ()


def _find_given_frames(architecture: Architecture, giver: str, taker: str) -> Iterator[SharedFrame]:
    ports_by_frame: dict[str | None, dict[str, None]] = {}
    # Here and below: what belongs to both is theirs together.
    for port in architecture.list_ports():
        owners = architecture.components[port.component].owners
        if taker in owners and giver not in owners:
            ports_by_frame.setdefault(architecture.frame_of(port), {})[port.id] = None
    children = index_child_frames(architecture.frames)
    for frame in architecture.frames.values():
        writers = list_frame_owners(architecture, frame)
        if giver not in writers or taker in writers or frame.parent is None:
            continue
        frames = tuple(
            child.id
            for child in children.get(frame.id, ())
            if taker in (owners := list_frame_owners(architecture, child)) and giver not in owners
        )
        ports = tuple(ports_by_frame.get(frame.id, ()))
        if ports or frames:
            yield SharedFrame(frame, giver, taker, ports, frames)
