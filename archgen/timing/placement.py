"""Who shares a processor with whom: activities in units (one thread each), units on cores.

A core to which something is pinned is kept for what is pinned there; everything else shares the remaining cores. Where
none remains, what is not pinned may run anywhere, and interferes everywhere.
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
    """Cores that some units share. `foreign_units` are analysed elsewhere, but may run here.

    `joined`: some unit here waits for a thread of a container that units on other cores hold. Then all that runs on any
    of these cores is foreign, for only one thing is sure: while one of them waits, one of the cores works.
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
        """Return the ids of the activities whose responses are found here."""
        return tuple(activity for unit in self.units for activity in unit)


def resources(system: System) -> tuple[Resource, ...]:
    """Return the resources of all hosts, then those of crowded containers without a host.

    An activity with neither has a core of its own and belongs to no resource; so does one whose container has a thread
    for each member.
    """
    by_host: dict[str, list[Activity]] = defaultdict(list)
    for activity in system.activities.values():
        if activity.host is not None:
            by_host[activity.host].append(activity)
    on_hosts = (one for host, members in by_host.items() for one in _of_host(system, host, members))
    return (*on_hosts, *_of_threads(system))


def homeless(system: System) -> dict[str, list[Activity]]:
    """Return the members of each container without a host that has fewer threads than members."""
    found: dict[str, list[Activity]] = defaultdict(list)
    for activity in system.activities.values():
        if activity.host is None and activity.container is not None:
            found[activity.container].append(activity)
    # Where `threads` is not written, there is one for each member, and none waits for another.
    return {
        name: members for name, members in found.items() if len(members) > (system.threads.get(name) or len(members))
    }


def _of_threads(system: System) -> Iterable[Resource]:
    """Yield a resource for each crowded container without a host, with as many dedicated cores as it has threads."""
    for name, members in homeless(system).items():
        threads = system.threads.get(name) or 1
        units = (tuple(one.id for one in members),) if threads == 1 else tuple((one.id,) for one in members)
        said = f"assuming {'a dedicated core' if threads == 1 else f'{threads} dedicated cores'} for container {name}"
        yield Resource(name, None, threads, units, assumptions=(said,))


def _of_host(system: System, host: str, members: Iterable[Activity]) -> Iterable[Resource]:
    """Return the resources of a host: one for its only core, else one per pinned core and one for the rest."""
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
    """Yield the pinned cores, then the cores that everything else shares."""
    cores = system.cores.get(host) or 1
    free = cores - len(pinned)
    # With a pin on every core nothing is left for the unpinned units. They may land on any core, so they interfere on
    # each one, and everything pinned interferes with them.
    foreign = () if free > 0 else loose
    for core, units in pinned.items():
        yield Resource(f"{host} core {core}", host, 1, tuple(units), foreign, tuple(_torn(system, units)))
    if loose and free > 0:
        kept = ("cores to which something is pinned are kept for it",) if pinned else ()
        yield Resource(host, host, free, loose, assumptions=kept)
    elif loose:
        yield Resource(host, host, cores, loose, tuple(unit for units in pinned.values() for unit in units))


def _torn(system: System, units: Iterable[Unit]) -> Iterable[str]:
    """Yield an assumption for each single-threaded container whose members are pinned to several cores."""
    for unit in units:
        activities = [system.activities[name] for name in unit]
        if len({one.core for one in activities if _is_pinned(system, one)}) > 1:
            yield f"container {activities[0].container} has one thread: it runs where the first pinned member is"


def _joined(system: System, found: tuple[Resource, ...]) -> Iterable[Resource]:
    """Join the cores over which the members of a container with fewer threads than members are spread."""
    # A member may wait for a thread that is held by a member on another core, and that one for its core: the wait
    # crosses cores, so that the work of all joined cores bounds it (tests/timing/test_shared_threads.py has an example
    # of 11 ms).
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
    """Return for each resource, by position, those that share the threads of a container with it."""
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
    """Return the units of some activities, each with the core it is pinned to, or None.

    A container with one thread is one unit, pinned where its first pinned member is; everything else is a unit by
    itself. A pin to a core that does not exist counts as none.
    """
    # Keys are prefixed, since an activity and a container may have the same id.
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
