"""What `archgen generate ros2_launch` and `ros1_launch` write comes back as the same nodes."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from archgen.pipeline import CheckedProject, check_project
from archgen.plugins.ros.launch.launch_import import read_launch
from archgen.syntax.yaml_writer import write_yaml
from tests.judged_projects import judge_shipped
from tests.plugins.ros_code.launch.launch_reading import make_launch_workspace
from tests.plugins.ros_code.launch.test_launch_files import write_simple
from tests.property_sizes import try_some
from tests.running import RAMCIP, ROOT

EXAMPLES = {
    "courier": ROOT / "examples" / "bringup",
    "arm": ROOT / "examples" / "arm",
    "drone": ROOT / "examples" / "drone",
    "first": ROOT / "examples" / "first_robot",
    "ramcip": RAMCIP,
    "vehicle": ROOT / "examples" / "vehicle" / "scenario",
}


def bring_back(launch_file: Path, folder: Path, distro: str) -> CheckedProject:
    """Import a launch file into a new project."""
    imported = read_launch([launch_file])
    folder.mkdir()
    (folder / "archgen.yaml").write_text(f"archgen: 1\nproject: {{id: back}}\nros: {{distro: {distro}}}\n")
    for name, sections in imported.slices.items():
        (folder / name).write_text(write_yaml(sections, imported.comments.get(name)), encoding="utf-8")
    return check_project(folder)


def list_nodes(checked: CheckedProject, *, with_values: bool) -> dict[str, dict[str, Any]]:
    """Return what a launch file says of each node with a package, by its full name."""
    architecture = checked.architecture
    nodes: dict[str, dict[str, Any]] = {}
    for node in architecture.nodes.values():
        if node.package is None or not (node.executable or node.plugin):
            continue
        container = architecture.containers[node.container] if node.container else None
        start = node.start
        nodes[node.full_name] = {
            "program": (node.package, None if node.plugin else node.executable, node.plugin),
            "arguments": node.arguments,
            "container": None if container is None else (container.name or container.id),
            "respawn": bool(start and start.respawn),
            "environment": dict(start.environment) if start else {},
            "directory": start.directory if start else None,
            "user": start.user if start else None,
        }
        if with_values:
            values = {value.name: value.value for value in (*node.file_values, *node.own_values)}
            nodes[node.full_name] |= {"values": {k: v for k, v in values.items() if v is not None}}
    return nodes


@pytest.mark.parametrize("name", try_some(EXAMPLES, 2))
def test_examples_come_back(name: str, tmp_path: Path) -> None:
    project = judge_shipped(EXAMPLES[name])
    ros = 1 if project.architecture.distro == "noetic" else 2
    package = make_launch_workspace(EXAMPLES[name], tmp_path / "ws", f"ros{ros}_launch")[0]
    launch_file = next(path for path in (package / "launch").iterdir() if path.is_file())
    back = bring_back(launch_file, tmp_path / "back", project.architecture.distro or "jazzy")
    assert not back.has_errors
    wanted, found = list_nodes(project, with_values=False), list_nodes(back, with_values=False)
    assert {key: found.get(key) for key in wanted} == wanted
    commands = {node.command for node in project.architecture.nodes.values() if node.command and not node.arguments}
    assert commands <= {node.command for node in back.architecture.nodes.values()}


@pytest.mark.parametrize("distro", ["jazzy", "noetic"])
def test_words_that_try_to_be_more_come_back(distro: str, tmp_path: Path) -> None:
    folder = write_simple(tmp_path / "bot", distro)
    ros = 1 if distro == "noetic" else 2
    package = make_launch_workspace(folder, tmp_path / "ws", f"ros{ros}_launch")[0]
    launch_file = next(path for path in (package / "launch").iterdir() if path.is_file())
    project, back = check_project(folder), bring_back(launch_file, tmp_path / "back", distro)
    assert not back.has_errors
    assert list_nodes(project, with_values=False).items() <= list_nodes(back, with_values=False).items()
    for full_name, wanted in list_nodes(project, with_values=True).items():
        # What the launch file adds are defaults of the component, and the time; it writes whole numbers as floats.
        found = {key: list_nodes(back, with_values=True)[full_name]["values"].get(key) for key in wanted["values"]}
        as_written = {
            key: v.replace("$(find ", "$(find-pkg-share ") if isinstance(v, str) else v for key, v in found.items()
        }
        assert as_written == wanted["values"]
    commands = {
        node.parameter_commands["robot_description"]
        for node in back.architecture.nodes.values()
        if node.parameter_commands
    }
    assert commands == {("xacro", "it's $(env HOME) \\")}
