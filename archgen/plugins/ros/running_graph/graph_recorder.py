"""Record the graph of a running robot as text: `python3 recorder.py > graph.txt`, on any computer of its network.

Printed by `archgen conform --recorder`. It needs rclpy (ROS 2), or rosgraph and rosservice (ROS 1), of a shell in which the robot's
setup.bash was sourced, and nothing else. It reads and changes nothing, but asks each node for its parameters. What it prints has the
form of `ros2 node info` and its sisters: `archgen conform` holds it against a design, `archgen import ros2` makes one of it.
"""

from __future__ import annotations

import json
import socket
import sys
import time
from importlib.util import find_spec
from pathlib import Path
from typing import Any, Callable, Iterable, Iterator

NAME = "archgen_recorder"
QUIET_SECONDS, MOST_SECONDS, ANSWER_SECONDS = 2.0, 15.0, 5.0
"""The graph is complete when nothing changed for the first, or after the second; the third is for each answer of a node."""
LONGEST_TEXT = 10_000
Write = Callable[[str], None]
"""Writes a line."""


def main() -> int:
    """Record what runs."""
    if find_spec("rclpy") is None:
        return record_ros_1(print)
    return record_ros_2(print)


def record_ros_2(write: Write) -> int:
    """Wait until the graph is complete, and write it."""
    import rclpy

    rclpy.init()
    node = rclpy.create_node(NAME, start_parameter_services=False, enable_rosout=False)
    try:
        names = wait_for_nodes(node, time.monotonic, lambda: rclpy.spin_once(node, timeout_sec=0.2))
        if not names:
            print("no node was found: is ROS_DOMAIN_ID that of the robot?", file=sys.stderr)
            return 1
        write_graph(node, names, write)
        ask = NodeQuestions(
            node, lambda future: rclpy.spin_until_future_complete(node, future, timeout_sec=ANSWER_SECONDS)
        )
        for full_name in dict.fromkeys(names):
            write_parameters(full_name, ask.read_values(full_name), write)
            write_state(full_name, ask.read_state(full_name), write)
        write_host(socket.gethostname(), names, list_commands(Path("/proc")), write)
    finally:
        node.destroy_node()
        rclpy.shutdown()
    return 0


def list_nodes(node: Any) -> list[str]:
    """Return the full names of all nodes but this one, sorted; one that runs twice stands there twice."""
    pairs = node.get_node_names_and_namespaces()
    return sorted(f"{namespace.rstrip('/')}/{name}" for name, namespace in pairs if name != NAME)


def wait_for_nodes(node: Any, clock: Callable[[], float], spin: Callable[[], None]) -> list[str]:
    """Return the nodes once the graph is complete."""
    begin = changed = clock()
    known: object = None
    while clock() - begin < MOST_SECONDS and clock() - changed < QUIET_SECONDS:
        spin()
        names = list_nodes(node)
        now = {name: [(title, sorted(found)) for title, found in list_uses(node, name)] for name in names}
        # Discovery takes seconds on a busy computer. What a node uses arrives after its name: one that uses nothing is not known yet.
        is_part = not names or any(not any(found for _, found in uses) for uses in now.values())
        if is_part or (names, now) != known:
            known, changed = (names, now), clock()
    return list_nodes(node)


def write_graph(node: Any, names: list[str], write: Write) -> None:
    """Write the nodes with what they use, and the ends of topics with their quality of service."""
    write("$ ros2 node list")
    for full_name in names:
        write(full_name)
    for full_name in dict.fromkeys(names):
        write(f"$ ros2 node info {full_name}")
        write(full_name)
        for title, uses in list_uses(node, full_name, lambda line: print(line, file=sys.stderr)):
            write(f"  {title}:")
            for name, types in sorted(uses):
                write(f"    {name}: {', '.join(types)}")
    for topic, _ in sorted(node.get_topic_names_and_types()):
        write(f"$ ros2 topic info -v {topic}")
        for kind, ends in (
            ("PUBLISHER", node.get_publishers_info_by_topic(topic)),
            ("SUBSCRIPTION", node.get_subscriptions_info_by_topic(topic)),
        ):
            for end in ends:
                if end.node_name != NAME:
                    write_end(end, kind, write)


