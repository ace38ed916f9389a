"""Do triggers form cycles that never end, or that never begin?"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING

from archgen.diagnostics.common_wording import join_words
from archgen.diagnostics.diagnostic import Diagnostic, Label, Severity
from archgen.diagnostics.source_span import NO_SPAN
from archgen.timing.system.thread_pools import name_lane

if TYPE_CHECKING:
    from collections.abc import Iterator

    from archgen.model.architecture import Architecture
    from archgen.timing.analysis import Analysis


def endless_trigger(_: Architecture, analysis: Analysis) -> Iterator[Diagnostic]:
    """Elements fire one another in a ring: an event that enters it circulates for ever."""
    for ring in analysis.endless:
        members = [analysis.system.activities[name] for name in ring]
        # It is an error only if the behaviour of every member is written: an inferred one may be wrong. The finding is
        # placed at a member whose behaviour is written, if there is one.
        inferred_members = [activity for activity in members if activity.behaviour_inferred]
        first = next((activity for activity in members if not activity.behaviour_inferred), members[0])
        is_certain = not inferred_members
        yield Diagnostic(
            "endless-trigger",
            f"{_join_quoted(ring)} fire one another without an end"
            if len(ring) > 1
            else f"`{ring[0]}` fires itself without an end",
            first.places.get("trigger", first.at),
            severity=None if is_certain else Severity.WARNING,
            labels=tuple(
                Label(member.at, "in the ring") for member in members if member is not first and member.at != NO_SPAN
            ),
            help="let one of them run by a timer (`period`), or only sample what comes back: name its other inputs in `trigger`",
            element=first.id,
        )


def deadlocked_trigger(_: Architecture, analysis: Analysis) -> Iterator[Diagnostic]:
    """Elements wait for all of several inputs, one of which never comes: they never run."""
    arriving_keys = _find_arriving_keys(analysis)
    for ring in analysis.deadlocked:
        members = [analysis.system.activities[name] for name in ring]
        # Only an activity that waits for several inputs can start a deadlock; the other members wait for its output.
        first = next(activity for activity in members if activity.mode in {"all", "match"})
        missing_keys = [key for key in first.triggers if key not in arriving_keys[first.id]]
        reason = (
            f"nothing feeds {_join_quoted(missing_keys)}"
            if missing_keys
            else f"{_join_quoted(ring)} wait for one another"
        )
        awaited = "all of its triggers" if first.mode == "all" else "messages that match"
        yield Diagnostic(
            "deadlocked-trigger",
            f"`{first.id}` never runs: it waits for {awaited}, and {reason}",
            first.places.get("trigger", first.at),
            labels=tuple(
                Label(member.at, "waits, too") for member in members if member is not first and member.at != NO_SPAN
            ),
            help=f"name in `trigger: {{{first.mode}: [...]}}` only the inputs that it has to wait for",
            element=first.id,
        )


def deadlocked_call(architecture: Architecture, analysis: Analysis) -> Iterator[Diagnostic]:
    """A callback waits, and the server that it calls has no other thread: the answer never comes."""
    system = analysis.system
    for arc in system.arcs:
        caller, server = system.activities[arc.source], system.activities[arc.target]
        # What a component asks another one of its node for is a function that it calls, unless ROS carries it.
        is_call = arc.role == "request" and arc.topic in architecture.topics
        if is_call and caller.wait and name_lane(system, caller) == name_lane(system, server):
            yield Diagnostic(
                "deadlocked-call",
                f"`{caller.id}` waits in its callback and calls `{arc.topic}` of `{server.id}`, which has the same thread: "
                "if it waits for that answer, it waits for ever",
                caller.places.get("response", caller.at),
                labels=(Label(server.at, "the server"),) if server.at != NO_SPAN else (),
                help="move one of them into another process, or do not wait: an answer comes in a callback of its own",
                element=caller.id,
            )


def _find_arriving_keys(analysis: Analysis) -> dict[str, set[str]]:
    """Return the input keys at which something arrives, from other activities or from outside, by activity id."""
    arriving_keys = defaultdict[str, set[str]](set)
    for arc in analysis.system.arcs:
        arriving_keys[arc.target].add(arc.input)
    for name, keys in analysis.system.external_inputs.items():
        arriving_keys[name].update(keys)
    return arriving_keys


def _join_quoted(names: tuple[str, ...] | list[str]) -> str:
    """Join names in backticks as in "`a`, `b` and `c`"."""
    return join_words([f"`{name}`" for name in names])


RULES = (
    (endless_trigger, Severity.ERROR),
    (deadlocked_trigger, Severity.ERROR),
    (deadlocked_call, Severity.WARNING),
)
