"""Read one launch file as actions, whatever language it is written in."""

from __future__ import annotations

import posixpath
from pathlib import Path

from archgen.plugin.importing import ForeignFileError, read_bounded
from archgen.plugins.ros.launch.launch_actions import LaunchAction
from archgen.plugins.ros.launch.launch_entities import read_xml_entities, read_yaml_entities
from archgen.plugins.ros.launch.launch_files import MAX_LAUNCH_BYTES
from archgen.plugins.ros.launch.launch_run import LaunchRun
from archgen.plugins.ros.launch.python_launch import read_python_launch, read_python_text
from archgen.plugins.ros.launch.ros_1_entities import Ros1EntityReader, is_ros_1_launch
from archgen.plugins.ros.launch.ros_2_entities import Ros2EntityReader


def load_included(path: Path, run: LaunchRun) -> list[LaunchAction]:
    """Return the actions of a file; of one that cannot be read none, with a note."""
    try:
        return load_actions(path, run)
    except ForeignFileError as error:
        run.add_note("launch file", error.message, error.span, error.help_line)
        return []


def load_actions(path: Path, run: LaunchRun) -> list[LaunchAction]:
    """Return the actions of a file. Raise ForeignFileError."""
    name = run.files.show_path(path)
    folder = posixpath.dirname(run.files.name_file(path))
    run.context.is_ros_1 = False
    if path.name.lower().endswith(".py"):
        return read_python_launch(path, run)
    if path.name.lower().endswith((".yaml", ".yml")):
        return Ros2EntityReader(folder).read_launch(read_yaml_entities(name, read_python_text(name, path)))
    root = read_xml_entities(name, read_bounded(path, MAX_LAUNCH_BYTES))
    if is_ros_1_launch(root, path.name):
        run.context.is_ros_1 = True
        return Ros1EntityReader(folder).read_launch(root)
    return Ros2EntityReader(folder).read_launch(root)
