"""The table of coordinate frames: what each is placed in, who writes it how often, and whose data is in it."""

from __future__ import annotations

from archgen.model.architecture import Architecture
from archgen.model.coordinate_frames import Frame
from archgen.views import inline_text
from archgen.views.elements.frame_users import NOBODY, index_frame_ports, list_shown_frames
from archgen.views.lookup import Lookup
from archgen.views.shapes import Column, Inlines, Table, Text


def make_frame_table(lookup: Lookup) -> Table | None:
    """List the frames in the order of the files; None where there is none."""
    architecture, frames = lookup.architecture, list_shown_frames(lookup)
    ports_by_frame = index_frame_ports(architecture)
    rows = tuple(
        (
            _name_cell(frame),
            link_declared_frame(architecture, frame.parent) if frame.parent is not None else _mute_words("a root"),
            link_writer(architecture, frame) if frame.parent is not None else (),
            _rate_cell(frame),
            inline_text.join_inlines(_link_port(architecture, port) for port in ports_by_frame.get(frame.id, ())),
        )
        for frame in frames
    )
    columns = (
        Column("Frame", 1.2),
        Column("Placed in"),
        Column("Written by", 1.2),
        Column("Rate", 0.6, "right"),
        Column("Data in it", 1.8),
    )
    # Frames have no page of their own: references to one lead to its row.
    anchors = tuple(f"frame:{frame.id}" for frame in frames)
    return Table("table:frames", "Frames", columns, rows, row_anchors=anchors) if rows else None


def link_declared_frame(architecture: Architecture, name: str) -> Inlines:
    """Link to a frame by its name; one that nobody declares is a plain text."""
    return (Text(name, ref=f"frame:{name}" if name in architecture.frames else None, code=True),)


def link_writer(architecture: Architecture, frame: Frame) -> Inlines:
    """Link to who writes a frame."""
    if frame.by is None:
        return _mute_words(NOBODY)
    if frame.by_kind == "node":
        return (inline_text.node_link(architecture.nodes[frame.by]),)
    component = architecture.components.get(frame.by)
    return (inline_text.component_link(component) if component else Text(frame.by, code=True),)


def _name_cell(frame: Frame) -> Inlines:
    name = Text(frame.id, code=True)
    return (name, Text(f" {frame.title}")) if frame.title != frame.id else (name,)


def _rate_cell(frame: Frame) -> Inlines:
    if frame.parent is None:
        return ()
    return _mute_words("static") if frame.static else inline_text.quantity_to_inlines(frame.rate)


def _link_port(architecture: Architecture, port_id: str) -> Inlines:
    return inline_text.port_link(architecture, architecture.outputs.get(port_id) or architecture.inputs[port_id])


def _mute_words(words: str) -> Inlines:
    return (Text(words, muted=True),)
