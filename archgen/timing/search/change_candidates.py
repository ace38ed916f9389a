"""Changes that may prove a chain without touching a program: priorities, cores, and threads of containers."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from archgen.model.architecture import Architecture
from archgen.timing.analysis import Analysis
from archgen.timing.search.change_trials import TriedChange
from archgen.timing.system.timing_system import Activity

_MAX_PRIORITY = 99
"""The most urgent priority of SCHED_FIFO."""


def list_settings(
    architecture: Architecture, analysis: Analysis, elements: Iterable[Activity]
) -> Iterator[TriedChange]:
    """Yield the settings to try, one by one: for each element its priority, its core, and the threads that it waits for."""
    seen: set[str] = set()
    for activity in elements:
        settings = (
            *_raise_priority(analysis, activity),
            *_choose_core(analysis, activity),
            *_add_threads(architecture, analysis, activity),
        )
        for setting in settings:
            if str(setting) not in seen:
                seen.add(str(setting))
                yield setting


def _raise_priority(analysis: Analysis, activity: Activity) -> Iterator[TriedChange]:
    """Yield the priority above all others on an element's host."""
    if activity.host is None:
        return
    others = [
        other.priority
        for other in analysis.system.activities.values()
        if other.host == activity.host and other.id != activity.id and other.priority is not None
    ]
    highest = max(others, default=0)
    if (activity.priority is None or activity.priority <= highest) and highest < _MAX_PRIORITY:
        yield _set_figure(activity, "priority", highest + 1)


def _choose_core(analysis: Analysis, activity: Activity) -> Iterator[TriedChange]:
    """Yield the core on which least is pinned, as long as one is left for what is pinned to none."""
    core_count = analysis.system.cores.get(activity.host or "")
    if not core_count or core_count == 1:
        return
    loads = dict.fromkeys(range(core_count), 0)
    has_loose_work = False
    shares = dict(analysis.hosts[activity.host or ""].activity_shares)
    for other in analysis.system.activities.values():
        if other.host == activity.host and other.id != activity.id:
            has_loose_work = has_loose_work or not other.cores
            for core in other.cores:
                loads[core] = loads.get(core, 0) + (shares[other.id].value or 0)
    busy_cores = {core for core, load in loads.items() if load}
    best_core = min(loads, key=lambda core: (loads[core], core))
    takes_last = has_loose_work and len(busy_cores | {best_core}) == core_count
    if activity.cores != (best_core,) and not takes_last:
        yield _set_figure(activity, "core", best_core)


def _add_threads(architecture: Architecture, analysis: Analysis, activity: Activity) -> Iterator[TriedChange]:
    """Yield more threads of the container that an element works in, up to one for each member."""
    container = architecture.containers.get(activity.container or "")
    if container is None or container.threads is None:
        return
    member_count = sum(other.container == activity.container for other in analysis.system.activities.values())
    for threads in dict.fromkeys((container.threads + 1, member_count)):
        if threads > container.threads:
            yield TriedChange(container.id, "threads", str(threads))


def _set_figure(activity: Activity, key: str, value: int) -> TriedChange:
    return TriedChange(activity.id, f"timing.{key}", str(value))
