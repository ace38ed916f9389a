"""Say what a graph of ROS 2 holds, from outside: run by the Python of ROS, with the names of the nodes to wait for.

It prints a mapping of node to what it publishes, subscribes to, serves and calls, with types and quality of service.
"""

from __future__ import annotations

import json
import sys
import time

import rclpy
from rclpy.node import Node

WAITING_SECONDS = 60


def read_graph(judge: Node, full_names: list[str]) -> dict[str, dict[str, list[list[str]]]]:
    """Return what each node has, without what every node of ROS has."""
    readers = {
        "publishes": judge.get_publisher_names_and_types_by_node,
        "subscribes": judge.get_subscriber_names_and_types_by_node,
        "serves": judge.get_service_names_and_types_by_node,
        "calls": judge.get_client_names_and_types_by_node,
    }
    graph: dict[str, dict[str, list[list[str]]]] = {}
    for full_name in full_names:
        namespace, _, name = full_name.rpartition("/")
        graph[full_name] = {
            use: sorted([topic, *types] for topic, types in read(name, namespace or "/"))
            for use, read in readers.items()
        }
    return graph


def main() -> None:
    """Wait for all nodes, and until what they have changes no more; then print it."""
    full_names = sys.argv[1:]
    rclpy.init()
    judge = Node("archgen_judge", enable_rosout=False, start_parameter_services=False)
    end = time.monotonic() + WAITING_SECONDS
    last: dict[str, dict[str, list[list[str]]]] | None = None
    while time.monotonic() < end:
        time.sleep(1)
        nodes = {f"{namespace.rstrip('/')}/{name}" for name, namespace in judge.get_node_names_and_namespaces()}
        graph = read_graph(judge, full_names) if nodes >= set(full_names) else None
        if graph is not None and graph == last:
            break
        last = graph
    qualities = {
        topic: [
            [info.node_name, info.qos_profile.reliability.name, info.qos_profile.durability.name]
            for info in judge.get_publishers_info_by_topic(topic)
        ]
        for each in (last or {}).values()
        for topic, *_ in each["publishes"]
    }
    sys.stdout.write(json.dumps({"graph": last, "qualities": qualities}) + "\n")
    judge.destroy_node()
    rclpy.try_shutdown()


main()
