"""Draw the shapes Graph and Chart as svg, png and pdf, with Graphviz.

`draw_pictures` is all that others need. Each graph is laid out by the recipe that it names, in worker processes; what
was drawn before comes from the cache. No picture is trusted: after each layout every arrow is looked for in the result.
Pictures are light; `svg_cleanup` and `dark_rules` say how a page turns them dark.
"""

from __future__ import annotations

import contextlib
import os
import tempfile
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Final

from archgen.emit.graphviz import cache as store
from archgen.emit.graphviz.palette import dark_rules
from archgen.emit.graphviz.pool import MissingGraphviz, Progress, Watch, Worker, idle
from archgen.emit.graphviz.pool import draw as draw_all
from archgen.emit.graphviz.worker import Task
from archgen.emit.picture import Picture
from archgen.views.bars import Chart, Drawing

__all__ = ["FORMATS", "MissingGraphviz", "dark_rules", "draw", "early"]

FORMATS: Final = ("svg", "svg_outlines", "png", "pdf")
"""The formats that can be asked for, by Picture's fields; `dot` is always there."""


def draw(  # noqa: PLR0913 - what to draw, and how, each by its name
    graphs: Sequence[Drawing],
    formats: Sequence[str],
    *,
    link: Callable[[str], str | None],
    cache: Path | None = None,
    workers: int | None = None,
    progress: Progress | None = None,
    ready: Sequence[Worker] = (),
) -> dict[str, Picture]:
    """Draw graphs and charts in some formats. Return the pictures by the graphs' ids.

    `resolve_link` returns the address for a ref, or None where its target is not part of the output. `cache` is a
    folder that archgen may fill; `ready_workers` comes from `start_early_workers`. Raise MissingGraphviz where nothing
    can be drawn and not all pictures are cached.
    """
    cache = cache if cache and _writable(cache) else None
    wanted = tuple(form for form in FORMATS if form in formats)
    # Addresses are resolved here: a function cannot be sent to a worker process, and the cache's key needs them.
    linked = [dict(_links(graph, link)) for graph in graphs]
    keys = [store.key(graph, links) for graph, links in zip(graphs, linked, strict=True)]
    found = {at: hit for at, name in enumerate(keys) if cache and (hit := store.load(cache, name, wanted))}
    missing = [at for at in range(len(graphs)) if at not in found]
    if missing:
        tasks = [Task(graphs[at], linked[at], wanted) for at in missing]

        def keep(at: int, picture: Picture) -> None:
            # A picture with a warning is drawn anew each time: a layout that was only too slow may succeed in the next
            # run.
            if cache and picture.warning is None:
                # Stored as soon as it is drawn, in the worker's thread: while other pictures are still laid out.
                with contextlib.suppress(OSError):  # a full disk costs only the time that this would have saved
                    store.store(cache, keys[missing[at]], picture, wanted)

        drawn = _draw(tasks, cache, workers or os.cpu_count() or 1, Watch(progress, keep), ready)
        found.update(zip(missing, drawn, strict=True))
        if cache:
            store.prune(cache, len(graphs))
    return {graph.id: found[at] for at, graph in enumerate(graphs)}


@contextmanager
def early(cache: Path | None) -> Iterator[Sequence[Worker]]:
    """Start drawing processes before the graphs are known, if no picture is cached: then all processes are needed."""
    workers: list[Worker] = []
    if cache and _writable(cache) and not any(cache.glob("*.picture")):
        workers = [idle(cache) for _ in range(os.cpu_count() or 1)]
    try:
        for each in workers:
            each.begin()
        yield workers
    finally:
        for each in workers:
            each.stop()


def _writable(folder: Path) -> bool:
    """Return whether a folder can hold the cache. Without one, pictures are drawn each time."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            return True
    except OSError:
        return False


def _draw(
    tasks: Sequence[Task], cache: Path | None, workers: int, watch: Watch, ready: Sequence[Worker]
) -> tuple[Picture, ...]:
    if cache:
        return draw_all(tasks, cache, workers=workers, watch=watch, ready=ready)
    # Even without a cache the workers need a folder for fontconfig. Early workers exist only with a cache: none to pass
    # on.
    with tempfile.TemporaryDirectory(prefix="archgen-fonts-") as folder:
        return draw_all(tasks, Path(folder), workers=workers, watch=watch)


def _links(graph: Drawing, link: Callable[[str], str | None]) -> Iterator[tuple[str, str]]:
    """Yield each ref of a graph that has an address, with the address."""
    if isinstance(graph, Chart):
        refs = [bar.ref for bar in graph.bars]
    else:
        refs = [item.ref for items in (graph.boxes, graph.arrows, graph.clusters) for item in items]
    for ref in dict.fromkeys(refs):
        href = link(ref) if ref else None
        if ref and href:
            yield ref, href
