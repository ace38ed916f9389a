"""A core on which activities fire one another, as far as no figure of events matters: threads, levels, cascades, ways."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from fractions import Fraction

from archgen.frozen import dataclass, replace
from archgen.timing.figures.timing_values import UnknownCause
from archgen.timing.load.event_streams import EventStreams
from archgen.timing.load.inner_triggers import FiringArc, InnerTriggers
from archgen.timing.load.level_cascades import (
    EntryWay,
    LevelCascades,
    Priority,
    build_level_cascades,
    find_entry_ways,
    number_arcs,
)
from archgen.timing.load.queue_responses import CoreQueue
from archgen.timing.load.thread_work import ThreadWork, find_priorities, lower_crowded_threads
from archgen.timing.system.core_placement import ProcessingResource
from archgen.timing.system.thread_pools import works_in_order
from archgen.timing.system.timing_system import TimingSystem


@dataclass(frozen=True, slots=True)
class InnerCore:
    """A core with triggers inside, as far as no figure of events matters: threads, levels, cascades and ways."""

    system: TimingSystem
    inner_triggers: InnerTriggers
    entering_arcs: tuple[FiringArc, ...]
    threads: tuple[ThreadWork, ...]
    thread_of: Mapping[str, ThreadWork]
    levels: Mapping[Priority, LevelCascades]
    ways_to: Mapping[str, tuple[EntryWay, ...]]
    queue: CoreQueue | None = None
    """The queue that the core works off, where its order is written."""


def prepare_inner_core(
    system: TimingSystem, resource: ProcessingResource, inner_triggers: InnerTriggers, *, is_ranked: bool = True
) -> InnerCore:
    """Find the threads of a core, its levels of urgency, and the cascades that count at each.

    Without `is_ranked` no priority counts, and all that works on the core is one level.
    """
    threads = rank_threads(system, (*resource.units, *resource.foreign_units), inner_triggers.silent_ids)
    if not is_ranked:
        threads = tuple(replace(thread, lowest_priority=None, highest_priority=None) for thread in threads)
    own_threads = threads[: len(resource.units)]
    foreign_ids = [name for thread in threads[len(resource.units) :] for name in thread.unit]
    arc_numbers, entering_arcs = number_arcs(inner_triggers)
    levels = {
        level: build_level_cascades(system, inner_triggers, arc_numbers, _find_level_ids(threads, level), foreign_ids)
        for level in sorted(
            dict.fromkeys(thread.lowest_priority for thread in own_threads), key=urgency_of, reverse=True
        )
    }
    return InnerCore(
        system,
        inner_triggers,
        entering_arcs,
        own_threads,
        {name: thread for thread in own_threads for name in thread.unit},
        levels,
        find_entry_ways(system, inner_triggers, arc_numbers),
    )


def rank_threads(
    system: TimingSystem, units: Iterable[tuple[str, ...]], silent_ids: Collection[str]
) -> tuple[ThreadWork, ...]:
    """Return the threads of some units with their priorities alone, as far as they compete with others.

    `silent_ids` are the activities that never work, or only at the start.
    """
    plain_threads = [_build_plain_thread(system, unit) for unit in units]
    event_models: dict[str, EventStreams | UnknownCause] = {
        name: () if name in silent_ids else UnknownCause() for thread in plain_threads for name in thread.unit
    }
    return tuple(lower_crowded_threads(system, plain_threads, event_models))


def _build_plain_thread(system: TimingSystem, unit: tuple[str, ...]) -> ThreadWork:
    """Return a thread with its priorities alone: its work is that of the cascades."""
    lowest, highest = find_priorities(system, unit)
    return ThreadWork(unit, (), None, lowest, highest, Fraction(0), works_in_order(system, system.activities[unit[0]]))


def urgency_of(level: Priority) -> int:
    """Sort key of levels: those without a priority are below all others."""
    return -1 if level is None else level


def _find_level_ids(threads: Iterable[ThreadWork], level: Priority) -> list[str]:
    """Return the activities that may run at a level or above it."""
    return [
        name
        for thread in threads
        if level is None or (thread.highest_priority is not None and thread.highest_priority >= level)
        for name in thread.unit
    ]
