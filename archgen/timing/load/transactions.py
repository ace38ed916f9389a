"""Transactions: all that one event leads to on cores that fire one another in turn, over hosts, pinned cores and links."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from archgen.frozen import NamedTuple, dataclass
from archgen.model.graph_search import find_strong_components
from archgen.timing.load.inner_core import rank_threads
from archgen.timing.load.inner_triggers import FiringArc, InnerTriggers, find_inner_triggers
from archgen.timing.load.level_cascades import EntryWay, EventOrigin, number_arcs
from archgen.timing.load.shared_cores import WayKey, begin_anew, find_ways_anew
from archgen.timing.load.thread_work import ThreadWork
from archgen.timing.system.core_placement import ProcessingResource
from archgen.timing.system.thread_pools import ThreadUnit, find_crowded_pools, find_serial_process, is_reentrant
from archgen.timing.system.timing_system import Arc, TimingSystem
from archgen.timing.system.trigger_graph import TriggerGraph


class PlaceJob(NamedTuple):
    """The last step of a way, as work of a place; without a `key` it comes as the event model of the activity says."""

    name: str
    key: WayKey | None
    origin: EventOrigin
    unit: ThreadUnit
    cost: int | None


@dataclass(frozen=True, slots=True)
class Place:
    """Cores that run some steps of transactions: those that share their work, or one that stands for several."""

    step: str
    core_count: int
    jobs_of: Mapping[ThreadUnit, tuple[PlaceJob, ...]]
    thread_of: Mapping[str, ThreadWork]

    def list_units(self, names: Iterable[str]) -> tuple[ThreadUnit, ...]:
        """Return the threads that come in the way of some activities: those as urgent as the least urgent of them."""
        levels = [self.thread_of[name].lowest_priority for name in names]
        known_levels = [level for level in levels if level is not None]
        threads = {thread.unit: thread.highest_priority for thread in self.thread_of.values()}
        if len(known_levels) < len(levels):
            return tuple(threads)
        return tuple(unit for unit, highest in threads.items() if highest is not None and highest >= min(known_levels))


@dataclass(frozen=True, slots=True)
class Transactions:
    """The transactions of some places: their ways, and for each (`paths`) the ways to all its steps, itself included."""

    system: TimingSystem
    inner_triggers: InnerTriggers
    entering_arcs: tuple[FiringArc, ...]
    ways_to: Mapping[str, tuple[EntryWay, ...]]
    ways: Mapping[WayKey, EntryWay]
    paths: Mapping[WayKey, tuple[WayKey, ...]]
    places: Mapping[str, Place]
    place_of: Mapping[str, str]
    forked_origins: frozenset[EventOrigin]
    """Of what fires several ways at once: their steps may run beside one another."""

    @property
    def outer_ids(self) -> tuple[str, ...]:
        """Return what fires something here, or works here, and has no way of these transactions."""
        jobs = (job for place in self.places.values() for jobs in place.jobs_of.values() for job in jobs)
        foreign_ids = (job.name for job in jobs if job.key is None)
        return tuple(dict.fromkeys((*self.inner_triggers.outer_sources, *foreign_ids)))


def find_transactions(
    system: TimingSystem,
    triggers: TriggerGraph,
    resources: Mapping[str, ProcessingResource],
    firing_arcs: Iterable[Arc],
) -> Iterator[Transactions]:
    """Yield the transactions of each group of cores that fire one another in turn."""
    # A thread that waits for a resource leaves its core idle.
    places = {step: resource for step, resource in resources.items() if not (resource.missing or resource.waits)}
    placed_ids = {name for resource in resources.values() for name in resource.members}
    places |= {
        name: ProcessingResource(name, None, 1, ((name,),))
        for name, activity in system.activities.items()
        if name not in placed_ids and not activity.suspends
    }
    place_of = {name: step for step, resource in places.items() for name in resource.members}
    next_places: dict[str, list[str]] = {step: [] for step in places}
    for arc in firing_arcs:
        if arc.source in place_of and arc.target in place_of:
            next_places[place_of[arc.source]].append(place_of[arc.target])
    for group in find_strong_components(places, next_places.__getitem__):
        # With two cores: what comes to a gate has an event model of its own.
        whole = ProcessingResource("", None, 2, tuple(unit for step in group for unit in places[step].units))
        inner_triggers = find_inner_triggers(system, triggers, whole, over_links=True) if len(group) > 1 else None
        if inner_triggers is not None:
            yield _build_transactions(system, inner_triggers, {step: places[step] for step in group})


def _build_transactions(
    system: TimingSystem, inner_triggers: InnerTriggers, resources: Mapping[str, ProcessingResource]
) -> Transactions:
    doubly_fired = (
        name for name, arcs in inner_triggers.inner_arcs.items() if len({each.arc.source for each in arcs}) < len(arcs)
    )
    inner_triggers, ways_to = find_ways_anew(system, begin_anew(inner_triggers, tuple(doubly_fired)))
    ways = {(name, number): way for name, name_ways in ways_to.items() for number, way in enumerate(name_ways)}
    keys = {(way.entry, way.steps): key for key, way in ways.items()}
    longest: dict[EventOrigin, tuple[str, ...]] = {}
    for entry, steps in sorted(keys, key=lambda pair: -len(pair[1])):
        longest.setdefault(entry, steps)
    return Transactions(
        system,
        inner_triggers,
        number_arcs(inner_triggers)[1],
        ways_to,
        ways,
        {
            key: tuple(keys[way.entry, way.steps[: count + 1]] for count in range(len(way.steps)))
            for key, way in ways.items()
        },
        {step: _build_place(system, step, resource, inner_triggers, ways) for step, resource in resources.items()},
        {name: step for step, resource in resources.items() for name in resource.members},
        frozenset(entry for entry, steps in keys if longest[entry][: len(steps)] != steps),
    )


def _build_place(
    system: TimingSystem,
    step: str,
    resource: ProcessingResource,
    inner_triggers: InnerTriggers,
    ways: Mapping[WayKey, EntryWay],
) -> Place:
    units = (*resource.units, *resource.foreign_units)
    members = [system.activities[name] for unit in units for name in unit]
    # While anything waits for a core, or for one of too few threads, one of the cores works.
    is_one = (
        resource.joined
        or any((pool.threads or 1) < resource.cores for pool in find_crowded_pools(system, members).values())
        or any(is_reentrant(system, each) or find_serial_process(system, each.id) for each in members)
    )
    keys_of: dict[str, list[WayKey]] = {}
    for key in ways:
        keys_of.setdefault(key[0], []).append(key)
    jobs_of: dict[ThreadUnit, tuple[PlaceJob, ...]] = {}
    for unit in units:
        working_ids = [
            name for name in unit if system.activities[name].wcet != 0 and name not in inner_triggers.silent_ids
        ]
        jobs_of[unit] = tuple(
            PlaceJob(
                name, key, ways[key].entry if key else EventOrigin("activity", name), unit, system.activities[name].wcet
            )
            for name in working_ids
            for key in keys_of.get(name, (None,))
        )
    threads = rank_threads(system, units, inner_triggers.silent_ids)
    return Place(
        step, 1 if is_one else resource.cores, jobs_of, {name: thread for thread in threads for name in thread.unit}
    )
