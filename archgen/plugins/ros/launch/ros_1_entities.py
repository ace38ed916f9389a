"""The elements of ROS 1's launch files as actions."""

from __future__ import annotations

import textwrap
from collections.abc import Callable
from typing import Any

from archgen.plugins.ros.launch.launch_actions import ConditionalValue, LaunchAction, LaunchCondition
from archgen.plugins.ros.launch.launch_entities import LaunchEntity
from archgen.plugins.ros.launch.launch_parameter_files import FILE_KIND, read_inline_value, read_inline_values
from archgen.plugins.ros.launch.launch_values import LaunchValue, Substitution, UnknownValue, describe_launch_value
from archgen.plugins.ros.launch.substitution_texts import read_substituted_text

_NODE_KEYS = {
    "package": "pkg",
    "executable": "type",
    "name": "name",
    "namespace": "ns",
    "respawn": "respawn",
    "respawn_delay": "respawn_delay",
    "prefix": "launch-prefix",
    "host": "machine",
}
_WORKING_FOLDERS = frozenset({"node", "ROS_HOME"})


def is_ros_1_launch(root: LaunchEntity, name: str) -> bool:
    """Whether a launch file in XML is one of ROS 1: its nodes have a `type`, those of ROS 2 an `exec`."""
    if root.find_all("param"):
        # In ROS 2 each parameter stands in a node.
        return True
    pending = list(root.children)
    marks = 0
    while pending:
        entity = pending.pop()
        attributes = entity.attributes
        texts = [value for value in attributes.values() if isinstance(value, str)]
        if entity.tag in {
            "let",
            "node_container",
            "set_parameter",
            "push-ros-namespace",
            "push_ros_namespace",
            "executable",
        }:
            return False
        holds_parameters = entity.tag == "group" and entity.find_all("param")
        if (
            holds_parameters
            or entity.tag in {"rosparam", "machine", "test"}
            or (entity.tag == "node" and "type" in attributes)
        ):
            return True
        if (entity.tag == "node" and "exec" in attributes) or any(
            "$(var " in text or "$(find-pkg" in text for text in texts
        ):
            return False
        marks += sum("$(arg " in text or "$(find " in text for text in texts)
        pending += entity.children
    return marks > 0 or not name.lower().endswith(".launch.xml")


