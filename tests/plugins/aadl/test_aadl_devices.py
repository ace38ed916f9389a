"""What is no program goes out as a device of AADL, with the buses that it is on, and comes back as the same component."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
import yaml

from archgen.pipeline import check_project
from archgen.plugins.aadl.aadl_import import read_aadl
from archgen.plugins.aadl.views.aadl_component_types import is_device
from archgen.plugins.aadl.views.aadl_view import make_view
from archgen.views.generation.generation_context import GenerationContext
from tests.plugins.aadl.aadl_judge import judge_packages
from tests.plugins.aadl.aadl_texts import merge_slices
from tests.plugins.aadl.test_aadl import find_line, write_files

PROJECT = """\
archgen: 1
project: {id: lab}
ros: {distro: jazzy}
groups:
  sensing:
    tags: [eyes]
    components:
      laser:
        title: Laser scanner
        functionality: Measures.
        role: source
        tags: [device, fast]
        inputs: {light: {medium: physical, external: The walls}}
        outputs: {scan: {medium: usb, type: sensor_msgs/msg/LaserScan}}
        timing: {behaviour: periodic, period: 100 ms, wcet: 3 ms, bcet: 1 ms, jitter: 1 ms, deadline: 50 ms, priority: 3}
      camera: {outputs: {image: {type: sensor_msgs/msg/Image}}}
      driver:
        inputs: {scan: {from: [sensing.laser.scan], medium: usb}}
        outputs: {points: {type: sensor_msgs/msg/PointCloud2}, force: {medium: physical}}
        timing: {behaviour: event, wcet: 1 ms, bcet: 1 us}
        role: filter
      wheel:
        components:
          motor:
            inputs: {torque: {from: [self.torque], medium: physical}}
            outputs: {turn: {medium: physical}}
        inputs: {torque: {from: [sensing.driver.force], medium: physical}}
        outputs: {turn: {from: [motor.turn], medium: physical}}
      ground: {inputs: {turn: {from: [sensing.wheel.turn], medium: physical}}}
nodes:
  driver: {implements: sensing.driver, host: pc}
  camera_node: {implements: sensing.camera, host: pc}
hosts: {pc: {}, board: {}}
links:
  usb: {connects: [pc, sensing.laser, sensing.camera], bandwidth: 480 Mbit/s, latency: {best: 10 us, worst: 1 ms}}
  wires: {connects: [board, sensing.laser, sensing.wheel.motor]}
chains: {see: {through: [sensing.laser, sensing.driver], deadline: 200 ms}}
"""


def write_project(folder: Path, text: str = PROJECT) -> dict[str, str]:
    """Return the AADL files of a project, which are AADL."""
    (folder / "archgen.yaml").write_text(text, encoding="utf-8")
    project = check_project(folder)
    assert not project.has_errors, [each.message for each in project.findings]
    files = write_files(project, folder / "ws")
    judge_packages(files)
    return files


def test_devices_stand_where_their_components_do(tmp_path: Path) -> None:
    files = write_project(tmp_path)
    devices, system = files["aadl/lab_devices.aadl"], files["aadl/lab.aadl"]
    assert "laser: device lab_devices::laser;" in system
    assert find_line(devices, r"^\s+usb: ") == "usb: requires bus access lab_hosts::usb;"
    assert "laser_usb: bus access usb -> laser.usb;" in system
    assert "motor_wires: bus access wires -> motor.wires;" in system
    assert "applies to sensing.laser_scan_to_driver;" in system
    assert "see: end to end flow laser.scan_flow -> laser_scan_to_driver -> driver.scan_flow {" in system
    assert "Dispatch_Jitter" not in devices  # which AADL has for threads alone
    assert (
        "driver_force_to_wheel" not in system.partition("Actual_Connection_Binding")[2]
    )  # what is no ROS is bound to no topic
    nodes = files["aadl/lab_nodes.aadl"]
    assert "process camera_node extends" in nodes
    assert not any(f"process {name} " in nodes for name in ("laser", "motor", "ground"))


def test_devices_come_back_as_they_were(tmp_path: Path) -> None:
    write_project(tmp_path)
    imported = read_aadl(sorted((tmp_path / "ws" / "aadl").iterdir()))
    sections, project = merge_slices(imported), yaml.safe_load(PROJECT)
    assert imported.notes == ()
    for section in ("groups", "nodes", "chains", "hosts", "links"):
        assert sections[section] == project[section], section


@pytest.mark.parametrize(
    ("component", "expected"),
    [
        ("{outputs: {x: {medium: physical}}}", True),
        ("{outputs: {x: {medium: usb}}, tags: [device]}", True),
        ("{outputs: {x: {medium: usb}}}", False),
        ("{outputs: {x: {medium: physical}, y: std_msgs/msg/String}}", False),
        ("{functionality: Thinks.}", False),
    ],
)
def test_what_is_a_device(component: str, *, expected: bool, tmp_path: Path) -> None:
    (tmp_path / "archgen.yaml").write_text(f"archgen: 1\ngroups: {{g: {{components: {{a: {component}}}}}}}\n", "utf-8")
    architecture = check_project(tmp_path).architecture
    [node] = architecture.nodes.values()
    assert is_device(architecture, node, ()) is expected
    assert is_device(architecture, node, {"g.a"}) is True


def test_what_a_program_implements_is_none(tmp_path: Path) -> None:
    text = "archgen: 1\ngroups: {g: {components: {a: {outputs: {x: {medium: physical}}, tags: [device]}}}}\nnodes: {n: {implements: g.a}}\n"
    (tmp_path / "archgen.yaml").write_text(text, "utf-8")
    packages: list[dict[str, Any]] = make_view(GenerationContext(check_project(tmp_path).architecture)).data["packages"]
    categories = {each["category"] for package in packages for each in package["classifiers"]}
    assert "device" not in categories
