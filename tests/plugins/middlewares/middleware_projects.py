"""Projects that the backends of three middlewares are tried with, and compilers for what they write."""

from __future__ import annotations

from pathlib import Path

from archgen.diagnostics.diagnostic import Severity
from archgen.pipeline import CheckedProject, check_project
from archgen.products.output_options import OutputOptions
from archgen.products.workspace_product import WorkspaceRequest, write_workspace
from tests.outside_tools import find_tool, run_judge

STAND_INS = Path(__file__).parent / "middleware_stubs"
HEADLAMP = """\
archgen: 1
project: {id: headlamp, title: Assembly of a headlamp}
ros: {distro: jazzy}
types:
  Image: {fields: {width: {type: uint32}, height: {type: uint32}, pixels: {type: "uint8[]"}}}
  Position: {fields: {x: {type: float64, unit: m}, y: {type: float64, unit: m}, yaw: {type: float64, unit: rad}}}
  Force: geometry_msgs/msg/WrenchStamped
  Target: geometry_msgs/msg/PoseArray
  Grip: {message: headlamp_msgs/srv/Grip, request: {width: {type: float64}}, response: {held: {type: bool}}}
  Words: {}
hosts: {vision_pc: {}, robot_pc: {}}
component_types:
  guppy_80:
    functionality: Takes pictures.
    outputs: {image: Image}
    operations:
      get_image: {response: Image, visibility: protected}
      set_exposure: {request: {exposure: float64}, visibility: protected}
      calibrate: {visibility: private}
    parameters:
      exposure: {type: float, value: 0.02, unit: s, description: How long the shutter is open.}
      mode: {choices: [fast, careful], value: careful}
      hidden: {value: 3, visibility: protected}
    timing: {rate: 25 Hz}
  four_point:
    functionality: Finds the channel for the gum.
    inputs: {image: Image}
    outputs: {position: Position}
    operations:
      get_position: Position
      find_all: {request: {image: Image, least: int32, names: "string[]"}, response: {count: int32, best: Position}, call: synchronous}
    parameters: {threshold: 12, corners: [1, 2, 3, 4], gains: [0.5, 1.5], labels: [gum, lens], flags: [true, false], on: true, big: 5000000000}
groups:
  assembly:
    components:
      camera: {is: guppy_80, node: {host: vision_pc}}
      spare_camera: {is: guppy_80, parameters: {exposure: 0.01}, node: {host: vision_pc}}
      pos_sensor: {is: four_point, inputs: {image: camera.image}, node: {host: vision_pc}}
      force_sensor:
        functionality: Feels forces and torques.
        inputs: {}
        outputs: {force: Force, words: Words}
        operations: {set_zero: {}}
        timing: {period: 10 ms}
      controller:
        functionality: Moves the lens into the channel.
        inputs: {position: pos_sensor.position, force: force_sensor.force, words: force_sensor.words, grip: robot.grip, outside: {type: Force, external: The operator's hand}}
        outputs: {target: Target}
        parameters: {stiffness: {value: 100.0, range: [0, 500]}}
        timing: {rate: 100 Hz}
      robot:
        functionality: Moves the lens.
        inputs: {target: controller.target}
        outputs: {grip: Grip}
nodes:
  force_sensor: {implements: assembly.force_sensor, host: robot_pc}
  controller:
    implements: assembly.controller
    host: robot_pc
    subscribes: {position: {qos: {depth: 1}}, force: {qos: {depth: 5}}, words: {qos: {history: keep_all, durability: transient_local}}}
  robot: {implements: assembly.robot, host: robot_pc}
"""
"""The five components of the paper's case, and a spare one of a type, with one of each row of the tables."""
ODD = """\
archgen: 1
project: {id: class, title: '*/ "); } ??/ // \\'}
groups:
  auto:
    components:
      double:
        functionality: "a\\n*/ b ??/"
        inputs: {}
        outputs: {register: T, end: Object, start: T, new: T}
        operations: {stop: T, update: {request: {class: T, attribute: int32, local: bool}}, nil: {request: {a: int8, b: int8, c: int8, d: int8, e: "uint64[]"}}, repeat: {response: {union: string, raises: time}}}
        parameters: {template: 1, int: {type: float, value: .inf}, then: {type: float, value: -.inf}, until: {type: string}, false_: true}
      void:
        inputs: {register: double.register, delete: double.new, end: double.end, both: [double.end, double.start]}
        outputs: {delete: T, oneway: Object}
        parameters: {a: {b: 1, B: 2}, quoted: {value: ["*/", "??="]}, least: -9223372036854775808}
types:
  T: {fields: {switch: {type: float32}, signed: {type: uint16}, sequence: {type: "bool[3]"}, when: {type: time}}}
  Object: {fields: {object: {type: T}, t: {type: "T[]"}, text: {type: wstring}}}
"""
"""Names that are words of C++, IDL or Lua, and that differ by their case alone."""


def write_project(folder: Path, text: str) -> CheckedProject:
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "archgen.yaml").write_text(text, encoding="utf-8")
    return check_project(folder)


def generate(
    project: CheckedProject, workspace: Path, backend: str, request: WorkspaceRequest | None = None
) -> list[str]:
    """Generate into a workspace, and return what was left out."""
    result = write_workspace(project, OutputOptions(), backend, workspace, request or WorkspaceRequest())
    return [each.message for each in result.findings if each.severity is not Severity.NOTE]


def compile_cpp(files: list[Path], folders: list[Path], stand_ins: list[Path], unit: Path) -> str:
    """Return what a compiler says of files, which it takes as one, since headers are read once then."""
    unit.write_text("".join(f'#include "{each}"\n' for each in files), encoding="utf-8")
    command = ["-std=c++17", "-fsyntax-only", "-Wall", "-Wextra", "-Werror"]
    command += [f"-I{each}" for each in folders]
    command += [word for each in stand_ins for word in ("-isystem", str(each))]
    return run_judge(find_tool("g++"), *command, unit).stderr
