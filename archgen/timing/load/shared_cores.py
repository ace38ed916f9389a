"""Cores that share their work, as far as no figure of events matters: threads, cascades, and the jobs of each thread."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping

from archgen.frozen import NamedTuple, dataclass, replace
from archgen.timing.load.inner_core import rank_threads
from archgen.timing.load.inner_triggers import FiringArc, InnerTriggers
from archgen.timing.load.level_cascades import (
    EntryWay,
    EventOrigin,
    LevelCascades,
    build_level_cascades,
    find_entry_ways,
    number_arcs,
)
from archgen.timing.load.thread_work import ThreadWork
from archgen.timing.system.core_placement import ProcessingResource
from archgen.timing.system.thread_pools import ThreadUnit, fills_cores, find_crowded_pools, find_thread_count
from archgen.timing.system.timing_system import TimingSystem

WayKey = tuple[str, int]
"""A way to an activity: the activity's id, and the way's place among those that lead to it."""


class ThreadJob(NamedTuple):
    """What each event of an origin asks of a thread on one way: the work of the way's last step, in ticks."""

    key: WayKey
    origin: EventOrigin
    work: int
    unit: ThreadUnit
    steps: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class SharedCores:
    """Cores that share their work.

    `crowd_of` is the process for whose threads an activity waits, with the number of its threads. `job_numbers` are the
    places in `jobs` of what each thread does; `origins_of_unit` is what keeps a thread busy, or passes through it without
    any work.
    """

    system: TimingSystem
    core_count: int
    inner_triggers: InnerTriggers
    entering_arcs: tuple[FiringArc, ...]
    cascades: LevelCascades
    ways_to: Mapping[str, tuple[EntryWay, ...]]
    own_units: tuple[ThreadUnit, ...]
    unit_of: Mapping[str, ThreadUnit]
    crowd_of: Mapping[str, tuple[str, int]]
    foreign_ids: frozenset[str]
    threads: Mapping[ThreadUnit, ThreadWork]
    jobs: tuple[ThreadJob, ...]
    job_numbers: Mapping[ThreadUnit, list[int]]
    origins_of_unit: Mapping[ThreadUnit, frozenset[EventOrigin]]
    reentrant_units: Mapping[ThreadUnit, int]
    """Units of which several activations may run at once, with how many."""

    def find_way_before(self, origin: EventOrigin, steps: tuple[str, ...]) -> WayKey:
        """Return the way to the step before the last one of a way."""
        before = steps[-2]
        return next(
            (before, number)
            for number, way in enumerate(self.ways_to[before])
            if way.entry == origin and way.steps == steps[:-1]
        )


def prepare_shared_cores(
    system: TimingSystem, resource: ProcessingResource, inner_triggers: InnerTriggers
) -> SharedCores:
    """Find the threads of some cores, and the cascades of what enters them."""
    all_units = (*resource.units, *resource.foreign_units)
    foreign_ids = tuple(name for unit in resource.foreign_units for name in unit)
    inner_triggers, ways_to = find_ways_anew(system, inner_triggers)
    arc_numbers, entering_arcs = number_arcs(inner_triggers)
    cascades = build_level_cascades(system, inner_triggers, arc_numbers, (*resource.members, *foreign_ids), foreign_ids)
    unit_of = {name: unit for unit in all_units for name in unit}
    jobs = tuple(_list_jobs(system, cascades, ways_to, unit_of, foreign_ids))
    job_numbers: dict[ThreadUnit, list[int]] = {unit: [] for unit in all_units}
    for number, job in enumerate(jobs):
        job_numbers[job.unit].append(number)
    return SharedCores(
        system,
        resource.cores,
        inner_triggers,
        entering_arcs,
        cascades,
        ways_to,
        resource.units,
        unit_of,
        _find_crowds(system, resource.members, resource.cores),
        frozenset(foreign_ids),
        {thread.unit: thread for thread in rank_threads(system, all_units, inner_triggers.silent_ids)},
        jobs,
        job_numbers,
        {
            # Also of what takes no time: an event that waits for its turn here has not led to what comes after.
            unit: frozenset(way.entry for name in unit for way in ways_to.get(name, ()))
            for unit in all_units
        },
        {
            unit: min(find_thread_count(system, unit[0]) or resource.cores, resource.cores)
            for unit in all_units
            if fills_cores(system, system.activities[unit[0]])
        },
    )


def find_ways_anew(
    system: TimingSystem, inner_triggers: InnerTriggers
) -> tuple[InnerTriggers, dict[str, tuple[EntryWay, ...]]]:
    """Return the ways to each activity, and the triggers without those into what too many ways lead to."""
    ways_to = find_entry_ways(system, inner_triggers, number_arcs(inner_triggers)[0])
    crowded_ids = frozenset(
        name
        for name, ways in ways_to.items()
        if ways[0].entry == EventOrigin("activity", name) and name not in inner_triggers.entry_ids
    )
    if crowded_ids:
        inner_triggers = begin_anew(inner_triggers, crowded_ids)
        ways_to = find_entry_ways(system, inner_triggers, number_arcs(inner_triggers)[0])
    return inner_triggers, ways_to


def begin_anew(inner_triggers: InnerTriggers, crowded_ids: Collection[str]) -> InnerTriggers:
    """Let some activities be fired as their own event models say."""
    return replace(
        inner_triggers,
        entry_ids=inner_triggers.entry_ids.union(crowded_ids),
        inner_arcs={name: arcs for name, arcs in inner_triggers.inner_arcs.items() if name not in crowded_ids},
        outer_arcs={name: arcs for name, arcs in inner_triggers.outer_arcs.items() if name not in crowded_ids},
    )


def _find_crowds(system: TimingSystem, names: Iterable[str], core_count: int) -> dict[str, tuple[str, int]]:
    """Return for each activity that may wait for one of several threads the process, and how many it has.

    What is reentrant and has as many threads as it asks for is a crowd of its own: its activations fill all cores.
    """
    activities = [system.activities[name] for name in names]
    crowd_of = {name: (pool.key, pool.threads or 1) for name, pool in find_crowded_pools(system, activities).items()}
    for activity in activities:
        if fills_cores(system, activity):
            crowd_of.setdefault(activity.id, (f"activity {activity.id}", core_count))
    return crowd_of


def _list_jobs(
    system: TimingSystem,
    cascades: LevelCascades,
    ways_to: Mapping[str, tuple[EntryWay, ...]],
    unit_of: Mapping[str, ThreadUnit],
    foreign_ids: Iterable[str],
) -> Iterator[ThreadJob]:
    """Yield the work that each way brings, and that of what works elsewhere too."""
    for name, ways in ways_to.items():
        cost = system.activities[name].wcet
        for number, way in enumerate(ways):
            if cost and cascades.volumes.get(way.entry):
                yield ThreadJob((name, number), way.entry, cost * way.multiplicity, unit_of[name], way.steps)
    for name in foreign_ids:
        origin = EventOrigin("activity", name)
        if cascades.volumes.get(origin):
            yield ThreadJob((name, 0), origin, system.activities[name].wcet or 0, unit_of[name], (name,))
