"""Domains, overrides, clocks and queues as real nodes of rclpy have them: archgen says the same."""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import pytest

from archgen.derivation.wire.running_state import domain_of, read_domain
from archgen.model.architecture import Architecture
from archgen.model.node import Endpoint
from tests.outside_tools import run_judge
from tests.ros_environment import NEWEST_PYTHON, make_ros_python, ros_environment

pytestmark = [
    pytest.mark.ros,
    pytest.mark.skipif(
        sys.version_info[:2] > NEWEST_PYTHON or sys.platform != "linux",
        reason="there are wheels of ROS for Linux, and not yet for this Python",
    ),
]
Derived = Callable[[str], Architecture]
_START = """
import json
import sys
import time

import rclpy
from rclpy.parameter import Parameter
from rclpy.qos import QoSDurabilityPolicy, QoSProfile
from rclpy.qos_overriding_options import QoSOverridingOptions, QoSPolicyKind
from std_msgs.msg import String

words = json.loads(sys.argv[1])
rclpy.init(args=words)


def spin(node, seconds):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        rclpy.spin_once(node, timeout_sec=0.02)


def wait_until(node, condition):
    end = time.monotonic() + 120
    while not condition() and time.monotonic() < end:
        rclpy.spin_once(node, timeout_sec=0.02)
    return condition()
"""
_DOMAIN = "print(json.dumps(rclpy.get_default_context().get_domain_id()))"
_QOS = """
node = rclpy.create_node("n", namespace="/a")
every_policy = [each for each in QoSPolicyKind if each not in (QoSPolicyKind.INVALID, QoSPolicyKind.LIFESPAN)]
options = {"none": None, "default": QoSOverridingOptions.with_default_policies(), "all": QoSOverridingOptions(every_policy)}
publisher = node.create_publisher(String, "x", 10, qos_overriding_options=options[sys.argv[2]])
told = node.get_publishers_info_by_topic(publisher.topic_name)[0].qos_profile
declared = [name for name in node._parameters if name.startswith("qos_overrides")]
print(json.dumps({
    "topic": publisher.topic_name, "depth": publisher.qos_profile.depth if hasattr(publisher, "qos_profile") else None,
    "reliability": told.reliability.name.lower(), "durability": told.durability.name.lower(), "declared": declared,
}))
"""
_CLOCK = """
node = rclpy.create_node("n", namespace="/a")
fired = []
node.create_timer(0.05, lambda: fired.append(1))
spin(node, 1.0)
subscribed = [name for name, _ in node.get_subscriber_names_and_types_by_node("n", "/a")]
print(json.dumps({"fired": bool(fired), "now": node.get_clock().now().nanoseconds, "clock": "/clock" in subscribed}))
"""
_QUEUE = """
depth, latched = int(sys.argv[2]), sys.argv[3] == "latched"
durability = QoSDurabilityPolicy.TRANSIENT_LOCAL if latched else QoSDurabilityPolicy.VOLATILE
sender, reader = rclpy.create_node("sender"), rclpy.create_node("reader")
a, b = (sender.create_publisher(String, "x", QoSProfile(depth=10, durability=durability)) for _ in range(2))
got = []


def read():
    return reader.create_subscription(String, "x", lambda m: got.append(m.data), QoSProfile(depth=depth, durability=durability))


if not latched:
    subscription = read()
    wait_until(sender, lambda: a.get_subscription_count() and b.get_subscription_count())
b.publish(String(data="b1"))
for number in (1, 2, 3):
    a.publish(String(data=f"a{number}"))
    time.sleep(0.05)
time.sleep(1)
if latched:
    subscription = read()
    wait_until(sender, lambda: a.get_subscription_count() and b.get_subscription_count())
    time.sleep(1)
spin(reader, 1.0)
print(json.dumps(got))
"""


@pytest.fixture
def ask(tmp_path: Path) -> Callable[..., Any]:
    """Run a program of rclpy with the words of its command line, and return what it prints; None where it ends early."""
    python = make_ros_python()

    def run(program: str, words: list[str], *more: str, environment: Mapping[str, str] | None = None) -> Any:  # noqa: ANN401
        variables = ros_environment(71, tmp_path) | dict(environment or {})
        command = (str(python), "-c", _START + program, json.dumps(words), *more)
        done = run_judge(*command, env=variables, statuses=(0, 1))
        return json.loads(done.stdout.strip().splitlines()[-1]) if done.returncode == 0 else None

    return run


