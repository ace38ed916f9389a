"""Which parameters a node has, which of several values counts, and what a value must be."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from typing import Literal, TypeGuard

from archgen.diagnostics import NO_SPAN, Span
from archgen.frozen import dataclass
from archgen.model.architecture import Architecture
from archgen.model.component import Component
from archgen.model.node import Node
from archgen.model.parameter import Parameter, ParameterValue, format_parameter
from archgen.model.ros_distro import is_ros_1

ValueOrigin = Literal["ros", "component", "file", "command", "node", "none"]

_ROS_2_NAMES = re.compile(
    r"use_sim_time\Z|start_type_description_service\Z|autostart_node\Z|bond_heartbeat_period\Z|thread_num\Z"
    r"|stand_in\Z|qos_overrides(?:\..*)?\Z|diagnostic_updater(?:\..*)?\Z"
    r"|.*\.(?:compressed|theora|compressedDepth|zstd|ffmpeg)(?:\..*)?\Z|.*\.(?:enable_pub_plugins|jpeg_quality|png_level)\Z",
    re.DOTALL,
)
"""What rclcpp and rclpy declare for every node, the libraries of life-cycle nodes, containers, diagnostics and
image_transport, and nodes that archgen generates with a stand-in."""
_ROS_1_NAMES = re.compile(
    r"use_sim_time\Z|tf_prefix\Z|num_worker_threads\Z|enable_statistics\Z|statistics_window_(?:min|max)_(?:size|elements)\Z"
    r"|diagnostic_period\Z|.*\.(?:compressed|theora|compressedDepth)(?:\..*)?\Z",
    re.DOTALL,
)
"""What roscpp, rospy, nodelets, diagnostics and image_transport read in ROS 1."""
_SUBSTITUTION_MARK = "$("
_TYPE_PHRASES = {
    "boolean": "boolean",
    "float": "number",
    "string": "text",
    "boolean[]": "list of booleans",
    "float[]": "list of numbers",
    "string[]": "list of texts",
}
"""What sentences call a type that nobody wrote."""
_MAX_CHOICES = 8
_MAX_SHOWN = 60


@dataclass(frozen=True, slots=True)
class EffectiveParameter:
    """A parameter of a node with the value that counts, where that comes from, and its declaration, if any.

    `origin` is "none" where nobody gives a value; `at` is where the value is written.
    """

    name: str
    value: object
    origin: ValueOrigin
    at: Span = NO_SPAN
    declaration: Parameter | None = None

    @property
    def is_known(self) -> bool:
        """Whether the value is known: nobody knows what a command gives."""
        return self.origin not in {"none", "command"} and self.value is not None


def canonical_name(name: str, *, ros_1: bool) -> str:
    """Return a parameter's name with dots between its sets; in ROS 1 slashes stand there."""
    return name.strip("~/").replace("/", ".") if ros_1 else name


def is_ros_parameter(name: str, *, ros_1: bool) -> bool:
    """Whether ROS itself, or one of its libraries, declares a parameter at a node."""
    return (_ROS_1_NAMES if ros_1 else _ROS_2_NAMES).match(name) is not None


EVERY_PARAMETER = "*"
"""The name in `open` below which everything stands."""


def is_open_parameter(name: str, components: tuple[Component, ...]) -> bool:
    """Whether a parameter is below an open set of one of the components; all are where `*` is open."""
    return any(
        opened in {name, EVERY_PARAMETER} or name.startswith(f"{opened}.")
        for each in components
        for opened in each.open
    )


def list_node_components(architecture: Architecture, node: Node) -> tuple[Component, ...]:
    """Return the components that a node implements."""
    return tuple(architecture.components[name] for name in node.implements if name in architecture.components)


def find_declarations(architecture: Architecture, node: Node) -> Mapping[str, Parameter]:
    """Return the parameters that the components of a node declare; of those with one name the first component's."""
    ros_1 = is_ros_1(architecture.distro)
    components = list_node_components(architecture, node)
    if len(components) == 1 and not ros_1:
        return components[0].parameters  # of nearly all nodes: rules ask for them again and again
    declarations: dict[str, Parameter] = {}
    for component in components:
        for name, parameter in component.parameters.items():
            declarations.setdefault(canonical_name(name, ros_1=ros_1), parameter)
    return declarations


def find_effective_parameters(architecture: Architecture, node: Node) -> dict[str, EffectiveParameter]:
    """Return the parameters of a node by name, each with the value that counts.

    Later ones win: `ros.parameters`, the component, the node's files, the node. Declared ones come first, in the order of
    their declarations.
    """
    ros_1 = is_ros_1(architecture.distro)
    declarations = find_declarations(architecture, node)
    result = {name: EffectiveParameter(name, None, "none", each.at, each) for name, each in declarations.items()}
    for value in architecture.ros_parameters:
        _lay_over(result, value, "ros", ros_1=ros_1)
    for name, each in declarations.items():
        if each.value is not None:
            result[name] = EffectiveParameter(name, each.value, "component", each.value_at, each)
    for value in node.file_values:
        _lay_over(result, value, "file", ros_1=ros_1)
    for value in node.own_values:
        is_command = value.value is None and value.name in node.parameter_commands
        _lay_over(result, value, "command" if is_command else "node", ros_1=ros_1)
    return result


