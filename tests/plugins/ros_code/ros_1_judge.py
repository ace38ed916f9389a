"""Say what a graph of ROS 1 holds, from outside: run by the Python of ROS, with the names of the nodes to wait for.

It prints, as JSON, the nodes with what each publishes, subscribes to and serves, with types, and all parameters.
"""

from __future__ import annotations

import json
import sys
import time
from typing import Any

import rosgraph
import rosservice

WAITING_SECONDS = 120
USES = ("publishes", "subscribes", "serves")


def read_graph(master: rosgraph.Master) -> dict[str, dict[str, list[str]]]:
    """Return what each node has."""
    graph: dict[str, dict[str, list[str]]] = {}
    for use, entries in zip(USES, master.getSystemState(), strict=True):
        for name, nodes in entries:
            for node in nodes:
                graph.setdefault(node, {each: [] for each in USES})[use].append(name)
    return graph


def main() -> None:
    """Wait for all nodes, and until what they have changes no more; then print it."""
    wanted = set(sys.argv[1:])
    master = rosgraph.Master("/archgen_judge")
    end = time.monotonic() + WAITING_SECONDS
    last: dict[str, dict[str, list[str]]] = {}
    while time.monotonic() < end:
        time.sleep(1)
        try:
            graph = read_graph(master)
        except OSError:
            # The master is not there yet.
            continue
        if set(graph) >= wanted and graph == last:
            break
        last = graph
    types: dict[str, Any] = dict(master.getTopicTypes())
    for node in last.values():
        for service in node["serves"]:
            # The judge asks each node itself: the master does not know what a service is.
            types[service] = (
                None
                if service.endswith(("/get_loggers", "/set_logger_level"))
                else rosservice.get_service_type(service)
            )
    parameters = {name: master.getParam(name) for name in master.getParamNames()}
    sys.stdout.write(json.dumps({"graph": last, "types": types, "parameters": parameters}) + "\n")


main()
