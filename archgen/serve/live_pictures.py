"""Pictures for pages that somebody waits for: drawn by processes that stay, and shown as they were until they are drawn."""

from __future__ import annotations

import tempfile
import threading
import time
from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from pathlib import Path

from archgen.emit import graphviz
from archgen.emit.graphviz.worker_pool import DrawingWorker, create_worker
from archgen.emit.picture import Picture
from archgen.frozen import dataclass
from archgen.products import report_cache
from archgen.views.picture_shapes import Drawing

_DRAWING_THREADS = 2
_PATIENCE = 0.12
"""Seconds that a page waits for a picture of which it can show an older one."""
_FIRST_PATIENCE = 6.0
"""Seconds that a page waits for a picture that it has never had."""
_WAITING_SVG = (
    b'<svg class="archgen" xmlns="http://www.w3.org/2000/svg" width="220pt" height="30pt" viewBox="0 0 220 30">'
    b'<text x="8" y="19" font-size="10">This picture is being drawn.</text></svg>'
)


@dataclass(frozen=True, slots=True)
class DrawnPicture:
    """A picture, and the drawing that it was drawn from."""

    drawing: Drawing
    picture: Picture


class LivePictures:
    """Draws pictures, each again only when its drawing changes. `on_late` is called when one is drawn that a page went
    without.
    """

    def __init__(self, on_late: Callable[[], None]) -> None:
        """Start nothing yet."""
        self._on_late = on_late
        self._drawn: dict[str, DrawnPicture] = {}
        self._waiting: dict[str, Drawing] = {}
        self._missed_ids: set[str] = set()
        self._changed = threading.Condition()
        self._stopped = False
        self._threads: list[threading.Thread] = []
        self._fonts: tempfile.TemporaryDirectory[str] | None = None

    def start(self) -> None:
        """Start the drawing processes: they take half a second until they can draw."""
        self._fonts = tempfile.TemporaryDirectory(prefix="archgen-fonts-")
        folder = Path(self._fonts.name)
        for _ in range(_DRAWING_THREADS):
            worker = create_worker(folder)
            worker.start_process()
            thread = threading.Thread(target=self._draw_waiting, args=(worker,), daemon=True)
            thread.start()
            self._threads.append(thread)

    def stop(self) -> None:
        """End the drawing processes."""
        with self._changed:
            self._stopped = True
            self._changed.notify_all()
        for thread in self._threads:
            # Daemons: a picture that takes half a minute does not keep Ctrl-C waiting.
            thread.join(timeout=1)
        if self._fonts is not None:
            self._fonts.cleanup()

    def find_pictures(self, drawings: Iterable[Drawing]) -> Mapping[str, Picture]:
        """Return pictures by id: as they are now if they are drawn soon, else as they were."""
        drawing_list = tuple(drawings)
        start = time.monotonic()
        with self._changed:
            for drawing in drawing_list:
                if not self._is_drawn(drawing):
                    # Last in, first out: what was asked for last is what somebody looks at.
                    self._waiting.pop(drawing.id, None)
                    self._waiting[drawing.id] = drawing
            self._changed.notify_all()
            for drawing in drawing_list:
                patience = _PATIENCE if drawing.id in self._drawn else _FIRST_PATIENCE
                while not self._is_drawn(drawing) and (left := start + patience - time.monotonic()) > 0:
                    self._changed.wait(left)
            self._missed_ids |= {drawing.id for drawing in drawing_list if not self._is_drawn(drawing)}
            return {
                drawing.id: self._drawn[drawing.id].picture
                if drawing.id in self._drawn
                else Picture(drawing.id, 220, 30, svg=_WAITING_SVG)
                for drawing in drawing_list
            }

    def _is_drawn(self, drawing: Drawing) -> bool:
        drawn = self._drawn.get(drawing.id)
        return drawn is not None and (drawn.drawing is drawing or drawn.drawing == drawing)

    def _draw_waiting(self, worker: DrawingWorker) -> None:
        """Draw what waits, the last first, until all ends. Runs in a thread of its own."""
        try:
            while True:
                with self._changed:
                    while not self._waiting and not self._stopped:
                        self._changed.wait()
                    if self._stopped:
                        return
                    drawing_id, drawing = self._waiting.popitem()
                picture = _draw_picture(drawing, worker)
                with self._changed:
                    self._drawn[drawing_id] = DrawnPicture(drawing, picture)
                    is_late = drawing_id in self._missed_ids
                    self._missed_ids.discard(drawing_id)
                    self._changed.notify_all()
                if is_late:
                    self._on_late()
        finally:
            worker.stop_process()


def _draw_picture(drawing: Drawing, worker: DrawingWorker) -> Picture:
    """Draw one picture; one without a format, and with the reason, where that cannot be done."""
    with suppress(OSError):
        try:
            return graphviz.draw_pictures(
                (drawing,),
                ("svg",),
                resolve_link=lambda ref: f"#{ref}",
                cache=report_cache.cache_folder(),
                ready_workers=(worker,),
                keeps_workers=True,
            )[drawing.id]
        except graphviz.MissingGraphviz as error:
            return Picture(drawing.id, 0, 0, warning=str(error))
    return Picture(drawing.id, 0, 0, warning="the drawing process broke down")
