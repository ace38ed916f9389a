"""Profiles of Fast DDS: which hosts have one, what its schema says of them, and that nodes of two networks meet by them alone."""

from __future__ import annotations

import contextlib
import os
import subprocess
import time
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path

import pytest

from archgen.bringup.dds_profiles import find_dds_profile, record_dds_profile
from archgen.bringup.start_plan import find_looking_variables, make_start_plan
from archgen.derivation.wire.running_state import list_peers
from archgen.model.architecture import Architecture
from tests.ros_environment import ROS_FOLDER, make_ros_python, ros_environment

Derived = Callable[[str], Architecture]

ROBOT = """
ros: {{distro: {distro}, discovery: peers, environment: {{{environment}}}}}
hosts: {{head: {{address: 10.0.0.1}}, base: {{address: 10.0.0.2}}, arm: {{address: arm.local}}, desk: {{address: 10.0.1.4}}, itself: {{address: 127.0.0.1}}, everywhere: {{address: 0.0.0.0}},
  six: {{address: 'fd00::1'}}}}
links: {{cable: [head, base, arm, six], radio: [base, desk]}}
"""


def test_what_runs_nothing_and_has_no_address_is_no_peer(derived: Derived) -> None:
    """With a name that cannot be resolved no node of Fast DDS starts."""
    architecture = derived(
        """
        ros: {distro: jazzy, discovery: peers}
        hosts: {head: {}, base: {}, motor_controller: {}, desk: {address: desk.local}}
        groups: {g: {components: {a: {outputs: {o: std_msgs/msg/Bool}}, b: {inputs: {o: a.o}}}}}
        nodes: {a: {implements: a, host: head}, b: {implements: b, host: base}}
        """
    )
    assert list_peers(architecture, "head") == ("base", "desk.local")


@pytest.mark.parametrize(
    ("distro", "environment", "host", "expected"),
    [
        ("jazzy", "", "head", ("FASTRTPS_DEFAULT_PROFILES_FILE", ("127.0.0.1", "10.0.0.1"), ())),
        ("kilted", "RMW_IMPLEMENTATION: rmw_fastrtps_cpp", "head", ("FASTDDS_DEFAULT_PROFILES_FILE", ("127.0.0.1", "10.0.0.1"), ())),
        ("humble", "", "head", ("FASTRTPS_DEFAULT_PROFILES_FILE", ("127.0.0.1", "10.0.0.1"), ("127.0.0.1", "10.0.0.2", "arm.local"))),
        # On two links, with one address; and a name, of which nobody knows the number.
        ("humble", "", "base", ("FASTRTPS_DEFAULT_PROFILES_FILE", (), ("127.0.0.1", "10.0.0.1", "arm.local", "10.0.1.4"))),
        ("jazzy", "", "base", None),
        ("jazzy", "", "arm", None),
        ("jazzy", "", "itself", None),
        ("jazzy", "", "everywhere", None),
        ("jazzy", "", None, None),
        ("jazzy", "RMW_IMPLEMENTATION: rmw_cyclonedds_cpp", "head", ("CYCLONEDDS_URI", ("127.0.0.1", "10.0.0.1"), ())),
        ("humble", "RMW_IMPLEMENTATION: rmw_cyclonedds_cpp", "head", ("CYCLONEDDS_URI", ("127.0.0.1", "10.0.0.1"), ("127.0.0.1", "10.0.0.2", "arm.local"))),
        ("jazzy", "RMW_IMPLEMENTATION: rmw_cyclonedds_cpp", "base", None),
        ("jazzy", "RMW_IMPLEMENTATION: rmw_zenoh_cpp", "head", None),
        ("jazzy", "CYCLONEDDS_URI: file:///etc/own.xml", "head", None),
        ("jazzy", "FASTRTPS_DEFAULT_PROFILES_FILE: /etc/own.xml", "head", None),
        ("jazzy", "ROS_DISCOVERY_SERVER: '10.0.0.1:11811'", "head", None),
        ("noetic", "", "head", None),
    ],
)  # fmt: skip
def test_who_has_a_profile(derived: Derived, distro: str, environment: str, host: str | None, expected: object) -> None:
    profile = find_dds_profile(derived(ROBOT.format(distro=distro, environment=environment)), host)
    assert (profile and (profile.variable, profile.interfaces, profile.peers)) == expected


