"""Files that a launch file in Python opens itself: YAML in them is read where they lie in the folders that were given.

What `MoveItConfigsBuilder` of MoveIt puts together: parameters from the files of a configuration package, as far as
these can be read. Commands that run xacro, as launch files in Python ask for its output.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from archgen.plugins.ros.launch.launch_values import OPEN_FILE, LaunchValue, Substitution, UnknownValue
from archgen.plugins.ros.launch.python_actions import MethodReader
from archgen.plugins.ros.launch.python_values import BoundMethod, CallArguments, RecordValue

if TYPE_CHECKING:
    from archgen.plugins.ros.launch.launch_run import LaunchRun

_COMMAND_WORDS = 2


class OpenedFileReader(MethodReader):
    """Reads calls that open files."""

    def __init__(self, path: Path, text: str, run: LaunchRun) -> None:
        super().__init__(path, text, run)
        self._callers: dict[str, Callable[[CallArguments, ast.Call], LaunchValue]] = {
            "MoveItConfigsBuilder": self._call_moveit_builder,
            "open": self._call_open,
            "exists": self._call_exists,
            "isfile": self._call_exists,
            "safe_load": self._call_safe_load,
            "load": self._call_safe_load,
            "full_load": self._call_safe_load,
            "process_file": self._call_process_file,
            "process": self._call_process_file,
            "parse": self._call_parse,
            "process_doc": self._call_process_doc,
        }
        """Who reads the calls of imported functions and classes, by the last part of their names."""

    def read_yaml(self, path: LaunchValue, node: ast.AST) -> LaunchValue:
        """Return what a file says, as a mapping; an UnknownValue where it cannot be read."""
        text = self._run.context.resolve(path)
        if isinstance(text, UnknownValue):
            return self.quote(node)
        file = self._run.files.find_file(text)
        values = None if file is None else self._run.parameter_reader.read_mapping(file)
        if values is None:
            is_far = file is None
            near_words = "it is no mapping in YAML, or more is opened than archgen reads"
            words = "it does not lie in the folders that were given" if is_far else near_words
            help_line = "give the folder of its package, too" if is_far else ""
            self._run.add_note("open", f"`{text}` is not read: {words}", self.place(node), help_line)
            return UnknownValue(text, getattr(node, "lineno", 0), self.file)
        return values

    def has_file(self, path: LaunchValue) -> bool:
        """Whether a file lies in the folders that were given."""
        text = self._run.context.resolve(path)
        return isinstance(text, str) and self._run.files.find_file(text) is not None

    def list_names(self, folder: LaunchValue) -> list[str]:
        """Return the names of the files in a folder."""
        text = self._run.context.resolve(folder)
        return self._run.files.list_names(text) if isinstance(text, str) else []

    def call_method(self, method: BoundMethod, arguments: CallArguments, node: ast.Call) -> LaunchValue:
        """Return what a method gives; what it changes is changed."""
        if isinstance(method.owner, MoveItBuilder):
            return call_builder(self, method.owner, method.name, arguments, node)
        if isinstance(method.owner, RecordValue):
            return method.owner.values[method.name]
        if method.name in {"exists", "is_file"} and isinstance(method.owner, str | Substitution):
            return True if self.has_file(method.owner) else self.quote(node)
        return super().call_method(method, arguments, node)

    def _call_moveit_builder(self, arguments: CallArguments, node: ast.Call) -> LaunchValue:
        return make_builder(arguments) or self.quote(node)

    def _call_open(self, arguments: CallArguments, node: ast.Call) -> LaunchValue:
        path = arguments.get(0, "file")
        return Substitution(OPEN_FILE, (path,)) if isinstance(path, str | Substitution) else self.quote(node)

    def _call_exists(self, arguments: CallArguments, node: ast.Call) -> LaunchValue:
        # That a file is not at hand says nothing about the robot.
        return True if self.has_file(arguments.get(0, "path")) else self.quote(node)

    def _call_safe_load(self, arguments: CallArguments, node: ast.Call) -> LaunchValue:
        path = _find_path(arguments.get(0, "stream"))
        return self.quote(node) if path is None else self.read_yaml(path, node)

    def _call_process_file(self, arguments: CallArguments, node: ast.Call) -> LaunchValue:
        path, mappings = arguments.get(0), arguments.get(None, "mappings")
        if isinstance(path, UnknownValue) or path is None or not (mappings is None or isinstance(mappings, dict)):
            return self.quote(node)
        return make_xacro_command(path, mappings)

    def _call_parse(self, arguments: CallArguments, node: ast.Call) -> LaunchValue:
        path = _find_path(arguments.get(0))
        return self.quote(node) if path is None else make_xacro_command(path)

    def _call_process_doc(self, arguments: CallArguments, node: ast.Call) -> LaunchValue:
        """Add what is given for the arguments of a document that `xacro.parse` gave: the document itself is changed."""
        document, mappings = arguments.get(0, "doc"), arguments.get(None, "mappings")
        words = document.parts[0] if isinstance(document, Substitution) and document.kind == "command" else None
        if not isinstance(words, list) or words[:1] != ["xacro "]:
            return self.quote(node)
        if isinstance(mappings, dict):
            words += write_mappings(mappings)
        elif mappings is not None:
            words.append(self.quote(node))
        return None


def _find_path(value: LaunchValue) -> LaunchValue | None:
    """Return the path of an open file, or of one whose text was read; None for anything else."""
    if not isinstance(value, Substitution):
        return None
    if value.kind == OPEN_FILE:
        return value.parts[0]
    words = value.parts[0] if value.kind == "command" else None
    is_text = isinstance(words, list) and len(words) == _COMMAND_WORDS and words[0] == "cat "
    return words[1] if is_text and words is not None else None


_PIPELINE_ENDING = "_planning.yaml"
_CONTROLLER_ENDING = "_controllers.yaml"
_MONITOR_DEFAULTS = {
    "publish_planning_scene": True,
    "publish_geometry_updates": True,
    "publish_state_updates": True,
    "publish_transforms_updates": True,
}
"""What every version of MoveIt 2 sets."""
_MONITOR_NAMES = (*_MONITOR_DEFAULTS, "publish_robot_description", "publish_robot_description_semantic")
_PILZ = "pilz_industrial_motion_planner"
_YAML_STEPS = {
    "robot_description_kinematics": ("_kinematics", "kinematics.yaml"),
    "joint_limits": ("_planning", "joint_limits.yaml"),
    "pilz_cartesian_limits": ("_planning", "pilz_cartesian_limits.yaml"),
}
_STEPS = (
    *("robot_description", "robot_description_semantic", "robot_description_kinematics", "planning_pipelines"),
    *("trajectory_execution", "planning_scene_monitor", "sensors_3d", "joint_limits"),
)
"""What is put together with the defaults unless the launch file does it, in MoveIt's order."""


