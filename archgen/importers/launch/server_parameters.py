"""Parameters of ROS 1 that stand outside of nodes: those below a node's name are the node's, the rest belongs to nobody."""

from __future__ import annotations

from typing import Any

from archgen.importers.launch.launch_run import LaunchRun
from archgen.importers.launch.launched_nodes import LaunchedNode
from archgen.importers.launch.node_making import merge_values

SIMULATED_TIME = "use_sim_time"


def give_server_parameters(run: LaunchRun, nodes: list[LaunchedNode]) -> dict[str, Any]:
    """Give nodes what stands below their names; return what is for all nodes, and note the rest."""
    names = {node.full_name: node for node in nodes if node.full_name}
    for_all: dict[str, Any] = {}
    for full_name, value, span in run.server_parameters:
        if full_name == f"/{SIMULATED_TIME}":
            for_all[SIMULATED_TIME] = value
            continue
        parts = full_name.strip("/").split("/")
        owner = next(
            (names[name] for end in range(len(parts), 0, -1) if (name := "/" + "/".join(parts[:end])) in names), None
        )
        if owner is None:
            message = f"`{full_name}` stands on the parameter server and below no node of the files"
            run.add_note("param", message, span, "give it to the nodes that read it")
            continue
        inner = parts[len(owner.full_name.strip("/").split("/")) :]
        for part in reversed(inner):
            value = {part: value}  # noqa: PLW2901 - wrapped from the inside
        given = value if isinstance(value, dict) else {}
        # What the node itself says counts more.
        own = dict(owner.parameters)
        owner.parameters.clear()
        merge_values(owner.parameters, given)
        merge_values(owner.parameters, own)
    return for_all
