"""Can the start-up come to its end: does what is waited for come up, and does nothing wait for itself?"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from archgen.derivation.ros_names import shared_topic_names
from archgen.diagnostics import Diagnostic, Label, Severity, Span, did_you_mean, join_words
from archgen.model.architecture import Architecture
from archgen.model.node import DEFAULT_PHASE, NO_START, Node, Topic

if TYPE_CHECKING:
    from archgen.bringup.plan_shapes import DroppedWait, StartPlan

_MAX_LISTED = 6
"""So many steps of a circle are named."""


def circular_start(architecture: Architecture) -> Iterator[Diagnostic]:
    """Something is to start after what starts only after it."""
    if any(node.start is not None and node.start.after for node in architecture.nodes.values()):
        from archgen.bringup.start_plan import make_start_plan

        for circle in make_start_plan(architecture).circles:
            yield _diagnose_circle(architecture, circle)


def _diagnose_circle(architecture: Architecture, closed: DroppedWait) -> Diagnostic:
    waiting, awaited = closed.wait.waiting, closed.wait.awaited
    if not closed.circle:
        phases = [(architecture.nodes[name].start or NO_START).phase for name in (waiting, awaited)]
        own, other = (phase or DEFAULT_PHASE for phase in phases)
        return Diagnostic(
            "circular-start",
            f"`{waiting}` starts after `{awaited}`, but in an earlier phase: `{own}` is over before `{other}` begins",
            closed.wait.at,
            labels=(
                Label(
                    architecture.nodes[awaited].at,
                    f"in the phase `{other}`" + ("" if phases[1] else ", as nothing is written"),
                ),
            ),
            help=f"write `phase: {own}` at `{awaited}`, `phase: {other}` at `{waiting}`, or take `after` out",
            element=waiting,
        )
    way = [f"`{name}`" for name in reversed(closed.circle)]
    shown = [*way[: _MAX_LISTED - 1], "...", way[-1]] if len(way) > _MAX_LISTED else way
    message = f"`{waiting}` starts after itself"
    if len(way) > 1:
        message = f"`{waiting}` starts after {', which starts after '.join(shown)}"
    places = (_find_after_span(architecture, name) for name in closed.circle[1 : _MAX_LISTED + 1])
    return Diagnostic(
        "circular-start",
        message,
        closed.wait.at,
        labels=tuple(Label(place, "the circle goes on here") for place in places if place),
        help="take one of these `after` out",
        element=waiting,
    )


def _find_after_span(architecture: Architecture, node_id: str) -> Span | None:
    start = architecture.nodes[node_id].start if node_id in architecture.nodes else None
    return start.after[0].at if start and start.after else None


def unmet_ready(architecture: Architecture) -> Iterator[Diagnostic]:
    """Something is up only when a topic or a service is there that nobody gives, or only somebody who starts later."""
    plan: StartPlan | None = None
    for node in architecture.nodes.values():
        if node.start is None or (node.start.ready.topic is None and node.start.ready.service is None):
            continue
        from archgen.bringup.start_plan import make_start_plan, resolve_conditions

        ready = resolve_conditions(node.start.ready, node, architecture.distro)
        for key, name in (("topic", ready.topic), ("service", ready.service)):
            if name is None or _is_always_there(architecture, key, name):
                continue
            givers = _list_givers(architecture, key, name)
            if not givers:
                yield _diagnose_no_giver(architecture, node, key, name)
            elif node.id not in givers:
                plan = plan or make_start_plan(architecture)
                if _find_later_steps(plan, node.id).issuperset(givers):
                    yield _diagnose_late_giver(architecture, node, key, name, givers)


def _is_always_there(architecture: Architecture, key: str, name: str) -> bool:
    """Whether every node has it: topics that all share, and the services of nodes themselves."""
    if key == "topic":
        return name in shared_topic_names(architecture.shared_topics)
    return any(name.startswith(f"{node.full_name}/") for node in architecture.nodes.values())


def _list_givers(architecture: Architecture, key: str, name: str) -> list[str]:
    """Return the nodes that publish a topic, or offer a service or an action."""
    return list(
        dict.fromkeys(
            writer.node
            for topic in architecture.topics.values()
            if topic.name == name and _is_of_key(topic, key)
            for writer in topic.writers
        )
    )


def _is_of_key(topic: Topic, key: str) -> bool:
    return (topic.flow == "topic") == (key == "topic")


def _diagnose_no_giver(architecture: Architecture, node: Node, key: str, name: str) -> Diagnostic:
    topics = [topic for topic in architecture.topics.values() if topic.is_known and _is_of_key(topic, key)]
    known_names = [topic.name for topic in topics if topic.writers]
    verb = "publishes" if key == "topic" else "offers"
    return Diagnostic(
        "unmet-ready",
        f"`{node.id}` is up when the {key} `{name}` is there, but nobody {verb} it",
        _find_ready_span(node, key),
        help=did_you_mean(name, known_names)
        or f"name a {key} that a node {verb}; one of no component stands below `internal` of its node",
        element=node.id,
    )


def _diagnose_late_giver(architecture: Architecture, node: Node, key: str, name: str, givers: list[str]) -> Diagnostic:
    ticked = join_words([f"`{each}`" for each in givers[:_MAX_LISTED]])
    verb = "publishes" if key == "topic" else "offers"
    return Diagnostic(
        "unmet-ready",
        f"`{node.id}` is up when the {key} `{name}` is there, but {ticked}, which {verb} it, waits for `{node.id}`",
        _find_ready_span(node, key),
        labels=tuple(Label(architecture.nodes[each].at, "starts later") for each in givers[:_MAX_LISTED]),
        help=f"write what `{node.id}` itself shows when it is up",
        element=node.id,
    )


def _find_ready_span(node: Node, key: str) -> Span:
    places = node.start.ready.places if node.start else {}
    return places.get(key, node.at)


def _find_later_steps(plan: StartPlan, step_id: str) -> set[str]:
    """Return the steps that wait for one, directly or not; without those that only need that it was started."""
    later = {step_id}
    for step in plan.steps:
        if any(wait.awaited in later and wait.reason != "manages" for wait in step.waits):
            later.add(step.id)
    return later - {step_id}


RULES = (
    (circular_start, Severity.ERROR),
    (unmet_ready, Severity.WARNING),
)
