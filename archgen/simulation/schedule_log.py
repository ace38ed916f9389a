"""Who ran, waited and held what in one run; and the way on which a chain was latest in it, step by step."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from fractions import Fraction
from typing import Literal

from archgen.frozen import NamedTuple, dataclass, field
from archgen.simulation.chain_series import ChainTrace, find_latest_passage, list_passed_jobs
from archgen.simulation.chain_tracking import ChainTrack, track_chain
from archgen.simulation.drawn_orders import list_drawn_orders
from archgen.simulation.event_loop import process_events
from archgen.simulation.plan_builder import PublishPauses, build_plan
from archgen.simulation.simulation_run import SimulationRun, ThreadState
from archgen.timing.analysis import DrawnOrder
from archgen.timing.system.timing_system import TimingSystem

_SECOND = 10**9
StepKind = Literal["waits", "rereads", "queues", "works", "stays"]
_STEP_WORDS: dict[StepKind, str] = {
    "waits": "until {} looks",
    "rereads": "until {} looks for the last time",
    "queues": "{} waits for its turn",
    "works": "{} works",
    "stays": "until {} sends the next",
}
"""What keeps the data of a chain: they are not asked for yet, or are asked for again since nothing newer has come, who asks
has to wait, it works (and is interrupted), or what was sent stays until something newer is.
"""


class ThreadSpan(NamedTuple):
    """A thread in one state, in units: it runs or waits for a core, or uses a resource or waits for it (else -1)."""

    thread: int
    callback: int
    job: int
    state: ThreadState
    resource: int
    start: int
    end: int


@dataclass(slots=True)
class ScheduleLog:
    """The states of all threads of a run, noted as they change."""

    spans: list[ThreadSpan] = field(default_factory=list)
    _open: dict[int, tuple[int, ThreadState, int, int]] = field(default_factory=dict)

    def enter_state(self, run: SimulationRun, thread: int, state: ThreadState, resource: int = -1) -> None:
        """Note that a thread begins to be in a state, now."""
        self.leave_state(run, thread)
        self._open[thread] = run.threads.callback[thread], state, resource, run.now

    def leave_state(self, run: SimulationRun, thread: int) -> None:
        """Note that a thread has nothing to do any more, now."""
        if thread in self._open:
            callback, state, resource, start = self._open.pop(thread)
            if run.now > start:
                job = run.threads.job_number[thread] if run.threads.time_left[thread] >= 0 else -1
                self.spans.append(ThreadSpan(thread, callback, job, state, resource, start, run.now))


class WayStep(NamedTuple):
    """A step of a chain's way, in ns: whose job it is about, what keeps the data, and who held that up for how long."""

    activity: str
    job: int
    kind: StepKind
    start: Fraction
    end: Fraction
    holders: tuple[tuple[str, Fraction], ...]

    @property
    def words(self) -> str:
        """Return the step in words: `until costmap looks`, `controller waits for its turn`."""
        return _STEP_WORDS[self.kind].format(self.activity)


class TrackSpan(NamedTuple):
    """What a thread is at from when to when, in ns, for which activity and job; `resource` is what it uses or waits for."""

    activity: str
    job: int
    state: ThreadState
    resource: str
    start: Fraction
    end: Fraction
    is_storing: bool
    is_on_way: bool


class Track(NamedTuple):
    """What one thread of a process did; `host` is empty where none is written."""

    host: str
    name: str
    spans: tuple[TrackSpan, ...]


@dataclass(frozen=True, slots=True)
class LateSchedule:
    """A run in which a chain was late: all that threads did, the chain's latest way, and the orders that were drawn."""

    seed: int
    seconds: int
    tracks: tuple[Track, ...]
    way: tuple[WayStep, ...]
    orders: tuple[DrawnOrder, ...]

    @property
    def longest(self) -> Fraction:
        """What the chain took, in ns."""
        return self.way[-1].end - self.way[0].start


def record_schedule(
    system: TimingSystem, through: Sequence[str], seed: int, seconds: int, pauses: PublishPauses
) -> LateSchedule | None:
    """Run one seed again and note all that threads do; None where nothing passed along the chain in it."""
    plan = build_plan(system, pauses)
    track = track_chain(plan, through)
    if track is None:
        return None
    run = SimulationRun(plan, seed, track.activities, {wire for wires in track.wires for wire in wires})
    run.log = ScheduleLog()
    process_events(run, int(seconds * _SECOND / plan.unit))
    spans = sorted(run.log.spans, key=lambda span: (span.start, span.thread))
    way = tuple(_list_way(run, track, track.trace_run(run), spans))
    orders = list_drawn_orders(run, track.activities)
    return LateSchedule(seed, seconds, tuple(_list_tracks(run, spans, way)), way, orders) if way else None