@pytest.mark.parametrize(
    "text",
    ["", "0", "42", " 42", "42 ", "+7", "1.5", "42abc", "-1", "010", "0x1F", "08", "0.5", "0x", " ", "abc", str(2**64)],
)
def test_a_domain_is_read_as_rcl_reads_it(ask: Callable[..., Any], text: str) -> None:
    # What is unset or -1 is the usual one.
    assert ask(_DOMAIN, [], environment={"ROS_DOMAIN_ID": text}) == read_domain(text)


@pytest.mark.parametrize("options", ["none", "default", "all"])
@pytest.mark.parametrize("topic", ["/y", "/a/x", "x"])
def test_overrides_of_the_name_on_the_wire_count_as_far_as_the_program_takes_them(
    ask: Callable[..., Any], derived: Derived, options: str, topic: str
) -> None:
    overrides = {"reliability": "best_effort", "durability": "transient_local", "depth": 3}
    given = [
        word for name, value in overrides.items() for word in ("-p", f"qos_overrides.{topic}.publisher.{name}:={value}")
    ]
    told = ask(_QOS, ["--ros-args", "-r", "x:=/y", *given], options)
    declared = ", ".join(
        f"{name}: {{type: {'integer' if name.endswith('depth') else 'string'}}}" for name in told["declared"]
    )
    written = ", ".join(f"{name}: {value}" for name, value in overrides.items())
    architecture = derived(
        f"groups: {{g: {{components: {{a: {{parameters: {{{declared}}}, outputs: {{o: std_msgs/msg/String}}}}}}}}}}\n"
        f"nodes: {{a: {{implements: a, status: existing, publishes: {{o: /y}}, "
        f"parameters: {{qos_overrides: {{{topic}: {{publisher: {{{written}}}}}}}}}}}}}"
    )
    endpoint = architecture.endpoints[0]
    assert told["topic"] == endpoint.name
    expected = {("none", "/y"): "unknown", ("default", "/y"): "obeyed", ("all", "/y"): "obeyed"}
    assert endpoint.qos_override == expected.get((options, topic))
    # Of a program that declares nothing archgen holds both for possible; this one takes none.
    qos = endpoint.qos_if_ignored or endpoint.qos
    assert (told["reliability"], told["durability"]) == (qos.reliability, qos.durability)


@pytest.mark.parametrize(
    "override",
    [
        "publisher.depth:=-1",
        "publisher.reliability:=often",
        "publisher.depth:=many",
        "publisher.depth:=0",
        "publisher.durability:=volatile",
    ],
)
def test_a_value_that_archgen_calls_wrong_ends_the_node(
    ask: Callable[..., Any], derived: Derived, override: str
) -> None:
    from archgen.derivation.wire.qos_overrides import list_overrides, read_policy

    name, _, value = override.partition(":=")
    architecture = derived(f"nodes: {{n: {{parameters: {{qos_overrides./a/x.{name}: {value}}}}}}}")
    (found,) = list_overrides(architecture, architecture.nodes["n"])
    told = ask(_QOS, ["--ros-args", "-p", f"qos_overrides./a/x.{override}"], "all")
    assert (told is None) == (read_policy(found.policy, found.value) is None)


@pytest.mark.parametrize(
    ("words", "clock"),
    [
        ([], "system"),
        (["use_sim_time:=true"], "simulated"),
        (["use_sim_time:=yes"], "simulated"),
        (["n:use_sim_time:=true"], "system"),
        (["/a/n:use_sim_time:=true"], None),
        (["a/n:use_sim_time:=true"], None),
        (["/**:use_sim_time:=true"], None),
        (["use_sim_time:=true", "use_sim_time:=false"], "system"),
        (['use_sim_time:="true"'], None),
    ],
)
def test_simulated_time_without_a_clock_stands_still(
    ask: Callable[..., Any], derived: Derived, words: list[str], clock: str | None
) -> None:
    arguments = ["--ros-args", *(each for word in words for each in ("-p", word))]
    told = ask(_CLOCK, arguments)
    architecture = derived(
        f"groups: {{g: {{components: {{a: {{outputs: {{o: std_msgs/msg/String}}}}}}}}}}\n"
        f"nodes: {{n: {{implements: a, namespace: /a, arguments: {json.dumps(arguments)}}}}}"
    )
    assert architecture.endpoints[0].clock == clock
    if clock is None:
        assert told is None  # the node ends at once
    else:
        is_simulated = clock == "simulated"
        assert (told["clock"], told["fired"], told["now"] == 0) == (is_simulated, not is_simulated, is_simulated)


