"""Cores that Linux shares among threads, as far as no event counts: which threads these are, and in which groups it serves them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import NamedTuple, TypeVar

from archgen.timing.load.level_cascades import EntryWay
from archgen.timing.system.core_placement import ProcessingResource, find_fair_share
from archgen.timing.system.thread_pools import ThreadUnit, find_crowded_pools, is_reentrant
from archgen.timing.system.timing_system import TimingSystem

_Amount = TypeVar("_Amount", int, Fraction)


class ThreadGroup(NamedTuple):
    """The threads of a process: what each runs one after the other (`units`), and how many there are (`width`).

    `width` is None where there may be any number. `is_urgent`: something in it has a priority.
    """

    units: tuple[ThreadUnit, ...]
    width: int | None
    is_urgent: bool

    def cut_work(self, work: _Amount, cut: _Amount) -> _Amount:
        """Return how much of its work may come before a thread: as often `cut` as it has threads, but for urgent ones."""
        return work if self.is_urgent or self.width is None else min(work, self.width * cut)


class FairThread(NamedTuple):
    """A thread whose response is found, or a callback group of a process with several threads: then it `changes_threads`.

    `own_ids` are the activities whose work it has to wait for as its own: those of the whole process where its threads
    are too few. `rest` is what is left of its `process`.
    """

    unit: ThreadUnit
    own_ids: tuple[str, ...]
    changes_threads: bool
    process: str
    rest: ThreadGroup | None


@dataclass(frozen=True, slots=True)
class FairCores:
    """Cores that threads share fairly, as far as no event counts."""

    system: TimingSystem
    core_count: int
    lead: int
    groups: Mapping[str, ThreadGroup]
    """The threads of each process."""
    threads: tuple[FairThread, ...]
    ways_to: Mapping[str, tuple[EntryWay, ...]]


def prepare_fair_cores(
    system: TimingSystem, resource: ProcessingResource, ways_to: Mapping[str, tuple[EntryWay, ...]]
) -> FairCores | None:
    """Return what shares the cores of a resource, None where they are not shared fairly, or by a single thread."""
    share = find_fair_share(system, resource)
    units = (*resource.units, *resource.foreign_units)
    if share is None or len(units) == 1:
        return None
    groups = _group_threads(system, units)
    threads = tuple(_list_fair_threads(system, resource.units, groups))
    return FairCores(system, resource.cores, share.lead, groups, threads, ways_to) if threads else None


def _group_threads(system: TimingSystem, units: Iterable[ThreadUnit]) -> dict[str, ThreadGroup]:
    units_by_process: dict[str, list[ThreadUnit]] = {}
    width_of: dict[str, int | None] = {}
    for unit in units:
        executor = system.executors.get(system.activities[unit[0]].executor)
        key = f"activity {unit[0]}" if executor is None else executor.id
        units_by_process.setdefault(key, []).append(unit)
        # Threads that compute one at a time are several for the kernel, which serves each of them.
        width_of[key] = 1 if executor is None else executor.threads
    return {
        key: ThreadGroup(
            tuple(group),
            width_of[key],
            any(system.activities[name].priority is not None for unit in group for name in unit),
        )
        for key, group in units_by_process.items()
    }


def _list_fair_threads(
    system: TimingSystem, units: Iterable[ThreadUnit], groups: Mapping[str, ThreadGroup]
) -> Iterator[FairThread]:
    """Yield the threads without a priority, of which all execution times are known and nothing works only once.

    Not those that compute one at a time: a thread that hands over to another one wakes it up, as often as it likes.
    """
    key_of = {unit: key for key, group in groups.items() for unit in group.units}
    crowded = find_crowded_pools(system, [system.activities[name] for unit in key_of for name in unit])
    for unit in units:
        group = groups[key_of[unit]]
        is_whole = unit[0] in crowded or is_reentrant(system, system.activities[unit[0]])
        own_units = group.units if is_whole else (unit,)
        own_ids = tuple(name for each in own_units for name in each)
        activities = [system.activities[name] for name in own_ids]
        executor = system.executors.get(activities[0].executor)
        if group.is_urgent or (executor is not None and executor.is_serial):
            continue
        if any(each.wcet is None or (each.behaviour == "once" and each.wcet) for each in activities):
            continue
        rest = tuple(each for each in group.units if each not in own_units)
        yield FairThread(unit, own_ids, group.width != 1, key_of[unit], group._replace(units=rest) if rest else None)
