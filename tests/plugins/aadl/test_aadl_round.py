"""What is exported to AADL and imported again is the same packed file, less what docs/aadl.md lists as lost."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
import yaml

from archgen.pipeline import check_project
from archgen.products.output_options import OutputOptions
from archgen.products.workspace_product import write_workspace
from tests.judged_projects import judge_shipped
from tests.property_sizes import try_some
from tests.running import ROOT, archgen_here

PROJECT = """\
archgen: 1
project: {id: round_trip, title: Round trip, description: There and back, version: 1.2.0}
ros: {distro: jazzy}
types:
  Scan: {message: sensor_msgs/msg/LaserScan, comment: "What \\"it\\" sees: 100 %", size: 4 kB, version: 2.0.0, status: planned}
  scan: {message: sensor_msgs/msg/PointCloud2, size: 5 GB, frame: base_link, deprecated: {use: Scan}}
  Twist: {message: geometry_msgs/msg/Twist}
  State: {fields: {state: uint8}, constants: {OK: {type: uint8, value: 1}}}
  Reset: {message: std_srvs/srv/Trigger}
  Go: {message: nav2_msgs/action/NavigateToPose}
  Map: {fields: {name: string, end: "float64[3]", more: {type: "float32[]", unit: m, comment: Cells}}}
component_types:
  camera:
    functionality: Sees.
    version: 1.0.0
    inputs: {}
    outputs: {image: {type: sensor_msgs/msg/Image, version: 1.0.0}}
  sieve: {functionality: Sifts., generic: [T], inputs: {in: T}, outputs: {out: T}}
  ghost: {outputs: {image: sensor_msgs/msg/Image}}
groups:
  sensing:
    title: Eyes
    owner: lab
    components:
      lidar:
        title: The scanner
        functionality: Measures.
        role: source
        inputs: {}
        outputs: {scan: Scan}
        timing: {behaviour: periodic, period: 100 ms, wcet: 3 ms, bcet: 1 ms}
        requirements: [R-1]
        tags: [fast]
        parameters: {rate: 10.0}
        status: planned
        contact: me@lab.org
        urls: {manual: "https://lab.org"}
        operations: {clean: {}}
        hints:
          aadl:
            internal_state: {schema: lidar.schema.json}
            threads: {publisher: {functions: {function: {source_text: [lidar.h], source_name: measure}}}}
      camera: {is: camera}
      sieve: {is: sieve<scan>, inputs: {in: {from: sensing.clouds.scan}}}
      clouds: {role: source, inputs: {}, outputs: {scan: scan}}
  driving:
    description: Drives
    components:
      stop:
        role: filter
        inputs: {scan: {from: sensing.lidar.scan, freshness: 1 s, optional: true}}
        outputs: {twist: Twist}
        timing: {behaviour: event, wcet: 4 ms, bcet: 1 ms, response: 20 ms}
      base:
        role: sink
        inputs: {twist: {from: driving.stop.twist}}
        timing: {behaviour: event, deadline: 50 ms, wcet: 2 ms, bcet: 500 us, priority: 3}
      server: {role: reactive, inputs: {}, outputs: {reset: Reset, go: Go}}
      user: {inputs: {reset: {from: driving.server.reset}, go: {from: driving.server.go}}, outputs: {map: Map}}
      arm:
        components:
          motor: {inputs: {goal: {from: self.goal}}, outputs: {angle: Twist}}
        inputs: {goal: {from: driving.stop.twist}}
        outputs: {angle: {from: motor.angle}}
      watcher: {inputs: {angle: {from: driving.arm.angle}}, outputs: {}}
nodes:
  lidar_driver:
    implements: sensing.lidar
    host: pc
    package: urg
    executable: urg_node
    description: Reads it.
    tags: [own]
    status: planned
    name: urg
    arguments: [--fast]
    remaps: {/old: /new}
    scheduling: fifo
    publishes: {scan: {topic: /scan, own_name: /raw}}
  stop:
    implements: driving.stop
    host: pc
    subscribes: {scan: {qos: {reliability: best_effort, depth: 2}}}
    publishes: {twist: {topic: /cmd_vel}}
  base: {implements: driving.base, host: board, namespace: /wheels, threads: 2, language: cpp, start: {phase: core}}
  server: {implements: driving.server, container: process, serves: {reset: /reset, go: /go}}
