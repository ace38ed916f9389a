"""Coordinate frames between partners: those that one of them writes and the other one uses."""

from __future__ import annotations

from collections.abc import Iterator

from archgen.frozen import dataclass
from archgen.model.architecture import Architecture
from archgen.model.coordinate_frames import Frame, index_child_frames


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
