"""What comes in the way of consecutive steps on cores that share their work: in their own threads, and beside them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence

from archgen.frozen import NamedTuple, dataclass, field
from archgen.timing.load.inner_core import urgency_of
from archgen.timing.load.level_cascades import EntryWay, EventOrigin, Priority
from archgen.timing.load.shared_cores import SharedCores, ThreadJob, WayKey
from archgen.timing.system.thread_pools import ThreadUnit

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


@dataclass(frozen=True, slots=True)
class LastStep:
    """The last step of a path where it has a thread of its own, so that its activations follow one another in order.

    `arrivals` are what fires it: for each way the origin, how many activations an event makes, the way to the step before
    (None where nothing can be pending on it while the path's threads are idle), and how long that takes at least.
    """

    cost: int
    arrivals: tuple[tuple[EventOrigin, int, WayKey | None, int], ...]


@dataclass(frozen=True, slots=True)
class CorePath:
    """What counts for some steps: their own time, and the work in their threads and beside them, by its place in the jobs.

    `own_jobs` are those of the steps' threads, but of `last_step`, where that is known. Each has the way that leads to it
    from other threads: what is pending of it can only be on that way. `crowds` are the jobs of each container whose threads
    the steps wait for, with the number of those that can work at once. Of the other threads only those count that may be
    as urgent. `held_jobs` are the jobs among theirs that may wait though a core is idle: of what is foreign, and behind
    something less urgent. `waiting_lanes` says what comes of which origins may wait for each of the other threads, or
    containers; `lane_widths`, how many cores each of them may use at once. `own_cost` is the work of steps that is in no thread's
    jobs: of one that works only at the start, and so has no events, and of those that are reentrant.
    """

    cost: int
    own_cost: int
    last_step: LastStep | None
    own_jobs: tuple[tuple[int, WayKey | None], ...]
    crowds: tuple[tuple[list[int], int], ...]
    other_lanes: tuple[list[int], ...]
    lane_widths: tuple[int, ...]
    held_jobs: frozenset[int]
    waiting_lanes: tuple[frozenset[EventOrigin], ...]

    def list_jobs(self) -> Iterator[int]:
        """Yield the jobs that come in the way."""
        yield from (number for number, _ in self.own_jobs)
        for lane in (*self.other_lanes, *(numbers for numbers, _ in self.crowds)):
            yield from lane


class ThreadUrgencies(NamedTuple):
    """How urgent the threads that do anything may be, and the least urgent thread on the way to each job: -2 if foreign."""

    of_units: tuple[tuple[ThreadUnit, int], ...]
    of_jobs: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class CorePaths:
    """The paths on some cores, each built when it is first asked for."""

    cores: SharedCores
    _urgencies: list[ThreadUrgencies] = field(default_factory=list)
    _paths: dict[tuple[str, ...], CorePath] = field(default_factory=dict)
    _way_works: dict[WayKey, WayWork] = field(default_factory=dict)

    @property
    def way_works(self) -> Mapping[WayKey, WayWork]:
        """Return the work of each way."""
        if not self._way_works:
            self._way_works.update(build_way_works(self.cores))
        return self._way_works

    def look_up(self, steps: tuple[str, ...]) -> CorePath:
        """Return what counts for some steps."""
        path = self._paths.get(steps)
        if path is None:
            path = self._paths[steps] = self._build_path(steps)
        return path

    def _build_path(self, steps: tuple[str, ...]) -> CorePath:
        cores = self.cores
        all_units = dict.fromkeys(cores.unit_of[step] for step in steps)
        level = min((cores.threads[unit].lowest_priority for unit in all_units), key=urgency_of)
        # What is reentrant waits for no thread of its own: other activations of it are a crowd's work.
        units = {unit: None for unit in all_units if unit not in cores.reentrant_units}
        crowds = self._find_crowds(steps, units)
        # What holds the threads of a container does so k at a time, with k threads: that counts for more than the cores.
        urgency_of_units, urgency_of_jobs = self._urgencies[0] if self._urgencies else self._find_urgencies()
        least_urgency = urgency_of(level)
        other_units = [
            unit
            for unit, urgency in urgency_of_units
            if urgency >= least_urgency
            and unit not in all_units
            and not (crowds and cores.crowd_of.get(unit[0]) in crowds)
        ]
        other_jobs = tuple(number for unit in other_units for number in cores.job_numbers[unit])
        last_step = self._find_last_step(steps, units)
        costs = [cores.system.activities[step].wcet or 0 for step in steps]
        return CorePath(
            sum(costs),
            self._find_own_cost(steps, last_step),
            last_step,
            tuple(
                (number, self._find_way_before(cores.jobs[number], units))
                for unit in units
                for number in cores.job_numbers[unit]
                if last_step is None or cores.jobs[number].key[0] != steps[-1]
            ),
            tuple((numbers, min(threads, cores.core_count)) for (_, threads), numbers in crowds.items()),
            tuple(cores.job_numbers[unit] for unit in other_units if cores.job_numbers[unit]),
            tuple(cores.reentrant_units.get(unit, 1) for unit in other_units if cores.job_numbers[unit]),
            frozenset(
                number
                for number in other_jobs
                if urgency_of_jobs[number] < least_urgency and self._is_held(number, units, level)
            ),
            self._list_waiting_lanes(other_units),
        )

    def _find_urgencies(self) -> ThreadUrgencies:
        """Find what all paths have in common."""
        cores = self.cores
        urgencies = {unit: urgency_of(thread.highest_priority) for unit, thread in cores.threads.items()}
        self._urgencies.append(
            ThreadUrgencies(
                tuple(
                    (unit, urgencies[unit])
                    for unit, numbers in cores.job_numbers.items()
                    if numbers or cores.origins_of_unit[unit]
                ),
                tuple(
                    -2
                    if job.key[0] in cores.foreign_ids
                    else min([urgencies[cores.unit_of[step]] for step in job.steps])
                    for job in cores.jobs
                ),
            )
        )
        return self._urgencies[0]

    def _find_last_step(self, steps: tuple[str, ...], units: Mapping[ThreadUnit, None]) -> LastStep | None:
        """Return the last step where its activations can be looked at one by one; the first is that of the first event."""
        cores, name = self.cores, steps[-1]
        cost, ways = cores.system.activities[name].wcet, cores.ways_to[name]
        is_only_way = len(steps) == 1 or len(ways) == 1
        if (
            not cost
            or len(cores.unit_of[name]) > 1
            or not is_only_way
            or not cores.threads[cores.unit_of[name]].in_order
        ):
            return None
        if not all(cores.cascades.volumes.get(way.entry) for way in ways):
            return None
        return LastStep(
            cost,
            tuple(
                (
                    way.entry,
                    way.multiplicity,
                    self._find_way_before(ThreadJob((name, number), way.entry, cost, (name,), way.steps), units),
                    way.best_before,
                )
                for number, way in enumerate(ways)
            ),
        )

    def _find_own_cost(self, steps: tuple[str, ...], last_step: LastStep | None) -> int:
        """Return the work of the steps of a path that is among no thread's jobs, each counted once."""
        cores = self.cores
        starts_only = steps[-1] in cores.inner_triggers.silent_ids and last_step is None
        return sum(
            cores.system.activities[step].wcet or 0
            for step in steps
            if cores.unit_of[step] in cores.reentrant_units or (starts_only and step == steps[-1])
        )

    def _find_crowds(self, steps: Iterable[str], units: Mapping[ThreadUnit, None]) -> dict[tuple[str, int], list[int]]:
        """Return the containers whose threads some steps wait for, each with the jobs of its other members."""
        crowd_of = self.cores.crowd_of
        crowds: dict[tuple[str, int], list[int]] = {crowd_of[step]: [] for step in steps if step in crowd_of}
        for number, job in enumerate(self.cores.jobs if crowds else ()):
            crowd = crowd_of.get(job.key[0])
            if crowd is not None and crowd in crowds and job.unit not in units:
                crowds[crowd].append(number)
        return crowds

    def _is_held(self, number: int, units: Mapping[ThreadUnit, None], level: Priority) -> bool:
        """Whether a job is foreign, or something less urgent that is not of the path itself leads to it."""
        job, unit_of = self.cores.jobs[number], self.cores.unit_of
        return job.key[0] in self.cores.foreign_ids or not all(
            unit_of[step] in units or self._counts_at(unit_of[step], level) for step in job.steps
        )

    def _counts_at(self, unit: ThreadUnit, level: Priority) -> bool:
        """Whether a thread may be as urgent as a level."""
        highest = self.cores.threads[unit].highest_priority
        return level is None or (highest is not None and highest >= level)

    def _find_way_before(self, job: ThreadJob, units: Mapping[ThreadUnit, None]) -> WayKey | None:
        """Return the way to the step before a job, where that leads through other threads than these, else None."""
        if all(self.cores.unit_of[step] in units for step in job.steps[:-1]):
            return None
        return self.cores.find_way_before(job.origin, job.steps)

    def _list_waiting_lanes(self, units: Iterable[ThreadUnit]) -> tuple[frozenset[EventOrigin], ...]:
        """Return what waits in each thread, or container, that takes an idle core as soon as it has work."""
        cores = self.cores
        origins_by_crowd: dict[object, frozenset[EventOrigin]] = {}
        lanes: list[frozenset[EventOrigin]] = []
        for unit in units:
            crowd = cores.crowd_of.get(unit[0])
            if crowd is not None:
                origins_by_crowd[crowd] = origins_by_crowd.get(crowd, frozenset()) | cores.origins_of_unit[unit]
            elif unit[0] not in cores.foreign_ids:
                lanes.append(cores.origins_of_unit[unit])
        return (*lanes, *origins_by_crowd.values())
