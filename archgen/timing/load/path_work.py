"""How long all takes that comes in the way of a path on several cores: in its own threads, and beside them (A + B)."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from archgen.frozen import NamedTuple
from archgen.timing.load.busy_windows import divide_among_cores
from archgen.timing.load.core_paths import CorePath
from archgen.timing.load.event_streams import EventStream, EventStreams, max_arrivals
from archgen.timing.load.level_cascades import CascadeDemand, EventOrigin
from archgen.timing.load.shared_cores import SharedCores, WayKey

_ENDLESS = 1 << 200
"""Longer than any window, in ticks."""
PendingTerm = tuple[EventOrigin, int, int, int, EventStreams, bool]
"""What a job may have pending: its origin, work, delay, the longest window in which nothing is, its streams, whether held."""


class LaneSums(NamedTuple):
    """What comes for each of the other threads, and what may have been pending: in each, by origin, and of what is held."""

    lane_works: list[int]
    pending_works: list[int]
    pending_by_origin: dict[EventOrigin, int]
    held_work: int


class CoreBlock(NamedTuple):
    """For how long (`time`) all cores may be busy beside a path: with `lane_works`, and with what was `pending`.

    Where it `is_cut`, no thread's work counts for longer than that; it may have what was pending in it (`has_pending`).
    """

    time: int
    lane_works: Sequence[int]
    pending: int = 0
    is_cut: bool = False
    has_pending: bool = False


class PathWork:
    """The work that comes in the way of paths, for given event models; `delays` are how long ways take at most."""

    def __init__(self, cores: SharedCores, demand: CascadeDemand) -> None:
        """Find the longest windows in which no more comes of an origin, or of all of them, than at once."""
        self.cores = cores
        self.delays: dict[WayKey, int] = {}
        self.longest_delay = 0
        self.streams: dict[EventOrigin, EventStreams] = {
            origin: demand.streams_of(origin) for origin, volume in cores.cascades.volumes.items() if volume
        }
        self.calm_arrivals = {origin: max_arrivals(model, 1) for origin, model in self.streams.items()}
        self.calm_works = [job.work * self.calm_arrivals[job.origin] for job in cores.jobs]
        self.calm_windows = {
            origin: min((_find_calm_time(stream) for stream in model), default=_ENDLESS)
            for origin, model in self.streams.items()
        }
        self.calm_window = min(self.calm_windows.values(), default=0)
        self.calm_times: dict[int, int] = {}
        self.longest_window = 0
        """The longest window of which somebody said that it was looked at."""
        self._lanes_of_path: dict[int, dict[EventOrigin, list[int]]] = {}
        # By the path's identity; they rest on no window, only on the delays.
        self._terms_of_path: dict[int, list[list[PendingTerm]]] = {}

    def note_delay(self, key: WayKey, delay: int) -> bool:
        """Note how long a way takes, unless it was longer before; return whether it grew."""
        if delay <= self.delays.get(key, 0):
            self.delays.setdefault(key, delay)
            return False
        self.delays[key] = delay
        self._terms_of_path.clear()
        self.longest_delay = max(self.longest_delay, delay)
        return True

    def is_calm(self) -> bool:
        """Whether nothing came twice in any window, with all that may be pending: then it makes nothing longer."""
        return self.longest_window + self.longest_delay <= self.calm_window

    def find_time_beside(self, path: CorePath, window: int, spend: Callable[[int], None]) -> int:
        """Return how long all takes in a window but the last step's activations: A + B."""
        if window + self.longest_delay > self.calm_window:
            spend(2 * (len(self.streams) + len(self.cores.jobs)))
            calm_windows = self.calm_windows
            arrivals = {
                origin: count if window <= calm_windows[origin] else max_arrivals(self.streams[origin], window)
                for origin, count in self.calm_arrivals.items()
            }
            return self._path_work(path, window, arrivals) + self._find_block(path, window, arrivals).time
        # In such a window nothing comes twice, and nothing is pending: its length does not matter.
        time = self.calm_times.get(id(path))
        if time is None:
            time = self._path_work(path, window, self.calm_arrivals) + self._find_calm_block(path)
            self.calm_times[id(path)] = time
        return time

    def find_block(self, path: CorePath, window: int) -> CoreBlock:
        """Return how all cores may be busy with other threads in a window."""
        return self._find_block(
            path, window, {origin: max_arrivals(model, window) for origin, model in self.streams.items()}
        )

    def _find_calm_block(self, path: CorePath) -> int:
        """Return how long all cores may be busy with other threads where nothing comes twice and nothing is pending."""
        works = self.calm_works
        lane_works = [sum([works[number] for number in lane]) for lane in path.other_lanes]
        if path.crowds:
            return -(-sum(lane_works) // self.cores.core_count)
        return divide_among_cores(split_lanes(path, lane_works), 0, self.cores.core_count)

    def _count_pending(self, origin: EventOrigin, window: int, delay: int, arrivals: Mapping[EventOrigin, int]) -> int:
        """Return how many events more there are in a window and up to `delay` before it than in a window."""
        if not delay or window + delay <= self.calm_windows[origin]:
            return 0
        return max_arrivals(self.streams[origin], window + delay) - arrivals[origin]

    def _path_work(self, path: CorePath, window: int, arrivals: Mapping[EventOrigin, int]) -> int:
        """Return the work of the threads of a path in a window, as the time for which they can hold it up."""
        total, jobs = path.own_cost, self.cores.jobs
        for number, way_before in path.own_jobs:
            _, origin, work, _, _ = jobs[number]
            # At t0 nothing waits in the threads of the path themselves.
            delay = self.delays.get(way_before, 0) if way_before else 0
            total += work * (arrivals[origin] + self._count_pending(origin, window, delay, arrivals))
        for numbers, threads in path.crowds:
            crowd_work = 0
            for key, origin, work, _, _ in (jobs[number] for number in numbers):
                pending = self._count_pending(origin, window, self.delays.get(key, 0), arrivals)
                crowd_work += work * (arrivals[origin] + pending)
            total -= -crowd_work // threads
        return total

    def _find_block(self, path: CorePath, window: int, arrivals: Mapping[EventOrigin, int]) -> CoreBlock:
        """Return how long all cores may be busy with other threads: with what arrives, and with what was pending.

        Pending at t0 is what waits for m - 1 threads, and all that is foreign, for that may have waited for a core of its
        own.
        """
        core_count = self.cores.core_count
        lane_works, pending_works, pending_by_origin, held_work = self._sum_lanes(path, window, arrivals)
        if not any(pending_works) and not path.crowds:
            time = divide_among_cores(split_lanes(path, lane_works), 0, core_count)
            return CoreBlock(time, lane_works, is_cut=True)
        most_pending = held_work + self._find_most_waiting(path, pending_by_origin)
        block = CoreBlock(-(-(sum(lane_works) + most_pending) // core_count), lane_works, most_pending)
        if path.crowds:
            return block
        # All that each thread may have in the end: less, where a single one has most of it.
        all_works = [work + pending for work, pending in zip(lane_works, pending_works, strict=True)]
        time = divide_among_cores(split_lanes(path, all_works), 0, core_count)
        return CoreBlock(time, all_works, is_cut=True, has_pending=True) if time < block.time else block

    def _sum_lanes(self, path: CorePath, window: int, arrivals: Mapping[EventOrigin, int]) -> LaneSums:
        """Add up what comes for each of the other threads, and what was pending."""
        lane_works: list[int] = []
        pending_works: list[int] = []
        pending_by_origin: dict[EventOrigin, int] = {}
        held_work = 0
        # As in `_count_pending`, but written out: this is the innermost loop of all that is found on several cores.
        for lane_terms in self._look_up_terms(path):
            lane_work = pending_work = 0
            for origin, work, delay, calm_window, streams, is_held in lane_terms:
                arrived = arrivals[origin]
                lane_work += work * arrived
                if window <= calm_window:
                    continue
                count = -arrived
                for period, jitter, distance, per_period, batch in streams:
                    batches = -(-(window + delay + jitter) * per_period // period)
                    if distance:
                        batches = min(batches, -(-(window + delay) // distance))
                    count += batch * batches
                if count:
                    pending_work += work * count
                    if is_held:
                        held_work += work * count
                    else:
                        pending_by_origin[origin] = pending_by_origin.get(origin, 0) + work * count
            lane_works.append(lane_work)
            pending_works.append(pending_work)
        return LaneSums(lane_works, pending_works, pending_by_origin, held_work)

    def _look_up_terms(self, path: CorePath) -> Sequence[Sequence[PendingTerm]]:
        """Return the jobs of the other threads with their delays as they are now."""
        terms = self._terms_of_path.get(id(path))
        if terms is None:
            terms = self._terms_of_path[id(path)] = [
                [self._build_term(number, is_held=number in path.held_jobs) for number in lane]
                for lane in path.other_lanes
            ]
        return terms

    def _build_term(self, number: int, *, is_held: bool) -> PendingTerm:
        key, origin, work, _, _ = self.cores.jobs[number]
        delay = self.delays.get(key, 0)
        calm_window = self.calm_windows[origin] - delay if delay else _ENDLESS
        return (origin, work, delay, calm_window, self.streams[origin], is_held)

    def _find_most_waiting(self, path: CorePath, work_by_origin: Mapping[EventOrigin, int]) -> int:
        """Return the most work that may have waited for m - 1 threads."""
        waiting_works = [0] * len(path.waiting_lanes)
        lanes_of_origin = self._look_up_lanes(path)
        for origin, work in work_by_origin.items():
            for lane in lanes_of_origin.get(origin, ()):
                waiting_works[lane] += work
        waiting_works.sort(reverse=True)
        return min(sum(waiting_works[: self.cores.core_count - 1]), sum(work_by_origin.values()))

    def _look_up_lanes(self, path: CorePath) -> Mapping[EventOrigin, Sequence[int]]:
        """Return the other threads, or containers, for which what comes of each origin may wait."""
        lanes_of_origin = self._lanes_of_path.get(id(path))
        if lanes_of_origin is None:
            lanes_of_origin = self._lanes_of_path[id(path)] = {}
            for lane, origins in enumerate(path.waiting_lanes):
                for origin in origins:
                    lanes_of_origin.setdefault(origin, []).append(lane)
        return lanes_of_origin


def split_lanes(path: CorePath, lane_works: Sequence[int]) -> Sequence[int]:
    """Return the work of each lane that one core at a time may do: what is reentrant counts as several lanes."""
    if not path.lane_widths or max(path.lane_widths) == 1:
        return lane_works
    return [
        part for work, width in zip(lane_works, path.lane_widths, strict=True) for part in [-(-work // width)] * width
    ]


def _find_calm_time(stream: EventStream) -> int:
    """Return the longest window in which no more of a stream comes than at once."""
    period, jitter, distance, per_period, batch = stream
    batches = max_arrivals((stream,), 1) // batch
    return max(batches * period // per_period - jitter, batches * distance)
