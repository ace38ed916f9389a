"""On which cores of a host each thread may run."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable

from archgen.timing.system.thread_pools import (
    find_serial_process,
    find_thread_count,
    name_lane,
)
from archgen.timing.system.timing_system import Activity, TimingSystem

ThreadUnit = tuple[str, ...]
"""Activities that one thread runs, or that a callback group keeps apart: one after the other."""
CoreSet = tuple[int, ...]
"""Numbers of the cores on which something may run."""


def group_lanes(system: TimingSystem, members: Iterable[Activity]) -> tuple[ThreadUnit, ...]:
    """Return the activities of each thread, or callback group."""
    names_by_lane: dict[str, list[str]] = defaultdict(list)
    for activity in members:
        names_by_lane[name_lane(system, activity)].append(activity.id)
    return tuple(map(tuple, names_by_lane.values()))


def find_free_cores(core_count: int, pinned_sets: Iterable[CoreSet]) -> CoreSet:
    """Return the cores on which what is not pinned may run: those that are kept for nothing, else all."""
    # With a pin on every core nothing is left for what is not pinned. It may land on any core, so it interferes on each
    # one, and everything pinned interferes with it.
    kept_cores = {core_set[0] for core_set in pinned_sets if len(core_set) == 1}
    return tuple(core for core in range(core_count) if core not in kept_cores) or tuple(range(core_count))


def find_core_sets(system: TimingSystem, members: Iterable[Activity]) -> dict[ThreadUnit, CoreSet]:
    """Return the units of some activities, each with the cores to which it is pinned, none where it is not.

    A thread is pinned where its first pinned member is; a callback group is divided where its members are pinned apart. A
    pin to a core that does not exist counts as none.
    """
    core_sets: dict[ThreadUnit, CoreSet] = {}
    serial_sets: dict[str, CoreSet] = {}
    for unit in group_lanes(system, members):
        names_by_set: dict[CoreSet, list[str]] = defaultdict(list)
        for name in unit:
            names_by_set[find_cores(system, system.activities[name])].append(name)
        serial_process = find_serial_process(system, unit[0])
        if serial_process is not None:  # only one of its threads computes: where the first pinned member is
            first_set = next((core_set for core_set in names_by_set if core_set), ())
            serial_sets[serial_process] = serial_sets.get(serial_process, ()) or first_set
        if len(names_by_set) == 1 or find_thread_count(system, unit[0]) == 1:
            core_sets[unit] = next((core_set for core_set in names_by_set if core_set), ())
        else:
            core_sets |= {tuple(names): core_set for core_set, names in names_by_set.items()}
    if not serial_sets:
        return core_sets
    return {
        unit: serial_sets.get(find_serial_process(system, unit[0]) or "", core_set)
        for unit, core_set in core_sets.items()
    }


def find_cores(system: TimingSystem, activity: Activity) -> CoreSet:
    """Return the cores to which an activity is pinned, as far as its host has them."""
    cores = system.cores.get(activity.host or "")
    return tuple(core for core in activity.cores if cores is None or core < cores)
