"""Run generated nodes, all in one process: run by the Python of ROS, with a list of modules, classes and arguments on standard input.

It says `ready`, and ends with its input.
"""

from __future__ import annotations

import importlib
import json
import sys
import threading

import rclpy
from rclpy.executors import SingleThreadedExecutor


def main() -> None:
    """Start all nodes, and spin until nobody writes any more."""
    rclpy.init()
    executor = SingleThreadedExecutor()
    nodes = [
        getattr(importlib.import_module(each["module"]), each["class"])(
            cli_args=["--ros-args", *each["words"]], use_global_arguments=False
        )
        for each in json.loads(sys.stdin.readline())
    ]
    for node in nodes:
        executor.add_node(node)
    spinning = threading.Thread(target=executor.spin, daemon=True)
    spinning.start()
    sys.stdout.write("ready\n")
    sys.stdout.flush()
    sys.stdin.read()
    executor.shutdown()
    spinning.join()
    for node in nodes:
        node.destroy_node()
    rclpy.try_shutdown()


main()
