"""What a project says of its deployment stands once, and comes out the same in launch files, scripts, units and compose."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
import yaml

from archgen.pipeline import check_project
from archgen.products.output_options import OutputOptions
from archgen.products.workspace_product import WorkspaceRequest, write_workspace
from tests.plugins.ros_code.launch.launch_reading import read_launch_file

ROBOT = """
archgen: 1
project: {id: rover, title: Rover, license: Apache-2.0}
ros: {distro: jazzy, discovery: peers, environment: {ROS_DOMAIN_ID: "7"}}
groups:
  eyes:
    components:
      camera: {outputs: {image: Image, still: Image}, node: {container: vision, language: cpp}}
      finder: {inputs: {image: camera.image}, outputs: {found: Found}, node: {container: vision, language: cpp}}
      keeper: {inputs: {still: camera.still}, node: {container: vision, language: cpp, subscribes: {still: {qos: {durability: transient_local}}}}}
      driver: {inputs: {found: finder.found}, node: {host: base, language: cpp}}
types: {Image: sensor_msgs/msg/Image, Found: std_msgs/msg/Bool}
containers: {vision: {host: head}}
hosts:
  head: {address: 10.0.0.2}
  base: {address: rover-base.local}
  desk: {environment: {ROS_STATIC_PEERS: own}}
links: {cable: {connects: [head, base]}, radio: {connects: [base, desk]}}
nodes: {screen: {host: desk, package: screen, executable: screen}}
"""


@pytest.fixture(scope="module")
def workspace(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("rover")
    (folder / "rover.yaml").write_text(ROBOT, encoding="utf-8")
    checked = check_project(folder / "rover.yaml")
    assert not checked.has_errors, checked.findings
    for backend in ("ros2_launch", "start", "ros2_cpp"):
        write_workspace(checked, OutputOptions(), backend, folder / "ws", WorkspaceRequest())
    return folder / "ws"


def _list_texts(workspace: Path, host: str) -> dict[str, str]:
    """Return what starts a host, by who reads it."""
    units = "\n".join(each.read_text() for each in sorted((workspace / "start" / "systemd" / host).glob("*.service")))
    return {
        "launch": (workspace / f"src/rover_bringup/launch/hosts/{host}.launch.xml").read_text(),
        "script": (workspace / f"start/hosts/{host}.sh").read_text(),
        "units": units,
        "compose": (workspace / f"start/compose/{host}.yaml").read_text(),
    }


@pytest.mark.parametrize(
    ("host", "peers"), [("head", "rover-base.local"), ("base", "10.0.0.2;desk"), ("desk", "own")], ids=str
)
def test_hosts_find_one_another_by_their_addresses(workspace: Path, host: str, peers: str) -> None:
    for reader, text in _list_texts(workspace, host).items():
        for name, value in {
            "ROS_STATIC_PEERS": peers,
            "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
            "ROS_DOMAIN_ID": "7",
        }.items():
            assert re.search(rf"{name}\W[^\n]{{0,12}}{re.escape(value)}\b", text), (reader, name, value)


def test_who_looks_for_a_node_is_in_its_network(workspace: Path) -> None:
    """What loads a node, changes its state or waits for it finds it only in the same domain, by the same peers."""
    names = ("ROS_AUTOMATIC_DISCOVERY_RANGE", "ROS_DOMAIN_ID", "ROS_STATIC_PEERS")
    texts = _list_texts(workspace, "head")
    # A launch file says it once, for all that it starts.
    profile = "FASTRTPS_DEFAULT_PROFILES_FILE"
    assert re.findall(r'<(?:set_)?env name="(\w+)"', texts["launch"]) == [*names, profile]
    assert re.findall(r"^export (\w+)=", texts["script"], re.MULTILINE) == [*names, profile]
    started = [line for line in texts["units"].splitlines() if line.startswith("ExecStart=")]
    assert len(started) == 4
    services = yaml.safe_load(texts["compose"])["services"].values()
    for name in names:
        assert all(name in line for line in started), name
        assert all(name in each["environment"] for each in services), name


def test_a_container_hands_on_without_a_copy_what_rclcpp_lets_it(workspace: Path) -> None:
    root = read_launch_file(workspace / "src/rover_bringup/launch/hosts/head.launch.xml", 2)
    shared = {
        each.get("name"): [extra.get("value") for extra in each.iter("extra_arg")]
        for each in root.iter("composable_node")
    }
    assert shared == {"camera": ["true"], "finder": ["true"], "keeper": []}
    for reader, text in _list_texts(workspace, "head").items():
        if reader != "launch":
            assert text.count("use_intra_process_comms:=true") == 2, reader


@pytest.mark.parametrize(
    ("host", "addresses"), [("head", ["127.0.0.1", "10.0.0.2"]), ("base", None), ("desk", None)], ids=str
)
def test_dds_uses_the_interface_of_the_only_link(workspace: Path, host: str, addresses: list[str] | None) -> None:
    """An address that is a number, of a host on one link, is that of its interface; others may have more of them."""
    paths = [workspace / f"start/dds/{host}.xml", workspace / f"src/rover_bringup/launch/hosts/{host}.dds.xml"]
    assert [each.exists() for each in paths] == [bool(addresses)] * 2
    for reader, text in _list_texts(workspace, host).items():
        assert text.count("FASTRTPS_DEFAULT_PROFILES_FILE") == (
            (addresses and {"launch": 1, "script": 5, "units": 4, "compose": 4}[reader]) or 0
        )
    for path in paths if addresses else ():
        assert re.findall("<address>(.*?)</address>", path.read_text()) == addresses


def test_a_license_stands_in_every_package(workspace: Path) -> None:
    licenses = {
        each.parent.name: re.findall("<license>(.*?)</license>", each.read_text())
        for each in workspace.glob("src/*/package.xml")
    }
    assert licenses == {"rover_bringup": ["Apache-2.0"], "rover_eyes": ["Apache-2.0"]}


def test_an_image_of_the_workspace_goes_with_compose(workspace: Path) -> None:
    lines = (workspace / "start/compose/Dockerfile").read_text().splitlines()
    assert "FROM ros:jazzy-ros-base" in lines
    service = next(iter(yaml.safe_load((workspace / "start/compose/head.yaml").read_text())["services"].values()))
    assert service["image"].startswith("${START_IMAGE:?")


def test_units_with_a_profile_wait_for_the_network_that_dds_looks_at_once(workspace: Path) -> None:
    units = {host: _list_texts(workspace, host)["units"] for host in ("head", "base")}
    assert "After=network-online.target" in units["head"]
    assert "After=network-online.target" not in units["base"]
