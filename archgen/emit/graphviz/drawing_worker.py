"""A worker process: reads graphs from its standard input, one after the other, and writes pictures to its output.

Messages are pickles with their length before them. Graphviz may write to the standard output or end the process: the
output is kept apart, and whoever waits at the other end sees the pipe close.
"""

from __future__ import annotations

import math
import os
import pickle
import struct
import sys
from typing import IO, Any

from archgen.cache.layout_memory import NO_MEMORY, LayoutMemory
from archgen.emit.picture import Picture
from archgen.frozen import dataclass
from archgen.views.picture_shapes import Drawing

_LENGTH_PREFIX = struct.Struct("<Q")
PROCESSOR_SECONDS = 30
"""Seconds of the processor that one drawing may take: what else the machine does must not decide what a picture looks like."""


@dataclass(frozen=True, slots=True)
class DrawingTask:
    """One graph to draw: the addresses of its links, the formats, and how.

    `simple` asks for the last resort, `warning` is passed on to the picture, `memory` knows layouts of earlier runs.
    """

    drawing: Drawing
    links: dict[str, str]
    formats: tuple[str, ...]
    simple: bool = False
    warning: str | None = None
    memory: LayoutMemory = NO_MEMORY


@dataclass(frozen=True, slots=True)
class DrawingFailure:
    """What went wrong. `kind` is `missing` if pygraphviz cannot be imported, `layout` if this graph cannot be drawn."""

    kind: str
    message: str


def send_message(stream: IO[bytes], message: object) -> None:
    """Write one message."""
    data = pickle.dumps(message, pickle.HIGHEST_PROTOCOL)
    stream.write(_LENGTH_PREFIX.pack(len(data)) + data)
    stream.flush()


def receive_message(stream: IO[bytes]) -> Any:  # noqa: ANN401 - whatever was sent
    """Read one message. Raise EOFError where the other end is gone."""
    head = stream.read(_LENGTH_PREFIX.size)
    if len(head) < _LENGTH_PREFIX.size:
        raise EOFError
    data = stream.read(_LENGTH_PREFIX.unpack(head)[0])
    return pickle.loads(data)  # noqa: S301 - from our own process, over a pipe


def main() -> None:
    """Draw tasks until the input ends. Called by name from the command line that `worker_command` makes."""
    # Messages go to a copy of the standard output, and descriptor 1 to nowhere: Graphviz's C code prints there.
    output = os.fdopen(os.dup(1), "wb")
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
    try:
        import archgen.emit.graphviz.graph_drawing  # noqa: F401 - to see whether it can be
    except ImportError as error:
        send_message(output, DrawingFailure("missing", str(error)))
        return
    send_message(output, "ready")
    while True:
        try:
            task = receive_message(sys.stdin.buffer)
        except EOFError:
            return
        send_message(output, _draw_task(task))


def _draw_task(task: DrawingTask) -> Picture | DrawingFailure:
    from archgen.emit.graphviz.graph_drawing import draw_picture

    _limit_processor_time()
    try:
        return draw_picture(
            task.drawing, task.links, task.formats, simple=task.simple, warning=task.warning, memory=task.memory
        )
    except Exception as error:  # noqa: BLE001 - whatever it is costs this picture, not the others
        return DrawingFailure("layout", f"{type(error).__name__}: {error}")


def _limit_processor_time() -> None:
    """Have the system end this process where the next drawing takes too long (not on Windows)."""
    try:
        import resource
    except ImportError:
        return
    usage = resource.getrusage(resource.RUSAGE_SELF)
    limit = math.ceil(usage.ru_utime + usage.ru_stime) + PROCESSOR_SECONDS
    _, hard_limit = resource.getrlimit(resource.RLIMIT_CPU)
    if hard_limit != resource.RLIM_INFINITY:
        limit = min(limit, hard_limit)
    resource.setrlimit(resource.RLIMIT_CPU, (limit, hard_limit))