CYCLONE_PROFILE = """\
<?xml version="1.0" encoding="UTF-8"?>
<!-- Which interface DDS uses, and whom it asks for others: from hosts, addresses and links. Made by archgen. -->
<CycloneDDS xmlns="https://cdds.io/config">
  <Domain Id="any">
    <General>
      <Interfaces>
        <NetworkInterface address="10.0.0.1"/>
      </Interfaces>
      <AllowMulticast>false</AllowMulticast>
    </General>
    <Discovery>
      <ParticipantIndex>auto</ParticipantIndex>
      <MaxAutoParticipantIndex>100</MaxAutoParticipantIndex>
      <Peers>
        <Peer Address="10.0.0.1"/>
        <Peer Address="127.0.0.1"/>
        <Peer Address="10.0.0.2"/>
        <Peer Address="arm.local"/>
      </Peers>
    </Discovery>
  </Domain>
</CycloneDDS>
"""
"""By hand it was held against the schemas of Cyclone DDS 0.9.1, 0.10.5 and 11.0, and its library read it."""


def test_cyclone_dds_is_told_in_its_own_words(derived: Derived) -> None:
    environment = "RMW_IMPLEMENTATION: rmw_cyclonedds_cpp"
    record = record_dds_profile(derived(ROBOT.format(distro="humble", environment=environment)), "head")
    assert record == {"variable": "CYCLONEDDS_URI", "scheme": "file://", "text": CYCLONE_PROFILE}


SERVED_ROBOT = """
ros: {distro: DISTRO, discovery: server}
hosts: {head: {address: 10.0.0.1, discovery_server: 11811}, base: {address: 10.0.0.2}, spare: {discovery_server: 11812}}
links: {cable: [head, base]}
groups: {g: {components: {a: {outputs: {o: std_msgs/msg/Bool}}, b: {inputs: {o: a.o}}}}}
nodes: {a: {implements: a, host: head}, b: {implements: b, host: base, start: {environment: {ROS_SUPER_CLIENT: "TRUE"}}}}
"""


def test_a_discovery_server_starts_first_and_every_node_asks_it(derived: Derived) -> None:
    plan = make_start_plan(derived(SERVED_ROBOT.replace("DISTRO", "jazzy")))
    assert [(step.id, step.phase, step.host, step.kind) for step in plan.steps] == [
        ("head_discovery_server", "network", "head", "program"),
        ("spare_discovery_server", "network", "spare", "program"),
        ("a", "components", "head", "node"),
        ("b", "components", "base", "node"),
    ]
    assert plan.steps[1].command == ("fastdds", "discovery", "-i", "1", "-p", "11812")
    servers = {"ROS_DISCOVERY_SERVER": "10.0.0.1:11811;spare:11812"}
    assert [step.environment for step in plan.steps[2:]] == [
        servers | {"ROS_SUPER_CLIENT": "FALSE"},
        servers | {"ROS_SUPER_CLIENT": "TRUE"},
    ]
    # What looks whether nodes are up is told of all of them.
    assert find_looking_variables(plan.steps[:3]) == servers | {"ROS_SUPER_CLIENT": "TRUE"}


@pytest.mark.parametrize("distro", ["humble", "noetic"])
def test_without_a_way_to_look_there_is_no_discovery_server(derived: Derived, distro: str) -> None:
    plan = make_start_plan(derived(SERVED_ROBOT.replace("DISTRO", distro)))
    assert [(step.id, "ROS_DISCOVERY_SERVER" in step.environment) for step in plan.steps] == [
        ("a", False),
        ("b", False),
    ]


def test_a_discovery_server_takes_no_name_of_a_node(derived: Derived) -> None:
    robot = SERVED_ROBOT.replace("DISTRO", "jazzy").replace("nodes: {a:", "nodes: {head_discovery_server:")
    names = [step.id for step in make_start_plan(derived(robot)).steps]
    assert names == ["head_discovery_server_", "spare_discovery_server", "head_discovery_server", "b"]


def _write_profile(derived: Derived, file: Path, distro: str, host: str) -> str:
    record = record_dds_profile(derived(ROBOT.format(distro=distro, environment="")), host)
    assert record
    file.write_text(record["text"])
    return record["text"]


@pytest.mark.ros
def test_profiles_are_what_fast_dds_reads(derived: Derived, tmp_path: Path) -> None:
    make_ros_python()
    etree = pytest.importorskip("lxml.etree")
    schema = etree.XMLSchema(etree.parse(str(ROS_FOLDER / "share" / "fastRTPS_profiles.xsd")))
    for distro, host in (("jazzy", "head"), ("humble", "head"), ("humble", "base")):
        _write_profile(derived, tmp_path / "profile.xml", distro, host)
        schema.assertValid(etree.parse(str(tmp_path / "profile.xml")))


