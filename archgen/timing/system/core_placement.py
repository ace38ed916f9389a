"""Who shares a processor with whom: activities in units (one thread, or one callback group, each), units on cores.

A core to which something is pinned alone is kept for what is pinned there; everything else shares the remaining cores.
Where none remains, what is not pinned may run anywhere, and interferes everywhere. A set of cores keeps nobody away: what
is pinned to one shares it with all that may run on any of its cores. On a host of which nobody wrote how many cores
it has, only what is pinned has a core that is known, and a single thread, which uses one however many there are.

Hosts that share their cores fairly, as Linux does: which they are, and what is assumed where nobody wrote it.

Processing resources are taken apart: what shares no work can be analysed by itself.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from fractions import Fraction

from archgen.frozen import dataclass, replace
from archgen.model.declared_timing import ASSUMED_LEAD, ASSUMED_SLICE, ASSUMED_TICK, FairScheduling
from archgen.model.deployment import Host
from archgen.model.graph_search import find_strong_components
from archgen.timing.figures.tick_unit import TickUnit
from archgen.timing.system.thread_pools import (
    CoreSet,
    ThreadPool,
    ThreadUnit,
    fills_cores,
    find_core_sets,
    find_cores,
    find_crowded_pools,
    find_free_cores,
    find_pool,
    find_serial_process,
    find_unplaced_pools,
    group_lanes,
    group_unplaced,
    name_lane,
)
from archgen.timing.system.timing_system import Activity, FairShare, TimingSystem


@dataclass(frozen=True, slots=True)
class ProcessingResource:
    """Cores that some units share. `foreign_units` are analysed elsewhere, but may run here.

    Those of them that may have begun on a core that is none of these are the `roaming_units`.

    `joined`: some unit here waits for a thread of a container that units on other cores hold. Then all that runs on any
    of these cores is foreign, for only one thing is sure: while one of them waits, one of the cores works.
    `missing` is what nobody wrote, and without which no response is found here: `cores` is 1 then, and means nothing.
    """

    id: str
    host: str | None
    cores: int
    units: tuple[ThreadUnit, ...]
    foreign_units: tuple[ThreadUnit, ...] = ()
    roaming_units: tuple[ThreadUnit, ...] = ()
    assumptions: tuple[str, ...] = ()
    joined: bool = False
    missing: tuple[str, ...] = ()
    core_set: CoreSet = ()
    """The numbers of the cores, where they are known."""
    undisturbed: bool = False
    """One thread, of no more threads than there are cores: it always has one to itself."""
    neighbour_units: tuple[ThreadUnit, ...] = ()
    """Those of `foreign_units` that have no other cores than these: their responses are found in another part."""
    waits: bool = False
    """One thread, or the members of one container, that keep the thread while they wait for a resource such as a GPU."""

    @property
    def stranger_units(self) -> tuple[ThreadUnit, ...]:
        """Return the units that may run here and elsewhere."""
        neighbours = frozenset(self.neighbour_units)
        return tuple(unit for unit in self.foreign_units if unit not in neighbours)

    @property
    def members(self) -> tuple[str, ...]:
        """Return the ids of the activities whose responses are found here."""
        return tuple(activity for unit in self.units for activity in unit)


def find_resources(system: TimingSystem) -> tuple[ProcessingResource, ...]:
    """Return the resources of all hosts, then those of crowded containers without a host.

    An activity with neither has a core of its own and belongs to no resource; so does one whose container has a thread
    for each member.
    """
    activities_by_host: dict[str, list[Activity]] = defaultdict(list)
    for activity in system.activities.values():
        if activity.host is not None:
            activities_by_host[activity.host].append(activity)
    on_hosts = (
        resource
        for host, members in activities_by_host.items()
        for resource in _resources_of_host(system, host, members)
    )
    return (*on_hosts, *_resources_of_pools(system))


def _resources_of_pools(system: TimingSystem) -> Iterable[ProcessingResource]:
    """Yield a resource for each process without a host in which one may wait for another, with dedicated cores."""
    unplaced_pools = find_unplaced_pools(system)
    for pool, members in group_unplaced(system).items():
        units = group_lanes(system, members)
        is_serial = find_serial_process(system, members[0].id) is not None
        if pool not in unplaced_pools and len(units) == len(members) and not (is_serial and len(units) > 1):
            continue
        cores = 1 if is_serial else (pool.threads if pool in unplaced_pools else None) or len(units)
        assumption = f"assuming {'a dedicated core' if cores == 1 else f'{cores} dedicated cores'} for {pool.key}"
        name = pool.key.partition(" ")[2]
        yield ProcessingResource(name, None, cores, units, assumptions=(assumption,))


def _resources_of_host(system: TimingSystem, host: str, members: Iterable[Activity]) -> Iterable[ProcessingResource]:
    """Return the resources of a host: one for its only core, else one for each set of cores, and one for the rest."""
    cores, lanes = system.cores.get(host), group_lanes(system, members)
    # One thread uses one core, however many there are.
    if cores == 1 or (cores is None and _count_working(system, lanes) <= 1):
        return (ProcessingResource(host, host, 1, lanes, core_set=(0,)),)
    core_sets = find_core_sets(system, members)
    pinned_units: dict[CoreSet, list[ThreadUnit]] = defaultdict(list)
    unpinned_units: list[ThreadUnit] = []
    for unit, core_set in core_sets.items():
        (pinned_units[core_set] if core_set else unpinned_units).append(unit)
    place_units = _pinned_and_shared if cores is not None else _pinned_and_open
    return _join_resources(system, tuple(place_units(system, host, pinned_units, tuple(unpinned_units))))


def _count_working(system: TimingSystem, units: Iterable[ThreadUnit]) -> int:
    """Return how many threads need a core for some time."""
    # What is reentrant works on several cores at once.
    return sum(
        1 + fills_cores(system, system.activities[unit[0]])
        for unit in units
        if any(system.activities[name].wcet != 0 for name in unit)
    )


def _pinned_and_open(
    system: TimingSystem,
    host: str,
    pinned_units: Mapping[CoreSet, list[ThreadUnit]],
    unpinned_units: tuple[ThreadUnit, ...],
) -> Iterable[ProcessingResource]:
    """Yield the resources of a host of which nobody wrote how many cores it has: only pinned cores are known."""
    missing = (name_missing_cores(host),) if unpinned_units else ()
    # A pin to core 3 says that there are cores 0 to 3. If one of them is left, what is not pinned runs there, or on others
    # that nobody wrote, and disturbs nothing that is pinned. A set of cores it may disturb.
    pinned_cores = {core for core_set in pinned_units for core in core_set}
    is_core_left = len(pinned_cores) <= max(pinned_cores, default=-1)
    for resource in _pinned_resources(system, host, pinned_units):
        yield replace(resource, missing=() if is_core_left and resource.cores == 1 else missing)
    if unpinned_units:
        yield ProcessingResource(host, host, 1, unpinned_units, missing=missing)


def _pinned_resources(
    system: TimingSystem, host: str, units_by_set: Mapping[CoreSet, list[ThreadUnit]]
) -> Iterable[ProcessingResource]:
    """Yield the resource of each set of cores; what is foreign there are the units of all sets that share a core."""
    for core_set, units in units_by_set.items():
        foreign_units = tuple(
            unit
            for other_set, other_units in units_by_set.items()
            if other_set != core_set and not set(core_set).isdisjoint(other_set)
            for unit in other_units
        )
        yield ProcessingResource(
            _name_cores(system, host, core_set),
            host,
            len(core_set),
            tuple(units),
            foreign_units,
            foreign_units,
            tuple(_torn_thread_notes(system, units)),
            core_set=core_set,
        )


def _name_cores(system: TimingSystem, host: str, core_set: CoreSet) -> str:
    if len(core_set) == system.cores.get(host):
        return host
    return f"{host} core {core_set[0]}" if len(core_set) == 1 else f"{host} cores {', '.join(map(str, core_set))}"


_MISSING_CORES = "cores of "


def name_missing_cores(host: str) -> str:
    """Return what is missing where nobody wrote how many cores a host has: `cores of pc`."""
    return f"{_MISSING_CORES}{host}"


def is_missing_cores(missing_name: str) -> bool:
    """Whether what is missing is a number of cores: no element has a blank in its id."""
    return missing_name.startswith(_MISSING_CORES)


def _pinned_and_shared(
    system: TimingSystem,
    host: str,
    pinned_units: Mapping[CoreSet, list[ThreadUnit]],
    unpinned_units: tuple[ThreadUnit, ...],
) -> Iterable[ProcessingResource]:
    """Yield the cores to which something is pinned, then the cores that everything else shares."""
    cores = system.cores.get(host) or 1
    free_cores = find_free_cores(cores, pinned_units)
    units_by_set = dict(pinned_units)
    if unpinned_units:
        # A set may be all the cores that are left: then a group that was divided is one again.
        names = [name for unit in (*units_by_set.pop(free_cores, ()), *unpinned_units) for name in unit]
        units_by_set[free_cores] = list(group_lanes(system, [system.activities[name] for name in names]))
    for resource in _pinned_resources(system, host, units_by_set):
        is_rest = bool(unpinned_units) and resource.core_set == free_cores
        kept_notes = ("cores to which something is pinned are kept for it",) if len(free_cores) < cores else ()
        yield replace(resource, id=host, assumptions=kept_notes) if is_rest else resource


def _torn_thread_notes(system: TimingSystem, units: Iterable[ThreadUnit]) -> Iterable[str]:
    """Yield an assumption for each thread whose members are pinned to several cores."""
    for unit in units:
        activities = [system.activities[name] for name in unit]
        if len({core_set for activity in activities if (core_set := find_cores(system, activity))}) > 1:
            pool = find_pool(system, activities[0])
            yield f"{pool.key if pool else activities[0].id} has one thread: it runs where the first pinned member is"


def _join_resources(
    system: TimingSystem, host_resources: tuple[ProcessingResource, ...]
) -> Iterable[ProcessingResource]:
    """Join the cores over which members are spread of a callback group, or of a process with too few threads."""
    # A member may wait for a thread that is held by a member on another core, and that one for its core: the wait
    # crosses cores, so that the work of all joined cores bounds it (tests/timing/test_shared_threads.py has an example
    # of 11 ms).
    neighbours = _cores_sharing_threads(system, host_resources)
    groups = {
        position: group for group in find_strong_components(neighbours, neighbours.__getitem__) for position in group
    }
    for position, resource in enumerate(host_resources):
        if len(groups[position]) == 1:
            yield resource
            continue
        joined_resources = [host_resources[other_position] for other_position in groups[position]]
        own_units = dict.fromkeys(unit for joined in joined_resources for unit in joined.units)
        foreign_units = dict.fromkeys(
            unit for joined in joined_resources for unit in (*joined.units, *joined.foreign_units)
        )
        yield replace(
            resource,
            foreign_units=tuple(unit for unit in foreign_units if unit not in resource.units),
            roaming_units=tuple(unit for unit in foreign_units if unit not in own_units),
            joined=True,
        )


def _cores_sharing_threads(
    system: TimingSystem, host_resources: tuple[ProcessingResource, ...]
) -> dict[int, list[int]]:
    """Return for each resource, by position, those that share a callback group or the threads of a process with it."""
    members = [system.activities[name] for resource in host_resources for name in resource.members]
    crowded_pools = find_crowded_pools(system, members)
    positions_by_pool: dict[ThreadPool | str, dict[int, None]] = defaultdict(dict)
    for position, resource in enumerate(host_resources):
        for name in resource.members:
            positions_by_pool[name_lane(system, system.activities[name])][position] = None
            if name in crowded_pools:
                positions_by_pool[crowded_pools[name]][position] = None
    neighbours: dict[int, list[int]] = {position: [] for position in range(len(host_resources))}
    for positions in positions_by_pool.values():
        for position in positions:
            neighbours[position] += [other_position for other_position in positions if other_position != position]
    return neighbours


PREEMPTIVE_ORDERS = frozenset({None, "fair", "fixed_priority"})
"""The orders of a host on which what has a priority preempts all that is less urgent."""


def build_fair_share(host: Host, tick_unit: TickUnit) -> FairShare:
    """Return how a host shares its cores, with what is assumed of it."""
    written = host.fair or FairScheduling()
    slice_time, tick_time = written.slice or ASSUMED_SLICE, written.tick or ASSUMED_TICK
    lead = written.lead or ASSUMED_LEAD
    figures = f"{lead} times a slice of {slice_time} and a tick of {tick_time}"
    is_all_written = None not in (host.scheduling, written.slice, written.tick, written.lead)
    turn = tick_unit.ns_to_ticks(slice_time.value + tick_time.value)
    other_load = written.other_load or Fraction(0)
    left = 1 - other_load
    return FairShare(
        # What is served takes longer beside other programs, a lead as well.
        -(-lead * turn * left.denominator // left.numerator),
        turn,
        other_load,
        "" if is_all_written else f"threads of {host.id} lead one another by at most {figures}",
        figures,
    )


def find_fair_share(system: TimingSystem, resource: ProcessingResource) -> FairShare | None:
    """Return how the threads of a resource share its cores; None where their order is another one, or not the same."""
    # What may run on other cores as well, or waits for what does, is served elsewhere too: nothing is proven of it.
    if resource.joined or resource.missing or resource.stranger_units:
        return None
    host = resource.host or ""
    orders = {
        order
        for (name, core), order in system.core_orders.items()
        if name == host and (core in resource.core_set or not resource.core_set)
    }
    return system.fair_shares.get(host) if orders <= {"fair"} else None


def split_resources(system: TimingSystem, resource_list: Iterable[ProcessingResource]) -> Iterator[ProcessingResource]:
    """Yield the parts of resources whose responses are found at once."""
    for resource in resource_list:
        for part in divide_resource(system, resource):
            yield from part_waiting_units(system, part)


def divide_resource(system: TimingSystem, resource: ProcessingResource) -> Iterable[ProcessingResource]:
    """Yield one core for each thread where there are cores enough for all of them, else the resource as it is.

    A process of which members wait for threads has as many cores as threads.
    """
    if resource.cores == 1 or resource.joined or resource.foreign_units:
        return (resource,)
    members = [system.activities[name] for name in resource.members]
    crowded_pools = find_crowded_pools(system, members)
    if any(fills_cores(system, activity) and activity.id not in crowded_pools for activity in members):
        return (resource,)  # as many threads as are asked for
    units_by_process: dict[tuple[str, int], list[ThreadUnit]] = defaultdict(list)
    lone_units: list[ThreadUnit] = []
    for unit in resource.units:
        serial_process = find_serial_process(system, unit[0])
        if serial_process is not None:
            units_by_process[serial_process, 1].append(unit)
        elif unit[0] in crowded_pools:
            pool = crowded_pools[unit[0]]
            units_by_process[pool.key, pool.threads or 1].append(unit)
        else:
            lone_units.append(unit)
    if len(lone_units) + sum(cores for _, cores in units_by_process) > resource.cores:
        return (resource,)
    return (
        *(replace(resource, cores=1, units=(unit,), undisturbed=True) for unit in lone_units),
        *(replace(resource, cores=cores, units=tuple(units)) for (_, cores), units in units_by_process.items()),
    )


def part_waiting_units(system: TimingSystem, resource: ProcessingResource) -> Iterable[ProcessingResource]:
    """Yield a part for each thread that waits for resources, and one for all others; the resource where none waits."""
    is_waiting = any(
        system.activities[name].suspends for unit in (*resource.units, *resource.foreign_units) for name in unit
    )
    waiting_threads = tuple(_find_waiting_threads(system, resource)) if is_waiting else ()
    if not waiting_threads or resource.missing:
        yield resource
        return
    waiting_units = tuple(unit for units in waiting_threads for unit in units)
    waiting_ids = {name for unit in waiting_units for name in unit}
    other_units = tuple(unit for unit in resource.units if unit[0] not in waiting_ids)
    if other_units:
        yield replace(
            resource,
            units=other_units,
            foreign_units=(*resource.foreign_units, *waiting_units),
            roaming_units=(*resource.roaming_units, *waiting_units),
            neighbour_units=waiting_units,
        )
    for units in waiting_threads:
        neighbours = (*other_units, *(unit for unit in waiting_units if unit not in units))
        yield replace(
            resource,
            # Among one another they wait for threads as if there was one: all of their work lies in one busy window.
            units=(tuple(name for unit in units for name in unit),),
            foreign_units=(*resource.foreign_units, *neighbours),
            neighbour_units=neighbours,
            waits=True,
        )


def _find_waiting_threads(system: TimingSystem, resource: ProcessingResource) -> Iterable[tuple[ThreadUnit, ...]]:
    """Yield the units that wait for resources, each alone, and together those of a process with too few threads, which
    wait for one another. To all others they stay as many: several of its threads run at once.
    """
    all_members = [system.activities[name] for unit in (*resource.units, *resource.foreign_units) for name in unit]
    crowded_pools = find_crowded_pools(system, all_members)
    waiting_pools = {
        crowded_pools[activity.id] for activity in all_members if activity.suspends and activity.id in crowded_pools
    }
    waiting_lanes = {name_lane(system, activity) for activity in all_members if activity.suspends}
    crowds: dict[ThreadPool, list[ThreadUnit]] = {}
    for unit in resource.units:
        pool = crowded_pools.get(unit[0])
        if pool is not None and pool in waiting_pools:
            crowds.setdefault(pool, []).append(unit)
        # Who computes in turn with others that wait, be it on another core, is held up by them as if it waited itself.
        elif find_serial_process(system, unit[0]) or name_lane(system, system.activities[unit[0]]) in waiting_lanes:
            yield (unit,)
    yield from (tuple(units) for units in crowds.values())
