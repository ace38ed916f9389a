"""Walk through the actions of launch files as ROS would, without starting anything: what they start, and how."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NamedTuple

from archgen.plugin.importing import Span
from archgen.plugins.ros.launch.launch_context import LaunchContext, LaunchScope
from archgen.plugins.ros.launch.launch_entities import LaunchAction, LaunchedNode, join_names
from archgen.plugins.ros.launch.launch_files import LaunchFiles
from archgen.plugins.ros.launch.launch_parameter_values import (
    FILE_KIND,
    CommandWords,
    evaluate_parameter,
    nest_values,
    overlay_parameters,
    split_parameter,
)
from archgen.plugins.ros.launch.launch_values import OPEN, LaunchValue, Substitution, UnknownValue
from archgen.plugins.ros.launch.node_making import NodeMaker
from archgen.plugins.ros.launch.scope_run import LaunchArguments, ScopeRun

ActionLoader = Callable[[Path, "LaunchRun"], list[LaunchAction]]
_STEPS_OF_AN_ACTION = 10
_STEPS_OF_A_CONDITION = 2
_STEPS_OF_A_SCOPE = 15
_CONFIGURATIONS_COPIED_IN_A_STEP = 32
_MAX_NESTING = 100
"""Actions in actions: each takes some of Python's own frames."""
_MAX_OPEN_FILES = 25
_SETTERS = frozenset(
    {"argument", "configure", "namespace", "parameter", "parameter_file", "remap", "environment", "host"}
)
"""Actions that only set something for others."""
_LATER_HELP = "what it starts is taken; say with `start: {after: ...}` what it waits for"


