"""The ways on which events reach the activities of a core, from where they enter it, and how long they take at most."""

from __future__ import annotations

from collections.abc import Mapping

from archgen.frozen import NamedTuple
from archgen.timing.load.event_streams import MAX_STREAMS
from archgen.timing.load.inner_triggers import FiringArc, InnerTriggers
from archgen.timing.load.level_cascades import EventOrigin
from archgen.timing.system.timing_system import Arc, TimingSystem

Priority = int | None
"""A level of urgency: all threads of this priority or a higher one, None all threads."""


class EntryWay(NamedTuple):
    """A way from where an event enters a core to an activity: each step fires at the end of the one before, for it alone.

    `steps` are the activities, the last one included. Each event comes `multiplicity` times. The last activity starts
    `best_before` (ticks) after the event at the earliest, and ends `delay` (ticks) after it at the latest: None where
    that is not bounded. `entry_arc` is the arc by which the event comes, None where the first step has events of its own.
    Of a way over hosts the links take `link_time` at most, all together.
    """

    entry: EventOrigin
    entry_arc: FiringArc | None
    steps: tuple[str, ...]
    multiplicity: int = 1
    best_before: int = 0
    delay: int | None = None
    link_time: int = 0


def begin_way(name: str) -> EntryWay:
    """Return the way to an activity that has events of its own."""
    return EntryWay(EventOrigin("activity", name), None, (name,))


def find_entry_ways(
    system: TimingSystem, inner_triggers: InnerTriggers, arc_numbers: Mapping[int, int]
) -> dict[str, tuple[EntryWay, ...]]:
    """Return the ways to each activity of a core. One with too many, or behind a gate, begins a way of its own."""
    ways_to: dict[str, tuple[EntryWay, ...]] = {}
    for name in inner_triggers.order:
        ways_to[name] = _find_ways_to(system, inner_triggers, arc_numbers, name, ways_to) or (begin_way(name),)
    return ways_to


def _find_ways_to(
    system: TimingSystem,
    inner_triggers: InnerTriggers,
    arc_numbers: Mapping[int, int],
    name: str,
    ways_to: Mapping[str, tuple[EntryWay, ...]],
) -> tuple[EntryWay, ...]:
    """Return the ways to an activity that each event takes, none where not each event fires it."""
    if name in inner_triggers.entry_ids or is_gate(system, inner_triggers, name):
        return ()
    ways = [
        EntryWay(EventOrigin("arc", arc_numbers[id(each.arc)]), each, (name,))
        for each in inner_triggers.outer_arcs[name]
    ]
    for arc, calls in inner_triggers.inner_arcs[name]:
        if arc.source in inner_triggers.silent_ids:
            continue
        # A call may come as soon as its caller starts, data at its end.
        best_case = 0 if arc.role == "request" else (system.activities[arc.source].bcet or 0) + (arc.best or 0)
        ways += [
            way._replace(
                steps=(*way.steps, name),
                multiplicity=way.multiplicity * int(calls),
                best_before=way.best_before + best_case,
                link_time=way.link_time + (arc.worst or 0),
            )
            for way in ways_to[arc.source]
        ]
        if len(ways) > MAX_STREAMS:
            return ()
    return tuple(ways)


def find_run_arcs(
    inner_triggers: InnerTriggers, ways_to: Mapping[str, tuple[EntryWay, ...]]
) -> dict[str, tuple[Arc, ...]]:
    """Return the arcs by which a way goes on to each activity from another one of its core."""
    return {
        name: tuple(firing_arc.arc for firing_arc in firing_arcs)
        for name, firing_arcs in inner_triggers.inner_arcs.items()
        # What begins a way of its own is reached by none that began before.
        if firing_arcs and ways_to[name][0].entry != EventOrigin("activity", name)
    }


def is_gate(system: TimingSystem, inner_triggers: InnerTriggers, name: str) -> bool:
    """Whether not each event that arrives at an activity fires it."""
    activity = system.activities[name]
    gated_inputs = inner_triggers.gated_inputs.get(name)
    if gated_inputs is not None and (len(gated_inputs) > 1 or name not in inner_triggers.complete_gates):
        return True
    if activity.every > 1 or activity.throttle:
        return True
    return any(firing_arc.calls.denominator != 1 for firing_arc in inner_triggers.inner_arcs[name])
