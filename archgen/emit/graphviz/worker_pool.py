"""Draw in worker processes, several at once, each picture under a time limit.

A picture whose drawing crashes, fails or takes too long is drawn once more in a simpler way, and says so. If that fails
as well, the picture comes without any format. The other pictures are not affected.
"""

from __future__ import annotations

import queue
import signal
import subprocess
import sys
import threading
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from archgen.emit.graphviz import font_config
from archgen.emit.graphviz.drawing_worker import (
    PROCESSOR_SECONDS,
    DrawingFailure,
    DrawingTask,
    receive_message,
    send_message,
)
from archgen.emit.picture import Picture
from archgen.resources import worker_environment
from archgen.views.picture_shapes import Graph

DRAWING_TIMEOUT = 300.0
"""Seconds that one drawing may take by the clock: for what hangs, and for a machine without limits on processor time."""

_BOXES_FOR_WORKER = 400
"""A further worker pays where there is so much to draw: to start one takes as long as to draw a hundred boxes."""

ProgressCallback = Callable[[int, int], None]
CommandLine = Sequence[str]


@dataclass(frozen=True, slots=True)
class DrawingObserver:
    """Callbacks for each picture as it is drawn: `on_progress(done, total)`, `on_drawn(task's index, picture)`.

    `on_drawn` is called in any thread, several at a time; `on_progress` under a lock, in order.
    """

    on_progress: ProgressCallback | None = None
    on_drawn: Callable[[int, Picture], None] = lambda _at, _picture: None
    keeps_workers: bool = False
    """Whether the processes go on when all is drawn, for the next run."""


_WORKER_CODE = "import sys; sys.path.append({root!r}); from archgen.emit.graphviz.drawing_worker import main; main()"
_SYSTEM_PACKAGES = {
    "libglib-2": "libglib2.0-0",
    "libgobject-2": "libglib2.0-0",
    "libX11": "libx11-6",
    "libXext": "libxext6",
    "libXrender": "libxrender1",
    "libexpat": "libexpat1",
}


class MissingGraphviz(Exception):  # noqa: N818 - it says what is missing
    """Pictures cannot be drawn on this machine: a system library, or pygraphviz itself, is missing.

    The message says which package to install. Everything else can still be made.
    """


def explain_missing(message: str) -> str:
    """Describe which package is missing, from the message of the ImportError."""
    package = next((package for library, package in _SYSTEM_PACKAGES.items() if library in message), None)
    if package:
        all_packages = " ".join(dict.fromkeys(_SYSTEM_PACKAGES.values()))
        return (
            f"pictures need the system package {package} (or what it is called here): {message}. "
            f"On Debian and Ubuntu: apt-get install {all_packages}"
        )
    return f"pictures need pygraphviz, which cannot be imported: {message}"


def worker_command() -> CommandLine:
    """Return the command line of a worker. `-P` keeps the current folder, which anybody may fill, out of its import
    path.
    """
    root = str(Path(__file__).resolve().parents[3])
    return (sys.executable, "-P", "-c", _WORKER_CODE.format(root=root))


def draw_tasks(  # noqa: PLR0913 - what to draw, and how, each by its name
    tasks: Sequence[DrawingTask],
    folder: Path,
    *,
    workers: int,
    observer: DrawingObserver = DrawingObserver(),
    timeout: float = DRAWING_TIMEOUT,
    command_line: CommandLine | None = None,
    ready_workers: Sequence[DrawingWorker] = (),
) -> tuple[Picture, ...]:
    """Draw all tasks, the largest first. Return the pictures in the order of the tasks.

    Raise MissingGraphviz where no worker can draw. Workers in `ready_workers` are used and, unless the observer keeps
    them, stopped; more are started as needed.
    """
    # Threads, since each only waits for its process; `ready` workers beyond the number of tasks are stopped by who made
    # them.
    enough = 1 + sum(_count_boxes(task) for task in tasks) // _BOXES_FOR_WORKER
    count = max(1, min(workers, len(tasks), max(enough, len(ready_workers))))
    drawing_workers = [
        *ready_workers[:count],
        *(create_worker(folder, command_line) for _ in range(count - len(ready_workers))),
    ]
    run = _DrawingRun(tasks, observer, timeout)
    threads = [threading.Thread(target=run.draw_waiting, args=(process,)) for process in drawing_workers]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    if run.missing_library:
        raise MissingGraphviz(explain_missing(run.missing_library))
    return tuple(run.pictures[at] for at in range(len(tasks)))


def create_worker(folder: Path, command_line: CommandLine | None = None) -> DrawingWorker:
    """Create a worker whose process is not started yet."""
    # PATH: Windows looks for libraries there, and Graphviz for its plugins.
    environment = worker_environment("PATH") | {
        "FONTCONFIG_FILE": str(font_config.write_font_config(folder)),
        # In UTC the date in a PDF, of which the digits are overwritten, is shorter than elsewhere.
        "TZ": "UTC0",
    }
    return DrawingWorker(command_line or worker_command(), environment)