def list_uses(node: Any, full_name: str, tell: Write = lambda _: None) -> Iterator[tuple[str, Any]]:
    """Yield what a node uses, as `ros2 node info` groups it. What it no longer tells, since it ended, is empty."""
    import rclpy.action as actions

    namespace, _, name = full_name.rpartition("/")
    questions = (
        ("Subscribers", node.get_subscriber_names_and_types_by_node),
        ("Publishers", node.get_publisher_names_and_types_by_node),
        ("Service Servers", node.get_service_names_and_types_by_node),
        ("Service Clients", node.get_client_names_and_types_by_node),
        ("Action Servers", lambda *of: actions.get_action_server_names_and_types_by_node(node, *of)),
        ("Action Clients", lambda *of: actions.get_action_client_names_and_types_by_node(node, *of)),
    )
    for title, question in questions:
        try:
            found = question(name, namespace or "/")
        except Exception as error:
            tell(f"{full_name}: {error}")
            found = []
        yield title, found


def write_end(end: Any, kind: str, write: Write) -> None:
    """Write one end of a topic."""
    qos = end.qos_profile
    write(f"Node name: {end.node_name}")
    write(f"Node namespace: {end.node_namespace}")
    write(f"Topic type: {end.topic_type}")
    write(f"Endpoint type: {kind}")
    write("QoS profile:")
    write(f"  Reliability: {qos.reliability.name}")
    write(f"  Durability: {qos.durability.name}")
    write(f"  Lifespan: {qos.lifespan.nanoseconds} nanoseconds")
    write(f"  Deadline: {qos.deadline.nanoseconds} nanoseconds")
    write(f"  Liveliness: {qos.liveliness.name}")
    write(f"  Liveliness lease duration: {qos.liveliness_lease_duration.nanoseconds} nanoseconds")


class NodeQuestions:
    """Asks nodes for their parameters and states. `wait` waits for an answer, for as long as it may take."""

    def __init__(self, node: Any, wait: Callable[[Any], None]) -> None:
        """Take the node that asks."""
        self._node, self._wait = node, wait

    def read_values(self, full_name: str) -> dict[str, Any]:
        """Return the parameters of a node by name; none of one that does not answer."""
        from rcl_interfaces.srv import GetParameters, ListParameters

        listed = self._ask(f"{full_name}/list_parameters", ListParameters, ListParameters.Request())
        names = list(listed.result.names) if listed is not None else []
        answer = (
            self._ask(f"{full_name}/get_parameters", GetParameters, GetParameters.Request(names=names))
            if names
            else None
        )
        return {name: read_value(value) for name, value in zip(names, answer.values)} if answer is not None else {}

    def read_state(self, full_name: str) -> Any:
        """Return the state of a lifecycle node; None of another one."""
        is_managed = any(
            (name, "lifecycle_msgs/srv/GetState" in types) == (f"{full_name}/get_state", True)
            for title, uses in list_uses(self._node, full_name)
            if title == "Service Servers"
            for name, types in uses
        )
        if not is_managed or find_spec("lifecycle_msgs") is None:
            return None
        from lifecycle_msgs.srv import GetState  # type: ignore[import-not-found]

        answer = self._ask(f"{full_name}/get_state", GetState, GetState.Request())
        return answer.current_state if answer is not None else None

    def _ask(self, service: str, kind: Any, request: Any) -> Any:
        client = self._node.create_client(kind, service)
        try:
            if not client.wait_for_service(timeout_sec=ANSWER_SECONDS):
                return None
            future = client.call_async(request)
            self._wait(future)
            return future.result()
        finally:
            self._node.destroy_client(client)


def read_value(value: Any) -> Any:
    """Return the value of a parameter."""
    fields = (
        *("bool", "integer", "double", "string", "byte_array", "bool_array", "integer_array", "double_array"),
        "string_array",
    )
    if not 1 <= value.type <= len(fields):
        return None
    found = getattr(value, f"{fields[value.type - 1]}_value")
    if fields[value.type - 1] == "byte_array":
        return [int.from_bytes(each, "little") for each in found]
    return list(found) if fields[value.type - 1].endswith("array") else found


