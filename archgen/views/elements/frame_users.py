"""What a coordinate frame is there for: who writes it, the frames placed in it, the ports that name it."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping

from archgen.model.architecture import Architecture
from archgen.model.coordinate_frames import Frame, index_child_frames, walk_ancestors
from archgen.views.lookup import Lookup

NOBODY = "nobody yet"
FrameUsers = tuple[tuple[str, tuple[str, ...]], ...]


def list_frame_users(architecture: Architecture, frame: Frame) -> FrameUsers:
    """Return lists below their headings: frames placed in a frame, ports whose data is given or expected in it."""
    children = tuple(child.id for child in index_child_frames(architecture.frames).get(frame.id, ()))
    return (("holds", children), ("used by", tuple(index_frame_ports(architecture).get(frame.id, ()))))


def index_frame_ports(architecture: Architecture) -> Mapping[str, list[str]]:
    """Return the ids of the ports whose data is in each frame, by themselves or by their type: outputs, then inputs."""
    ports_by_frame: dict[str, dict[str, None]] = defaultdict(dict)
    for port in architecture.list_ports():
        frame_name = architecture.frame_of(port)
        if frame_name is not None:
            ports_by_frame[frame_name][port.id] = None
    return {name: list(ports) for name, ports in ports_by_frame.items()}


def name_writer(architecture: Architecture, frame: Frame) -> str:
    """Return what people call the writer of a frame."""
    component = architecture.components.get(frame.by or "") if frame.by_kind == "component" else None
    return component.title if component else frame.by or NOBODY


def list_shown_frames(lookup: Lookup) -> list[Frame]:
    """Return the frames that a document shows: all, or those its components and nodes write and name, with all above."""
    frames, scope = lookup.architecture.frames, lookup.scope
    if scope.components is None:
        return list(frames.values())
    ports = [port for port in lookup.architecture.list_ports() if scope.shows_component(port.component)]
    names = {lookup.architecture.frame_of(port) for port in ports}
    names |= {frame.id for frame in frames.values() if frame.by and _shows_writer(lookup, frame, frame.by)}
    shown_names = {above for name in names if name for above in (name, *walk_ancestors(frames, name))}
    return [frame for frame in frames.values() if frame.id in shown_names]


def _shows_writer(lookup: Lookup, frame: Frame, writer: str) -> bool:
    return lookup.scope.shows_component(writer) if frame.by_kind == "component" else lookup.scope.shows_node(writer)