def _list_tracks(run: SimulationRun, spans: Sequence[ThreadSpan], way: Sequence[WayStep]) -> Iterator[Track]:
    """Yield the threads by host, in the order in which they began to work; those of one process are numbered."""
    plan, on_way = run.plan, {(step.activity, step.job) for step in way}
    threads: dict[tuple[str, int, int], list[TrackSpan]] = {}
    for thread, callback_number, job, state, resource, start, end in spans:
        callback = plan.callbacks[callback_number]
        activity = plan.activities[callback.activity]
        place = plan.processors[activity.processor].host or "", callback.executor, thread
        used = plan.resources[resource].id if resource >= 0 else ""
        times = start * plan.unit, end * plan.unit
        is_way = not callback.is_storing and (activity.id, job) in on_way
        span = TrackSpan(activity.id, job, state, used, *times, callback.is_storing, is_way)
        threads.setdefault(place, []).append(span)
    counts = Counter[int]()
    for (host, executor, _), track_spans in threads.items():
        counts[executor] += 1
        # Processes are called `container navbox`, `node base`.
        name = plan.executors[executor].id.partition(" ")[2]
        number = f" ({counts[executor]})" if counts[executor] > 1 else ""
        yield Track(host, f"{name}{number}", tuple(track_spans))


def _list_way(
    run: SimulationRun, track: ChainTrack, trace: ChainTrace, spans: Sequence[ThreadSpan]
) -> Iterator[WayStep]:
    """Yield the steps of the latest passage, without a gap: their lengths add up to what it took."""
    passage = find_latest_passage(trace, forwarded_only=track.is_selective)
    if passage is None:
        return
    time, activities, unit = passage.begin, run.activities, run.plan.unit
    sender: tuple[int, int] | None = None
    for activity, job in zip(track.activities, list_passed_jobs(trace, passage), strict=True):
        moments: tuple[tuple[StepKind, int], ...] = (
            ("waits", activities.job_activations[activity][job]),
            ("queues", activities.job_starts[activity][job]),
            ("works", activities.job_ends[activity][job]),
            ("stays", passage.end if activity == track.activities[-1] else -1),
        )
        for kind, end in moments:
            if end > time:
                # Nobody holds up the world, nor what was sent.
                is_free = kind == "stays" or (kind == "waits" and sender is None)
                delayed = activity, job
                step_kind, held_kind = kind, kind
                if kind == "waits" and sender is not None and job and activities.job_starts[activity][job - 1] > time:
                    step_kind = "rereads"
                    # It looked before: what lasts is that the sender's next message does not come, or is not stored.
                    next_ends = activities.job_ends[sender[0]][sender[1] + 1 :][:1]
                    if not 0 <= next(iter(next_ends), -1) < end:
                        delayed, held_kind = (sender[0], sender[1] + 1), "queues"
                holders = [] if is_free else _find_holders(run, spans, delayed, held_kind, (time, end))
                held = tuple((name, length * unit) for name, length in holders)
                yield WayStep(run.plan.activities[activity].id, job, step_kind, time * unit, end * unit, held)
                time = end
        sender = activity, job


def _find_holders(
    run: SimulationRun, spans: Sequence[ThreadSpan], key: tuple[int, int], kind: StepKind, window: tuple[int, int]
) -> list[tuple[str, int]]:
    """Return who was on the thread, the core or the resource that a job waited for, and for how long, the longest first."""
    callbacks, processors = run.callbacks, run.processors.of_activity
    activity = key[0]
    near_spans = [span for span in spans if span.end > window[0] and span.start < window[1]]
    own_spans = [
        span
        for span in near_spans
        if (callbacks.activity[span.callback], span.job) == key and not callbacks.is_storing[span.callback]
    ]
    # What has begun waits where it was stopped; what has not waits all the time, for its thread first of all.
    stops = [span for span in own_spans if span.state in {"ready", "awaits"}]
    waits = [(each.resource, each.start, each.end) for each in stops] if kind == "works" else [(-1, *window)]
    executors = {planned.executor for planned in run.plan.callbacks if planned.activity == activity}
    mates, others = Counter[str](), Counter[str]()
    for resource, start, end in waits:
        for span in near_spans:
            overlap = min(span.end, end) - max(span.start, start)
            if overlap <= 0 or span in own_spans or span.state == "ready":
                continue
            other = callbacks.activity[span.callback]
            is_mate = kind != "works" and callbacks.executor[span.callback] in executors
            holds_resource = span.state == "uses" and span.resource == resource
            holds_core = span.state == "runs" and processors[other] == processors[activity]
            if is_mate or (holds_core if resource < 0 else holds_resource):
                (mates if is_mate else others)[run.plan.activities[other].id] += overlap
    # Data that are not asked for yet wait for a turn of the thread as well, to be stored, but for no core.
    found = mates if mates or kind == "waits" else others
    return sorted(found.items(), key=lambda item: (-item[1], item[0]))
