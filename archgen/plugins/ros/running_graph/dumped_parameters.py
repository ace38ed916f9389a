"""Parameters that a dump holds as YAML."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from archgen.plugin.importing import MappingNode, node_to_data, parse_yaml
from archgen.plugin.ros import flatten_parameters
from archgen.plugins.ros.running_graph.dump_lines import DumpLine
from archgen.plugins.ros.running_graph.graph_model import RunningGraph

_OWN_PARAMETERS = ("qos_overrides", "start_type_description_service")
"""What every node of ROS 2 has, and nobody sets."""
_USUAL_TIME = ("use_sim_time", False)


def take_node_parameters(graph: RunningGraph, lines: Sequence[DumpLine]) -> None:
    """Read what `ros2 param dump` printed of one node: its name, and `ros__parameters` below it."""
    root = _parse_lines(graph, lines)
    for entry in root or ():
        values = entry.value.get("ros__parameters") if isinstance(entry.value, MappingNode) else None
        if not isinstance(values, MappingNode):
            continue
        node = graph.get_node(f"/{entry.key.strip('/')}", lines[0].span)
        for value in flatten_parameters(values):
            is_own = value.name.partition(".")[0] in _OWN_PARAMETERS or (value.name, value.value) == _USUAL_TIME
            if not is_own and value.value is not None:
                node.parameters[value.name] = value.value
                graph.taken["parameter"] += 1


def read_server_values(graph: RunningGraph, lines: Sequence[DumpLine]) -> dict[str, Any]:
    """Return what `rosparam dump` printed: the whole parameter server."""
    root = _parse_lines(graph, lines)
    data = node_to_data(root) if root is not None else {}
    return data if isinstance(data, dict) else {}


def _parse_lines(graph: RunningGraph, lines: Sequence[DumpLine]) -> MappingNode | None:
    first = lines[0].span
    document, problems = parse_yaml(first.file, "\n".join(line.text for line in lines) + "\n")
    if document is None:
        problem = problems[0].message if problems else "it is no mapping"
        graph.add_note("parameters", f"they cannot be read: {problem}", first)
    return document.root if document is not None else None
