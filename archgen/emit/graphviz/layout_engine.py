"""Call Graphviz, through pygraphviz. Only worker processes import this module: Graphviz can crash its process."""

from __future__ import annotations

import json
import re
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from pygraphviz import AGraph
from pygraphviz import graphviz as library

_GRAPHVIZ_CONTEXT = library.gvContextWithBuiltins()
_PDF_DATE = re.compile(rb"(/CreationDate \(D:)[^)]*\)")


class LayoutError(Exception):
    """Graphviz refused a graph, or lost a part of it."""


def lay_out_dot(dot: str, program: str = "dot") -> dict[str, Any]:
    """Lay out a DOT graph. Return Graphviz's json: `objects` (nodes, clusters) and `edges`, positions in points."""
    layout: dict[str, Any] = json.loads(render_dot(dot, ("json0",), program)[0])
    return layout


def render_dot(dot: str, formats: Sequence[str], program: str = "nop2") -> tuple[bytes, ...]:
    """Render a DOT graph in several formats. `nop2` keeps the positions that it has."""
    with _open_layout(dot, program) as graph:
        return tuple(_render_format(graph, form) for form in formats)


def render_to_file(dot: str, format_name: str) -> bytes:
    """Render a DOT graph in a format that Graphviz writes to files only: gd's, of plain pixels."""
    with _open_layout(dot, "nop2") as graph, tempfile.TemporaryFile() as file:
        # Graphviz writes through a stream of C's: what this file object holds back would be lost.
        failed = library.gvRender(_GRAPHVIZ_CONTEXT, graph.handle, format_name.encode(), file)
        data = b"" if failed else (file.seek(0), file.read())[1]
    if not data:
        raise LayoutError(f"no {format_name} came out")
    return data


@contextmanager
def _open_layout(dot: str, program: str) -> Iterator[AGraph]:
    """Yield a DOT graph that is laid out."""
    # Through the library's functions, not `AGraph.draw`: pygraphviz 2 ignores `args="-n2"` there and lays the graph out
    # anew, without an error. `nop2` as the program is what keeps positions and lines.
    graph = AGraph(string=dot)
    try:
        if library.gvLayout(_GRAPHVIZ_CONTEXT, graph.handle, program.encode()):
            raise LayoutError(f"{program} gave up")
        yield graph
        library.gvFreeLayout(_GRAPHVIZ_CONTEXT, graph.handle)
    finally:
        graph.close()


def _render_format(graph: AGraph, format_name: str) -> bytes:
    failed, data = library.gvRenderData(_GRAPHVIZ_CONTEXT, graph.handle, format_name.encode())
    if failed:
        raise LayoutError(f"no {format_name} came out")
    data = data if isinstance(data, bytes) else str(data).encode()
    return _PDF_DATE.sub(_blank_date, data) if format_name.startswith("pdf") else data


def _blank_date(match: re.Match[bytes]) -> bytes:
    """Overwrite the date in place: the file's offsets must not move, and two runs must give the same bytes."""
    digits = re.sub(rb"[0-9]", b"0", match[0][len(match[1]) :])
    return match[1] + digits.replace(b"00000000", b"20000101", 1)
