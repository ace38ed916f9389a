"""Draw the shapes Graph, Chart, SequenceChart and Sheet as svg, png and pdf, with Graphviz.

`draw_pictures` is all that others need. Each graph is laid out by the recipe that it names, in worker processes; what
was drawn before comes from the cache. No picture is trusted: after each layout every arrow is looked for in the result.
Pictures are light; `graph_drawing` and `dark_rules` say how a page turns them dark.
"""

from __future__ import annotations

import contextlib
import os
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Final

from archgen.cache.layout_memory import NO_MEMORY, LayoutMemory
from archgen.cache.program_stamp import stamp_writers
from archgen.emit.graphviz import font_config
from archgen.emit.graphviz import picture_cache as store
from archgen.emit.graphviz.dot_text import hide_texts
from archgen.emit.graphviz.drawing_worker import DrawingTask
from archgen.emit.graphviz.palette import dark_rules
from archgen.emit.graphviz.worker_pool import (
    DrawingObserver,
    DrawingWorker,
    MissingGraphviz,
    ProgressCallback,
    create_worker,
)
from archgen.emit.graphviz.worker_pool import draw_tasks as draw_all
from archgen.emit.picture import Picture
from archgen.views.picture_shapes import Chart, Drawing, SequenceChart, Sheet

__all__ = ["PICTURE_FORMATS", "MissingGraphviz", "dark_rules", "draw_pictures", "start_early_workers"]

PICTURE_FORMATS: Final = ("svg", "svg_outlines", "png", "pdf", "dot")
"""The formats that can be asked for, by Picture's fields."""


def draw_pictures(  # noqa: PLR0913 - what to draw, and how, each by its name
    drawings: Sequence[Drawing],
    formats: Sequence[str] | Mapping[str, Sequence[str]],
    *,
    resolve_link: Callable[[str], str | None],
    cache: Path | None = None,
    workers: int | None = None,
    progress: ProgressCallback | None = None,
    ready_workers: Sequence[DrawingWorker] = (),
    keeps_workers: bool = False,
) -> dict[str, Picture]:
    """Draw graphs and charts in some formats: the same for all, or by the graphs' ids. Return the pictures by those ids.

    `resolve_link` returns the address for a ref, or None where its target is not part of the output. `cache` is a
    folder that archgen may fill; `ready_workers` comes from `start_early_workers`, or (`keeps_workers`) goes on for the
    next call. Raise MissingGraphviz where nothing can be drawn and not all pictures are cached.
    """
    cache = cache if cache and _is_usable(cache) else None
    wanted_formats = [
        tuple(
            form for form in PICTURE_FORMATS if form in (formats[each.id] if isinstance(formats, Mapping) else formats)
        )
        for each in drawings
    ]
    # Addresses are resolved here: a function cannot be sent to a worker process, and the cache's key needs them.
    hidden = [hide_texts(graph, dict(_link_addresses(graph, resolve_link))) for graph in drawings]
    keys = [store.picture_key(each.describe_visible()) for each in hidden]
    pictures = {
        at: hit
        for at, name in enumerate(keys)
        if cache and (hit := store.load_picture(cache, name, wanted_formats[at]))
    }
    missing = [at for at in range(len(drawings)) if at not in pictures]
    if missing:
        memory = LayoutMemory(cache, stamp_writers()) if cache else NO_MEMORY
        # Every picture has its source in any case.
        drawn_formats = [tuple(form for form in wanted_formats[at] if form != "dot") for at in missing]
        tasks = [
            DrawingTask(drawing, dict(links), drawn_formats[number], memory=memory)
            for number, (drawing, links) in enumerate(hidden[at].mark_drawing() for at in missing)
        ]

        def keep_picture(index: int, picture: Picture) -> None:
            # A picture with a warning is drawn anew each time: a layout that was only too slow may succeed in the next
            # run.
            if cache and picture.warning is None:
                # Stored as soon as it is drawn, in the worker's thread: while other pictures are still laid out.
                with contextlib.suppress(OSError):  # a full disk costs only the time that this would have saved
                    store.store_picture(cache, keys[missing[index]], picture, drawn_formats[index])

        drawn = _draw_tasks(
            tasks,
            cache,
            workers or os.cpu_count() or 1,
            DrawingObserver(progress, keep_picture, keeps_workers),
            ready_workers,
        )
        pictures.update(zip(missing, drawn, strict=True))
        if cache:
            store.prune_pictures(cache, len(drawings))
    return {
        graph.id: hidden[at].restore_texts(pictures[at], with_dot="dot" in wanted_formats[at])
        for at, graph in enumerate(drawings)
    }


@contextmanager
def start_early_workers(cache: Path | None) -> Iterator[Sequence[DrawingWorker]]:
    """Start drawing processes before the graphs are known, if no picture is cached: then all processes are needed."""
    workers: list[DrawingWorker] = []
    if cache and _is_usable(cache) and not any(cache.glob("*.picture")):
        workers = [create_worker(cache) for _ in range(os.cpu_count() or 1)]
    try:
        for worker in workers:
            worker.start_process()
        yield workers
    finally:
        for worker in workers:
            worker.stop_process()


def _is_usable(folder: Path) -> bool:
    """Return whether a folder can hold the cache. Without one, pictures are drawn each time."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        # Drawing needs the font there, and a disk may be full.
        font_config.write_font_config(folder)
        with tempfile.TemporaryFile(dir=folder):
            return True
    except OSError:
        return False


def _draw_tasks(
    tasks: Sequence[DrawingTask],
    cache: Path | None,
    workers: int,
    observer: DrawingObserver,
    ready_workers: Sequence[DrawingWorker],
) -> tuple[Picture, ...]:
    if cache:
        return draw_all(tasks, cache, workers=workers, observer=observer, ready_workers=ready_workers)
    # Even without a cache the workers need a folder for fontconfig. Early workers exist only with a cache; those that
    # are kept have a folder of their own.
    with tempfile.TemporaryDirectory(prefix="archgen-fonts-") as folder:
        return draw_all(tasks, Path(folder), workers=workers, observer=observer, ready_workers=ready_workers)


def _link_addresses(drawing: Drawing, resolve_link: Callable[[str], str | None]) -> Iterator[tuple[str, str]]:
    """Yield each ref of a graph that has an address, with the address."""
    refs: list[str | None]
    if isinstance(drawing, Chart):
        refs = [bar.ref for bar in drawing.bars]
    elif isinstance(drawing, Sheet):
        refs = [item.ref for items in (drawing.bars, drawing.texts) for item in items]
    elif isinstance(drawing, SequenceChart):
        refs = [lifeline.ref for lifeline in drawing.lifelines] + [message.ref for message in drawing.messages]
    else:
        refs = [item.ref for items in (drawing.boxes, drawing.arrows, drawing.clusters) for item in items]
    for ref in dict.fromkeys(refs):
        href = resolve_link(ref) if ref else None
        if ref and href:
            yield ref, href
