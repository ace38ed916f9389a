"""A small project of two partners, with a shared component and a node of the other partner, for tests of agreements."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from archgen import pipeline
from archgen.pipeline import CheckedProject
from archgen.products import project_views
from archgen.products.output_options import OutputOptions
from archgen.views.lookup import Lookup
from archgen.views.shapes import Block, Bullets, Facts, Inlines, Outline, Paragraph, Section, Table
from archgen.views.timing.timing_lookup import analyse_with_chains

DUO = """\
archgen: 1
project: {id: duo, title: Duo Arm, version: "0.3"}
ros: {distro: jazzy}
partners:
  north: {title: North Robotics, contact: ada@north.example, reviewers: "@duo/north"}
  south: {title: South Vision, reviewers: ["@duo/south", lee@south.example]}
  west: West Wheels
requirements: {R-1: The arm grasps what lies on the table}
groups:
  seeing:
    owner: south
    components:
      camera: {outputs: {image: Colour image, info: sensor_msgs/msg/CameraInfo}}
      finder:
        requirements: [R-1]
        inputs: {image: camera.image, planner: moving.planner.plan}
        outputs: {objects: Found objects}
  moving:
    owner: north
    components:
      arm: {inputs: {commands: planner.commands}, outputs: {joints: Joint states}}
      planner:
        requirements: [R-1]
        inputs: {objects: finder.objects, joints: arm.joints}
        outputs: {commands: Joint trajectory, plan: Plan on request}
      calibration: {owner: [north, south], inputs: {image: camera.image}, outputs: {offset: Camera offset}}
      watch: {owner: [north, south], inputs: {offset: calibration.offset}}
types:
  Colour image: {message: sensor_msgs/msg/Image, size: 900 kB}
  Found objects: {message: geometry_msgs/msg/PoseArray, size: 12 kB}
  Plan on request: example_interfaces/srv/Trigger
  Joint states: sensor_msgs/msg/JointState
  Joint trajectory: {message: std_msgs/msg/Float64, size: 80 B}
  Camera offset: geometry_msgs/msg/Transform
nodes:
  camera_driver: {implements: camera, timing: {rate: 30 Hz, wcet: 3 ms}, host: pc, publishes: {image: {topic: /image, qos: sensor_data}}}
  finder_node:
    implements: finder
    timing: {wcet: 20 ms, trigger: [image]}
    host: pc
    publishes: {objects: {topic: /objects, qos: {reliability: reliable}}}
    subscribes: {image: {qos: sensor_data}}
  planner_node: {implements: planner, timing: {wcet: 5 ms, trigger: [objects]}, host: pc}
  arm_node: {implements: arm, owner: west, timing: {rate: 100 Hz, wcet: 1 ms}, host: pc}
hosts: {pc: {cores: 4}}
chains: {see_and_move: {through: [camera, finder, planner], deadline: 300 ms, requirements: [R-1]}}
"""


def written(folder: Path, text: str = DUO) -> Path:
    """Write a project of one file."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "archgen.yaml").write_text(text, encoding="utf-8")
    return folder


def checked(folder: Path, text: str = DUO) -> CheckedProject:
    """Write a project and check it."""
    return pipeline.check_project(written(folder, text))


def view(of: CheckedProject) -> Lookup:
    """Make the look-ups, with timing."""
    return replace(project_views.make_scoped_lookup(of, OutputOptions()), timing=analyse_with_chains(of.architecture))


def text(inlines: Inlines) -> str:
    """Give the words of runs of text."""
    return "".join(("\n" if run.line_break else "") + run.text for run in inlines)


def section(outline: Outline, title: str) -> Section:
    """Find a section by its title, however deep."""
    waiting = list(outline.sections)
    while waiting:
        found = waiting.pop(0)
        if found.title == title:
            return found
        waiting += found.sections
    raise AssertionError(title)


def lines(blocks: tuple[Block, ...]) -> list[str]:
    """Write blocks as lines: tables cell by cell, facts as `name: value`."""
    said: list[str] = []
    for block in blocks:
        match block:
            case Paragraph():
                said.append(text(block.inlines))
            case Table():
                said += [" | ".join(text(cell) for cell in row) for row in block.rows]
            case Facts():
                said += [f"{name}: {text(value)}" for name, value in block.rows]
            case Bullets():
                said += [f"- {text(item)}" for item in block.items]
            case _:
                said.append(type(block).__name__)
    return said
