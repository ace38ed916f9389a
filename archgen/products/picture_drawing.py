"""Draw pictures for outputs: what cannot be drawn costs a warning, and everything else is still written."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import field
from typing import TYPE_CHECKING

from archgen.emit.picture import Picture
from archgen.frozen import dataclass
from archgen.products import report_cache
from archgen.products.output_options import DrawingProgress, OutputOptions
from archgen.views.chart_shapes import Drawing

if TYPE_CHECKING:
    from archgen.emit.graphviz.worker_pool import DrawingWorker


@dataclass(frozen=True, slots=True)
class DrawnPictures:
    """Pictures by id, and what could not be drawn as asked."""

    pictures: Mapping[str, Picture] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()


def draw_started_pictures(
    drawings: Sequence[Drawing],
    formats: Sequence[str] | Mapping[str, Sequence[str]],
    progress: DrawingProgress | None = None,
    workers: Sequence[DrawingWorker] = (),
) -> DrawnPictures:
    """Draw graphs and charts in formats for all or by their ids, on idle `workers` where there are some; links lead to
    `#` and an element's anchor.

    Where the machine lacks the drawing libraries there are no pictures, but a warning.
    """
    from archgen.emit import graphviz

    try:
        pictures = graphviz.draw_pictures(
            drawings,
            formats,
            resolve_link=lambda ref: f"#{ref}",
            cache=report_cache.cache_folder(),
            progress=progress,
            ready_workers=workers,
        )
    except graphviz.MissingGraphviz as error:
        return DrawnPictures(warnings=(str(error),))
    return DrawnPictures(
        pictures, tuple(f"{picture.id}: {picture.warning}" for picture in pictures.values() if picture.warning)
    )


def draw_or_warn(drawings: Sequence[Drawing], formats: Sequence[str], options: OutputOptions) -> Mapping[str, Picture]:
    """Draw graphs and charts, and pass on the warnings."""
    drawn = draw_started_pictures(drawings, formats, options.progress)
    for warning in drawn.warnings:
        options.warn(warning)
    return drawn.pictures
