"""`archgen import ros2` and `archgen import ros1`: the nodes of a running robot, from what command-line tools print."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from pathlib import Path

from archgen.plugin.importing import ForeignFileError, ForeignImport, Span, make_id, title_from_id
from archgen.plugins.ros.running_graph.dump_lines import DumpLine, read_dump_lines
from archgen.plugins.ros.running_graph.graph_model import RunningGraph
from archgen.plugins.ros.running_graph.graph_slices import write_graph
from archgen.plugins.ros.running_graph.ros_1_dump import read_ros_1_dump
from archgen.plugins.ros.running_graph.ros_2_dump import read_ros_2_dump


def read_ros_2_graph(files: Sequence[Path]) -> ForeignImport:
    """Read dumps of ROS 2. Raise ForeignFileError."""
    return _read_graph(files, read_ros_2_dump, "`ros2 node info NAME` of each node")


def read_ros_1_graph(files: Sequence[Path]) -> ForeignImport:
    """Read dumps of ROS 1. Raise ForeignFileError."""
    return _read_graph(files, read_ros_1_dump, "`rosnode info NAME` of each node")


def _read_graph(
    files: Sequence[Path], read: Callable[[Iterable[DumpLine], RunningGraph], None], wanted_format: str
) -> ForeignImport:
    graph = RunningGraph()
    read(read_dump_lines(files), graph)
    slices = write_graph(graph)
    if not slices:
        words = "there is no node in it"
        raise ForeignFileError(
            words, Span.of_file(files[0].name if files else "."), f"give what these print: {wanted_format}"
        )
    taken = {word: count for word, count in sorted(graph.taken.items()) if count}
    title = title_from_id(make_id(files[0].stem, "robot"))
    return ForeignImport(slices, taken, tuple(graph.notes), title, graph.distro)
