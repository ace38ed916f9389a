"""Make what an action starts: a node, a container or a program, with everything filled in that the file says."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from archgen.plugin.importing import STEPS_OF_A_KEPT_VALUE, find_program_name
from archgen.plugins.ros.launch.launch_entities import LaunchAction, LaunchedNode, join_names
from archgen.plugins.ros.launch.launch_parameter_values import (
    FILE_KIND,
    FileRewrites,
    RewrittenFile,
    count_leaves,
    evaluate_parameter,
    nest_values,
    overlay_parameters,
    read_nodelet,
    read_prefix,
    read_ros_arguments,
    split_parameter,
)
from archgen.plugins.ros.launch.launch_values import (
    OPEN,
    LaunchValue,
    Substitution,
    UnknownValue,
    describe_launch_value,
)
from archgen.plugins.ros.launch.scope_run import ScopeRun
from archgen.plugins.ros.launch.substitution_texts import fill_in_values, split_words

_VARIABLE = re.compile(r"[A-Za-z_][A-Za-z0-9_]*\Z")

CONTAINER_PACKAGE = "rclcpp_components"
_STEPS_OF_A_NODE = 75
_COMPUTED = "$(computed "
"""Stands for a word that only running the file would tell, as no launch file says it."""
_MAX_COMPUTED = 80
_COLLECTIONS = frozenset({list, tuple, dict})


class NodeMaker:
    """Makes nodes for a run, whose context says what is set."""

    def __init__(self, run: ScopeRun) -> None:
        self._run = run

    def make_node(self, action: LaunchAction, form: str) -> LaunchedNode | None:
        """Return the node, container or loaded node of an action; None where it is more than is followed."""
        if not self._pay(action):
            return None
        node = self._begin(action, form)
        for key in ("package", "executable", "plugin", "name"):
            setattr(node, key, self._resolve_key(node, action, key))
        if not node.name and not self._run.context.is_ros_1:
            node.program_name = find_program_name(node.package, node.plugin or node.executable) or ""
        if form == "node" and node.package == CONTAINER_PACKAGE and node.executable.startswith("component_container"):
            # Nav2 starts its container as a node.
            node.form = "container"
        node.is_lifecycle = bool(action.get("is_lifecycle"))
        self._set_namespace(node, action)
        self._set_remaps(node, action)
        if form != "loaded":
            self._set_process(node, action)
            self._set_arguments(node, action)
        self._set_parameters(node, action)
        self._finish(node)
        return node

    def make_process(self, action: LaunchAction) -> LaunchedNode | None:
        """Return the program that an action starts; None where its words are computed."""
        if not self._pay(action):
            return None
        node = self._begin(action, "program")
        words: list[str] = []
        for value in wrap_in_list(action.get("command")):
            if value is None:
                continue
            text = self._resolve_word(action, "a word of the command", value, action.get("command"))
            if text is None or (text.startswith(_COMPUTED) and not words):
                return None
            words += split_words(text) if action.get("splits_words") and not text.startswith(_COMPUTED) else [text]
        if not words:
            self._run.add_note(action.word, "it has no command", action.span)
            return None
        node.command, node.name = words, self._resolve_key(node, action, "name")
        self._set_process(node, action)
        self._finish(node)
        return node

    def _resolve_word(self, action: LaunchAction, what: str, value: LaunchValue, whole: LaunchValue) -> str | None:
        """Return a word of a command line; None for what may be any number of them.

        One that is computed keeps its place: without it the others mean something else.
        """
        text = self._run.context.resolve(value)
        if isinstance(text, str):
            return text
        self._run.tell_computed(action, what, text)
        if value is whole or text.is_several:
            return None
        return f"{_COMPUTED}{' '.join(text.reason.split())[:_MAX_COMPUTED]})"

    def _pay(self, action: LaunchAction) -> bool:
        """Pay for a node with what it takes over from what is around it, and with what its action says."""
        scope = self._run.context.scope
        # What is around is written again with each node; what an action says was paid for as it was read.
        kept = 3 * (len(scope.remaps) + len(scope.environment) + len(scope.parameters))
        kept += sum(len(value) for value in action.values.values() if type(value) in _COLLECTIONS)
        steps = _STEPS_OF_A_NODE + STEPS_OF_A_KEPT_VALUE * kept + 2 * len(scope.conditions)
        steps += len(scope.namespace) // 4 if isinstance(scope.namespace, str) else 0
        return self._run.pay(steps, action.word, action.span)

    def _begin(self, action: LaunchAction, form: str) -> LaunchedNode:
        self._run.context.used = {}
        scope = self._run.context.scope
        node = LaunchedNode(form, action.word, action.span, action.span.file)
        node.conditions = [words for words, _ in scope.conditions]
        node.is_on = all(verdict is not False for _, verdict in scope.conditions)
        return node

    def _finish(self, node: LaunchedNode) -> None:
        node.launch_arguments = dict(self._run.context.used)

    def _resolve_key(self, node: LaunchedNode, action: LaunchAction, key: str) -> str:
        """Return a text of a node; empty where it is absent or cannot be told."""
        value = action.get(key)
        if value is None:
            return ""
        text = self._run.resolve_told(action, f"its {key}", value)
        if text is None:
            return ""
        if OPEN in text:
            self._run.add_note(
                action.word, f"its {key} is known at the launch only: `{text}`", action.span, fate="noted"
            )
            node.written[key] = text
            return ""
        self._keep_written(node, key, value)
        return text

    def _keep_written(self, node: LaunchedNode, key: str, value: LaunchValue) -> None:
        """Remember what stood where a launch argument was filled in."""
        if isinstance(value, Substitution | list | tuple):
            shown = describe_launch_value(value)
            if "$(var " in shown and len(shown) <= 500:  # noqa: PLR2004 - a hint, not a file
                node.written[key] = shown

    def _set_namespace(self, node: LaunchedNode, action: LaunchAction) -> None:
        outer = self._run.context.scope.namespace
        value = action.get("namespace")
        inner = self._run.context.resolve("" if value is None else value)
        for part in (outer, inner):
            if isinstance(part, UnknownValue):
                self._run.tell_computed(action, "its namespace", part)
                return
        joined = join_names(str(outer), str(inner))
        if OPEN in joined:
            message = f"its namespace is known at the launch only: `{joined}`"
            self._run.add_note(action.word, message, action.span, fate="noted")
            node.written["namespace"] = joined
            return
        if value is not None:
            self._keep_written(node, "namespace", value)
        node.namespace = joined

    def _set_remaps(self, node: LaunchedNode, action: LaunchAction) -> None:
        # The first rule for a name counts. Those of the scope come first, in ROS 1 last.
        around, own = list(self._run.context.scope.remaps), self._run.choose_values(action, action.get("remaps"))
        pairs: list[Any] = [*reversed(own), *around] if self._run.context.is_ros_1 else [*around, *own]
        for pair in pairs:
            if isinstance(pair, UnknownValue) or not isinstance(pair, list | tuple) or len(pair) != 2:  # noqa: PLR2004
                unknown = pair if isinstance(pair, UnknownValue) else UnknownValue(describe_launch_value(pair))
                self._run.tell_computed(action, "a remap", unknown)
                node.unclear_remaps.add("*")
                continue
            self._add_remap(node, action, pair)

    def _add_remap(self, node: LaunchedNode, action: LaunchAction, pair: Sequence[LaunchValue]) -> None:
        named = self._run.resolve_remap(action, "a remap", pair)
        if named is not None:
            self._keep_written(node, f"remaps.{named[0]}", pair[1])
            node.remaps.setdefault(*named)
        elif own_name := self._run.context.resolve(pair[0]):
            node.unclear_remaps.add(own_name if isinstance(own_name, str) else "*")

    def _set_process(self, node: LaunchedNode, action: LaunchAction) -> None:
        context = self._run.context
        node.respawn = action.get("respawn") is not None and context.judge(action.get("respawn")) is True
        delay = action.get("respawn_delay")
        delay_text = context.resolve(delay) if delay is not None else ""
        node.respawn_delay = delay_text if isinstance(delay_text, str) and node.respawn else ""
        node.environment.update(context.scope.environment)
        given = action.get("environment")
        pairs = given.items() if isinstance(given, Mapping) else _list_pairs(self._run.choose_values(action, given))
        for name, value in pairs:
            variable, setting = context.resolve(name), context.resolve(value)
            if isinstance(variable, str) and isinstance(setting, str):
                node.environment[variable] = setting
            else:
                unknown = setting if isinstance(setting, UnknownValue) else UnknownValue(describe_launch_value(name))
                self._run.tell_computed(action, "a variable of its environment", unknown)
        for name in [name for name in node.environment if not _VARIABLE.match(name)]:
            del node.environment[name]
            self._run.add_note(action.word, f"`{name}` is no name of a variable of an environment", action.span)
        directory = context.resolve(action.get("directory")) if action.get("directory") is not None else ""
        if isinstance(directory, UnknownValue):
            self._run.tell_computed(action, "its folder", directory)
        else:
            node.directory = directory
        prefix = context.resolve(action.get("prefix")) if action.get("prefix") is not None else ""
        rest = prefix.reason if isinstance(prefix, UnknownValue) else read_prefix(node, prefix)
        if rest:
            self._run.add_note(action.word, f"what runs it is left out: `{rest}`", action.span)
        host = context.resolve(action.get("host")) if action.get("host") is not None else ""
        node.host = host if isinstance(host, str) else ""

    def _set_arguments(self, node: LaunchedNode, action: LaunchAction) -> None:
        words: list[str] = []
        for key in ("arguments", "ros_arguments"):
            given: list[str] = []
            for value in wrap_in_list(action.get(key)):
                text = self._resolve_word(action, "an argument of the program", value, action.get(key))
                if text is None:
                    continue
                self._keep_written(node, "arguments", value)
                given += split_words(text) if action.get("splits_words") and not text.startswith(_COMPUTED) else [text]
            words += ["--ros-args", *given] if key == "ros_arguments" and given else given
        node.arguments = words
        if not self._run.context.is_ros_1:
            read_ros_arguments(node, lambda path: self._add_file(node, path, "", ()))
        elif action.get("keeps_arguments") is not True:
            read_nodelet(node)

    def _set_parameters(self, node: LaunchedNode, action: LaunchAction) -> None:
        own = self._run.choose_values(action, action.get("parameters"))
        for entry in [*self._run.context.scope.parameters, *own]:
            if isinstance(entry, Mapping):
                for raw_name, value in entry.items():
                    name = self._run.context.resolve(raw_name)
                    if isinstance(name, str):
                        self._set_parameter(node, action, name, value)
                    else:
                        self._run.tell_computed(action, "the name of a parameter", name)
            else:
                self._add_file_value(node, action, entry)

    def _set_parameter(self, node: LaunchedNode, action: LaunchAction, name: str, value: LaunchValue) -> None:
        found, others = split_parameter(evaluate_parameter(value, self._run.context), name)
        for inner_name, other in others:
            node.parameters.pop(inner_name, None)
            node.parameter_commands.pop(inner_name, None)
            if isinstance(other, UnknownValue):
                self._run.tell_computed(action, f"the parameter `{inner_name}`", other)
                node.unclear_parameters[inner_name] = other.reason
            elif other:
                node.parameter_commands[inner_name] = list(other)
        if found is not None:
            self._keep_written(node, f"parameters.{name}", value)
            # In ROS 1 a `/` in a parameter's name is a level of its tree.
            parts = [each for each in name.split("/") if each] if self._run.context.is_ros_1 else [name]
            overlay_parameters(node.parameters, nest_values(found, parts))
            node.file_parameters.discard(name)
            node.unclear_parameters.pop(name, None)
            node.parameter_commands.pop(name, None)

    def _add_file_value(self, node: LaunchedNode, action: LaunchAction, entry: LaunchValue) -> None:
        if isinstance(entry, Substitution) and entry.kind == "typed":
            entry = entry.parts[0]
        is_file = isinstance(entry, Substitution) and entry.kind == FILE_KIND
        value, namespace, changes = entry.parts if is_file else (entry, "", None)
        text = self._run.resolve_told(action, "a parameter file", value)
        if text is None:
            node.unclear_parameters["*"] = f"a parameter file that is computed, {describe_launch_value(value)}"
            return
        self._keep_written(node, "parameter_files", value)
        root_name, all_changes = self._resolve_text(namespace), (changes,) if isinstance(changes, FileRewrites) else ()
        if isinstance(text, RewrittenFile):
            root_name, all_changes = "/".join(filter(None, (root_name, text.root_name))), (*text.changes, *all_changes)
        self._add_file(node, text, root_name, all_changes, action if changes is True else None)

    def _resolve_text(self, value: LaunchValue) -> str:
        text = self._run.context.resolve("" if value is None else value)
        return text if isinstance(text, str) else ""

    def _add_file(
        self,
        node: LaunchedNode,
        text: str,
        root_name: str,
        changes: Sequence[FileRewrites],
        action: LaunchAction | None = None,
    ) -> None:
        """Add a parameter file: its name, and what it says to the node where it can be read; an action fills its values in."""
        if not text:
            return
        path = self._run.files.find_file(text)
        if self._run.context.is_ros_1:
            self._add_ros_1_file(node, text, path, root_name, action)
            return
        # A file below a namespace is for the nodes of that namespace.
        full_name = node.full_name or (node.program_name and join_names(node.namespace, node.program_name))
        full_name = full_name.removeprefix(join_names("", root_name)) if root_name else full_name
        values = None if path is None else self._run.parameter_reader.read_for_node(path, full_name or node.executable)
        if path is not None:
            text = self._run.files.name_file(path)
        if text not in node.parameter_files and text.startswith("$("):
            node.parameter_files.append(text)
        if values is None:
            words = "it is not read" if path is None else "it is no file of parameters of ROS 2"
            self._run.add_note(FILE_KIND, f"`{text}`: {words}", node.span, fate="noted")
            node.unclear_parameters["*"] = f"the parameter file {text}"
            return
        if not self._run.pay(STEPS_OF_A_KEPT_VALUE * len(values), FILE_KIND, node.span):
            return
        self._tell_unaddressed(node, path, full_name, values)
        for each in changes:
            values = each.change_values(values, self._run.context)
        for name, value in values.items():
            if isinstance(value, UnknownValue):
                node.parameters.pop(name, None)
                self._run.tell_computed(node, f"the parameter `{name}`", value)
                node.unclear_parameters[name] = value.reason
            else:
                node.unclear_parameters.pop(name, None)
                node.parameters[name] = value
                node.file_parameters.add(name)

    def _tell_unaddressed(
        self, node: LaunchedNode, path: Path | None, full_name: str, values: Mapping[str, Any]
    ) -> None:
        """Note that a file is for other nodes: a name that is misspelt there, of which ROS says nothing either."""
        if values or path is None or node.form == "container":
            return
        addressed = [f"`{each}`" for each in self._run.parameter_reader.list_addressed(path)]
        if not addressed:
            return
        known = f"`{full_name}`" if full_name else f"{node.executable}, whose own name the launch file does not say"
        more = " and others" if addressed[3:] else ""
        words = f"`{self._run.files.show_path(path)}` says nothing to {known}, but to {', '.join(addressed[:3])}{more}"
        self._run.add_note(FILE_KIND, words, node.span, fate="noted")

    def _add_ros_1_file(
        self, node: LaunchedNode, text: str, path: Path | None, inner_name: str, action: LaunchAction | None
    ) -> None:
        """Add a file that ROS 1 loads below a node's name, or deeper."""
        values = None if path is None else self._run.parameter_reader.read_whole(path)
        if values is None:
            self._run.add_note(FILE_KIND, f"`{text}`: it is not read", node.span, fate="noted")
            node.unclear_parameters["*"] = f"the parameter file {text}"
            if not inner_name and text not in node.parameter_files:
                node.parameter_files.append(text)
            return
        if not self._run.pay(STEPS_OF_A_KEPT_VALUE * count_leaves(values), FILE_KIND, node.span):
            return
        if action is not None:
            for name, value in fill_in_values(values, "").items():
                self._set_parameter(node, action, "/".join(filter(None, [inner_name, name])), value)
        else:
            overlay_parameters(node.parameters, nest_values(values, inner_name.split("/") if inner_name else []))


def wrap_in_list(value: LaunchValue) -> list[LaunchValue]:
    """Return a list of values; of one value alone a list of it."""
    if value is None:
        return []
    return list(value) if isinstance(value, list | tuple) else [value]


def _list_pairs(value: LaunchValue) -> list[tuple[LaunchValue, LaunchValue]]:
    return [(each[0], each[1]) for each in wrap_in_list(value) if isinstance(each, list | tuple) and len(each) == 2]  # noqa: PLR2004
