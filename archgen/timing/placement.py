"""Who shares a processor with whom: activities in units (threads), units on cores.

A core to which something is pinned is kept for what is pinned there; all else shares the cores that are left. Where none
is left, what is not pinned may run anywhere, and gets in the way everywhere.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

from archgen.timing.rings import components
from archgen.timing.system import Activity, System

Unit = tuple[str, ...]
"""Activities that one thread runs, one after the other."""


@dataclass(frozen=True, slots=True)
class Resource:
    """Cores that some units share. `foreign` are units that are analysed elsewhere, and may run here.

    `joined`: some wait for the threads of a container that units on other cores hold. All that runs on any of these cores is
    `foreign` then, and only this is sure: while one of them waits, one of the cores works.
    """

    id: str
    host: str | None
    cores: int
    units: tuple[Unit, ...]
    foreign: tuple[Unit, ...] = ()
    assumptions: tuple[str, ...] = ()
    joined: bool = False

    @property
    def members(self) -> tuple[str, ...]:
        """Name the activities whose responses are found here."""
        return tuple(activity for unit in self.units for activity in unit)


def resources(system: System) -> tuple[Resource, ...]:
    """Give the cores of all hosts, then those of containers without one.

    What has neither has a core of its own, and stands in none of them; so has each thread of a container without a host.
    """
    by_host: dict[str, list[Activity]] = defaultdict(list)
    for activity in system.activities.values():
        if activity.host is not None:
            by_host[activity.host].append(activity)
    on_hosts = (one for host, members in by_host.items() for one in _of_host(system, host, members))
    return (*on_hosts, *_of_threads(system))


def homeless(system: System) -> dict[str, list[Activity]]:
    """Give the members of each container without a host that has fewer threads than members."""
    found: dict[str, list[Activity]] = defaultdict(list)
    for activity in system.activities.values():
        if activity.host is None and activity.container is not None:
            found[activity.container].append(activity)
    return {
        name: members for name, members in found.items() if len(members) > (system.threads.get(name) or len(members))
    }


def _of_threads(system: System) -> Iterable[Resource]:
    for name, members in homeless(system).items():
        threads = system.threads.get(name) or 1
        units = (tuple(one.id for one in members),) if threads == 1 else tuple((one.id,) for one in members)
        said = f"assuming {'a dedicated core' if threads == 1 else f'{threads} dedicated cores'} for container {name}"
        yield Resource(name, None, threads, units, assumptions=(said,))


def _of_host(system: System, host: str, members: Iterable[Activity]) -> Iterable[Resource]:
    cores = system.cores.get(host)
    units = pins(system, members)
    if cores is None or cores <= 1:
        said = () if cores else (f"one core, as nobody wrote how many `{host}` has",)
        return (Resource(host, host, 1, tuple(units), assumptions=said),)
    pinned: dict[int, list[Unit]] = defaultdict(list)
    loose: list[Unit] = []
    for unit, core in units.items():
        (loose if core is None else pinned[core]).append(unit)
    return _joined(system, tuple(_shared(system, host, pinned, tuple(loose))))


def _shared(system: System, host: str, pinned: Mapping[int, list[Unit]], loose: tuple[Unit, ...]) -> Iterable[Resource]:
    cores = system.cores.get(host) or 1
    free = cores - len(pinned)
    foreign = () if free > 0 else loose
    for core, units in pinned.items():
        yield Resource(f"{host} core {core}", host, 1, tuple(units), foreign, tuple(_torn(system, units)))
    if loose and free > 0:
        kept = ("cores to which something is pinned are kept for it",) if pinned else ()
        yield Resource(host, host, free, loose, assumptions=kept)
    elif loose:
        yield Resource(host, host, cores, loose, tuple(unit for units in pinned.values() for unit in units))


def _torn(system: System, units: Iterable[Unit]) -> Iterable[str]:
    """Name the threads whose members are pinned to several cores."""
    for unit in units:
        activities = [system.activities[name] for name in unit]
        if len({one.core for one in activities if _is_pinned(system, one)}) > 1:
            yield f"container {activities[0].container} has one thread: it runs where the first pinned member is"


def _joined(system: System, found: tuple[Resource, ...]) -> Iterable[Resource]:
    """Join cores over which members of a container with fewer threads than members are spread."""
    spread = _spread(system, found)
    groups = {at: group for group in components(spread, spread.__getitem__) for at in group}
    for at, resource in enumerate(found):
        if len(groups[at]) == 1:
            yield resource
            continue
        here = [unit for other in groups[at] for unit in (*found[other].units, *found[other].foreign)]
        others = tuple(unit for unit in dict.fromkeys(here) if unit not in resource.units)
        yield replace(resource, foreign=others, joined=True)


def _spread(system: System, found: tuple[Resource, ...]) -> dict[int, list[int]]:
    """Say which cores share a container's threads with which others."""
    where: dict[str, list[int]] = defaultdict(list)
    for at, resource in enumerate(found):
        for name in resource.members:
            container = system.activities[name].container
            if container is not None and system.threads.get(container) != 1:
                where[container].append(at)
    spread: dict[int, list[int]] = {at: [] for at in range(len(found))}
    for container, places in where.items():
        if len(places) > (system.threads.get(container) or len(places)):
            for at in places:
                spread[at] += [other for other in set(places) if other != at]
    return spread


def pins(system: System, members: Iterable[Activity]) -> dict[Unit, int | None]:
    """Gather what containers with one thread run; all else runs by itself. A unit is pinned where its first pinned member is.

    What is pinned to a core that is not there may run anywhere.
    """
    threads: dict[str, list[Activity]] = {}
    for activity in members:
        alone = activity.container is None or system.threads.get(activity.container) != 1
        threads.setdefault(f"activity {activity.id}" if alone else f"container {activity.container}", []).append(
            activity
        )
    return {
        tuple(one.id for one in several): next((one.core for one in several if _is_pinned(system, one)), None)
        for several in threads.values()
    }


def _is_pinned(system: System, activity: Activity) -> bool:
    return activity.core is not None and activity.core < (system.cores.get(activity.host or "") or 1)