class LaunchRun(ScopeRun):
    """Everything that was found so far. One run reads all files that were given."""

    def __init__(
        self, files: LaunchFiles, load_actions: ActionLoader, arguments: Mapping[str, str] | None = None
    ) -> None:
        super().__init__(files, LaunchArguments(dict(arguments or {})))
        self.nodes: list[LaunchedNode] = []
        self.taken: Counter[str] = Counter()
        """What was taken of the file that is read."""
        self.included: set[Path] = set()
        self.server_parameters: list[ServerParameter] = []
        """Parameters of ROS 1 that stand outside of nodes, by their full names."""
        self._load_actions = load_actions
        self._maker = NodeMaker(self)
        self._started: dict[int, LaunchedNode] = {}
        """What an action has started last, by its identity."""
        self._depth = 0
        self._handlers |= {
            "ignored": self._run_ignored,
            "description": self._run_description,
            "server_parameter": self._run_server_parameter,
            "group": self._run_group,
            "later": self._run_later,
            "call": self._run_call,
            "include": self._run_include,
            "node": self._run_node,
            "process": self._run_process,
            "container": self._run_container,
            "load": self._run_load,
        }

    def run_file(self, path: Path) -> None:
        """Walk through a file that was given, with nothing set from outside but arguments of the command line."""
        self.context.push()
        self.context.scope = LaunchScope(configurations=dict(self.arguments.given))
        self._run_file(path)
        self.context.pop()

    def _run_file(self, path: Path) -> None:
        was_ros_1 = self.context.is_ros_1
        self.open_files.append(path)
        actions = self._load_actions(path, self)
        self.run_actions(actions)
        self.open_files.pop()
        self.context.is_ros_1 = was_ros_1

    def run_actions(self, actions: list[LaunchAction]) -> None:
        """Walk through actions in their order."""
        self._depth += 1
        for action in actions:
            # Actions that stand in one another twice, level by level, or that make themselves, would have no end.
            steps = _STEPS_OF_AN_ACTION + _STEPS_OF_A_CONDITION * len(action.conditions)
            if not self.pay(steps, action.word, action.span):
                break
            if self._depth > _MAX_NESTING:
                self.add_note(action.word, "actions in so many others are not followed", action.span)
                break
            self._run_conditional(action)
        self._depth -= 1

    def _run_conditional(self, action: LaunchAction) -> None:
        verdicts = tuple(map(self.context.judge_condition, action.conditions))
        if any(verdict is False for _, verdict in verdicts):
            # What does not run sets nothing for what stands behind it.
            if action.kind not in _SETTERS:
                with self._enter_scope(action, (), is_scoped=True, keeps_others=True):
                    self.context.scope.conditions += verdicts
                    self._run_action(action)
            return
        before = self.context.scope.conditions
        self.context.scope.conditions += verdicts
        self._run_action(action)
        self.context.scope.conditions = before

    def _run_action(self, action: LaunchAction) -> None:
        handler = self._handlers.get(action.kind)
        if handler is None:
            reason = str(action.get("reason") or "it has no counterpart in the language")
            self.add_note(action.word, reason, action.span)
            return
        if action.kind not in {"ignored", "description"}:
            self.taken[action.word] += 1
        handler(action)

    def _run_ignored(self, action: LaunchAction) -> None:
        """Nothing that an architecture holds."""

    def _run_description(self, action: LaunchAction) -> None:
        self.run_actions(action.children)

    def _run_server_parameter(self, action: LaunchAction) -> None:
        scope = self.context.scope
        for name, value in read_server_parameters(self, action).items():
            if isinstance(scope.namespace, str):
                full_name = join_names(scope.namespace, name)
                self.server_parameters.append(ServerParameter(full_name, value, action.span, scope.conditions))

    def _run_group(self, action: LaunchAction) -> None:
        is_scoped = action.get("scoped", True)
        is_scoped = is_scoped if isinstance(is_scoped, bool) else self.context.judge(is_scoped) is not False
        pairs = self.resolve_pairs(action.get("configurations"))
        forwards = action.get("forwards") is None or self.context.judge(action.get("forwards")) is not False
        with self._enter_scope(action, pairs, is_scoped=is_scoped, keeps_others=forwards):
            self.run_actions(action.children)

    @contextmanager
    def _enter_scope(
        self, action: LaunchAction, pairs: Iterable[tuple[str, LaunchValue]], *, is_scoped: bool, keeps_others: bool
    ) -> Iterator[None]:
        """Set values, and a namespace, for what stands in an action; what is not scoped sets them for what follows, too."""
        if is_scoped:
            copied = len(self.context.scope.configurations) if keeps_others else 0
            self.pay(_STEPS_OF_A_SCOPE + copied // _CONFIGURATIONS_COPIED_IN_A_STEP, action.word, action.span)
            self.context.push(keeps_others=keeps_others)
        self.context.scope.configurations.update(pairs)
        if action.get("namespace") is not None:
            self.push_namespace(action, action.get("namespace"))
        yield
        if is_scoped:
            self.context.pop()

    def _run_later(self, action: LaunchAction) -> None:
        if action.children:
            reason = str(action.get("reason") or "what is in it starts later")
            self.add_note(action.word, reason, action.span, _LATER_HELP, "noted")
        self.run_actions(action.children)

    def _run_call(self, action: LaunchAction) -> None:
        call: Callable[[LaunchContext], list[LaunchAction]] = action.values["call"]
        self.run_actions(call(self.context))

    def _run_include(self, action: LaunchAction) -> None:
        text = self.resolve_told(action, "the file", action.get("file"))
        if text is None:
            return
        path = self.files.find_file(text)
        if path is None or path in self.open_files or len(self.open_files) > _MAX_OPEN_FILES:
            is_far = path is None
            message = f"`{text}` is not read: " + (
                "it does not lie in the folders that were given"
                if is_far
                else "it includes itself"
                if path in self.open_files
                else f"more than {_MAX_OPEN_FILES} files in one another"
            )
            help_line = "give the folder of its package, too" if is_far else ""
            self.add_note(action.word, message, action.span, help_line)
            return
        self._run_included(action, path)

    def _run_included(self, action: LaunchAction, path: Path) -> None:
        arguments = action.get("arguments")
        given = self.resolve_pairs(arguments if isinstance(arguments, dict) else self.choose_values(action, arguments))
        is_scoped, keeps_others = bool(action.get("scoped")), bool(action.get("passes_all"))
        with self._enter_scope(action, given, is_scoped=is_scoped, keeps_others=keeps_others):
            self.included.add(path)
            self._run_file(path)

    def _run_node(self, action: LaunchAction) -> None:
        self._add_node(self._maker.make_node(action, "node"), action)

    def _run_process(self, action: LaunchAction) -> None:
        self._add_node(self._maker.make_process(action), action)

    def _run_container(self, action: LaunchAction) -> None:
        container = self._maker.make_node(action, "container")
        self._add_node(container, action)
        for child in action.children if container is not None else ():
            self._load_child(child, container, "")

    def _run_load(self, action: LaunchAction) -> None:
        target = action.get("target")
        container_name = ""
        container = self._started.get(id(target)) if isinstance(target, LaunchAction) else None
        if isinstance(target, LaunchAction) and container is None:
            target = target.get("name")
        if target is not None and container is None:
            name = self.context.resolve(target)
            if isinstance(name, UnknownValue):
                self.tell_computed(action, "the container", name)
            elif OPEN in name:
                self.add_note(
                    action.word, f"the container is known at the launch only: `{name}`", action.span, fate="noted"
                )
            else:
                # ROS asks for it from the root, in whatever namespace that is done.
                container_name = join_names("", name)
        for child in action.children:
            self._load_child(child, container, container_name)

    def _load_child(self, child: LaunchAction, container: LaunchedNode | None, container_name: str) -> None:
        before = self.context.scope.conditions
        for condition in child.conditions:
            self.context.scope.conditions = (*self.context.scope.conditions, self.context.judge_condition(condition))
        if child.kind == "node":
            node = self._maker.make_node(child, "loaded")
            self.taken[child.word] += 1
            self._add_node(node, child)
            if node is not None:
                node.container, node.container_name = container, container_name
        else:
            self._run_action(child)
        self.context.scope.conditions = before

    def _add_node(self, node: LaunchedNode | None, action: LaunchAction) -> None:
        if node is None:
            self.taken[action.word] -= 1
        else:
            node.action = action
            self.nodes.append(node)
            self._started[id(action)] = node


SIMULATED_TIME = "use_sim_time"
_MAX_DEPTH = 20
"""So many parts of a parameter's name are levels of its tree."""


class ServerParameter(NamedTuple):
    """A parameter outside of nodes: its full name, and the conditions around, each with its verdict by the defaults."""

    full_name: str
    value: Any
    span: Span
    conditions: tuple[tuple[str, bool | None], ...]


def give_server_parameters(
    run: ScopeRun, server_parameters: Sequence[ServerParameter], nodes: list[LaunchedNode]
) -> dict[str, Any]:
    """Give nodes what stands below their names; return what is for all nodes, and note the rest."""
    names = {node.full_name: node for node in nodes if node.full_name}
    for_all: dict[str, Any] = {}
    given: dict[str, dict[str, Any]] = {}
    for full_name, value, span, conditions in server_parameters:
        parts = [each for each in full_name.strip("/").split("/", _MAX_DEPTH) if each]
        owner = next(
            (names[name] for end in range(len(parts), 0, -1) if (name := "/" + "/".join(parts[:end])) in names), None
        )
        # What is not sure to count is for nodes that run under the same conditions.
        shared = () if owner is None else owner.conditions
        others = [(words, verdict) for words, verdict in conditions if verdict is not True and words not in shared]
        if any(verdict is False for _, verdict in others):
            continue
        if others:
            run.add_note("param", f"what counts only {others[0][0]} is left out", span)
            continue
        if full_name == f"/{SIMULATED_TIME}":
            for_all[SIMULATED_TIME] = value
            continue
        if owner is None:
            message = f"`{full_name}` stands on the parameter server and below no node of the files"
            run.add_note("param", message, span, "give it to the nodes that read it")
            continue
        inner = parts[len(owner.full_name.strip("/").split("/")) :]
        values = given.setdefault(owner.full_name, {})
        if isinstance(value, CommandWords):
            if not _has_parameter(owner.parameters, inner) and not _has_parameter(values, inner):
                owner.parameter_commands.setdefault(".".join(inner), list(value))
        elif isinstance(nested := nest_values(value, inner), dict):
            overlay_parameters(values, nested)
    for name, values in given.items():
        # What the node itself says counts more.
        overlay_parameters(values, names[name].parameters)
        names[name].parameters = values
    return for_all


def _has_parameter(parameters: Any, parts: list[str]) -> bool:  # noqa: ANN401 - data of any form
    for part in parts:
        parameters = parameters.get(part) if isinstance(parameters, dict) else None
    return parameters is not None


def read_server_parameters(run: ScopeRun, action: LaunchAction) -> dict[str, Any]:
    """Return parameters of ROS 1 that stand outside of nodes, by their names."""
    server_values: dict[str, Any] = {}
    for entry in action.values["entries"]:
        if isinstance(entry, Substitution) and entry.kind == FILE_KIND:
            _read_server_file(run, action, entry, server_values)
        elif isinstance(entry, Mapping):
            for raw_name, raw_value in entry.items():
                name = run.resolve_told(action, "the name of a parameter", raw_name)
                if name is None:
                    continue
                value, others = split_parameter(evaluate_parameter(raw_value, run.context), name)
                if value is not None:
                    server_values[name] = value
                for inner_name, other in others:
                    if isinstance(other, UnknownValue):
                        run.tell_computed(action, f"the parameter `{inner_name}`", other)
                    else:
                        server_values[inner_name.replace(".", "/")] = other
    return server_values


def _read_server_file(run: ScopeRun, action: LaunchAction, entry: Substitution, server_values: dict[str, Any]) -> None:
    text = run.context.resolve(entry.parts[0])
    path = run.files.find_file(text) if isinstance(text, str) else None
    values = None if path is None else run.parameter_reader.read_whole(path)
    if values is None:
        shown = text if isinstance(text, str) else text.reason
        run.add_note(FILE_KIND, f"`{shown}`: it is not read", action.span)
        return
    overlay_parameters(server_values, nest_values(values, str(entry.parts[1]).split("/") if entry.parts[1] else []))
