"""What holds up the events of a way on cores that share their work, as far as no figure of events matters.

A way leads through threads. Where a thread has one step of the way, the events pass it one after the other, in order: so of
several events in a row, one after the other waits at one step only (the slowest), and not at each of them.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from archgen.timing.load.level_cascades import EventOrigin
from archgen.timing.load.run_ways import EntryWay
from archgen.timing.load.shared_cores import SharedCores, ThreadJob, WayKey

_WayName = tuple[EventOrigin, tuple[str, ...]]


class SharedWork(NamedTuple):
    """Work of others that a way may wait for: of each event of an origin, up to the delay of a way (`way_before`) earlier."""

    origin: EventOrigin
    work: int
    way_before: WayKey | None


class WayWork(NamedTuple):
    """A way with its work, in ticks.

    The steps with a thread that has no other step of the way (`step_works`) take `cost` together, the longest `slowest`: a
    number of events in a row takes `cost`, and `slowest` for each but one. `others` is all other work in the threads of the
    way. `crowds` are the members of each container whose threads it waits for, with the number of threads, if they are
    fewer than the cores.

    Of the work that an event leads to on these cores, `left` is not done while the last step is not, `behind` is done after
    the last step, and `from_last` is the last step and all that it leads to.
    """

    key: WayKey
    origin: EventOrigin
    step_works: tuple[tuple[str, int], ...]
    cost: int
    slowest: int
    others: tuple[SharedWork, ...]
    crowds: tuple[tuple[tuple[SharedWork, ...], int], ...]
    left: int
    behind: int
    from_last: int


def build_way_works(cores: SharedCores) -> dict[WayKey, WayWork]:
    """Return the work of each way of what works again and again, the shorter ways first."""
    return _WayWorkBuilder(cores).build()


def build_thread_work(cores: SharedCores, name: str) -> WayWork:
    """Return all work of the thread of an activity as that of a way without steps."""
    return _WayWorkBuilder(cores).build_thread(name)


class _WayWorkBuilder:
    def __init__(self, cores: SharedCores) -> None:
        self.cores = cores
        self.costs = {name: cores.system.activities[name].wcet or 0 for name in cores.unit_of}
        self.keys: dict[_WayName, WayKey] = {}
        self.jobs = {job.key: job for job in cores.jobs}
        # What works only at the start holds up nothing that comes later, and has no way.
        silent_ids = cores.inner_triggers.silent_ids
        self.unit_jobs = {
            unit: [cores.jobs[number] for number in numbers if cores.jobs[number].key[0] not in silent_ids]
            for unit, numbers in cores.job_numbers.items()
        }
        self.calls = {
            (each.arc.source, name)
            for name, firing_arcs in cores.inner_triggers.inner_arcs.items()
            for each in firing_arcs
            if each.arc.role == "request"
        }

    def build(self) -> dict[WayKey, WayWork]:
        """Build all of them."""
        ways = dict(self._list_ways())
        self.keys = {(way.entry, way.steps): key for key, way in ways.items()}
        works_from, works_behind = self._sum_rests(ways)
        done_before: dict[WayKey, int] = {}
        way_works: dict[WayKey, WayWork] = {}
        for key, way in ways.items():
            volume = self.cores.cascades.volumes.get(way.entry, 0)
            done_before[key] = self._find_done(way, done_before)
            is_single = way.multiplicity == 1
            way_works[key] = self._build_work(
                key, way, volume - done_before[key], works_behind.get(key, 0) if is_single else 0, works_from[key]
            )
        return way_works

    def build_thread(self, name: str) -> WayWork:
        """Build the work of a thread."""
        self.keys = {(way.entry, way.steps): key for key, way in self._list_ways()}
        others = [
            SharedWork(job.origin, job.work, self._find_way_before(job))
            for job in self.unit_jobs[self.cores.unit_of[name]]
        ]
        return WayWork(
            (name, 0), EventOrigin("activity", name), (), 0, 0, tuple(others), tuple(self._find_crowds([name])), 0, 0, 0
        )

    def _list_ways(self) -> Iterator[tuple[WayKey, EntryWay]]:
        for name, ways in self.cores.ways_to.items():
            if name not in self.cores.inner_triggers.silent_ids:
                for number, way in enumerate(ways):
                    yield (name, number), way

    def _find_done(self, way: EntryWay, done_before: Mapping[WayKey, int]) -> int:
        """Return the work that is done when the last step of a way is activated: of a caller nobody knows."""
        if len(way.steps) == 1:
            return 0
        before, last = way.steps[-2:]
        done = done_before[self.keys[way.entry, way.steps[:-1]]]
        return done if (before, last) in self.calls else done + self.costs[before]

    def _sum_rests(self, ways: Mapping[WayKey, EntryWay]) -> tuple[dict[WayKey, int], dict[WayKey, int]]:
        """Return the work from the last step of each way on, and that which begins when it has ended."""
        works_from = {key: self.costs[way.steps[-1]] * way.multiplicity for key, way in ways.items()}
        works_behind: dict[WayKey, int] = {}
        for key, way in sorted(ways.items(), key=lambda pair: -len(pair[1].steps)):
            if len(way.steps) > 1:
                key_before = self.keys[way.entry, way.steps[:-1]]
                works_from[key_before] += works_from[key]
                if way.steps[-2:] not in self.calls:
                    works_behind[key_before] = works_behind.get(key_before, 0) + works_from[key]
        return works_from, works_behind

    def _build_work(self, key: WayKey, way: EntryWay, left: int, behind: int, from_last: int) -> WayWork:
        units = [self.cores.unit_of[step] for step in way.steps]
        own_keys: set[WayKey] = set()
        step_works: list[tuple[str, int]] = []
        for number, unit in enumerate(units):
            if units.count(unit) == 1:
                step_key = self.keys[way.entry, way.steps[: number + 1]]
                own_keys.add(step_key)
                job = self.jobs.get(step_key)
                step_works.append((way.steps[number], job.work if job else 0))
        others = [
            SharedWork(job.origin, job.work, self._find_way_before(job) if unit == units[0] else job.key)
            for unit in dict.fromkeys(units)
            for job in self.unit_jobs[unit]
            if job.key not in own_keys
        ]
        return WayWork(
            key,
            way.entry,
            tuple(step_works),
            sum(work for _, work in step_works),
            max((work for _, work in step_works), default=0),
            tuple(others),
            tuple(self._find_crowds(way.steps)),
            left,
            behind,
            from_last,
        )

    def _find_way_before(self, job: ThreadJob) -> WayKey | None:
        """Return the way to the step before a job, None where that is in the same thread: then nothing can be pending."""
        if all(self.cores.unit_of[step] == job.unit for step in job.steps):
            return None
        return self.keys[job.origin, job.steps[:-1]]

    def _find_crowds(self, steps: Sequence[str]) -> Iterator[tuple[tuple[SharedWork, ...], int]]:
        """Yield the other members of the containers whose threads the steps wait for."""
        crowd_of = self.cores.crowd_of
        for crowd in dict.fromkeys(crowd_of[step] for step in steps if step in crowd_of):
            # Of several threads of the way there one may wait while another works, for a later event.
            own_units = {self.cores.unit_of[step] for step in steps if crowd_of.get(step) == crowd}
            if crowd[1] < self.cores.core_count:
                yield (
                    tuple(
                        SharedWork(job.origin, job.work, job.key)
                        for job in self.cores.jobs
                        if crowd_of.get(job.key[0]) == crowd
                        and (len(own_units) > 1 or job.unit not in own_units)
                        and job.key[0] not in self.cores.inner_triggers.silent_ids
                    ),
                    crowd[1],
                )
