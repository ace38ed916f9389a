"""The elements of launch files in XML and YAML as actions: those of ROS 1, and those of ROS 2."""

from __future__ import annotations

import textwrap
from typing import Any, ClassVar

from archgen.plugins.ros.launch.launch_entities import ConditionalValue, EntityReader, LaunchAction, LaunchEntity
from archgen.plugins.ros.launch.launch_parameter_values import FILE_KIND, read_inline_value, read_inline_values
from archgen.plugins.ros.launch.launch_values import LaunchValue, Substitution, UnknownValue, describe_launch_value
from archgen.plugins.ros.launch.substitution_texts import fill_in_values, read_substituted_text

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
            *("let", "node_container", "set_parameter", "push-ros-namespace", "push_ros_namespace", "executable"),
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


class Ros1EntityReader(EntityReader):
    """Turns elements of ROS 1 into actions."""

    is_ros_1 = True
    plain_actions: ClassVar = {
        "env": ("environment", {"name": "name", "value": "value"}),
        "machine": ("host", {"name": "name", "address": "address"}),
        "remap": ("remap", {"from": "from", "to": "to"}),
    }
    unread_reasons: ClassVar = {"test": "a test is no part of the robot"}
    node_keys: ClassVar = {
        "package": ("pkg",),
        "executable": ("type",),
        "name": ("name",),
        "namespace": ("ns",),
        "respawn": ("respawn",),
        "respawn_delay": ("respawn_delay",),
        "prefix": ("launch-prefix",),
        "host": ("machine",),
    }

    def __init__(self, folder: str) -> None:
        super().__init__(folder)
        self._readers = {
            "arg": self._read_arg,
            "group": self._read_group,
            "include": self._read_include,
            "node": self._read_node,
            "param": self._read_param,
            "rosparam": self._read_param,
        }

    def _condition(self, entity: LaunchEntity, value: LaunchValue) -> LaunchValue:
        """Return what an element inside of another one gives, with its own conditions."""
        conditions = self._read_conditions(entity)
        return ConditionalValue(value, conditions) if conditions else value

    def _read_arg(self, entity: LaunchEntity) -> LaunchAction:
        name = entity.attributes.get("name", "")
        if "value" in entity.attributes:
            values = {"name": name, "value": self._attribute(entity, "value"), "is_fixed": True}
            return LaunchAction("configure", entity.tag, entity.span, values)
        values = {"name": name, "default": self._attribute(entity, "default")}
        return LaunchAction("argument", entity.tag, entity.span, values)

    def _read_node(self, entity: LaunchEntity) -> LaunchAction:
        values = self._read_node_values(entity)
        if entity.attributes.get("cwd", "node") not in _WORKING_FOLDERS:
            values["directory"] = self._attribute(entity, "cwd")
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

    def _read_param(self, entity: LaunchEntity) -> LaunchAction:
        name = str(entity.attributes.get("name", ""))
        if entity.tag == "param" and name.startswith("~"):
            # A private name is for the nodes behind it, in the same group.
            values = {"name": self._clean_name(name), "value": self._read_param_value(entity)}
            return LaunchAction("parameter", entity.tag, entity.span, values)
        return LaunchAction("server_parameter", entity.tag, entity.span, {"entries": self._read_entries(entity)})

    def _read_entries(self, entity: LaunchEntity) -> list[LaunchValue]:
        """Return what a `param` or `rosparam` sets: mappings by name, or a file."""
        if entity.tag == "param":
            return [{self._clean_name(entity.attributes.get("name", "")): self._read_param_value(entity)}]
        if entity.attributes.get("command", "load") != "load":
            return []
        prefix = [part for key in ("ns", "param") if (part := str(entity.attributes.get(key, "")).strip("/~"))]
        is_filled_in = entity.attributes.get("subst_value") in {"true", "1", "True"}
        if "file" in entity.attributes:
            return [Substitution(FILE_KIND, (self._attribute(entity, "file"), "/".join(prefix), is_filled_in or None))]
        values: Any = read_inline_values(textwrap.dedent(entity.text.strip("\n")), entity.span)
        if values is None:
            text = entity.text.strip()
            values = read_inline_value(text) if prefix and text else None
        if values is None:
            return []
        if is_filled_in:
            values = fill_in_values(values, self._folder)
        for part in reversed(prefix):
            values = {part: values}
        return [values] if isinstance(values, dict) else []

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


