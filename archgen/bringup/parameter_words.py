"""The words of commands that give parameters to nodes, each as ROS 2 and ROS 1 read it."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterator, Mapping

from archgen.bringup.plan_shapes import RosLaunch

_SIMPLE_WORD = re.compile(r"[A-Za-z_/][A-Za-z0-9_./-]*\Z")
_GLOBAL_IN_ROS_1 = "use_sim_time"
"""In ROS 1 it is one parameter of all nodes."""
_SPECIAL_WORDS = frozenset({"true", "false", "yes", "no", "on", "off", "y", "n", "null", "nan", "inf", "infinity"})
"""Texts that YAML or ROS takes for something else."""
_ESCAPES = {code: f"\\u{code:04x}" for code in (*range(0x7F, 0xA0), 0x2028, 0x2029, 0xFEFF, 0xFFFE, 0xFFFF)}
"""What YAML wants escaped in quotes, and JSON does not."""


def list_ros_2_options(launch: RosLaunch) -> Iterator[str]:
    """Yield the words behind `--ros-args` that give a node its parameters: those that count most stand last."""
    for name, value in launch.earlier_values.items():
        yield from ("-p", f"{name}:={_format_value(value)}")
    for path in launch.parameter_files:
        yield from ("--params-file", path)
    for name, value in launch.own_values.items():
        # With the node's name it counts more than what a file says to this node, and to all nodes alike.
        place = f"{launch.name}:" if name in launch.file_values and launch.namespace == "/" else ""
        yield from ("-p", f"{place}{name}:={_format_value(value)}")


def list_loading_options(launch: RosLaunch) -> Iterator[str]:
    """Yield the words that give a loaded node its parameters in ROS 2: who loads it reads no files."""
    for name, value in {**launch.earlier_values, **launch.file_values, **launch.own_values}.items():
        yield from ("-p", f"{name}:={_format_value(value)}")


def list_ros_1_preparations(launch: RosLaunch) -> Iterator[tuple[str, ...]]:
    """Yield the commands that give a node its parameters in ROS 1 before it starts, where its own words cannot."""
    for name, value in launch.earlier_values.items():
        if launch.parameter_files or not _is_word_in_ros_1(name, value):
            yield _set_in_ros_1(launch, name, value)
    for path in launch.parameter_files:
        yield ("rosparam", "load", path, launch.full_name)
    for name, value in launch.own_values.items():
        if not _is_word_in_ros_1(name, value):
            yield _set_in_ros_1(launch, name, value)


def list_ros_1_options(launch: RosLaunch) -> Iterator[str]:
    """Yield the words that give a node its parameters in ROS 1: plain ones, which each client library reads alike."""
    earlier_values = {} if launch.parameter_files else launch.earlier_values
    for name, value in {**earlier_values, **launch.own_values}.items():
        if _is_word_in_ros_1(name, value):
            yield f"_{_name_in_ros_1(name)}:={_format_value(value)}"


def _set_in_ros_1(launch: RosLaunch, name: str, value: object) -> tuple[str, ...]:
    place = "" if name == _GLOBAL_IN_ROS_1 else launch.full_name
    return ("rosparam", "set", f"{place}/{_name_in_ros_1(name)}", _format_value(value))


def _name_in_ros_1(name: str) -> str:
    return name.replace(".", "/")


def _is_word_in_ros_1(name: str, value: object) -> bool:
    """Whether a value is a number, a boolean, or a text that nothing takes for something else."""
    if isinstance(value, str):
        return _is_simple(value)
    return isinstance(value, (int, float)) and name != _GLOBAL_IN_ROS_1


def _is_simple(text: str) -> bool:
    return _SIMPLE_WORD.match(text) is not None and text.lower() not in _SPECIAL_WORDS


def _format_value(value: object) -> str:
    """Format a value on one line as YAML that ROS 1 and 2 read alike."""
    if isinstance(value, Mapping):
        return f"{{{', '.join(f'{_format_value(key)}: {_format_value(item)}' for key, item in value.items())}}}"
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(_format_value(item) for item in value)}]"
    if isinstance(value, float):
        return _format_float(value)
    if isinstance(value, str):
        return value if _is_simple(value) else json.dumps(value, ensure_ascii=False).translate(_ESCAPES)
    return json.dumps(value)


def _format_float(value: float) -> str:
    if not math.isfinite(value):
        return ".nan" if math.isnan(value) else ".inf" if value > 0 else "-.inf"
    text = repr(value)
    # Without a point, YAML 1.1 reads a text.
    return text.replace("e", ".0e") if "e" in text and "." not in text else text
