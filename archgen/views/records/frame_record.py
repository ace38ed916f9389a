"""Coordinate frames in the resolved record."""

from __future__ import annotations

from archgen.model.architecture import Architecture
from archgen.model.coordinate_frames import Frame
from archgen.views.records.record_values import drop_unknown, pick_fields, record_annotations, record_quantity


def record_frames(architecture: Architecture) -> dict[str, object]:
    """Return the section of frames, empty in a project without any."""
    return drop_unknown({"frames": {frame.id: record_frame(frame) for frame in architecture.frames.values()}})


def record_frame(frame: Frame) -> dict[str, object]:
    """Return a frame with its rate (Hz), or that it is static."""
    values = {"rate": record_quantity(frame.rate, "Hz"), "static": frame.static or None}
    return pick_fields(frame, "title", "parent", "by") | drop_unknown(dict(values)) | record_annotations(frame)