ADDS_TO_ENVIRONMENT = "it adds to a variable of the environment"


class Ros2EntityReader(EntityReader):
    """Turns elements of ROS 2 into actions."""

    is_ros_1 = False
    plain_actions: ClassVar = {
        "let": ("configure", {"name": "name", "value": "value"}),
        "log": ("ignored", {}),
        "push_ros_namespace": ("namespace", {"namespace": "namespace"}),
        "set_env": ("environment", {"name": "name", "value": "value"}),
        "set_parameters_from_file": ("parameter_file", {"file": "filename"}),
        "set_remap": ("remap", {"from": "from", "to": "to"}),
    }
    unread_reasons: ClassVar = {
        "unset_env": "it takes a variable of the environment away",
        "reset": "it takes back what was set before",
        "forward": "it hands arguments on to a scope",
        "shutdown": "it ends the launch",
        "append_env": ADDS_TO_ENVIRONMENT,
    }
    node_keys: ClassVar = {
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

    def __init__(self, folder: str) -> None:
        super().__init__(folder)
        self._readers = {
            "arg": self._read_arg,
            "composable_node": self._read_node,
            "executable": self._read_executable,
            "group": self._read_group,
            "include": self._read_include,
            "lifecycle_node": self._read_lifecycle_node,
            "load_composable_node": self._read_load_composable_node,
            "node": self._read_node,
            "node_container": self._read_node_container,
            "set_parameter": self._read_set_parameter,
            "timer": self._read_timer,
        }

    def _read_arg(self, entity: LaunchEntity) -> LaunchAction:
        choices = [self._attribute(each, "value") for each in entity.find_all("choice")]
        values = {
            "name": entity.attributes.get("name", ""),
            "default": self._attribute(entity, "default"),
            "choices": choices,
        }
        return LaunchAction("argument", entity.tag, entity.span, values)

    def _read_node(self, entity: LaunchEntity) -> LaunchAction:
        return LaunchAction("node", entity.tag, entity.span, self._read_node_values(entity))

    def _read_lifecycle_node(self, entity: LaunchEntity) -> LaunchAction:
        return LaunchAction("node", entity.tag, entity.span, {**self._read_node_values(entity), "is_lifecycle": True})

    def _read_node_container(self, entity: LaunchEntity) -> LaunchAction:
        children = [self._read_entity(child) for child in entity.find_all("composable_node")]
        return LaunchAction("container", entity.tag, entity.span, self._read_node_values(entity), children)

    def _read_load_composable_node(self, entity: LaunchEntity) -> LaunchAction:
        children = [self._read_entity(child) for child in entity.find_all("composable_node")]
        return LaunchAction("load", entity.tag, entity.span, {"target": self._attribute(entity, "target")}, children)

    def _read_node_values(self, entity: LaunchEntity) -> dict[str, LaunchValue]:
        values = super()._read_node_values(entity)
        values["ros_arguments"] = [value] if (value := self._attribute(entity, "ros_args")) is not None else []
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
        pairs = self._read_pairs(entity, "keep", "name", "value")
        children = [
            self._read_entity(child) for child in entity.children if child.tag not in {"scoped", "forwarding", "keep"}
        ]
        values = {"scoped": self._value(scoped), "forwards": self._value(forwards), "configurations": pairs}
        return LaunchAction("group", entity.tag, entity.span, values, children)

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

    def _read_timer(self, entity: LaunchEntity) -> LaunchAction:
        children = [self._read_entity(child) for child in entity.children]
        reason = f"what is in it starts after {entity.attributes.get('period', '?')} s"
        return LaunchAction("later", entity.tag, entity.span, {"reason": reason}, children)


def _write_scalar(value: LaunchValue) -> str:
    return value if isinstance(value, str) else "" if value is None else str(value)
