"""The system as processors see it: callbacks that store inputs are activities too, and an order may ignore priorities."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from archgen.frozen import replace
from archgen.model.declared_timing import SchedulingOrder
from archgen.model.graph_search import find_strong_components
from archgen.timing.system.core_placement import PREEMPTIVE_ORDERS
from archgen.timing.system.thread_pools import CoreSet, find_core_sets, find_free_cores
from archgen.timing.system.timing_system import Activity, TimingSystem, group_arcs


def build_load_system(system: TimingSystem) -> TimingSystem:
    """Return the system of what loads processors, itself where nothing differs."""
    unranked_ids = frozenset(_find_unranked(system))
    storing_activities = dict(_build_storing_activities(system))
    is_shared = any(share.other_load for share in system.fair_shares.values())
    if not unranked_ids and not storing_activities and not is_shared:
        return system
    activities = {
        name: replace(activity, priority=None) if name in unranked_ids else activity
        for name, activity in system.activities.items()
    }
    for activity in storing_activities.values():
        activities[activity.id] = replace(activity, priority=activities[_find_reader(activity)].priority)
    if is_shared:
        activities = {name: _stretch_work(system, activity) for name, activity in activities.items()}
    storing_arcs = [
        # An answer as well: for the processor it is a message like any other.
        replace(arc, target=storing_activities[arc.target, arc.input].id, role="data")
        for arc in system.arcs
        if (arc.target, arc.input) in storing_activities and arc.role != "request"
    ]
    arcs = (*system.arcs, *storing_arcs)
    outside_inputs = {
        storing.id: (key,)
        for (reader, key), storing in storing_activities.items()
        if key in system.external_inputs.get(reader, ())
    }
    return replace(
        system,
        activities=activities,
        arcs=arcs,
        arcs_into=group_arcs((arc.target, arc) for arc in arcs),
        arcs_from=group_arcs((arc.source, arc) for arc in arcs),
        external_inputs={**system.external_inputs, **outside_inputs},
    )


def _stretch_work(system: TimingSystem, activity: Activity) -> Activity:
    """Return an activity whose work takes as long as it does beside other programs, which take a share of its core."""
    share = system.fair_shares.get(activity.host or "")
    if share is None or not share.other_load or not activity.wcet:
        return activity
    left = 1 - share.other_load
    return replace(activity, wcet=-(-activity.wcet * left.denominator // left.numerator))


def name_storing_callback(reader_id: str, input_key: str) -> str:
    """Return the id of the activity that stores an input: no element has a blank in its id."""
    return f"{reader_id} stores {input_key}"


def list_storing_ids(activity: Activity) -> Iterator[str]:
    """Yield the ids of the activities that store an activity's inputs, as far as that takes time."""
    return (name_storing_callback(activity.id, key) for key, callback in activity.storing.items() if callback.wcet)


def _find_reader(storing: Activity) -> str:
    return storing.id.partition(" ")[0]


def list_written_priorities(system: TimingSystem, load_system: TimingSystem) -> dict[str, int | None]:
    """Return the priorities that are written, of storing callbacks as well: those of their readers."""
    return {
        activity.id: system.activities[_find_reader(activity)].priority for activity in load_system.activities.values()
    }


def _build_storing_activities(system: TimingSystem) -> Iterator[tuple[tuple[str, str], Activity]]:
    """Yield the activities of storing callbacks that take time, by reader and input."""
    for reader in system.activities.values():
        for key, callback in reader.storing.items():
            if callback.wcet:
                yield (
                    (reader.id, key),
                    Activity(
                        id=name_storing_callback(reader.id, key),
                        node=reader.node,
                        component=reader.component,
                        behaviour="event",
                        wcet=callback.wcet,
                        bcet=callback.bcet,
                        triggers=(key,),
                        host=reader.host,
                        container=reader.container,
                        cores=reader.cores,
                        executor=reader.executor,
                        callback_group=reader.callback_group,
                        inputs=(key,),
                        at=reader.at,
                    ),
                )


def _find_unranked(system: TimingSystem) -> Iterator[str]:
    """Yield the activities whose priority lets nobody wait who has begun: on cores of another order, or sharing with them."""
    hosts = {host for host, order in system.host_orders.items() if order not in PREEMPTIVE_ORDERS}
    hosts |= {host for (host, _), order in system.core_orders.items() if order not in PREEMPTIVE_ORDERS}
    for host in sorted(hosts):
        members = [activity for activity in system.activities.values() if activity.host == host]
        core_sets = find_core_sets(system, members)
        for core_set, names in _group_connected(system, host, core_sets):
            if any(order_of_core(system, host, core) not in PREEMPTIVE_ORDERS for core in core_set):
                yield from names


def _group_connected(
    system: TimingSystem, host: str, core_sets: Mapping[tuple[str, ...], CoreSet]
) -> Iterator[tuple[CoreSet, list[str]]]:
    """Yield the cores of a host that are linked by what may run on several of them, with what runs there."""
    all_cores = tuple(
        range(system.cores.get(host) or 1 + max((max(each, default=0) for each in core_sets.values()), default=0))
    )
    free_cores = find_free_cores(len(all_cores), core_sets.values())
    allowed_sets = {unit: core_set or free_cores for unit, core_set in core_sets.items()}
    neighbours: dict[int, list[int]] = {core: [] for core in all_cores}
    for core_set in allowed_sets.values():
        for core in core_set:
            neighbours[core] += [core_set[0], *core_set]
            neighbours[core_set[0]].append(core)
    for cores in find_strong_components(neighbours, neighbours.__getitem__):
        members = set(cores)
        names = [name for unit, core_set in allowed_sets.items() if core_set[0] in members for name in unit]
        if names:
            yield tuple(cores), names


def order_of_core(system: TimingSystem, host: str, core: int) -> SchedulingOrder | None:
    """Return the order that is written for a core, or for its host."""
    return system.core_orders.get((host, core), system.host_orders.get(host))
