"""Draw in worker processes, several at once, each picture under a time limit.

A picture whose drawing crashes, fails or takes too long is drawn once more in a simpler way, and says so. If that fails
as well, the picture comes without any format. The other pictures are not affected.
"""

from __future__ import annotations

import os
import queue
import subprocess
import sys
import threading
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from archgen.emit.graphviz import fonts
from archgen.emit.graphviz.worker import Failure, Task, receive, send
from archgen.emit.picture import Picture
from archgen.views.bars import Chart

TIMEOUT = 30.0
"""Seconds that one drawing may take."""

Progress = Callable[[int, int], None]
Command = Sequence[str]


@dataclass(frozen=True, slots=True)
class Watch:
    """Callbacks for each picture as it is drawn: `on_progress(done, total)`, `on_drawn(task's index, picture)`.

    `on_drawn` is called in any thread, several at a time; `on_progress` under a lock, in order.
    """

    progress: Progress | None = None
    drawn: Callable[[int, Picture], None] = lambda _at, _picture: None


_START = "import sys; sys.path.append({root!r}); from archgen.emit.graphviz.worker import main; main()"
_PACKAGES = {
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


def explain(message: str) -> str:
    """Describe which package is missing, from the message of the ImportError."""
    package = next((package for library, package in _PACKAGES.items() if library in message), None)
    if package:
        everything = " ".join(dict.fromkeys(_PACKAGES.values()))
        return (
            f"pictures need the system package {package} (or what it is called here): {message}. "
            f"On Debian and Ubuntu: apt-get install {everything}"
        )
    return f"pictures need pygraphviz, which cannot be imported: {message}"


def command() -> Command:
    """Return the command line of a worker. `-P` keeps the current folder, which anybody may fill, out of its import
    path.
    """
    root = str(Path(__file__).resolve().parents[3])
    return (sys.executable, "-P", "-c", _START.format(root=root))


def draw(  # noqa: PLR0913 - what to draw, and how, each by its name
    tasks: Sequence[Task],
    folder: Path,
    *,
    workers: int,
    watch: Watch = Watch(),
    timeout: float = TIMEOUT,
    start: Command | None = None,
    ready: Sequence[Worker] = (),
) -> tuple[Picture, ...]:
    """Draw all tasks, the largest first. Return the pictures in the order of the tasks.

    Raise MissingGraphviz where no worker can draw. Workers in `ready_workers` are used and stopped; more are started as
    needed.
    """
    # Threads, since each only waits for its process; `ready` workers beyond the number of tasks are stopped by who made
    # them.
    count = max(1, min(workers, len(tasks)))
    processes = [*ready[:count], *(idle(folder, start) for _ in range(count - len(ready)))]
    run = _Run(tasks, watch, timeout)
    threads = [threading.Thread(target=run.work, args=(process,)) for process in processes]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    if run.missing:
        raise MissingGraphviz(explain(run.missing))
    return tuple(run.done[at] for at in range(len(tasks)))


def idle(folder: Path, start: Command | None = None) -> Worker:
    """Create a worker whose process is not started yet."""
    # In UTC: the date in a PDF, of which the digits are overwritten, is shorter there than elsewhere.
    environment = {**os.environ, "FONTCONFIG_FILE": str(fonts.configure(folder)), "TZ": "UTC0"}
    return Worker(start or command(), environment)


def _size(task: Task) -> int:
    """Estimate how long a drawing takes, by its boxes; charts have nothing to lay out."""
    return 0 if isinstance(task.graph, Chart) else len(task.graph.boxes)


class _Run:
    """What the threads share. Each has one worker process and takes the next task when its last one is done."""

    def __init__(self, tasks: Sequence[Task], watch: Watch, timeout: float) -> None:
        self.done: dict[int, Picture] = {}
        self.missing = ""
        self._watch, self._timeout = watch, timeout
        self._lock = threading.Lock()
        self._total = len(tasks)
        self._waiting: queue.SimpleQueue[tuple[int, Task]] = queue.SimpleQueue()
        # The largest first: started last, one large picture would keep all others waiting at the end.
        for at, task in sorted(enumerate(tasks), key=lambda each: -_size(each[1])):
            self._waiting.put((at, task))

    def work(self, process: Worker) -> None:
        """Draw waiting tasks until there are none, or nothing can be drawn at all. Then stop the worker."""
        try:
            while not self.missing:
                at, task = self._waiting.get_nowait()
                self._finish(at, self._drawn(process, task))
        except queue.Empty:
            pass
        finally:
            process.stop()

    def _finish(self, at: int, picture: Picture) -> None:
        self._watch.drawn(at, picture)
        with self._lock:
            self.done[at] = picture
            if self._watch.progress:
                self._watch.progress(len(self.done), self._total)

    def _drawn(self, process: Worker, task: Task) -> Picture:
        answer = process.ask(task, self._timeout)
        # No other worker will fare better: the run ends, and the caller makes everything else without pictures.
        if isinstance(answer, Failure) and answer.kind == "missing":
            self.missing = answer.message
        if isinstance(answer, Failure) and not self.missing:
            warning = f"the picture {task.graph.id} is drawn in a simpler way: {answer.message}"
            answer = process.ask(replace(task, simple=True, warning=warning), self._timeout)
        if isinstance(answer, Failure):
            return Picture(task.graph.id, 0, 0, warning=f"the picture {task.graph.id} is missing: {answer.message}")
        return answer


class Worker:
    """One worker process, started when it is first needed or before, and again after it broke."""

    def __init__(self, start: Command, environment: dict[str, str]) -> None:
        self._start, self._environment = start, environment
        self._process: subprocess.Popen[bytes] | None = None
        self._late = self._greeted = False

    def ask(self, task: Task, timeout: float) -> Picture | Failure:
        """Have one picture drawn. Return a failure where the process died or took longer than `timeout` seconds."""
        self._late = False
        # Killing the process is what ends a layout that takes too long: reading its answer then meets the end of the
        # pipe.
        alarm = threading.Timer(timeout, self._kill)
        alarm.start()
        try:
            return self._asked(task)
        except (EOFError, OSError):
            self.stop()
            return Failure("layout", f"it took longer than {timeout:g} s" if self._late else "Graphviz broke down")
        finally:
            alarm.cancel()

    def _asked(self, task: Task) -> Picture | Failure:
        process = self.begin()
        if not self._greeted:
            hello = receive(process.stdout)  # type: ignore[arg-type]
            if isinstance(hello, Failure):
                return hello
            self._greeted = True
        send(process.stdin, task)  # type: ignore[arg-type]
        answer: Picture | Failure = receive(process.stdout)  # type: ignore[arg-type]
        return answer

    def begin(self) -> subprocess.Popen[bytes]:
        """Start the process unless it runs. Does not wait until it can draw."""
        if self._process is None:
            pipe = subprocess.PIPE
            self._greeted = False
            self._process = subprocess.Popen(  # noqa: S603 - our own interpreter
                self._start, stdin=pipe, stdout=pipe, stderr=subprocess.DEVNULL, env=self._environment
            )
        return self._process

    def _kill(self) -> None:
        self._late = True
        if self._process:
            self._process.kill()

    def stop(self) -> None:
        """End the process. It can be started again."""
        process, self._process = self._process, None
        if process:
            process.kill()
            process.wait()
            for pipe in (process.stdin, process.stdout):
                if pipe:
                    try:
                        pipe.close()
                    except OSError:  # what was still to be written has no reader any more
                        continue
