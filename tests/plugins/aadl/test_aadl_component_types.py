"""A component type is one classifier; its instances say what differs, and come back as instances of it."""

from __future__ import annotations

from pathlib import Path

import yaml

from archgen.pipeline import check_project
from archgen.plugins.aadl.aadl_import import read_aadl
from archgen.plugins.aadl.views.aadl_component_types import find_type_of_node
from tests.plugins.aadl.aadl_texts import merge_slices
from tests.plugins.aadl.test_aadl_devices import write_project

PROJECT = """\
archgen: 1
project: {id: twins}
ros: {distro: jazzy}
component_types:
  camera:
    title: A camera
    functionality: Sees.
    description: With a lens.
    timing: {behaviour: periodic, period: 40 ms, wcet: 3 ms}
    role: source
    outputs: {image: {type: sensor_msgs/msg/Image, description: Colours}}
  stitcher:
    timing: {behaviour: event, wcet: 1 ms}
    inputs: {left: {type: sensor_msgs/msg/Image}, right: {type: sensor_msgs/msg/Image}}
    outputs: {image: {type: sensor_msgs/msg/Image}}
  lamp: {functionality: Lights., tags: [device], outputs: {light: {medium: physical}}}
groups:
  eyes:
    components:
      camera: {is: camera}
      right:
        is: camera
        title: The other one
        functionality: Sees more.
        timing: {wcet: 5 ms}
        outputs: {image: {frame: right_eye}}
      third: {is: camera, tags: [spare]}
      both: {is: stitcher, inputs: {left: {from: [eyes.camera.image]}, right: {from: [eyes.right.image]}}}
      lamp_1: {is: lamp}
      lamp_2: {is: lamp, title: Second}
nodes:
  driver: {implements: eyes.camera, package: cam, executable: cam, publishes: {image: {topic: /left}}, host: pc}
  right: {implements: eyes.right, package: cam, executable: cam2, host: board}
  third: {implements: eyes.third, host: pc}
  both: {implements: eyes.both, subscribes: {left: {qos: {depth: 3}}}, host: pc}
hosts: {pc: {scheduling: fixed_priority, cores: 1}, board: {scheduling: fixed_priority, cores: 1}}
links:
  usb: {connects: [pc, eyes.lamp_1]}
  lan: {connects: [pc, board], latency: {best: 1 ms, worst: 2 ms}}
frames: {right_eye: {}}
chains:
  see: {through: [eyes.camera, eyes.both], deadline: 200 ms}
  see_right: {through: [eyes.right, eyes.both], deadline: 200 ms}
"""


def test_types_and_instances_come_back_as_they_were(tmp_path: Path) -> None:
    files = write_project(tmp_path, PROJECT)
    nodes, devices = files["aadl/twins_nodes.aadl"], files["aadl/twins_devices.aadl"]
    assert [nodes.count(f"process {name} extends") for name in ("camera", "stitcher", "right", "third")] == [1, 1, 0, 0]
    assert devices.count("device lamp\n") == 1
    assert "right: process twins_nodes::camera.impl {" in files["aadl/twins.aadl"]
    imported = read_aadl(sorted((tmp_path / "ws" / "aadl").iterdir()))
    sections, project = merge_slices(imported), yaml.safe_load(PROJECT)
    assert imported.notes == ()
    for section in ("component_types", "groups", "nodes", "chains", "links"):
        assert sections[section] == project[section], section


def test_flows_of_all_instances_stand_in_the_type(tmp_path: Path) -> None:
    files = write_project(tmp_path, PROJECT)
    nodes, system = files["aadl/twins_nodes.aadl"], files["aadl/twins.aadl"]
    flows = {name for name in ("image_flow", "image_flow_2", "left_flow", "right_flow") if f"{name}: flow " in nodes}
    assert flows == {"image_flow", "image_flow_2", "left_flow", "right_flow"}
    assert "see: end to end flow camera.image_flow -> " in system
    assert "see_right: end to end flow right.image_flow_2 -> " in system
    assert "_flow;" not in system  # Ocarina takes no latency that applies to a flow of a part


def test_an_instance_with_another_thread_is_written_out(tmp_path: Path) -> None:
    text = PROJECT.replace("tags: [spare]}", "timing: {behaviour: event}}")
    files = write_project(tmp_path, text)
    assert "process third extends" in files["aadl/twins_nodes.aadl"]
    sections = merge_slices(read_aadl(sorted((tmp_path / "ws" / "aadl").iterdir())))
    components = sections["groups"]["eyes"]["components"]
    assert [components[name].get("is") for name in ("camera", "right", "third")] == ["camera", "camera", None]
    assert components["third"]["outputs"]["image"]["type"] == "sensor_msgs/msg/Image"


def test_generic_types_are_written_out(tmp_path: Path) -> None:
    (tmp_path / "archgen.yaml").write_text(
        "archgen: 1\ncomponent_types:\n  plain: {outputs: {x: std_msgs/msg/Bool}}\n"
        "  filter: {generic: [T], inputs: {in: {type: T}}}\n"
        "groups: {g: {components: {a: {is: plain}, b: {is: filter<std_msgs/msg/Bool>}, c: {outputs: {}}}}}\n",
        encoding="utf-8",
    )
    architecture = check_project(tmp_path).architecture
    found = {node.implements[0]: find_type_of_node(architecture, node) for node in architecture.nodes.values()}
    assert {name: declared and declared.id for name, declared in found.items()} == {
        "g.a": "plain",
        "g.b": None,
        "g.c": None,
    }
