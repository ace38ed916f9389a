"""Transactions: all that one event leads to on cores that fire one another in turn, over hosts, pinned cores and links."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import NamedTuple

from archgen.frozen import dataclass
from archgen.model.graph_search import find_strong_components
from archgen.timing.load.inner_core import rank_threads
from archgen.timing.load.inner_triggers import FiringArc, InnerTriggers, find_inner_triggers
from archgen.timing.load.level_cascades import EventOrigin, number_arcs
from archgen.timing.load.run_ways import EntryWay
from archgen.timing.load.shared_cores import WayKey, begin_anew, find_ways_anew
from archgen.timing.load.thread_work import ThreadWork
from archgen.timing.system.core_placement import ProcessingResource
from archgen.timing.system.core_sets import ThreadUnit
from archgen.timing.system.thread_pools import find_crowded_pools, is_reentrant
from archgen.timing.system.timing_system import Arc, TimingSystem
from archgen.timing.system.trigger_graph import TriggerGraph


class PlaceJob(NamedTuple):
    """The last step of a way, as work of a place; without a `key` it comes as the event model of the activity says."""

    name: str
    key: WayKey | None
    origin: EventOrigin
    unit: ThreadUnit
    cost: int | None
    is_foreign: bool
    """Whether it may run on other cores as well."""


@dataclass(frozen=True, slots=True)
class Place:
    """Cores that run some steps of transactions: `core_count` that share their work, or several that count as one."""

    step: str
    core_count: int
    jobs_of: Mapping[ThreadUnit, tuple[PlaceJob, ...]]
    threads: Mapping[ThreadUnit, ThreadWork]
    crowd_of: Mapping[ThreadUnit, frozenset[ThreadUnit]]
    """All units of a thread's container where that has fewer threads than there are cores, and more to run."""
    reentrant_units: frozenset[ThreadUnit]

    def find_level(self, units: Iterable[ThreadUnit]) -> int | None:
        """Return the priority of the least urgent of some threads, None where one waits for everything."""
        levels = [self.threads[unit].lowest_priority for unit in units]
        known_levels = [level for level in levels if level is not None]
        return min(known_levels) if len(known_levels) == len(levels) else None

    def list_units(self, level: int | None) -> tuple[ThreadUnit, ...]:
        """Return the threads that come in the way of what is as urgent as a level, None for all of them."""
        highest = {unit: thread.highest_priority for unit, thread in self.threads.items()}
        return tuple(unit for unit, each in highest.items() if level is None or (each is not None and each >= level))


@dataclass(frozen=True, slots=True)
class Transactions:
    """The transactions of some places: by way `paths` has the ways to all its steps, the last one included."""

    inner_triggers: InnerTriggers
    entering_arcs: tuple[FiringArc, ...]
    ways_to: Mapping[str, tuple[EntryWay, ...]]
    places: Mapping[str, Place]
    place_of: Mapping[str, str]
    unit_of: Mapping[str, ThreadUnit]
    costs: Mapping[str, int | None]
    paths: Mapping[WayKey, tuple[WayKey, ...]]
    forked_origins: frozenset[EventOrigin]
    """Of what fires several ways at once: their steps may run beside one another."""
    declared: Mapping[str, int]
    periodic_ids: frozenset[str]

    def way_of(self, key: WayKey) -> EntryWay:
        """Return the way of a key."""
        return self.ways_to[key[0]][key[1]]

    def list_foreign_ids(self) -> Iterator[str]:
        """Yield what works here and has no way of these transactions."""
        for place in self.places.values():
            yield from (job.name for jobs in place.jobs_of.values() for job in jobs if job.key is None)


def find_transactions(
    system: TimingSystem, triggers: TriggerGraph, resources: Mapping[str, ProcessingResource], firing_arcs: Iterable[Arc]
) -> list[Transactions]:
    """Return the transactions of each group of cores that fire one another in turn."""
    places = {
        step: resource
        for step, resource in resources.items()
        # A thread that waits for a resource leaves its core idle.
        if not (resource.missing or resource.waits)
    }
    placed_ids = {name for resource in resources.values() for name in resource.members}
    places |= {
        name: ProcessingResource(name, None, 1, ((name,),))
        for name, activity in system.activities.items()
        if name not in placed_ids and not activity.uses
    }
    place_of = {name: step for step, resource in places.items() for name in resource.members}
    next_places: dict[str, list[str]] = {step: [] for step in places}
    for arc in firing_arcs:
        if arc.source in place_of and arc.target in place_of:
            next_places[place_of[arc.source]].append(place_of[arc.target])
    groups = (group for group in find_strong_components(places, next_places.__getitem__) if len(group) > 1)
    found = (_build_transactions(system, triggers, {step: places[step] for step in group}) for group in groups)
    return [transactions for transactions in found if transactions is not None]


