"""Observe a robot that exists: plug-ins read workspaces, dumps of graphs and recordings, whichever one knows the content."""

from __future__ import annotations

import os
from collections.abc import Collection, Iterator, Mapping
from pathlib import Path
from typing import Any

from archgen.conformance.observed_robot import ObservedRobot
from archgen.diagnostics import Span
from archgen.frozen import NamedTuple, dataclass, field, replace
from archgen.importers.foreign_import import ForeignFileError
from archgen.installed_plugins import list_shipped_facts, load_shipped_object
from archgen.model.architecture import Architecture
from archgen.model.parameter_values import find_effective_parameters
from archgen.project.project_search import name_path_from


class DesignedStart(NamedTuple):
    """How the design starts a node: what a launch file says of it. `remaps` are from the names that its program uses."""

    package: str
    executable: str
    plugin: str
    name: str
    namespace: str
    remaps: Mapping[str, str]
    parameters: Mapping[str, object]


@dataclass(frozen=True, slots=True)
class ObservationOptions:
    """What launch files of a workspace are given, which of them start the robot, and its distribution of ROS.

    `starts` count where no launch file starts it: the names of nodes, remaps and parameters are those of the design then.
    """

    arguments: Mapping[str, str] = field(default_factory=dict)
    environment: Mapping[str, str] = field(default_factory=dict)
    launch_files: tuple[str, ...] = ()
    distro: str = ""
    starts: tuple[DesignedStart, ...] = ()


def list_designed_starts(architecture: Architecture) -> Iterator[DesignedStart]:
    """Yield how the design starts each node of a package."""
    remaps: dict[str, dict[str, str]] = {}
    for endpoint in architecture.endpoints:
        if endpoint.name and endpoint.program_name and endpoint.name != endpoint.program_name:
            remaps.setdefault(endpoint.node, {})[endpoint.program_name] = endpoint.name
    for node in architecture.nodes.values():
        if node.package and not node.is_program:
            parameters = {
                name: each.value
                for name, each in find_effective_parameters(architecture, node).items()
                if each.is_known and each.origin != "component"
            }
            program = (node.package, node.executable or "", node.plugin or "")
            own_remaps = {**node.remaps, **remaps.get(node.id, {})}
            yield DesignedStart(*program, node.name, node.namespace, own_remaps, parameters)


def observe_robot(path: Path, root: Path, options: ObservationOptions, kinds: Collection[str] = ()) -> ObservedRobot:
    """Read what a path holds of a robot. Places in it are relative to the project's folder `root`, as all in findings.

    `kinds` are those that may be read, none for all. Raise ForeignFileError for what nobody knows or what cannot be read.
    """
    observers = sorted(list_shipped_facts("observers"), key=lambda item: item[2]["rank"])
    observers = [each for each in observers if not kinds or each[1] in kinds]
    for _, _, facts in observers:
        robot: ObservedRobot | None = load_shipped_object(facts["reader"])(path, options)
        if robot is not None:
            folder = path if path.is_dir() else path.parent
            return _move_places(robot, name_path_from(root.resolve(), folder.resolve()))
    known = (
        "; ".join(facts["summary"] for _, _, facts in observers) or "none: the plug-ins that read them are taken out"
    )
    words = "it is nothing that says how a robot is"
    raise ForeignFileError(words, Span.of_file(str(path)), f"give one of these: {known}")


def _move_places(robot: ObservedRobot, folder: str) -> ObservedRobot:
    """Return what was observed with places from another folder on."""

    def move(element: Any) -> Any:  # noqa: ANN401 - a node, an endpoint or a topic
        file = Path(os.path.normpath(os.path.join(folder, element.at.file))).as_posix()  # noqa: PTH118 - `..` stays
        return replace(element, at=element.at._replace(file=file))

    return replace(
        robot,
        nodes=tuple(map(move, robot.nodes)),
        endpoints=tuple(map(move, robot.endpoints)),
        topics=tuple(map(move, robot.topics)),
    )
