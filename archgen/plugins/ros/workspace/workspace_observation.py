"""A workspace as what was observed of a robot: the nodes that its launch files start, with what their sources use."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from archgen.plugin.importing import (
    ObservationOptions,
    ObservedEndpoint,
    ObservedNode,
    ObservedRobot,
    Span,
    make_id,
)
from archgen.plugin.model import Endpoint, UseKind, qos_profile
from archgen.plugins.ros.launch.launch_import import SliceMaker
from archgen.plugins.ros.ros_package.package_programs import MANIFEST
from archgen.plugins.ros.sources.walk_values import settle
from archgen.plugins.ros.workspace.node_components import WrittenNode
from archgen.plugins.ros.workspace.program_reading import flatten_parameters
from archgen.plugins.ros.workspace.workspace_import import join_workspace
from archgen.plugins.ros.workspace.workspace_slices import make_slices

_POLICIES = ("reliability", "durability", "history", "depth")


def observe_workspace(path: Path, options: ObservationOptions) -> ObservedRobot | None:
    """Read a workspace; None for what is no folder with packages. Raise ForeignFileError."""
    if not path.is_dir() or next(path.rglob(MANIFEST), None) is None:
        return None
    workspace = join_workspace([path], options)
    account, run = workspace.account, workspace.launched.run
    made = make_slices(SliceMaker(run), workspace.knowledge, workspace.files, account, workspace.distro)
    # A program of which no sources tell that it is a node is none that the graph of a robot would have.
    programs = {node.id for node in made.architecture.nodes.values() if node.is_program}
    nodes_of_ros = [each for each in made.nodes if each.found is not None or each.id not in programs]
    named = {each.id: each for each in nodes_of_ros if _has_known_name(each)}
    names = {node_id: made.architecture.nodes[node_id].full_name for node_id in named}
    counts = Counter(names[node_id] for node_id, each in named.items() if not each.variants)
    nodes = {names[node_id]: _observe_node(names[node_id], each, counts) for node_id, each in named.items()}
    endpoints = tuple(
        _observe_endpoint(names[each.node], named[each.node], each)
        for each in made.architecture.endpoints
        if each.node in named
    )
    unread = tuple(f"{note.span}: {note.message}" for note in (*account.notes, *run.notes) if note.fate == "not taken")
    return ObservedRobot(
        str(path),
        "workspace",
        tuple(nodes.values()),
        endpoints,
        unnamed_nodes=len(nodes_of_ros) - len(named),
        has_designed_starts=workspace.is_without_launch,
        unread=unread,
    )


def _has_known_name(node: WrittenNode) -> bool:
    known = node.known
    is_launched = node.found is None or (
        known is not None and known.program is not None and known.program.nodes[0] is node.found
    )
    if is_launched and known is not None and (known.node.name or known.node.program_name):
        return True
    return node.found is not None and isinstance(settle(node.found.name), str)


def _observe_node(full_name: str, node: WrittenNode, counts: Mapping[str, int]) -> ObservedNode:
    known = node.known
    at = known.node.span if known is not None else Span.of_file(".")
    defaults = {} if node.found is None else {name: settle(value) for name, value in node.found.defaults.items()}
    plain = {name: value for name, value in defaults.items() if isinstance(value, str | int | float | list)}
    given = {} if known is None else flatten_parameters(known.node.parameters)
    return ObservedNode(
        full_name,
        max(counts[full_name], 1),
        {**plain, **given},
        has_known_uses=node.found is not None or (known is not None and bool(known.library_type)),
        # What the library does not say of a program, nobody looked for: it may load plug-ins, or be asked by parameters.
        has_all_uses=known is None
        or (not known.library_type and (known.program is None or not known.program.strange_base)),
        is_conditional=bool(node.variants),
        at=at,
    )


def _observe_endpoint(full_name: str, node: WrittenNode, endpoint: Endpoint) -> ObservedEndpoint:
    """Return an endpoint with its name on the robot, and the place in the sources; of the library's types that of the node."""
    port = endpoint.port.rpartition(".")[2] if endpoint.port else make_id(endpoint.name or "", "topic")
    found = node.endpoints.get((endpoint.use, port))
    at = found.span if found is not None else node.known.node.span if node.known is not None else Span.of_file(".")
    return ObservedEndpoint(
        full_name,
        endpoint.use,
        endpoint.flow,
        endpoint.name,
        endpoint.message,
        {} if found is None else _read_qos(found.qos, endpoint.use),
        is_conditional=found is None or found.is_conditional or bool(node.variants),
        program_name=endpoint.program_name,
        at=at,
    )


def _read_qos(said: Mapping[str, Any], use: UseKind) -> dict[str, Any]:
    """Return the policies that sources say: where a queue or profile is known, what ROS takes for those that are not set."""
    if not {"depth", "profile", "history"} & {key for key, value in said.items() if value is not None}:
        return {}
    qos = qos_profile(str(said.get("profile", "default")), use)
    usual = {policy: getattr(qos, policy) for policy in _POLICIES}
    return {policy: said.get(policy, value) for policy, value in usual.items() if said.get(policy, value) is not None}
