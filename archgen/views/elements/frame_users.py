"""What a coordinate frame is there for: the frames placed in it, the nodes that write it, the ports that name it."""

from __future__ import annotations

from archgen.model.architecture import Architecture
from archgen.model.coordinate_frames import Frame, list_children

FrameUsers = tuple[tuple[str, tuple[str, ...]], ...]


def list_frame_users(architecture: Architecture, frame: Frame) -> FrameUsers:
    """Return lists below their headings: frames placed in a frame, ports whose data is given or expected in it."""
    children = tuple(child.id for child in list_children(architecture.frames).get(frame.id, ()))
    return (("holds", children), ("used by", list_frame_ports(architecture, frame.id)))


def list_frame_ports(architecture: Architecture, frame_name: str) -> tuple[str, ...]:
    """Return the ids of the ports whose data is in a frame, by themselves or by their type: outputs, then inputs."""
    ports = (*architecture.outputs.values(), *architecture.inputs.values())
    return tuple(dict.fromkeys(port.id for port in ports if architecture.frame_of(port) == frame_name))
