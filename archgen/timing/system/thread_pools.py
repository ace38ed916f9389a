"""What runs one after the other: the callbacks of a thread, or of a callback group; and the threads of each process, placed or not.

On which cores of a host each thread may run.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping

from archgen.frozen import NamedTuple
from archgen.timing.system.timing_system import Activity, Arc, TimingSystem, name_queue


class ThreadPool(NamedTuple):
    """The threads of a process, `threads` None where there are as many as are asked for."""

    key: str
    threads: int | None


def find_pool(system: TimingSystem, activity: Activity) -> ThreadPool | None:
    """Return the threads that may run an activity, None where it has one of its own."""
    executor = system.executors.get(activity.executor)
    return None if executor is None else ThreadPool(executor.id, executor.parallel_threads)


def name_lane(system: TimingSystem, activity: Activity) -> str:
    """Return a name that activities share exactly where one of them waits for the other: a thread's, or a group's."""
    # Keys are prefixed, since an activity, a group and a container may have the same id.
    executor = system.executors.get(activity.executor)
    if executor is None:
        return f"activity {activity.id}"
    if executor.parallel_threads == 1:
        return executor.id
    if activity.callback_group is None:
        return f"activity {activity.id}"
    return f"group {activity.callback_group} in {executor.id}"


def is_reentrant(system: TimingSystem, activity: Activity) -> bool:
    """Whether several activations of an activity may run at once."""
    executor = system.executors.get(activity.executor)
    return executor is not None and executor.threads != 1 and activity.callback_group is None


def fills_cores(system: TimingSystem, activity: Activity) -> bool:
    """Whether several activations of an activity may compute at once."""
    return is_reentrant(system, activity) and not system.executors[activity.executor].is_serial


def find_serial_process(system: TimingSystem, name: str) -> str | None:
    """Return the process of an activity where its threads compute one at a time, and wait beside one another."""
    executor = system.executors.get(system.activities[name].executor)
    return executor.id if executor is not None and executor.is_serial and executor.suspends else None


def works_in_order(system: TimingSystem, activity: Activity) -> bool:
    """Whether the activations of an activity begin in the order in which they come, each at the end of the one before.

    Not what is reentrant, and not what several subscriptions or services fire: each of these has a queue of its own.
    """
    if is_reentrant(system, activity):
        return False
    if activity.executor not in system.executors or activity.behaviour == "periodic":
        return True
    # Whether there are several is all that is asked, and this is asked often.
    entities = ((arc.role, arc.input, name_queue(activity, arc)) for arc in list_waiting_arcs(system, activity))
    first_entity = next(entities, None)
    return all(entity == first_entity for entity in entities)


def may_skip_ticks(system: TimingSystem, activity: Activity, response: int | None) -> bool:
    """Whether a tick of an activity may come while another one waits, in an executor of ROS 2: rcl counts it as done."""
    executor = system.executors.get(activity.executor)
    if activity.behaviour != "periodic" or executor is None or executor.order != "ros2_executor":
        return False
    return response is None or response - (activity.wcet or 0) > (activity.period or 0) - activity.jitter


def count_entities(system: TimingSystem, activity: Activity) -> int:
    """Return how many callbacks of an activity wait for their turn: its clock, or each subscription and service."""
    if activity.behaviour == "periodic":
        return 1
    return len({(arc.role, arc.input, name_queue(activity, arc)) for arc in list_waiting_arcs(system, activity)})


def list_waiting_arcs(system: TimingSystem, activity: Activity) -> Iterator[Arc]:
    """Yield the arcs by which what fires an activity comes."""
    for arc in system.arcs_into.get(activity.id, ()):
        if arc.role == "request" or arc.input in activity.triggers:
            yield arc


def find_thread_count(system: TimingSystem, name: str) -> int | None:
    """Return how many threads may run an activity's process, None where there are as many as are asked for."""
    pool = find_pool(system, system.activities[name])
    return pool.threads if pool is not None else None


def find_crowded_pools(system: TimingSystem, activities: Iterable[Activity]) -> dict[str, ThreadPool]:
    """Return the pool of each of some activities that may have to wait for one of several threads, by their ids.

    That is so where a process has fewer threads than lanes; a reentrant activity takes as many as there are.
    """
    members_by_pool: dict[ThreadPool, list[Activity]] = defaultdict(list)
    for activity in activities:
        executor = system.executors.get(activity.executor)
        if executor is not None and executor.parallel_threads == 1:
            continue  # as nearly everywhere
        pool = find_pool(system, activity)
        if pool is not None and pool.threads is not None and pool.threads > 1:
            members_by_pool[pool].append(activity)
    return {
        activity.id: pool
        for pool, members in members_by_pool.items()
        if is_crowded(system, pool, members)
        for activity in members
    }


def is_crowded(system: TimingSystem, pool: ThreadPool, members: Iterable[Activity]) -> bool:
    """Whether some activities of a process may ask for more threads than it has."""
    if pool.threads is None:
        return False
    member_list = list(members)
    return len({name_lane(system, activity) for activity in member_list}) > pool.threads or any(
        is_reentrant(system, activity) for activity in member_list
    )


def find_joint_nodes(system: TimingSystem) -> Mapping[str, tuple[Activity, ...]]:
    """Return the nodes outside of containers that implement several components and have one thread, with these."""
    members_by_node: dict[str, list[Activity]] = defaultdict(list)
    for activity in system.activities.values():
        executor = system.executors.get(activity.executor)
        if activity.container is None and executor is not None and executor.threads == 1:
            members_by_node[activity.node].append(activity)
    return {node: tuple(members) for node, members in members_by_node.items() if len(members) > 1}


def find_unplaced_pools(system: TimingSystem) -> dict[ThreadPool, list[Activity]]:
    """Return the members of each process without a host that has fewer threads than there may be asked for."""
    # Where `threads` is not written, there is one for each member, and none waits for another.
    return {
        pool: members
        for pool, members in group_unplaced(system).items()
        if (pool.threads == 1 and len(members) > 1) or (pool.threads != 1 and is_crowded(system, pool, members))
    }


def group_unplaced(system: TimingSystem) -> dict[ThreadPool, list[Activity]]:
    """Return the activities without a host by the process that runs them."""
    members_by_pool: dict[ThreadPool, list[Activity]] = defaultdict(list)
    for activity in system.activities.values():
        pool = find_pool(system, activity) if activity.host is None else None
        if pool is not None:
            members_by_pool[pool].append(activity)
    return members_by_pool


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
        if len(names_by_set) == 1 or serial_process is not None or find_thread_count(system, unit[0]) == 1:
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
