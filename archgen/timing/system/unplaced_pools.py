"""Processes that nobody placed on a host: their threads have dedicated cores."""

from __future__ import annotations

from collections import defaultdict

from archgen.timing.system.thread_pools import ThreadPool, find_pool, is_crowded
from archgen.timing.system.timing_system import Activity, TimingSystem


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