LISTENER = """
import sys, time, rclpy
from std_msgs.msg import String
rclpy.init()
node = rclpy.create_node(sys.argv[1])
publisher, heard = node.create_publisher(String, "names", 10), set()
node.create_subscription(String, "names", lambda message: heard.add(message.data), 10)
end = time.monotonic() + float(sys.argv[2])
while time.monotonic() < end and len(heard) < 2:
    publisher.publish(String(data=sys.argv[1]))
    rclpy.spin_once(node, timeout_sec=0.1)
for _ in range(100):  # the other one may have come later
    publisher.publish(String(data=sys.argv[1]))
    time.sleep(0.1)
print(*sorted(heard))
"""


_IP = "/sbin/ip"


@contextlib.contextmanager
def two_computers() -> Iterator[tuple[str, str]]:
    """Yield the names of two network namespaces that a cable joins, which carries no multicast."""
    names = f"ag{os.getpid()}a", f"ag{os.getpid()}b"
    words = [
        *(f"netns add {name}" for name in names),
        f"link add eth netns {names[0]} type veth peer name eth netns {names[1]}",
        *(
            f"-n {name} {each}"
            for number, name in enumerate(names, start=1)
            for each in (
                f"addr add 10.0.0.{number}/24 dev eth",
                "link set lo up",
                "link set eth up multicast off",
                "route add blackhole 224.0.0.0/4",
            )
        ),
    ]
    try:
        for each in words:
            done = _run_ip(*each.split())
            if done.returncode:
                pytest.skip(f"no networks can be made here: {done.stderr}")
        # DDS looks once which interfaces run; a new one does so after a moment.
        for name in names:
            _wait_until_it_runs(name)
        yield names
    finally:
        for name in names:
            _run_ip("netns", "del", name)


def _wait_until_it_runs(network: str) -> None:
    end = time.monotonic() + 120
    while (
        "state UP" not in _run_ip("-n", network, "link", "show", "eth").stdout
        or "tentative" in _run_ip("-n", network, "addr").stdout
    ):
        assert time.monotonic() < end, network
        time.sleep(0.1)


def _run_ip(*words: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([_IP, *words], capture_output=True, text=True, check=False)  # noqa: S603 - of the system


@pytest.mark.ros
@pytest.mark.slow
def test_nodes_of_two_hosts_meet_by_their_profiles_alone(derived: Derived, tmp_path: Path) -> None:
    """They do not where a profile names another interface, or another peer."""
    if os.geteuid() or not Path(_IP).exists():
        pytest.skip("who is not root makes no networks")
    python = make_ros_python()
    (tmp_path / "listener.py").write_text(LISTENER)
    profiles = {
        host: _write_profile(derived, tmp_path / f"{host}.xml", "humble", host).replace(">arm.local<", ">10.0.0.9<")
        for host in ("head", "base")
    }
    with two_computers() as networks:
        for wanted, change in (
            ({"one two"}, {}),
            ({"one", "two"}, {"10.0.0.1</address>\n        </inter": "10.9.9.9</address>\n        </inter"}),
            ({"one", "two"}, {"10.0.0.1<": "10.0.0.9<", "10.0.0.2<": "10.0.0.9<"}),
        ):
            nodes = []
            for network, (host, text) in zip(networks, profiles.items(), strict=True):
                profile = tmp_path / f"{host}.xml"
                profile.write_text(_replace_all(text, change))
                environment = ros_environment(88, tmp_path) | {
                    "ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET",
                    "FASTRTPS_DEFAULT_PROFILES_FILE": str(profile),
                }
                name, seconds = "one" if host == "head" else "two", 8 if change else 60
                # Of two computers, they share no memory.
                words = f"mount -t tmpfs tmpfs /dev/shm && exec {python} {tmp_path}/listener.py {name} {seconds}"
                command = [_IP, "netns", "exec", network, "sh", "-c", words]
                nodes.append(subprocess.Popen(command, env=environment, stdout=subprocess.PIPE, text=True))  # noqa: S603 - our own
            assert {node.communicate(timeout=120)[0].strip().splitlines()[-1] for node in nodes} == wanted, change


def _replace_all(text: str, changes: Mapping[str, str]) -> str:
    for old, new in changes.items():
        text = text.replace(old, new)
    return text