@dataclass(slots=True, eq=False)
class MoveItBuilder:
    """A builder, step by step. `package` is the folder of the configuration package, `prefix` how its parameters begin."""

    robot: LaunchValue
    prefix: str
    package: LaunchValue
    parts: dict[str, dict[LaunchValue, LaunchValue]] = field(default_factory=dict)


def make_builder(arguments: CallArguments) -> MoveItBuilder | None:
    """Return the builder that a call makes; None where the robot's name is not known."""
    robot = arguments.get(0, "robot_name")
    prefix = arguments.get(1, "robot_description")
    package = arguments.get(2, "package_name")
    if package is None and isinstance(robot, str):
        package = f"{robot}_moveit_config"
    if not isinstance(package, str | Substitution):
        return None
    share = Substitution("share", (package,))
    return MoveItBuilder(robot, prefix if isinstance(prefix, str) else "robot_description", share)


def call_builder(
    reader: OpenedFileReader, builder: MoveItBuilder, name: str, arguments: CallArguments, node: ast.Call
) -> LaunchValue:
    """Return what a method of a builder gives: mostly itself."""
    files = _MoveItReader(reader, builder, node)
    if name in {"to_moveit_configs", "to_dict"}:
        made = files.finish()
        return made.values["to_dict"] if name == "to_dict" else made
    if not files.has_step(name):
        return reader.quote(node)
    files.take_step(name, arguments)
    return builder


