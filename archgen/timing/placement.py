"""Who shares a processor with whom: activities in units (threads), units on cores.

A core to which something is pinned is kept for what is pinned there; all else shares the cores that are left. Where none
is left, what is not pinned may run anywhere, and gets in the way everywhere.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from archgen.timing.system import Activity, System

Unit = tuple[str, ...]
"""Activities that one thread runs, one after the other."""


@dataclass(frozen=True, slots=True)
class Resource:
    """Cores that some units share. `foreign` are units that are analysed elsewhere, and may run here."""

    id: str
    host: str | None
    cores: int
    units: tuple[Unit, ...]
    foreign: tuple[Unit, ...] = ()
    assumptions: tuple[str, ...] = ()

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
    units = _units(system, members)
    if cores is None or cores <= 1:
        said = () if cores else (f"one core, as nobody wrote how many `{host}` has",)
        return (Resource(host, host, 1, tuple(units), assumptions=said),)
    pinned: dict[int, list[Unit]] = defaultdict(list)
    loose: list[Unit] = []
    for unit, core in units.items():  # what is pinned to a core that is not there may run anywhere
        (loose if core is None or core >= cores else pinned[core]).append(unit)
    return _shared(host, cores, pinned, tuple(loose))


def _shared(host: str, cores: int, pinned: Mapping[int, list[Unit]], loose: tuple[Unit, ...]) -> Iterable[Resource]:
    free = cores - len(pinned)
    foreign = () if free > 0 else loose
    for core, units in pinned.items():
        yield Resource(f"{host} core {core}", host, 1, tuple(units), foreign)
    if loose and free > 0:
        kept = ("cores to which something is pinned are kept for it",) if pinned else ()
        yield Resource(host, host, free, loose, assumptions=kept)
    elif loose:
        yield Resource(host, host, cores, loose, tuple(unit for units in pinned.values() for unit in units))


def _units(system: System, members: Iterable[Activity]) -> dict[Unit, int | None]:
    """Gather what containers with one thread run; all else runs by itself. A unit is pinned where its first pinned member is."""
    threads: dict[str, list[Activity]] = {}
    for activity in members:
        alone = activity.container is None or system.threads.get(activity.container) != 1
        threads.setdefault(f"activity {activity.id}" if alone else f"container {activity.container}", []).append(
            activity
        )
    return {
        tuple(one.id for one in several): next((one.core for one in several if one.core is not None), None)
        for several in threads.values()
    }