def _build_transactions(
    system: TimingSystem, triggers: TriggerGraph, resources: Mapping[str, ProcessingResource]
) -> Transactions | None:
    units = tuple(unit for resource in resources.values() for unit in resource.units)
    # With two cores: what comes to a gate has an event model of its own.
    whole = ProcessingResource("", None, 2, units)
    inner_triggers = find_inner_triggers(system, triggers, whole, over_links=True)
    if inner_triggers is None:
        return None
    doubly_fired = [
        name
        for name, arcs in inner_triggers.inner_arcs.items()
        if len({each.arc.source for each in arcs}) < len(arcs)
    ]
    inner_triggers, ways_to = find_ways_anew(system, begin_anew(inner_triggers, doubly_fired))
    keys = {
        (way.entry, way.steps): (name, number) for name, ways in ways_to.items() for number, way in enumerate(ways)
    }
    paths = {
        key: tuple(keys[entry, steps[: count + 1]] for count in range(len(steps))) for (entry, steps), key in keys.items()
    }
    longest: dict[EventOrigin, tuple[str, ...]] = {}
    for entry, steps in sorted(keys, key=lambda pair: -len(pair[1])):
        longest.setdefault(entry, steps)
    members = {name for unit in units for name in unit}
    return Transactions(
        inner_triggers,
        number_arcs(inner_triggers)[1],
        ways_to,
        {
            step: _build_place(system, step, resource, inner_triggers, ways_to)
            for step, resource in resources.items()
        },
        {name: step for step, resource in resources.items() for name in resource.members},
        {name: unit for unit in units for name in unit},
        {name: system.activities[name].wcet for name in members},
        paths,
        frozenset(entry for entry, steps in keys if longest[entry][: len(steps)] != steps),
        {name: response for name in members if (response := system.activities[name].response) is not None},
        frozenset(name for name in members if system.activities[name].behaviour == "periodic"),
    )


def _build_place(
    system: TimingSystem,
    step: str,
    resource: ProcessingResource,
    inner_triggers: InnerTriggers,
    ways_to: Mapping[str, tuple[EntryWay, ...]],
) -> Place:
    units = (*resource.units, *resource.foreign_units)
    # While anything waits on joined cores, one of them works.
    core_count = 1 if resource.joined else resource.cores
    crowded_pools = find_crowded_pools(system, [system.activities[name] for unit in units for name in unit])
    pool_of = {unit: pool for unit in units if (pool := crowded_pools.get(unit[0])) and (pool.threads or 1) < core_count}
    return Place(
        step,
        core_count,
        {unit: tuple(_list_jobs(system, resource, unit, inner_triggers, ways_to)) for unit in units},
        {thread.unit: thread for thread in rank_threads(system, units, inner_triggers.silent_ids)},
        {
            unit: frozenset(other for other, other_pool in pool_of.items() if other_pool == pool)
            for unit, pool in pool_of.items()
        },
        frozenset(unit for unit in units if is_reentrant(system, system.activities[unit[0]])),
    )


def _list_jobs(
    system: TimingSystem,
    resource: ProcessingResource,
    unit: ThreadUnit,
    inner_triggers: InnerTriggers,
    ways_to: Mapping[str, tuple[EntryWay, ...]],
) -> Iterator[PlaceJob]:
    is_foreign = unit not in resource.units
    for name in unit:
        cost = system.activities[name].wcet
        if cost == 0 or name in inner_triggers.silent_ids or system.activities[name].behaviour == "once":
            continue
        if name not in ways_to:
            yield PlaceJob(name, None, EventOrigin("activity", name), unit, cost, is_foreign)
        for number, way in enumerate(ways_to.get(name, ())):
            yield PlaceJob(name, (name, number), way.entry, unit, cost, is_foreign)