class _MoveItReader:
    """Reads the files of one call."""

    def __init__(self, reader: OpenedFileReader, builder: MoveItBuilder, node: ast.Call) -> None:
        self._reader, self._builder, self._node = reader, builder, node
        self._steps: dict[str, Callable[[CallArguments], dict[LaunchValue, LaunchValue]]] = {
            "robot_description": self._read_robot_description,
            "robot_description_semantic": self._read_robot_description_semantic,
            "trajectory_execution": self._read_trajectory_execution,
            "planning_scene_monitor": self._read_planning_scene_monitor,
            "sensors_3d": self._read_sensors_3d,
            "moveit_cpp": self._read_moveit_cpp,
            "planning_pipelines": self._read_planning_pipelines,
        }

    def has_step(self, name: str) -> bool:
        """Whether a method of the builder is one that loads something."""
        return name in _YAML_STEPS or name in self._steps

    def take_step(self, name: str, arguments: CallArguments) -> None:
        """Put together what one method of the builder loads."""
        if name in _YAML_STEPS:
            suffix, default = _YAML_STEPS[name]
            values = self._read_yaml(arguments.get(0, "file_path"), default)
            self._builder.parts[name] = {f"{self._builder.prefix}{suffix}": values}
            return
        self._builder.parts[name] = self._steps[name](arguments)

    def finish(self) -> RecordValue:
        """Return the parameters by MoveIt's names for their kinds, and as one mapping by `to_dict`."""
        for name in _STEPS:
            if name not in self._builder.parts:
                self.take_step(name, CallArguments([], {}))
        parts = self._builder.parts
        if _PILZ in parts["planning_pipelines"] and "pilz_cartesian_limits" not in parts:
            self.take_step("pilz_cartesian_limits", CallArguments([], {}))
        merged: dict[LaunchValue, LaunchValue] = {}
        for name in (*_STEPS, "moveit_cpp"):
            merged |= parts.get(name, {})
        # They stand below the same key as the limits of joints, and are added there key by key.
        for key, limits in parts.get("pilz_cartesian_limits", {}).items():
            known = merged.get(key)
            if isinstance(known, dict) and isinstance(limits, dict):
                merged[key] = {**known, **limits}
            else:
                merged.setdefault(key, limits)
        values: dict[str, LaunchValue] = {name: parts.get(name, {}) for name in (*_STEPS, "moveit_cpp", *_YAML_STEPS)}
        values |= {"package_path": self._builder.package, "to_dict": merged}
        return RecordValue(values, frozenset({"to_dict"}))

    def _read_robot_description(self, arguments: CallArguments) -> dict[LaunchValue, LaunchValue]:
        """Return the command that gives the URDF."""
        path, mappings = arguments.get(0, "file_path"), arguments.get(1, "mappings")
        place = None if path is None else self._place(path)
        if place is None:
            place, mappings = self._find_urdf(mappings)
        return {self._builder.prefix: self._make_command(place, mappings, "its URDF")}

    def _read_robot_description_semantic(self, arguments: CallArguments) -> dict[LaunchValue, LaunchValue]:
        """Return the command that gives the SRDF."""
        path, mappings = arguments.get(0, "file_path"), arguments.get(1, "mappings")
        if path is None:
            path = self._read_assistant("srdf").get("relative_path")
        if path is None and self._reader.has_file(self._place(f"config/{self._builder.robot}.srdf")):
            path = f"config/{self._builder.robot}.srdf"
        place = None if path is None else self._place(path)
        return {f"{self._builder.prefix}_semantic": self._make_command(place, mappings, "its SRDF")}

    def _read_trajectory_execution(self, arguments: CallArguments) -> dict[LaunchValue, LaunchValue]:
        manages = arguments.get(1, "moveit_manage_controllers")
        found: dict[LaunchValue, LaunchValue] = {"moveit_manage_controllers": True if manages is None else manages}
        path = arguments.get(0, "file_path")
        if path is None:
            names = self._list_names(_CONTROLLER_ENDING)
            wanted = [each for each in ("moveit", "moveit2", self._builder.robot) if each in names] or names
            path = f"config/{wanted[0]}{_CONTROLLER_ENDING}" if len(names) == 1 or wanted != names else None
        return found | self._read_mapping(path, "moveit_simple_controller_manager")

    def _read_planning_scene_monitor(self, arguments: CallArguments) -> dict[LaunchValue, LaunchValue]:
        given = {name: arguments.get(number, name) for number, name in enumerate(_MONITOR_NAMES)}
        return {**_MONITOR_DEFAULTS, **{name: value for name, value in given.items() if value is not None}}

    def _read_sensors_3d(self, arguments: CallArguments) -> dict[LaunchValue, LaunchValue]:
        """Return the sensors, where there is a file of them."""
        path = arguments.get(0, "file_path") or "config/sensors_3d.yaml"
        if not self._reader.has_file(self._place(path)):
            return {}
        values = self._reader.read_yaml(self._place(path), self._node)
        sensors = values.get("sensors") if isinstance(values, Mapping) else None
        return dict(values) if isinstance(values, Mapping) and isinstance(sensors, list) and any(sensors) else {}

    def _read_moveit_cpp(self, arguments: CallArguments) -> dict[LaunchValue, LaunchValue]:
        return self._read_mapping(arguments.get(0, "file_path") or "config/moveit_cpp.yaml", "moveit_cpp")

    def _read_planning_pipelines(self, arguments: CallArguments) -> dict[LaunchValue, LaunchValue]:
        """Return the planners. Those that MoveIt itself has files for are not known."""
        default, given = arguments.get(0, "default_planning_pipeline"), arguments.get(1, "pipelines")
        own_names = self._list_names(_PIPELINE_ENDING)
        names: list[LaunchValue] = given if isinstance(given, list) else list(own_names)
        is_open = given is None and arguments.get(2, "load_all") is not False
        unknown = self._make_unknown("the pipelines that MoveIt's own files add")
        found: dict[LaunchValue, LaunchValue] = {
            "planning_pipelines": unknown if is_open or (given is not None and given is not names) else list(names)
        }
        if default is None:
            default = "ompl" if "ompl" in names else names[0] if names and not is_open else unknown
        found["default_planning_pipeline"] = default
        for name in names:
            if isinstance(name, str):
                found[name] = self._read_yaml(None, f"{name}{_PIPELINE_ENDING}")
        ompl = found.get("ompl")
        if isinstance(ompl, dict) and "planner_configs" not in ompl:
            ompl["planner_configs"] = self._make_unknown("ompl_defaults.yaml of moveit_configs_utils")
        return found

    def _place(self, path: LaunchValue) -> LaunchValue:
        return Substitution("path", (self._builder.package, path))

    def _read_yaml(self, path: LaunchValue, default: str) -> LaunchValue:
        return self._reader.read_yaml(self._place(f"config/{default}" if path is None else path), self._node)

    def _read_mapping(self, path: LaunchValue, key: str) -> dict[LaunchValue, LaunchValue]:
        """Return what a file says; where it cannot be read one key for all of it, which is not known."""
        unknown = self._make_unknown("its file is not known")
        values = unknown if path is None else self._reader.read_yaml(self._place(path), self._node)
        return dict(values) if isinstance(values, Mapping) else {key: values}

    def _list_names(self, ending: str) -> list[str]:
        names = self._reader.list_names(self._place("config"))
        return [name.removesuffix(ending) for name in names if name.endswith(ending)]

    def _read_assistant(self, part: str) -> dict[str, LaunchValue]:
        """Return what MoveIt's setup assistant remembers of the URDF or the SRDF."""
        place = self._place(".setup_assistant")
        values = self._reader.read_yaml(place, self._node) if self._reader.has_file(place) else {}
        config = values.get("moveit_setup_assistant_config") if isinstance(values, Mapping) else None
        found = (config.get(part) or config.get(part.upper())) if isinstance(config, Mapping) else None
        return dict(found) if isinstance(found, Mapping) else {}

    def _find_urdf(self, mappings: LaunchValue) -> tuple[LaunchValue, LaunchValue]:
        remembered = self._read_assistant("urdf")
        words = remembered.get("xacro_args")
        if mappings is None and isinstance(words, str):
            mappings = dict(word.split(":=", 1) for word in words.split() if ":=" in word)
        own = self._place(f"config/{self._builder.robot}.urdf.xacro")
        if self._reader.has_file(own):
            return own, mappings
        package, path = remembered.get("package"), remembered.get("relative_path")
        if isinstance(package, str) and isinstance(path, str):
            return Substitution("path", (Substitution("share", (package,)), path)), mappings
        plain = self._place(f"config/{self._builder.robot}.urdf")
        return (plain if self._reader.has_file(plain) else None), mappings

    def _make_command(self, place: LaunchValue, mappings: LaunchValue, what: str) -> LaunchValue:
        if place is None or not (mappings is None or isinstance(mappings, Mapping)):
            return self._make_unknown(what)
        return make_xacro_command(place, mappings)

    def _make_unknown(self, reason: str) -> UnknownValue:
        return UnknownValue(reason, self._node.lineno, self._reader.file)


def make_xacro_command(path: LaunchValue, mappings: Mapping[LaunchValue, LaunchValue] | None = None) -> Substitution:
    """Return the command whose output is what xacro makes of a file."""
    return Substitution("command", (["xacro ", path, *write_mappings(mappings or {})],))


def write_mappings(mappings: Mapping[LaunchValue, LaunchValue]) -> list[LaunchValue]:
    """Return what is given for the arguments of a file, as words behind the command."""
    return [part for name, value in mappings.items() for part in (f" {name}:=", value)]
