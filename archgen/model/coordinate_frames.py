"""Coordinate frames (TF): what each is placed in, who writes it, and what data is given in it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Literal

from archgen.diagnostics import NO_SPAN, Span
from archgen.frozen import dataclass, field
from archgen.grouping import group_pairs
from archgen.model.element_annotations import NO_ANNOTATIONS, ElementAnnotations
from archgen.model.quantity import Quantity


@dataclass(frozen=True, slots=True)
class Frame:
    """A coordinate frame. `parent` is the name as written (declared or not), None for a root; `rate` in Hz.

    `by` is the complete id of the component, or of the node, that writes it, None while unknown. `component` is the one
    that holds it, None for a frame of the project.
    """

    id: str
    title: str
    parent: str | None = None
    by: str | None = None
    by_kind: Literal["component", "node"] = "component"
    rate: Quantity | None = None
    static: bool = False
    component: str | None = None
    by_written: bool = False
    """Whether `by` is written, resolved or not: no rule reports such a frame as unpublished."""
    annotations: ElementAnnotations = NO_ANNOTATIONS
    at: Span = field(default=NO_SPAN, compare=False, repr=False)
    parent_at: Span = field(default=NO_SPAN, compare=False, repr=False)

    @property
    def answering_element(self) -> str:
        """The component or node that holds or writes it, else its own name: whom findings about it concern."""
        # Findings are filed by id: by its own name they would also be those of a node that is called so.
        return self.component or self.by or self.id

    @property
    def topic(self) -> str:
        """The topic on which it is written."""
        return "/tf_static" if self.static else "/tf"


def walk_ancestors(frames: Mapping[str, Frame], name: str) -> Iterator[str]:
    """Yield the names above a frame, the nearest first, each once: a circle ends where it began."""
    seen_names = {name}
    frame = frames.get(name)
    while frame and frame.parent is not None and frame.parent not in seen_names:
        seen_names.add(frame.parent)
        yield frame.parent
        frame = frames.get(frame.parent)


def index_child_frames(frames: Mapping[str, Frame]) -> dict[str, list[Frame]]:
    """Return the frames that are placed in each name, in their order."""
    return group_pairs((frame.parent, frame) for frame in frames.values() if frame.parent is not None)