def _count_boxes(task: DrawingTask) -> int:
    """Count the boxes of a drawing, which tell how long it takes; charts have nothing to lay out."""
    return len(task.drawing.boxes) if isinstance(task.drawing, Graph) else 0


class _DrawingRun:
    """What the threads share. Each has one worker process and takes the next task when its last one is done."""

    def __init__(self, tasks: Sequence[DrawingTask], observer: DrawingObserver, timeout: float) -> None:
        self.pictures: dict[int, Picture] = {}
        self.missing_library = ""
        self._observer, self._timeout = observer, timeout
        self._lock = threading.Lock()
        self._total = len(tasks)
        self._waiting: queue.SimpleQueue[tuple[int, DrawingTask]] = queue.SimpleQueue()
        # The largest first: started last, one large picture would keep all others waiting at the end.
        for at, task in sorted(enumerate(tasks), key=lambda each: -_count_boxes(each[1])):
            self._waiting.put((at, task))

    def draw_waiting(self, worker: DrawingWorker) -> None:
        """Draw waiting tasks until there are none, or nothing can be drawn at all. Then stop the worker, unless it is kept."""
        try:
            while not self.missing_library:
                at, task = self._waiting.get_nowait()
                self._finish_task(at, self._draw_task(worker, task))
        except queue.Empty:
            pass
        finally:
            if not self._observer.keeps_workers:
                worker.stop_process()

    def _finish_task(self, index: int, picture: Picture) -> None:
        self._observer.on_drawn(index, picture)
        with self._lock:
            self.pictures[index] = picture
            if self._observer.on_progress:
                self._observer.on_progress(len(self.pictures), self._total)

    def _draw_task(self, worker: DrawingWorker, task: DrawingTask) -> Picture:
        answer = worker.request_picture(task, self._timeout)
        # No other worker will fare better: the run ends, and the caller makes everything else without pictures.
        if isinstance(answer, DrawingFailure) and answer.kind == "missing":
            self.missing_library = answer.message
        if isinstance(answer, DrawingFailure) and not self.missing_library:
            warning = f"the picture {task.drawing.id} is drawn in a simpler way: {answer.message}"
            answer = worker.request_picture(replace(task, simple=True, warning=warning), self._timeout)
        if isinstance(answer, DrawingFailure):
            return Picture(task.drawing.id, 0, 0, warning=f"the picture {task.drawing.id} is missing: {answer.message}")
        return answer


class DrawingWorker:
    """One worker process, started when it is first needed or before, and again after it broke."""

    def __init__(self, command_line: CommandLine, environment: dict[str, str]) -> None:
        self._command_line, self._environment = command_line, environment
        self._process: subprocess.Popen[bytes] | None = None
        self._timed_out = self._greeted = False

    def request_picture(self, task: DrawingTask, timeout: float) -> Picture | DrawingFailure:
        """Have one picture drawn. Return a failure where the process died or took longer than `timeout` seconds."""
        self._timed_out = False
        # Killing the process is what ends a layout that takes too long: reading its answer then meets the end of the
        # pipe.
        alarm = threading.Timer(timeout, self._kill_late)
        alarm.start()
        try:
            return self._exchange_messages(task)
        except (EOFError, OSError):
            return DrawingFailure("layout", self._explain_end(self.stop_process(), timeout))
        finally:
            alarm.cancel()

    def _explain_end(self, exit_status: int | None, timeout: float) -> str:
        """Say why the process ended before it answered."""
        if self._timed_out:
            return f"it took longer than {timeout:g} s"
        if exit_status is not None and exit_status == -getattr(signal, "SIGXCPU", 0):
            return f"it took longer than {PROCESSOR_SECONDS} s of the processor"
        return "Graphviz broke down"

    def _exchange_messages(self, task: DrawingTask) -> Picture | DrawingFailure:
        process = self.start_process()
        if not self._greeted:
            hello = receive_message(process.stdout)  # type: ignore[arg-type]
            if isinstance(hello, DrawingFailure):
                return hello
            self._greeted = True
        send_message(process.stdin, task)  # type: ignore[arg-type]
        answer: Picture | DrawingFailure = receive_message(process.stdout)  # type: ignore[arg-type]
        return answer

    def start_process(self) -> subprocess.Popen[bytes]:
        """Start the process unless it runs. Does not wait until it can draw."""
        if self._process is None:
            pipe = subprocess.PIPE
            self._greeted = False
            self._process = subprocess.Popen(  # noqa: S603 - our own interpreter
                self._command_line, stdin=pipe, stdout=pipe, stderr=subprocess.DEVNULL, env=self._environment
            )
        return self._process

    def _kill_late(self) -> None:
        self._timed_out = True
        if self._process:
            self._process.kill()

    def stop_process(self) -> int | None:
        """End the process, and return its exit status, None where there was none. It can be started again."""
        process, self._process = self._process, None
        exit_status = None
        if process:
            process.kill()
            exit_status = process.wait()
            for pipe in (process.stdin, process.stdout):
                if pipe:
                    try:
                        pipe.close()
                    except OSError:  # what was still to be written has no reader any more
                        continue
        return exit_status
