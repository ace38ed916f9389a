"""Changes that may prove a chain without touching a program: priorities, cores, threads and callback groups."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from fractions import Fraction

from archgen.model.architecture import Architecture
from archgen.timing.analysis import Analysis
from archgen.timing.search.change_trials import Changes, TriedChange
from archgen.timing.system.timing_system import Activity

_MAX_PRIORITY = 99
"""The most urgent priority of SCHED_FIFO."""


def list_settings(architecture: Architecture, analysis: Analysis, elements: Iterable[Activity]) -> list[Changes]:
    """Return the settings to try, those of one change first.

    They are for each element its priority, its core, the threads and the callback group for which it waits.
    """
    settings = dict.fromkeys(
        setting
        for activity in elements
        for setting in (
            *_raise_priority(analysis, activity),
            *_choose_core(analysis, activity),
            *_separate_callbacks(architecture, analysis, activity),
        )
    )
    return sorted(settings, key=len)


def _raise_priority(analysis: Analysis, activity: Activity) -> Iterator[Changes]:
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


def _choose_core(analysis: Analysis, activity: Activity) -> Iterator[Changes]:
    """Yield the core on which least is pinned, as long as one is left for what is pinned to none."""
    core_count = analysis.system.cores.get(activity.host or "")
    if not core_count or core_count == 1:
        return
    loads = dict.fromkeys(range(core_count), Fraction(0))
    has_loose_work = False
    shares = dict(analysis.hosts[activity.host or ""].activity_shares)
    for other in analysis.system.activities.values():
        if other.host == activity.host and other.id != activity.id:
            has_loose_work = has_loose_work or not other.cores
            for core in other.cores:
                loads[core] = loads.get(core, Fraction(0)) + (shares[other.id].value or Fraction(0))
    busy_cores = {core for core, load in loads.items() if load}
    best_core = min(loads, key=lambda core: (loads[core], core))
    takes_last = has_loose_work and len(busy_cores | {best_core}) == core_count
    if activity.cores != (best_core,) and not takes_last:
        yield _set_figure(activity, "core", best_core)


def _separate_callbacks(architecture: Architecture, analysis: Analysis, activity: Activity) -> Iterator[Changes]:
    """Yield what lets an element work beside others of its process: more threads, a callback group of its own, both."""
    process = analysis.system.executors.get(activity.executor)
    if process is None or process.threads is None:
        return
    section, _, process_id = process.id.partition(" ")
    members = [other for other in analysis.system.activities.values() if other.executor == activity.executor]
    groups = {(other.callback_group, None if other.callback_group else other.id) for other in members}
    more_threads = [count for count in dict.fromkeys((process.threads + 1, len(members))) if count > process.threads]
    is_ambiguous = process_id in architecture.nodes and process_id in architecture.containers
    thread_changes = [
        TriedChange(f"{section}s.{process_id}" if is_ambiguous else process_id, "threads", str(count))
        for count in more_threads
    ]
    own_groups = list(_find_own_groups(architecture, activity, members))
    # With one group, or one thread, only one callback works at a time: then both have to change.
    yield from ((change,) for change in thread_changes if len(groups) > 1)
    yield from ((change,) for change in own_groups if process.threads > 1)
    yield from (
        (change, own_group) for change in thread_changes[:1] for own_group in own_groups if process.threads == 1
    )


def _find_own_groups(
    architecture: Architecture, activity: Activity, members: Iterable[Activity]
) -> Iterator[TriedChange]:
    """Yield how an element can leave the callback group that it shares with others of its node."""
    shares_group = any(other.callback_group == activity.callback_group and other.id != activity.id for other in members)
    if activity.callback_group is not None and activity.component is not None and shares_group:
        name = activity.component.rpartition(".")[2]
        if name not in architecture.nodes[activity.node].callback_groups:
            yield TriedChange(activity.node, f"callback_groups.{name}", activity.component)
        yield TriedChange(activity.node, "reentrant", "true")


def _set_figure(activity: Activity, key: str, value: int) -> Changes:
    return (TriedChange(activity.id, f"timing.{key}", str(value)),)