def _lay_over(
    result: dict[str, EffectiveParameter], value: ParameterValue, origin: ValueOrigin, *, ros_1: bool
) -> None:
    name = canonical_name(value.name, ros_1=ros_1)
    earlier = result.get(name)
    if earlier is not None and earlier.declaration is not None and value.value is None and origin != "command":
        return  # `map_file: ` counts as not written
    result[name] = EffectiveParameter(name, value.value, origin, value.at, earlier.declaration if earlier else None)


def describe_origin(parameter: EffectiveParameter) -> str:
    """Say where a value comes from: `config/camera.yaml:3`, `ros.parameters (archgen.yaml:2)`."""
    place = f"{parameter.at.file}:{parameter.at.line}" if parameter.at.file else ""
    word = {"ros": "ros.parameters", "component": "component", "node": "node", "command": "command"}
    if parameter.origin == "none":
        return ""
    return f"{word[parameter.origin]} ({place})" if parameter.origin in word and place else place


def find_value_fault(parameter: Parameter, value: object) -> str | None:
    """Return what is wrong with a value of a parameter, None where it may have it.

    A value that a launch file fills in (`$(...)`) is not judged.
    """
    if value is None or (isinstance(value, str) and _SUBSTITUTION_MARK in value):
        return None
    if parameter.type is not None and not _has_type(value, parameter.type):
        return f"{describe_parameter_value(value)} is no `{parameter.type}`"
    # Choices say by themselves what a value may be.
    inferred_type = _infer_type(parameter.value) if parameter.type is None and parameter.choices is None else None
    if inferred_type is not None and not _has_type(value, inferred_type):
        return f"{describe_parameter_value(value)} is no {_TYPE_PHRASES[inferred_type]}"
    items = value if isinstance(value, list) else [value]
    if parameter.choices is not None and not _is_choice(value, parameter.choices):
        shown_choices = ", ".join(f"`{_shorten_value(choice)}`" for choice in parameter.choices[:_MAX_CHOICES])
        more = ", ..." if len(parameter.choices) > _MAX_CHOICES else ""
        return f"`{_shorten_value(value)}` is none of its choices: {shown_choices}{more}"
    if parameter.range is not None:
        least, greatest = parameter.range
        for item in items:
            if _is_number(item) and not least <= item <= greatest:
                limits = f"`{format_parameter(least)}` to `{format_parameter(greatest)}`"
                return f"{describe_parameter_value(item)} is outside of its range, {limits}"
    return None


def describe_parameter_value(value: object) -> str:
    """Return a value for a sentence: in backticks, cut where it is long, text in quotes."""
    text = _shorten_value(value)
    return f'`"{text}"`' if isinstance(value, str) else f"`{text}`"


def _shorten_value(value: object) -> str:
    text = " ".join(format_parameter(value).replace("`", "'").split())
    return text if len(text) <= _MAX_SHOWN else f"{text[: _MAX_SHOWN - 1]}…"


def _infer_type(value: object) -> str | None:
    """Return the type of a parameter that says none: that of its value. A whole number may stand for a float."""
    if isinstance(value, bool):
        return "boolean"
    if isinstance(value, int | float):
        return "float"
    if isinstance(value, str) and _SUBSTITUTION_MARK not in value:
        return "string"
    if isinstance(value, list) and value:
        first_type, *other_types = dict.fromkeys(_infer_type(item) for item in value)
        return None if other_types or first_type is None else f"{first_type}[]"
    return None


def _has_type(value: object, type_name: str) -> bool:
    if type_name.endswith("[]"):
        item_type = type_name.removesuffix("[]")
        return isinstance(value, list) and all(_has_type(item, item_type) for item in value)
    if isinstance(value, str) and _SUBSTITUTION_MARK in value:
        return True
    if type_name == "boolean":
        return isinstance(value, bool)
    if type_name == "integer":
        return isinstance(value, int) and not isinstance(value, bool)
    return _is_number(value) if type_name == "float" else isinstance(value, str)


def _is_number(value: object) -> TypeGuard[int | float]:
    return isinstance(value, int | float) and not isinstance(value, bool) and not math.isnan(value)


def _is_choice(value: object, choices: tuple[object, ...]) -> bool:
    if isinstance(value, list):
        return all(_is_choice(item, choices) for item in value)
    # To Python true equals 1.
    return any(choice == value and isinstance(choice, bool) == isinstance(value, bool) for choice in choices)
