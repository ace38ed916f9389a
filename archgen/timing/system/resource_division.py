"""Processing resources taken apart: what shares no work can be analysed by itself."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator

from archgen.frozen import replace
from archgen.timing.system.core_placement import ProcessingResource
from archgen.timing.system.thread_pools import (
    ThreadPool,
    ThreadUnit,
    fills_cores,
    find_crowded_pools,
    find_serial_process,
)
from archgen.timing.system.timing_system import TimingSystem


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
    crowds: dict[ThreadPool, list[ThreadUnit]] = {}
    for unit in resource.units:
        pool = crowded_pools.get(unit[0])
        if pool is not None and pool in waiting_pools:
            crowds.setdefault(pool, []).append(unit)
        # Who computes in turn with others that wait is held up by them as if it waited itself.
        elif find_serial_process(system, unit[0]) or any(system.activities[name].suspends for name in unit):
            yield (unit,)
    yield from (tuple(units) for units in crowds.values())
