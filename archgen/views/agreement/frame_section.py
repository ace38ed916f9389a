"""The section on coordinate frames: what one partner writes and the other one uses."""

from __future__ import annotations

from collections.abc import Iterator

from archgen.model.architecture import Architecture
from archgen.model.setting_sharing import SharedFrame, find_shared_frames
from archgen.views import inline_text
from archgen.views.agreement.agreement_content import AgreementContent
from archgen.views.agreement.term_changes import write_signed_kind
from archgen.views.graphs.element_boxes import join_owner_titles
from archgen.views.shapes import Column, Inlines, Paragraph, Section, Table, Text, drop_empty_columns
from archgen.views.tables.frame_table import link_declared_frame, link_writer

_LEAD = "These frames are written by one of the two, and used by the other one: its data is given or expected in them, or its own frames are placed in them."


def write_frame_section(content: AgreementContent) -> Iterator[Section]:
    """Yield the section, where there is such a frame."""
    shared_frames = find_shared_frames(content.lookup.architecture, *content.pair)
    if shared_frames:
        marks = _mark_frames(content)
        columns = (
            Column("Frame"),
            Column("Partner", 0.9),
            Column("Written by", 1.1),
            Column("Placed in", 0.9),
            Column("Rate", 0.6, "right"),
            Column("Used for", 1.7),
            Column("Change", 0.7),
        )
        rows = tuple(_frame_row(content, shared, marks.get(shared.frame.id)) for shared in shared_frames)
        table = drop_empty_columns(Table("table:shared_frames", "Frames between the two", columns, rows))
        yield Section("page:frames", "Frames", (Paragraph(inline_text.to_inlines(_LEAD)), table))


def list_changed_frames(content: AgreementContent) -> tuple[str, ...]:
    """Return the names of the frames that are not what they were at the earlier revision, those that are gone too."""
    return tuple(_mark_frames(content))


def _frame_row(content: AgreementContent, shared: SharedFrame, mark: Text | None) -> tuple[Inlines, ...]:
    architecture, frame = content.lookup.architecture, shared.frame
    rate = inline_text.to_inlines("static") if frame.static else inline_text.quantity_to_inlines(frame.rate)
    ports = (_link_port(architecture, name) for name in shared.ports)
    frames = (link_declared_frame(architecture, name) for name in shared.frames)
    return (
        (Text(frame.id, code=True),),
        inline_text.to_inlines(join_owner_titles(content.lookup, [shared.giver])),
        link_writer(architecture, frame),
        link_declared_frame(architecture, frame.parent or ""),
        rate,
        inline_text.join_inlines((*ports, *frames)),
        (mark,) if mark else (),
    )


def _link_port(architecture: Architecture, port_id: str) -> Inlines:
    return inline_text.port_link(architecture, architecture.outputs.get(port_id) or architecture.inputs[port_id])


def _mark_frames(content: AgreementContent) -> dict[str, Text]:
    """Return what happened to each frame since the earlier revision; nothing where no changes are asked for."""
    if content.changes is None or content.earlier_lookup is None:
        return {}
    shown, earlier = (
        {shared.frame.id: _plain_terms(shared) for shared in find_shared_frames(architecture, *content.pair)}
        for architecture in (content.lookup.architecture, content.earlier_lookup.architecture)
    )
    names = [name for name in {**earlier, **shown} if shown.get(name) != earlier.get(name)]
    return {
        name: write_signed_kind("removed" if name not in shown else "added" if name not in earlier else "changed")
        for name in names
    }


def _plain_terms(shared: SharedFrame) -> tuple[object, ...]:
    frame = shared.frame
    return shared.giver, shared.ports, shared.frames, frame.parent, frame.by, frame.rate, frame.static
