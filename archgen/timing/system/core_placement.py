"""Who shares a processor with whom: activities in units (one thread each), units on cores.

A core to which something is pinned is kept for what is pinned there; everything else shares the remaining cores. Where
none remains, what is not pinned may run anywhere, and interferes everywhere. On a host of which nobody wrote how many cores
it has, only what is pinned has a core that is known, and a single thread, which uses one however many there are.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

from archgen.model.graph_search import find_strong_components
from archgen.timing.system.timing_system import Activity, TimingSystem

ThreadUnit = tuple[str, ...]
"""Activities that one thread runs, one after the other."""


@dataclass(frozen=True, slots=True)
class ProcessingResource:
    """Cores that some units share. `foreign_units` are analysed elsewhere, but may run here.

    `joined`: some unit here waits for a thread of a container that units on other cores hold. Then all that runs on any
    of these cores is foreign, for only one thing is sure: while one of them waits, one of the cores works.
    `missing` is what nobody wrote, and without which no response is found here: `cores` is 1 then, and means nothing.
    """

    id: str
    host: str | None
    cores: int
    units: tuple[ThreadUnit, ...]
    foreign_units: tuple[ThreadUnit, ...] = ()
    assumptions: tuple[str, ...] = ()
    joined: bool = False
    missing: tuple[str, ...] = ()
    undisturbed: bool = False
    """One thread, of no more threads than there are cores: it always has one to itself."""
    neighbour_units: tuple[ThreadUnit, ...] = ()
    """Those of `foreign_units` that have no other cores than these: their responses are found in another part."""
    waits: bool = False
    """One thread, or the members of one container, that keep the thread while they wait for a resource such as a GPU."""

    @property
    def stranger_units(self) -> tuple[ThreadUnit, ...]:
        """Return the units that may run here and elsewhere."""
        return tuple(unit for unit in self.foreign_units if unit not in self.neighbour_units)

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
    return (*on_hosts, *_resources_of_containers(system))


def divide_resource(system: TimingSystem, resource: ProcessingResource) -> Iterable[ProcessingResource]:
    """Yield one core for each thread where there are cores enough for all of them, else the resource as it is."""
    if resource.cores == 1 or resource.joined or resource.foreign_units or len(resource.units) > resource.cores:
        return (resource,)
    containers = [system.activities[name].container for name in resource.members]
    is_crowded = any(
        container is not None and 1 < (system.threads.get(container) or 1) < containers.count(container)
        for container in containers
    )
    if is_crowded:
        return (resource,)
    return (replace(resource, cores=1, units=(unit,), undisturbed=True) for unit in resource.units)


def part_waiting_units(system: TimingSystem, resource: ProcessingResource) -> Iterable[ProcessingResource]:
    """Yield a part for each thread that waits for resources, and one for all others; the resource where none waits."""
    waiting_units = tuple(_find_waiting_units(system, resource)) if system.resources or _uses_any(system) else ()
    if not waiting_units or resource.missing:
        yield resource
        return
    waiting_ids = {name for unit in waiting_units for name in unit}
    other_units = tuple(unit for unit in resource.units if unit[0] not in waiting_ids)
    if other_units:
        yield replace(
            resource,
            units=other_units,
            foreign_units=(*resource.foreign_units, *waiting_units),
            neighbour_units=waiting_units,
        )
    for unit in waiting_units:
        neighbours = (*other_units, *(other_unit for other_unit in waiting_units if other_unit != unit))
        yield replace(
            resource,
            units=(unit,),
            foreign_units=(*resource.foreign_units, *neighbours),
            neighbour_units=neighbours,
            waits=True,
        )


def _uses_any(system: TimingSystem) -> bool:
    return any(activity.uses for activity in system.activities.values())


def _find_waiting_units(system: TimingSystem, resource: ProcessingResource) -> Iterable[ThreadUnit]:
    """Yield the units that wait for resources; the members of a container with too few threads wait for one another."""
    all_ids = [name for unit in (*resource.units, *resource.foreign_units) for name in unit]
    containers = [system.activities[name].container for name in all_ids]
    waiting_containers = {
        container
        for name, container in zip(all_ids, containers, strict=True)
        if container is not None
        and system.activities[name].uses
        and 1 < (system.threads.get(container) or 1) < containers.count(container)
    }
    crowds: dict[str, list[str]] = {}
    for unit in resource.units:
        container = system.activities[unit[0]].container
        if container in waiting_containers and container is not None:
            crowds.setdefault(container, []).extend(unit)
        elif any(system.activities[name].uses for name in unit):
            yield unit
    yield from (tuple(names) for names in crowds.values())


def find_unplaced_containers(system: TimingSystem) -> dict[str, list[Activity]]:
    """Return the members of each container without a host that has fewer threads than members."""
    members_by_container: dict[str, list[Activity]] = defaultdict(list)
    for activity in system.activities.values():
        if activity.host is None and activity.container is not None:
            members_by_container[activity.container].append(activity)
    # Where `threads` is not written, there is one for each member, and none waits for another.
    return {
        name: members
        for name, members in members_by_container.items()
        if len(members) > (system.threads.get(name) or len(members))
    }


def _resources_of_containers(system: TimingSystem) -> Iterable[ProcessingResource]:
    """Yield a resource for each crowded container without a host, with as many dedicated cores as it has threads."""
    for name, members in find_unplaced_containers(system).items():
        threads = system.threads.get(name) or 1
        units = (
            (tuple(activity.id for activity in members),)
            if threads == 1
            else tuple((activity.id,) for activity in members)
        )
        assumption = (
            f"assuming {'a dedicated core' if threads == 1 else f'{threads} dedicated cores'} for container {name}"
        )
        yield ProcessingResource(name, None, threads, units, assumptions=(assumption,))


def _resources_of_host(system: TimingSystem, host: str, members: Iterable[Activity]) -> Iterable[ProcessingResource]:
    """Return the resources of a host: one for its only core, else one per pinned core and one for the rest."""
    cores = system.cores.get(host)
    units = find_pins(system, members)
    # One thread uses one core, however many there are.
    if cores == 1 or (cores is None and _count_working(system, units) <= 1):
        return (ProcessingResource(host, host, 1, tuple(units)),)
    pinned_units: dict[int, list[ThreadUnit]] = defaultdict(list)
    unpinned_units: list[ThreadUnit] = []
    for unit, core in units.items():
        (unpinned_units if core is None else pinned_units[core]).append(unit)
    place_units = _pinned_and_shared if cores is not None else _pinned_and_open
    return _join_resources(system, tuple(place_units(system, host, pinned_units, tuple(unpinned_units))))


def _count_working(system: TimingSystem, units: Iterable[ThreadUnit]) -> int:
    """Return how many threads need a core for some time."""
    return sum(any(system.activities[name].wcet != 0 for name in unit) for unit in units)


def _pinned_and_open(
    system: TimingSystem,
    host: str,
    pinned_units: Mapping[int, list[ThreadUnit]],
    unpinned_units: tuple[ThreadUnit, ...],
) -> Iterable[ProcessingResource]:
    """Yield the resources of a host of which nobody wrote how many cores it has: only pinned cores are known."""
    missing = (name_missing_cores(host),) if unpinned_units else ()
    # A pin to core 3 says that there are cores 0 to 3. If one of them is left, what is not pinned runs there, or on others
    # that nobody wrote, and disturbs nothing that is pinned.
    is_core_left = len(pinned_units) <= max(pinned_units, default=-1)
    for core, units in pinned_units.items():
        notes = tuple(_torn_thread_notes(system, units))
        pinned_missing = () if is_core_left else missing
        yield ProcessingResource(
            f"{host} core {core}", host, 1, tuple(units), assumptions=notes, missing=pinned_missing
        )
    if unpinned_units:
        yield ProcessingResource(host, host, 1, unpinned_units, missing=missing)


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
    pinned_units: Mapping[int, list[ThreadUnit]],
    unpinned_units: tuple[ThreadUnit, ...],
) -> Iterable[ProcessingResource]:
    """Yield the pinned cores, then the cores that everything else shares."""
    cores = system.cores.get(host) or 1
    free_cores = cores - len(pinned_units)
    # With a pin on every core nothing is left for the unpinned units. They may land on any core, so they interfere on
    # each one, and everything pinned interferes with them.
    foreign_units = () if free_cores > 0 else unpinned_units
    for core, units in pinned_units.items():
        yield ProcessingResource(
            f"{host} core {core}", host, 1, tuple(units), foreign_units, tuple(_torn_thread_notes(system, units))
        )
    if unpinned_units and free_cores > 0:
        assumptions = ("cores to which something is pinned are kept for it",) if pinned_units else ()
        yield ProcessingResource(host, host, free_cores, unpinned_units, assumptions=assumptions)
    elif unpinned_units:
        yield ProcessingResource(
            host, host, cores, unpinned_units, tuple(unit for units in pinned_units.values() for unit in units)
        )


def _torn_thread_notes(system: TimingSystem, units: Iterable[ThreadUnit]) -> Iterable[str]:
    """Yield an assumption for each single-threaded container whose members are pinned to several cores."""
    for unit in units:
        activities = [system.activities[name] for name in unit]
        if len({activity.core for activity in activities if _is_pinned(system, activity)}) > 1:
            yield f"container {activities[0].container} has one thread: it runs where the first pinned member is"


def _join_resources(
    system: TimingSystem, host_resources: tuple[ProcessingResource, ...]
) -> Iterable[ProcessingResource]:
    """Join the cores over which the members of a container with fewer threads than members are spread."""
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
        joined_units = [
            unit
            for other_position in groups[position]
            for unit in (*host_resources[other_position].units, *host_resources[other_position].foreign_units)
        ]
        foreign_units = tuple(unit for unit in dict.fromkeys(joined_units) if unit not in resource.units)
        yield replace(resource, foreign_units=foreign_units, joined=True)


def _cores_sharing_threads(
    system: TimingSystem, host_resources: tuple[ProcessingResource, ...]
) -> dict[int, list[int]]:
    """Return for each resource, by position, those that share the threads of a container with it."""
    positions_by_container: dict[str, list[int]] = defaultdict(list)
    for position, resource in enumerate(host_resources):
        for name in resource.members:
            container = system.activities[name].container
            if container is not None and system.threads.get(container) != 1:
                positions_by_container[container].append(position)
    neighbours: dict[int, list[int]] = {position: [] for position in range(len(host_resources))}
    for container, positions in positions_by_container.items():
        if len(positions) > (system.threads.get(container) or len(positions)):
            for position in positions:
                neighbours[position] += [
                    other_position for other_position in dict.fromkeys(positions) if other_position != position
                ]
    return neighbours


def find_pins(system: TimingSystem, members: Iterable[Activity]) -> dict[ThreadUnit, int | None]:
    """Return the units of some activities, each with the core it is pinned to, or None.

    A container with one thread is one unit, pinned where its first pinned member is; everything else is a unit by
    itself. A pin to a core that does not exist counts as none.
    """
    # Keys are prefixed, since an activity and a container may have the same id.
    activities_by_thread: dict[str, list[Activity]] = {}
    for activity in members:
        is_alone = activity.container is None or system.threads.get(activity.container) != 1
        activities_by_thread.setdefault(
            f"activity {activity.id}" if is_alone else f"container {activity.container}", []
        ).append(activity)
    return {
        tuple(member.id for member in thread_members): next(
            (member.core for member in thread_members if _is_pinned(system, member)), None
        )
        for thread_members in activities_by_thread.values()
    }


def _is_pinned(system: TimingSystem, activity: Activity) -> bool:
    cores = system.cores.get(activity.host or "")
    return activity.core is not None and (cores is None or activity.core < cores)
