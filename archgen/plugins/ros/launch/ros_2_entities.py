"""The elements of ROS 2's launch files in XML and YAML as actions."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from archgen.plugins.ros.launch.launch_actions import LaunchAction, LaunchCondition
from archgen.plugins.ros.launch.launch_entities import LaunchEntity
from archgen.plugins.ros.launch.launch_values import LaunchValue, Substitution
from archgen.plugins.ros.launch.substitution_texts import read_substituted_text

ADDS_TO_ENVIRONMENT = "it adds to a variable of the environment"
_UNREAD = {
    "unset_env": "it takes a variable of the environment away",
    "reset": "it takes back what was set before",
    "forward": "it hands arguments on to a scope",
    "shutdown": "it ends the launch",
    "append_env": ADDS_TO_ENVIRONMENT,
}
_NODE_KEYS = {
    "package": ("pkg",),
    "executable": ("exec",),
    "plugin": ("plugin",),
    "name": ("name",),
    "namespace": ("namespace",),
    "respawn": ("respawn",),
    "respawn_delay": ("respawn_delay",),
    "directory": ("cwd",),
    "prefix": ("launch-prefix", "launch_prefix"),
}


class Ros2EntityReader:
    """Turns elements into actions. `folder` is what `$(dirname)` stands for."""

    def __init__(self, folder: str) -> None:
        self._folder = folder
        self._readers: dict[str, Callable[[LaunchEntity], LaunchAction]] = {
            "arg": self._read_arg,
            "composable_node": self._read_composable_node,
            "executable": self._read_executable,
            "group": self._read_group,
            "include": self._read_include,
            "let": self._read_let,
            "lifecycle_node": self._read_lifecycle_node,
            "load_composable_node": self._read_load_composable_node,
            "log": self._read_log,
            "node": self._read_node,
            "node_container": self._read_node_container,
            "push_ros_namespace": self._read_push_ros_namespace,
            "set_env": self._read_set_env,
            "set_parameter": self._read_set_parameter,
            "set_parameters_from_file": self._read_set_parameters_from_file,
            "set_remap": self._read_set_remap,
            "timer": self._read_timer,
        }

    def read_launch(self, root: LaunchEntity) -> list[LaunchAction]:
        """Return the actions of a launch file."""
        return [self._read_entity(child) for child in root.children]

    def _value(self, value: Any) -> LaunchValue:  # noqa: ANN401 - XML gives text, YAML more
        if isinstance(value, str):
            return read_substituted_text(value, self._folder, is_ros_1=False)
        return [self._value(item) for item in value] if isinstance(value, list) else value

    def _attribute(self, entity: LaunchEntity, *names: str) -> LaunchValue:
        return next((self._value(entity.attributes[name]) for name in names if name in entity.attributes), None)

    def _read_entity(self, entity: LaunchEntity) -> LaunchAction:
        action = self._readers.get(entity.tag.replace("-", "_"), self._read_unknown)(entity)
        for word, is_negated in (("if", False), ("unless", True)):
            if word in entity.attributes:
                action.conditions.append(LaunchCondition(self._attribute(entity, word), is_negated))
        return action

    def _read_unknown(self, entity: LaunchEntity) -> LaunchAction:
        reason = _UNREAD.get(entity.tag.replace("-", "_"), "archgen does not know it")
        return LaunchAction("unread", entity.tag, entity.span, {"reason": reason})

    def _read_arg(self, entity: LaunchEntity) -> LaunchAction:
        choices = [self._attribute(each, "value") for each in entity.find_all("choice")]
        values = {
            "name": entity.attributes.get("name", ""),
            "default": self._attribute(entity, "default"),
            "choices": choices,
        }
        return LaunchAction("argument", entity.tag, entity.span, values)

    def _read_let(self, entity: LaunchEntity) -> LaunchAction:
        values = {"name": self._attribute(entity, "name"), "value": self._attribute(entity, "value")}
        return LaunchAction("configure", entity.tag, entity.span, values)

    def _read_log(self, entity: LaunchEntity) -> LaunchAction:
        return LaunchAction("ignored", entity.tag, entity.span)

    def _read_node(self, entity: LaunchEntity) -> LaunchAction:
        return LaunchAction("node", entity.tag, entity.span, self._read_node_values(entity))

    def _read_lifecycle_node(self, entity: LaunchEntity) -> LaunchAction:
        return LaunchAction("node", entity.tag, entity.span, {**self._read_node_values(entity), "is_lifecycle": True})

    def _read_composable_node(self, entity: LaunchEntity) -> LaunchAction:
        return self._read_node(entity)

    def _read_node_container(self, entity: LaunchEntity) -> LaunchAction:
        children = [self._read_entity(child) for child in entity.find_all("composable_node")]
        return LaunchAction("container", entity.tag, entity.span, self._read_node_values(entity), children)

    def _read_load_composable_node(self, entity: LaunchEntity) -> LaunchAction:
        children = [self._read_entity(child) for child in entity.find_all("composable_node")]
        return LaunchAction("load", entity.tag, entity.span, {"target": self._attribute(entity, "target")}, children)

    def _read_node_values(self, entity: LaunchEntity) -> dict[str, LaunchValue]:
        values = {
            key: value for key, names in _NODE_KEYS.items() if (value := self._attribute(entity, *names)) is not None
        }
        values["arguments"] = [value] if (value := self._attribute(entity, "args")) is not None else []
        values["ros_arguments"] = [value] if (value := self._attribute(entity, "ros_args")) is not None else []
        values["splits_words"] = True
        values["remaps"] = [
            (self._attribute(each, "from"), self._attribute(each, "to")) for each in entity.find_all("remap")
        ]
        values["environment"] = [
            (self._attribute(each, "name"), self._attribute(each, "value")) for each in entity.find_all("env")
        ]
        values["parameters"] = list(map(self._read_param, entity.find_all("param")))
        return values

    def _read_param(self, entity: LaunchEntity, depth: int = 0) -> LaunchValue:
        source = self._attribute(entity, "from")
        if source is not None:
            return source
        name = self._attribute(entity, "name")
        inner = entity.find_all("param")
        if inner and depth < 20:  # noqa: PLR2004 - parameters nest a few times
            merged: dict[str, LaunchValue] = {}
            for child in inner:
                read = self._read_param(child, depth + 1)
                merged |= read if isinstance(read, dict) else {}
            return {_write_scalar(name): merged}
        value = self._attribute(entity, "value")
        if isinstance(entity.attributes.get("value"), str):
            separator = entity.attributes.get("value-sep")
            if separator:
                value = [
                    Substitution("typed", (self._value(each), "yaml"))
                    for each in entity.attributes["value"].split(separator)
                ]
            else:
                value = Substitution("typed", (value, entity.attributes.get("type", "yaml")))
        return {_write_scalar(name): value}

    def _read_executable(self, entity: LaunchEntity) -> LaunchAction:
        values = self._read_node_values(entity)
        command = [
            each for each in (self._attribute(entity, "cmd"), self._attribute(entity, "args")) if each is not None
        ]
        return LaunchAction("process", entity.tag, entity.span, {**values, "command": command, "splits_words": True})

    def _read_group(self, entity: LaunchEntity) -> LaunchAction:
        # In YAML what belongs to the group itself may be one of its children.
        own = {child.tag: child.attributes.get("value") for child in entity.children}
        scoped = entity.attributes.get("scoped", own.get("scoped", True))
        forwards = entity.attributes.get("forwarding", own.get("forwarding"))
        pairs = [(self._attribute(each, "name"), self._attribute(each, "value")) for each in entity.find_all("keep")]
        children = [
            self._read_entity(child) for child in entity.children if child.tag not in {"scoped", "forwarding", "keep"}
        ]
        values = {"scoped": self._value(scoped), "forwards": self._value(forwards), "configurations": pairs}
        return LaunchAction("group", entity.tag, entity.span, values, children)

    def _read_push_ros_namespace(self, entity: LaunchEntity) -> LaunchAction:
        return LaunchAction("namespace", entity.tag, entity.span, {"namespace": self._attribute(entity, "namespace")})

    def _read_include(self, entity: LaunchEntity) -> LaunchAction:
        arguments = [
            (self._attribute(each, "name"), self._attribute(each, "value")) for each in entity.find_all("arg", "let")
        ]
        values = {"file": self._attribute(entity, "file"), "arguments": arguments}
        return LaunchAction("include", entity.tag, entity.span, values)

    def _read_set_parameter(self, entity: LaunchEntity) -> LaunchAction:
        value = self._attribute(entity, "value")
        if isinstance(entity.attributes.get("value"), str):
            value = Substitution("typed", (value, "yaml"))
        return LaunchAction(
            "parameter", entity.tag, entity.span, {"name": self._attribute(entity, "name"), "value": value}
        )

    def _read_set_parameters_from_file(self, entity: LaunchEntity) -> LaunchAction:
        return LaunchAction("parameter_file", entity.tag, entity.span, {"file": self._attribute(entity, "filename")})

    def _read_set_remap(self, entity: LaunchEntity) -> LaunchAction:
        values = {"from": self._attribute(entity, "from"), "to": self._attribute(entity, "to")}
        return LaunchAction("remap", entity.tag, entity.span, values)

    def _read_set_env(self, entity: LaunchEntity) -> LaunchAction:
        values = {"name": self._attribute(entity, "name"), "value": self._attribute(entity, "value")}
        return LaunchAction("environment", entity.tag, entity.span, values)

    def _read_timer(self, entity: LaunchEntity) -> LaunchAction:
        children = [self._read_entity(child) for child in entity.children]
        reason = f"what is in it starts after {entity.attributes.get('period', '?')} s"
        return LaunchAction("later", entity.tag, entity.span, {"reason": reason}, children)


def _write_scalar(value: LaunchValue) -> str:
    return value if isinstance(value, str) else "" if value is None else str(value)
