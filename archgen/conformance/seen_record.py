"""What was seen of robots, as a project keeps it (`.archgen/conform.json`): `archgen conform --keep` writes it, the site and `archgen stats` show it.

What the file says is held against the model as it is by then: of what the model has no longer, nothing is said.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from typing import Any, Literal, get_args

from archgen.conformance.observed_robot import ObservationKind
from archgen.frozen import dataclass, replace
from archgen.model.architecture import Architecture
from archgen.model.node import Endpoint
from archgen.model.port_media import ROS

RECORD_FILE = ".archgen/conform.json"
EndState = Literal["seen", "differs", "missing", "untold"]
"""As designed; there, and otherwise than designed; not there; nobody can tell."""
_VERSION = 1


@dataclass(frozen=True, slots=True)
class SeenDifference:
    """A finding of a comparison: what it is about, and what it says."""

    rule: str
    element: str
    message: str


@dataclass(frozen=True, slots=True)
class SeenRobot:
    """What came out for one robot. `name` is what people call it, `origin` what said how it is; ends are named by `name_end`."""

    name: str
    origin: str
    kind: ObservationKind
    ends: Mapping[str, EndState]
    differences: tuple[SeenDifference, ...] = ()


class SeenRecordError(Exception):
    """The file holds no record. The message says why."""


def name_end(endpoint: Endpoint) -> str:
    """Return what a record calls an end of the design: one that is renamed by now is another one."""
    return f"{endpoint.node} {endpoint.use} {endpoint.name}"


def write_record(robots: Iterable[SeenRobot]) -> str:
    """Return a record as text, a line for each fact."""
    data = [
        {
            "name": robot.name,
            "against": robot.origin,
            "kind": robot.kind,
            "ends": dict(sorted(robot.ends.items())),
            "differences": [
                {"rule": each.rule, "element": each.element, "message": each.message} for each in robot.differences
            ],
        }
        for robot in robots
    ]
    return json.dumps({"archgen_conform": _VERSION, "robots": data}, indent=1, ensure_ascii=False) + "\n"


def read_record(text: str) -> tuple[SeenRobot, ...]:
    """Return what a record says. Raise SeenRecordError."""
    try:
        data = json.loads(text)
        if data["archgen_conform"] != _VERSION:
            raise SeenRecordError(f"it is of version {data['archgen_conform']!r}")
        return tuple(map(_read_robot, data["robots"]))
    except (ValueError, TypeError, KeyError, AttributeError, RecursionError) as error:
        raise SeenRecordError(f"it is none: {type(error).__name__}: {error}") from None


def _read_robot(data: Any) -> SeenRobot:  # noqa: ANN401 - plain data
    kind: ObservationKind = data["kind"]
    ends: dict[str, EndState] = {str(key): state for key, state in data["ends"].items()}
    if kind not in get_args(ObservationKind) or not set(ends.values()) <= {*get_args(EndState)}:
        raise ValueError("a kind or a state that there is not")
    differences = [
        SeenDifference(str(each["rule"]), str(each["element"]), str(each["message"])) for each in data["differences"]
    ]
    return SeenRobot(str(data["name"]), str(data["against"]), kind, ends, tuple(differences))


def replace_robots(old: Iterable[SeenRobot], new: Iterable[SeenRobot]) -> tuple[SeenRobot, ...]:
    """Return robots of before with new ones: what is called the same, and was seen in the same way, is replaced."""
    robots = {(each.name, each.origin): each for each in (*old, *new)}
    return tuple(robots[key] for key in sorted(robots))


def keep_known(architecture: Architecture, robots: Iterable[SeenRobot]) -> tuple[SeenRobot, ...]:
    """Return what robots say of the ends that a model has."""
    known = {name_end(each) for each in list_ends(architecture)}
    return tuple(
        replace(robot, ends={name: state for name, state in robot.ends.items() if name in known}) for robot in robots
    )


def list_ends(architecture: Architecture) -> list[Endpoint]:
    """Return the ends of a model of which robots say something."""
    return [each for each in architecture.endpoints if each.medium == ROS and each.name is not None]


def join_states(robots: Iterable[SeenRobot], end: str) -> EndState | None:
    """Return what all robots together say of an end: a difference anywhere counts most, then that somebody saw it; None for nothing."""
    states = {robot.ends.get(end) for robot in robots}
    order: tuple[EndState, ...] = ("differs", "seen", "missing", "untold")
    return next((state for state in order if state in states), None)


def list_seen_components(architecture: Architecture, robots: Iterable[SeenRobot]) -> frozenset[str]:
    """Return the components of which each end was seen as designed, by something that runs or ran."""
    running = [each for each in robots if each.kind != "workspace"]
    states: dict[str, set[EndState | None]] = {}
    for endpoint in list_ends(architecture):
        if endpoint.component is not None and not endpoint.internal:
            states.setdefault(endpoint.component, set()).add(join_states(running, name_end(endpoint)))
    return frozenset(component for component, each in states.items() if each == {"seen"})
