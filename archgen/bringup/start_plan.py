"""Make the plan of a start-up: phases, then who waits for whom, with circles cut where least is needed."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from heapq import heapify, heappop, heappush

from archgen.bringup.plan_shapes import FIRM_NEED, AwaitedStep, DroppedWait, StartPlan, StartStep, StepKind, Wait
from archgen.bringup.program_names import ProgramNames
from archgen.bringup.start_commands import (
    build_command,
    build_container_command,
    describe_container_launch,
    describe_node_launch,
    list_needed_rights,
    list_preparations,
    list_transitions,
)
from archgen.bringup.wait_circles import StartWaits, group_by_waiting, keep_acyclic, name_container
from archgen.derivation.wire.running_state import SUPER_CLIENT_VARIABLE, find_environment
from archgen.derivation.wire.wire_names import NodeNames
from archgen.frozen import replace
from archgen.grouping import group_pairs
from archgen.model.architecture import Architecture
from archgen.model.deployment import Container
from archgen.model.node import DEFAULT_PHASE, NO_START, PHASES, Node, ReadyConditions, StartPhase
from archgen.model.process_scheduling import NO_SCHEDULING, find_process_scheduling
from archgen.model.ros_distro import is_ros_1

_NETWORK_VARIABLE = re.compile(r"(?:ROS|RMW|FASTDDS|FASTRTPS|CYCLONEDDS|ZENOH)_")
_UNSAFE_IN_FILES = re.compile(r"[^A-Za-z0-9_.-]+")
_MAX_FILE_NAME = 100


def make_start_plan(architecture: Architecture) -> StartPlan:
    """Return the plan of all nodes and containers; it depends on nothing else, and on no order but that of the files."""
    start_waits = StartWaits(architecture)
    phases = _find_phases(architecture)
    step_ids = list(phases)
    following: list[Wait] = []
    against_phases: list[Wait] = []
    for wait in start_waits.list_waits():
        is_against = PHASES.index(phases[wait.awaited]) > PHASES.index(phases[wait.waiting])
        (against_phases if is_against else following).append(wait)
    kept, closing = keep_acyclic(step_ids, following)
    left_out = [*(DroppedWait(wait) for wait in against_phases), *closing]
    waits_of = group_by_waiting(kept)
    steps = {step.id: step for step in _list_steps(architecture, phases, start_waits.managers)}
    ordered_ids = _order_steps(step_ids, phases, kept)
    file_names = name_files(ordered_ids)
    return StartPlan(
        steps=tuple(
            replace(
                steps[step_id],
                file_name=file_names[step_id],
                waits=tuple(waits_of.get(step_id, ())),
                awaited=tuple(_gather_awaited(waits_of.get(step_id, ()), steps)),
            )
            for step_id in ordered_ids
        ),
        dropped=tuple(each for each in left_out if each.wait.need < FIRM_NEED),
        circles=tuple(each for each in left_out if each.wait.need >= FIRM_NEED),
    )


def find_network_variables(steps: Iterable[StartStep]) -> dict[str, str]:
    """Return the variables by which all processes of some steps find others: who looks at them has to have the same."""
    # What a container loads has the environment of its process.
    common = [set(step.environment.items()) for step in steps if step.command and step.kind != "composable"]
    shared = set[tuple[str, str]].intersection(*common) if common else set()
    return {name: text for name, text in sorted(shared) if _NETWORK_VARIABLE.match(name)}


def find_looking_variables(steps: Iterable[StartStep]) -> dict[str, str]:
    """Return the same for what looks whether some steps are up: a discovery server has to tell it of all nodes."""
    variables = find_network_variables(steps)
    return {name: "TRUE" if name == SUPER_CLIENT_VARIABLE else text for name, text in variables.items()}


def _gather_awaited(waits: Iterable[Wait], steps: Mapping[str, StartStep]) -> Iterator[AwaitedStep]:
    """Yield what is awaited, what is needed most first. A manager only needs that what it manages was started."""
    waits_by_step = group_pairs((wait.awaited, wait) for wait in waits)
    for awaited, its_waits in waits_by_step.items():
        is_managed = all(wait.reason == "manages" for wait in its_waits)
        yield AwaitedStep(
            awaited, "ended" if steps[awaited].once else "started" if is_managed else "ready", tuple(its_waits)
        )


def name_files(step_ids: Iterable[str]) -> dict[str, str]:
    """Return what files about each step are called: its id where that can be a name of a file, and no other has it."""
    names: dict[str, str] = {}
    taken_names: set[str] = set()
    for step_id in step_ids:
        stem = _UNSAFE_IN_FILES.sub("_", step_id).strip(".-") or "step"
        stem = stem[:_MAX_FILE_NAME]
        name, number = stem, 1
        while name.lower() in taken_names:
            number += 1
            name = f"{stem}_{number}"
        taken_names.add(name.lower())
        names[step_id] = name
    return names


def _find_phases(architecture: Architecture) -> dict[str, StartPhase]:
    """Return the phase of each step; a container starts in the earliest of what it loads, and stands before it."""
    nodes = architecture.nodes.values()
    phases_inside: dict[str, list[StartPhase]] = {container_id: [] for container_id in architecture.containers}
    for node in nodes:
        if node.container is not None:
            phases_inside[node.container].append(_phase_of(node))
    phases: dict[str, StartPhase] = {}
    for node in nodes:
        for container_id in (node.container,) if node.container is not None else ():
            earliest = min(phases_inside[container_id], key=PHASES.index)
            phases.setdefault(name_container(architecture, container_id), earliest)
        phases[node.id] = _phase_of(node)
    for container_id in architecture.containers:
        phases.setdefault(name_container(architecture, container_id), DEFAULT_PHASE)
    return phases


def _phase_of(node: Node) -> StartPhase:
    return (node.start or NO_START).phase or DEFAULT_PHASE


def _order_steps(step_ids: Sequence[str], phases: Mapping[str, StartPhase], waits: Sequence[Wait]) -> list[str]:
    """Return the steps, each behind all that it waits for; else by phase, and as they are written."""
    open_counts = dict.fromkeys(step_ids, 0)
    followers: dict[str, list[str]] = {step_id: [] for step_id in step_ids}
    for wait in waits:
        open_counts[wait.waiting] += 1
        followers[wait.awaited].append(wait.waiting)
    keys = {step_id: (PHASES.index(phases[step_id]), place) for place, step_id in enumerate(step_ids)}
    free = [(keys[step_id], step_id) for step_id in step_ids if not open_counts[step_id]]
    heapify(free)
    ordered: list[str] = []
    while free:
        _, step_id = heappop(free)
        ordered.append(step_id)
        for follower in followers[step_id]:
            open_counts[follower] -= 1
            if not open_counts[follower]:
                heappush(free, (keys[follower], follower))
    return ordered


def _list_steps(
    architecture: Architecture, phases: Mapping[str, StartPhase], managers: Mapping[str, tuple[str, ...]]
) -> list[StartStep]:
    program_names = ProgramNames(architecture, 1 if is_ros_1(architecture.distro) else 2)
    return [
        *(
            _make_container_step(architecture, each, phases[name_container(architecture, each.id)])
            for each in architecture.containers.values()
        ),
        *(
            _make_node_step(architecture, each, managers[each.id], program_names)
            for each in architecture.nodes.values()
        ),
    ]


def _make_container_step(architecture: Architecture, container: Container, phase: StartPhase) -> StartStep:
    launch = describe_container_launch(architecture, container)
    nodes = [node for node in architecture.nodes.values() if node.container == container.id]
    scheduling = find_process_scheduling(architecture, nodes)
    return StartStep(
        name_container(architecture, container.id),
        "container",
        phase,
        container.host,
        container.title,
        ros=launch,
        preparations=list_preparations(architecture, launch),
        command=build_container_command(architecture, container, launch),
        container=container.id,
        environment=_list_variables(architecture, container),
        scheduling=scheduling,
        needs_rights=tuple(scheduling.list_needed_rights()),
    )


def _list_variables(architecture: Architecture, started: Node | Container) -> dict[str, str]:
    """Return the variables with which a process is started, by name."""
    return {name: text for name, (text, _) in find_environment(architecture, started).items()}


def _make_node_step(
    architecture: Architecture, node: Node, managers: tuple[str, ...], program_names: ProgramNames
) -> StartStep:
    start = node.start or NO_START
    kind: StepKind = "program" if "program" in node.kinds else "composable" if node.container is not None else "node"
    launch = describe_node_launch(architecture, node, program_names)
    scheduling = NO_SCHEDULING if node.container else find_process_scheduling(architecture, [node])
    return StartStep(
        node.id,
        kind,
        _phase_of(node),
        node.host,
        node.title,
        status=node.status,
        ros=launch,
        preparations=list_preparations(architecture, launch),
        command=build_command(architecture, node, launch),
        ready=resolve_conditions(start.ready, node, architecture.distro),
        once=start.once,
        transitions=list_transitions(node),
        state=start.wanted_state if "lifecycle" in node.kinds else None,
        manager=managers,
        container=node.container,
        respawn=start.respawn,
        respawn_delay=start.respawn_delay,
        environment={} if node.container is not None else _list_variables(architecture, node),
        directory=start.directory,
        user=start.user,
        scheduling=scheduling,
        needs_rights=(*list_needed_rights(node), *scheduling.list_needed_rights()),
    )


def resolve_conditions(ready: ReadyConditions, node: Node, distro: str | None) -> ReadyConditions:
    """Return what shows that a node is up, with the names on the wire of its topic and service."""
    if ready.topic is None and ready.service is None:
        return ready
    names = NodeNames(node, distro)
    return replace(
        ready,
        topic=(names.resolve(ready.topic, "topic") or ready.topic) if ready.topic is not None else None,
        service=(names.resolve(ready.service, "service") or ready.service) if ready.service is not None else None,
    )