@pytest.mark.parametrize(
    ("depth", "kind", "got"),
    [
        (1, "live", ["a3"]),
        (3, "live", ["a1", "a2", "a3"]),
        (4, "live", ["a1", "a2", "a3", "b1"]),
        (1, "latched", ["a3"]),
        (3, "latched", ["a1", "a2", "a3"]),
    ],
)
def test_a_subscription_has_one_queue_for_all_publishers(
    ask: Callable[..., Any], depth: int, kind: str, got: list[str]
) -> None:
    """This is what `shared-memory` says: a depth of 3 holds three messages of both, not three of each."""
    assert sorted(ask(_QUEUE, [], str(depth), kind)) == got


def test_ends_in_two_domains_do_not_meet(ask: Callable[..., Any]) -> None:
    first, second = (str((72 + shift + os.getpid()) % 102) for shift in (0, 1))
    program = """
import subprocess
import os
other = subprocess.Popen([sys.executable, "-c", sys.argv[2]], env={**os.environ, "ROS_DOMAIN_ID": sys.argv[3]})
node = rclpy.create_node("n")
publisher = node.create_publisher(String, "x", 10)
met = wait_until(node, publisher.get_subscription_count) if sys.argv[4] == "meets" else (spin(node, 5), publisher.get_subscription_count())[1]
# Killed: a node that is asked to end may miss it, and spin for ever.
other.kill()
other.wait()
print(json.dumps(bool(met)))
"""
    reader = "import rclpy; from std_msgs.msg import String; rclpy.init(); n = rclpy.create_node('r'); n.create_subscription(String, 'x', print, 10); rclpy.spin(n)"
    environment = {"ROS_DOMAIN_ID": first}
    assert ask(program, [], reader, first, "meets", environment=environment)
    assert not ask(program, [], reader, second, "misses", environment=environment)
    ends = [Endpoint("n", "publishes", "/x", "topic", None, None, domain=domain) for domain in (1, 2)]
    assert domain_of(ends[0]) != domain_of(ends[1])


_LIFECYCLE = """
from rclpy.lifecycle import LifecycleNode, TransitionCallbackReturn


class Managed(LifecycleNode):
    def on_configure(self, state):
        self.managed = self.create_lifecycle_publisher(String, "managed", 10)
        return TransitionCallbackReturn.SUCCESS


node, reader, got = Managed("n"), rclpy.create_node("reader"), []
plain = node.create_publisher(String, "plain", 10)
for name in ("managed", "plain"):
    reader.create_subscription(String, name, lambda message: got.append(message.data), 10)
told = []
for transition in (lambda: None, node.trigger_configure, node.trigger_activate):
    transition()
    names = {name for name, _ in node.get_publisher_names_and_types_by_node("n", "/")}
    wait_until(reader, lambda: all(p.get_subscription_count() for p in ([plain, node.managed] if hasattr(node, "managed") else [plain])))
    got.clear()
    plain.publish(String(data="plain"))
    if hasattr(node, "managed"):
        node.managed.publish(String(data="managed"))
    spin(reader, 1.0)
    told.append(["/managed" in names, sorted(got)])
print(json.dumps(told))
"""


def test_managed_publishers_are_silent_until_active_and_plain_ones_are_not(
    ask: Callable[..., Any], derived: Derived
) -> None:
    """A generated node makes managed ones as it is configured; of another one in Python it is not known which it has."""
    assert ask(_LIFECYCLE, []) == [[False, ["plain"]], [True, ["plain"]], [True, ["managed", "plain"]]]
    robot = (
        "groups: {g: {components: {a: {outputs: {o: std_msgs/msg/String}}}}}\n"
        "nodes: {n: {implements: a, kind: lifecycle, language: python, start: {state: %s}, status: %s}}"
    )
    states = {
        (state, status): derived(robot % (state, status)).endpoints[0].runs
        for state in ("unconfigured", "inactive", "active")
        for status in ("~", "existing")
    }
    assert states == {
        ("unconfigured", "~"): "inactive",
        ("inactive", "~"): "inactive",
        ("active", "~"): "active",
        ("unconfigured", "existing"): None,
        ("inactive", "existing"): None,
        ("active", "existing"): "active",
    }
