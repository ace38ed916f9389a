"""Say on a page that its picture is left out because the architecture has too many of its kind, and where to see the same."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from archgen.views.graph_shapes import GraphKind
from archgen.views.pages.report_outline import DocumentEdition
from archgen.views.shapes import Block, Figure, Paragraph, Section, Text

_KINDS_BY_FOLDER: dict[str, GraphKind] = {"components": "component", "groups": "group"}
"""The kinds of pictures that a note stands for, by the folder of their ids. One note is enough for a component's two."""


def keep_drawn(blocks: Iterable[Block], edition: DocumentEdition) -> tuple[Block, ...]:
    """Drop figures that are not among the drawings, with a note where they are left out for their number."""
    return tuple(_iterate_drawn(blocks, edition))


def _iterate_drawn(blocks: Iterable[Block], edition: DocumentEdition) -> Iterator[Block]:
    for block in blocks:
        if not isinstance(block, Figure) or block.graph in edition.drawings:
            yield block
        elif _KINDS_BY_FOLDER.get(block.graph.partition("/")[0]) in edition.undrawn_kinds:
            yield _make_note()


def make_timing_note(edition: DocumentEdition) -> tuple[Section, ...]:
    """Return a section in the place of the pictures of each group's timing, where these are left out."""
    if "group-timing" not in edition.undrawn_kinds:
        return ()
    return (Section("timing:groups", "Group by group", (_make_note(),)),)


def _make_note() -> Paragraph:
    """Return the note: where the same is to be seen, and how to have the picture."""
    link = Text("explorer", ref="page:explorer")
    return Paragraph(
        (
            Text("No picture is drawn here, since there would be very many. The ", muted=True),
            link,
            Text(" shows the same; ", muted=True),
            Text("archgen site --component-pictures", code=True),
            Text(" draws them all.", muted=True),
        )
    )