def write_parameters(full_name: str, values: dict[str, Any], write: Write) -> None:
    """Write parameters as `ros2 param dump` does. Texts that are very long are left out."""
    kept = {name: value for name, value in values.items() if value is not None and len(str(value)) <= LONGEST_TEXT}
    if not kept:
        return
    write(f"$ ros2 param dump {full_name}")
    write(f"{full_name}:")
    write("  ros__parameters:")
    for name, value in sorted(kept.items()):
        write(f"    {json.dumps(name)}: {write_plain(value)}")


def write_state(full_name: str, state: Any, write: Write) -> None:
    """Write the state of a lifecycle node as `ros2 lifecycle get` does."""
    if state is not None:
        write(f"$ ros2 lifecycle get {full_name}")
        write(f"{state.label} [{state.id}]")


def list_commands(processes: Path) -> Iterator[list[str]]:
    """Yield the words of the commands of this computer's processes."""
    for file in sorted(processes.glob("[0-9]*/cmdline")):
        try:
            yield file.read_bytes().decode("utf-8", "replace").split("\0")
        except OSError:  # ended, or somebody else's
            continue


def write_host(host: str, names: list[str], commands: Iterable[list[str]], write: Write) -> None:
    """Write the nodes that run on this computer, as far as launch files gave them their names."""
    own = set()
    for words in commands:
        named = {key: value for key, _, value in (word.partition(":=") for word in words) if key in {"__node", "__ns"}}
        if "__node" in named:
            own.add(f"{named.get('__ns', '').rstrip('/')}/{named['__node']}")
    if own.intersection(names):
        write(f"$ archgen host {host}")
        for name in sorted(own.intersection(names)):
            write(name)


def write_plain(value: Any) -> str:
    """Return a value as YAML."""
    return json.dumps(value).replace("-Infinity", "-.inf").replace("Infinity", ".inf").replace("NaN", ".nan")


def record_ros_1(write: Write) -> int:
    """Write what the master of ROS 1 knows."""
    try:
        import rosgraph
        import rosservice
    except ImportError:
        print("neither rclpy nor rosgraph is there: source the setup.bash of the robot's ROS first", file=sys.stderr)
        return 1
    master = rosgraph.Master(f"/{NAME}")
    write_master(master.getSystemState(), dict(master.getTopicTypes()), rosservice.get_service_type, write)
    write("$ rosparam dump")
    for line in json.dumps(leave_out_long(master.getParam("/")), indent=1).splitlines():
        write(line)
    return 0


def write_master(state: Any, types: dict[str, str], ask_type: Callable[[str], Any], write: Write) -> None:
    """Write nodes with what they publish, subscribe and serve, as `rosnode info` does, and the types of services."""
    titles = ("Publications", "Subscriptions", "Services")
    by_node: dict[str, dict[str, list[str]]] = {}
    for title, entries in zip(titles, state):
        for name, nodes in entries:
            for node in nodes:
                by_node.setdefault(node, {each: [] for each in titles})[title].append(name)
    for node, uses in sorted(by_node.items()):
        write(f"Node [{node}]")
        for title in titles:
            write(f"{title}:")
            for name in sorted(uses[title]):
                write(f" * {name}" if title == "Services" else f" * {name} [{types.get(name, 'unknown type')}]")
    for name, _ in sorted(state[2]):
        service_type = ask_type(name)
        if service_type:
            write(f"$ rosservice info {name}")
            write(f"Type: {service_type}")


def leave_out_long(values: Any) -> Any:
    """Return parameters without texts that are very long, such as the description of a robot."""
    if isinstance(values, dict):
        return {
            key: leave_out_long(each)
            for key, each in values.items()
            if len(str(each)) <= LONGEST_TEXT or isinstance(each, dict)
        }
    return values


if __name__ == "__main__":
    sys.exit(main())