containers: {process: {host: pc, threads: 2, package: box, executable: box, name: crate, namespace: /box}}
hosts: {pc: {scheduling: edf, tags: [fast]}, board: {}}
links: {lan: {connects: [pc, board], bandwidth: 100 Mbit/s, latency: {best: 100 us, worst: 2 ms}}}
chains: {react: {title: Stops, through: [sensing.lidar, driving.stop, driving.base], deadline: 200 ms}}
partners: {lab: Lab}
requirements: {R-1: It moves.}
use_cases: {UC-1: {title: Tidy up}}
views: {whole: {show: "*"}}
frames: {base_link: {}, arm_link: {parent: base_link}}
resources: {gpu: {host: pc}}
glossary: {cloud: Many points.}
properties: {mass: {unit: kg}}
variants: {small: {without: driving.watcher}}
"""
LOST = {
    "component types that are generic": ["/component_types/sieve", "/groups/sensing/components/sieve/is"],
    "without instances": ["/component_types/ghost"],
    "requirements": ["/requirements", "/groups/sensing/components/lidar/requirements"],
    "use cases": ["/use_cases"],
    "views": ["/views"],
    "properties": ["/properties"],
    "parameters": ["/groups/sensing/components/lidar/parameters"],
    "operations": ["/groups/sensing/components/lidar/operations"],
    "frames": ["/frames"],
    "variants": ["/variants"],
    "glossary": ["/glossary"],
    "start-up": ["/nodes/base/start"],
    "namespaces": ["/nodes/base/namespace"],
    "threads of nodes": ["/nodes/base/threads"],
    "languages": ["/nodes/base/language"],
    "quality of service but for the depth": ["/nodes/stop/subscribes/scan/qos/reliability"],
    "description and version of the project": ["/project/description", "/project/version"],
    "frames, sizes above 4 GiB, deprecations and constants of types": [
        *(f"/types/scan/{key}" for key in ("deprecated", "frame", "size")),
        "/types/State/constants",
    ],
    "versions of component types and ports": [
        "/component_types/camera/version",
        "/component_types/camera/outputs/image/version",
    ],
    "status, contact, addresses of components": [
        f"/groups/sensing/components/lidar/{key}" for key in ("contact", "status", "urls")
    ],
    "freshness": ["/groups/driving/components/stop/inputs/scan/freshness"],
    "whether an input is optional": ["/groups/driving/components/stop/inputs/scan/optional"],
    "`response`": ["/groups/driving/components/stop/timing/response"],
    "names, descriptions, tags, status, arguments, remappings, scheduling of nodes": [
        f"/nodes/lidar_driver/{key}"
        for key in ("arguments", "description", "name", "remaps", "scheduling", "status", "tags")
    ],
    "tags of hosts": ["/hosts/pc/tags"],
    "programs and names of containers": [
        f"/containers/process/{key}" for key in ("executable", "name", "namespace", "package")
    ],
    "resources": ["/resources"],
    "what partners are called": ["/partners/lab/title"],
    "that a component has no inputs or no outputs": [
        *("/groups/driving/components/server/inputs", "/groups/driving/components/watcher/outputs"),
        "/component_types/camera/inputs",
        *("/groups/sensing/components/clouds/inputs", "/groups/sensing/components/lidar/inputs"),
    ],
}
"""What of the project does not come back, by the words of the page."""
GAINED = {
    "a node for each component that is no device": [
        f"/nodes/{name}" for name in ("camera", "clouds", "motor", "sieve", "user", "watcher")
    ],
    "role and behaviour of the thread": [
        *(f"/groups/driving/components/arm/components/motor/{key}" for key in ("role", "timing")),
        *(f"/groups/driving/components/watcher/{key}" for key in ("role", "timing")),
        *(f"/groups/sensing/components/sieve/{key}" for key in ("role", "timing")),
    ],
    "types and media of the ports of composed components": ["/groups/driving/components/arm/outputs/angle/type"],
    "what instances have from types that are written out": [
        f"/groups/sensing/components/sieve/{key}" for key in ("functionality", "outputs")
    ],
}


def list_differences(old: Any, new: Any, path: str = "") -> list[tuple[str, str]]:  # noqa: ANN401 - what YAML holds
    """Return what is in one of two packed files alone, or differs, each with its path."""
    if not (isinstance(old, dict) and isinstance(new, dict)):
        return [] if old == new else [("differs", path)]
    found = [("lost", f"{path}/{key}") for key in old if key not in new]
    found += [("gained", f"{path}/{key}") for key in new if key not in old]
    for key in old:
        if key in new:
            found += list_differences(old[key], new[key], f"{path}/{key}")
    return found


def pack(folder: Path, to: Path) -> Any:  # noqa: ANN401 - what YAML holds
    archgen_here("pack", folder, "-o", to, cwd=folder)
    return yaml.safe_load(to.read_text(encoding="utf-8"))


@pytest.fixture(scope="module")
def differences(tmp_path_factory: pytest.TempPathFactory) -> list[tuple[str, str]]:
    folder = tmp_path_factory.mktemp("round")
    source, back = folder / "source", folder / "back"
    source.mkdir()
    (source / "archgen.yaml").write_text(PROJECT, encoding="utf-8")
    archgen_here("generate", "aadl", "-C", source, "-o", folder / "ws", cwd=folder)
    archgen_here("import", "aadl", *sorted((folder / "ws" / "aadl").iterdir()), "-o", back, cwd=folder)
    return list_differences(pack(source, folder / "source.yaml"), pack(back, folder / "back.yaml"))


@pytest.mark.parametrize(("fate", "table"), [("lost", LOST), ("gained", GAINED)])
def test_only_what_the_page_lists_differs(
    fate: str, table: dict[str, list[str]], differences: list[tuple[str, str]]
) -> None:
    assert sorted(path for each, path in differences if each == fate) == sorted(
        path for paths in table.values() for path in paths
    )
    page = (ROOT / "docs" / "aadl.md").read_text(encoding="utf-8")
    (line,) = [each for each in page.splitlines() if each.startswith(f"**{fate.capitalize()}:**")]
    assert [words for words in table if words not in line] == []


def test_nothing_comes_back_as_something_else(differences: list[tuple[str, str]]) -> None:
    assert [path for fate, path in differences if fate == "differs"] == []


@pytest.mark.parametrize(
    "example", try_some(["examples/arm", "examples/drone", "examples/first_robot", "example_ramcip"])
)
def test_examples_are_read_back(example: str, tmp_path: Path) -> None:
    project = judge_shipped(ROOT / example)
    write_workspace(project, OutputOptions(), "aadl", tmp_path / "ws")
    archgen_here("import", "aadl", *sorted((tmp_path / "ws" / "aadl").iterdir()), "-o", tmp_path / "back", cwd=tmp_path)
    again = check_project(tmp_path / "back")
    assert not again.has_errors, [each.message for each in again.findings if each.effective_severity == "error"]
    assert len(again.architecture.groups) >= len(project.architecture.groups)
    assert {node.id for node in project.architecture.nodes.values()} <= {
        node.id for node in again.architecture.nodes.values()
    }


def drop_classifiers(data: Any) -> Any:  # noqa: ANN401 - what YAML holds
    """Return a packed file without the names that AADL's classifiers had."""
    if isinstance(data, dict):
        kept = {key: drop_classifiers(value) for key, value in data.items() if key not in {"classifier", "name"}}
        return {key: value for key, value in kept.items() if value != {} or data[key] == {}}
    return data


def test_the_talker_of_the_paper_goes_back(tmp_path: Path) -> None:
    models = ROOT / "tests" / "plugins" / "aadl" / "models"
    files = [models / f"{name}.aadl" for name in ("chatter", "chat_msgs", "ros", "cnc", "topic_properties")]
    archgen_here("import", "aadl", *files, "-o", tmp_path / "talking", cwd=tmp_path)
    archgen_here("generate", "aadl", "-C", tmp_path / "talking", "-o", tmp_path / "ws", cwd=tmp_path)
    archgen_here("import", "aadl", *sorted((tmp_path / "ws" / "aadl").iterdir()), "-o", tmp_path / "back", cwd=tmp_path)
    first, again = (pack(tmp_path / name, tmp_path / f"{name}.yaml") for name in ("talking", "back"))
    assert "talk" in str(first)
    assert "talker.schema.json" in str(first)
    first["project"] = again["project"]  # called as its folder
    assert drop_classifiers(again) == drop_classifiers(first)
