"""Parameters of ROS 1 that stand outside of nodes: those below a node's name are the node's, the rest belongs to nobody."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from archgen.plugin.importing import Span
from archgen.plugins.ros.launch.launch_actions import LaunchAction, LaunchedNode
from archgen.plugins.ros.launch.launch_parameter_values import (
    FILE_KIND,
    CommandWords,
    evaluate_parameter,
    nest_values,
    overlay_parameters,
    split_parameter,
)
from archgen.plugins.ros.launch.launch_values import Substitution, UnknownValue
from archgen.plugins.ros.launch.scope_run import ScopeRun

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