class Ros1EntityReader:
    """Turns elements into actions. `folder` is what `$(dirname)` stands for."""

    def __init__(self, folder: str) -> None:
        self._folder = folder
        self._readers: dict[str, Callable[[LaunchEntity], LaunchAction]] = {
            "arg": self._read_arg,
            "env": self._read_env,
            "group": self._read_group,
            "include": self._read_include,
            "machine": self._read_machine,
            "node": self._read_node,
            "param": self._read_param,
            "remap": self._read_remap,
            "rosparam": self._read_rosparam,
            "test": self._read_test,
        }

    def read_launch(self, root: LaunchEntity) -> list[LaunchAction]:
        """Return the actions of a launch file."""
        return [self._read_entity(child) for child in root.children]

    def _attribute(self, entity: LaunchEntity, name: str) -> LaunchValue:
        text = entity.attributes.get(name)
        return None if text is None else read_substituted_text(text, self._folder, is_ros_1=True)

    def _read_entity(self, entity: LaunchEntity) -> LaunchAction:
        action = self._readers.get(entity.tag, self._read_unknown)(entity)
        action.conditions += self._read_conditions(entity)
        return action

    def _read_conditions(self, entity: LaunchEntity) -> list[LaunchCondition]:
        return [
            LaunchCondition(self._attribute(entity, word), is_negated)
            for word, is_negated in (("if", False), ("unless", True))
            if word in entity.attributes
        ]

    def _condition(self, entity: LaunchEntity, value: LaunchValue) -> LaunchValue:
        """Return what an element inside of another one gives, with its own conditions."""
        conditions = self._read_conditions(entity)
        return ConditionalValue(value, conditions) if conditions else value

    def _read_unknown(self, entity: LaunchEntity) -> LaunchAction:
        return LaunchAction("unread", entity.tag, entity.span, {"reason": "archgen does not know it"})

    def _read_test(self, entity: LaunchEntity) -> LaunchAction:
        return LaunchAction("unread", entity.tag, entity.span, {"reason": "a test is no part of the robot"})

    def _read_arg(self, entity: LaunchEntity) -> LaunchAction:
        name = entity.attributes.get("name", "")
        if "value" in entity.attributes:
            values = {"name": name, "value": self._attribute(entity, "value"), "is_fixed": True}
            return LaunchAction("configure", entity.tag, entity.span, values)
        values = {"name": name, "default": self._attribute(entity, "default")}
        return LaunchAction("argument", entity.tag, entity.span, values)

    def _read_node(self, entity: LaunchEntity) -> LaunchAction:
        values = {key: self._attribute(entity, name) for key, name in _NODE_KEYS.items() if name in entity.attributes}
        arguments = self._attribute(entity, "args")
        values |= {"arguments": [] if arguments is None else [arguments], "splits_words": True}
        if entity.attributes.get("cwd", "node") not in _WORKING_FOLDERS:
            values["directory"] = self._attribute(entity, "cwd")
        values["remaps"] = [
            self._condition(each, (self._attribute(each, "from"), self._attribute(each, "to")))
            for each in entity.find_all("remap")
        ]
        values["environment"] = [
            self._condition(each, (self._attribute(each, "name"), self._attribute(each, "value")))
            for each in entity.find_all("env")
        ]
        values["parameters"] = [
            self._condition(each, entry)
            for each in entity.find_all("param", "rosparam")
            for entry in self._read_entries(each)
        ]
        return LaunchAction("node", entity.tag, entity.span, values)

    def _read_group(self, entity: LaunchEntity) -> LaunchAction:
        children = [self._read_entity(child) for child in entity.children]
        return LaunchAction("group", entity.tag, entity.span, {"namespace": self._attribute(entity, "ns")}, children)

    def _read_include(self, entity: LaunchEntity) -> LaunchAction:
        arguments = [
            self._condition(
                each,
                (
                    each.attributes.get("name", ""),
                    self._attribute(each, "value" if "value" in each.attributes else "default"),
                ),
            )
            for each in entity.find_all("arg")
        ]
        values = {
            "file": self._attribute(entity, "file"),
            "arguments": arguments,
            "namespace": self._attribute(entity, "ns"),
            "scoped": True,
            "passes_all": entity.attributes.get("pass_all_args") in {"true", "1"},
        }
        return LaunchAction("include", entity.tag, entity.span, values)

    def _read_remap(self, entity: LaunchEntity) -> LaunchAction:
        values = {"from": self._attribute(entity, "from"), "to": self._attribute(entity, "to")}
        return LaunchAction("remap", entity.tag, entity.span, values)

    def _read_env(self, entity: LaunchEntity) -> LaunchAction:
        values = {"name": self._attribute(entity, "name"), "value": self._attribute(entity, "value")}
        return LaunchAction("environment", entity.tag, entity.span, values)

    def _read_machine(self, entity: LaunchEntity) -> LaunchAction:
        values = {"name": self._attribute(entity, "name"), "address": self._attribute(entity, "address")}
        return LaunchAction("host", entity.tag, entity.span, values)

    def _read_param(self, entity: LaunchEntity) -> LaunchAction:
        name = str(entity.attributes.get("name", ""))
        if entity.tag == "param" and name.startswith("~"):
            # A private name is for the nodes behind it, in the same group.
            values = {"name": self._clean_name(name), "value": self._read_param_value(entity)}
            return LaunchAction("parameter", entity.tag, entity.span, values)
        return LaunchAction("server_parameter", entity.tag, entity.span, {"entries": self._read_entries(entity)})

    def _read_rosparam(self, entity: LaunchEntity) -> LaunchAction:
        return self._read_param(entity)

    def _read_entries(self, entity: LaunchEntity) -> list[LaunchValue]:
        """Return what a `param` or `rosparam` sets: mappings by name, or a file."""
        if entity.tag == "param":
            return [{self._clean_name(entity.attributes.get("name", "")): self._read_param_value(entity)}]
        if entity.attributes.get("command", "load") != "load":
            return []
        prefix = [part for key in ("ns", "param") if (part := str(entity.attributes.get(key, "")).strip("/~"))]
        if "file" in entity.attributes:
            return [Substitution(FILE_KIND, (self._attribute(entity, "file"), "/".join(prefix), None))]
        values: Any = read_inline_values(textwrap.dedent(entity.text.strip("\n")), entity.span)
        if values is None:
            text = entity.text.strip()
            values = read_inline_value(text) if prefix and text else None
        if values is None:
            return []
        if entity.attributes.get("subst_value") in {"true", "1", "True"}:
            values = self._fill_values(values)
        for part in reversed(prefix):
            values = {part: values}
        return [values] if isinstance(values, dict) else []

    def _fill_values(self, values: Any, depth: int = 0) -> Any:  # noqa: ANN401 - data of any form
        if depth > 20:  # noqa: PLR2004 - parameters nest a few times
            return UnknownValue("values nested very deep")
        if isinstance(values, dict):
            return {key: self._fill_values(value, depth + 1) for key, value in values.items()}
        if isinstance(values, list):
            return [self._fill_values(value, depth + 1) for value in values]
        if isinstance(values, str) and "$(" in values:
            return Substitution("typed", (read_substituted_text(values, self._folder, is_ros_1=True), "yaml"))
        return values

    def _clean_name(self, name: str) -> LaunchValue:
        return read_substituted_text(name.removeprefix("~"), self._folder, is_ros_1=True)

    def _read_param_value(self, entity: LaunchEntity) -> LaunchValue:
        kind = entity.attributes.get("type", "yaml")
        if "value" in entity.attributes:
            return Substitution("typed", (self._attribute(entity, "value"), kind))
        if "command" in entity.attributes:
            return Substitution("command", (self._attribute(entity, "command"),))
        for key in ("textfile", "binfile"):
            if key in entity.attributes:
                return Substitution("command", (["cat ", self._attribute(entity, key)],))
        return UnknownValue(describe_launch_value(entity.attributes.get("name", "")))
