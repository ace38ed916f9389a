"""Units with their work: what one thread asks of a processor, its priorities, and what is unknown of it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from functools import lru_cache

from archgen.frozen import NamedTuple, dataclass, replace
from archgen.timing.figures.timing_values import ResponseTier, UnknownCause, sum_fractions, sum_ratios, unite_causes
from archgen.timing.load.busy_windows import ActivityWork, WorstActivation
from archgen.timing.load.event_streams import EventStreams
from archgen.timing.system.core_placement import ProcessingResource
from archgen.timing.system.thread_pools import ThreadPool, ThreadUnit, find_crowded_pools, name_lane, works_in_order
from archgen.timing.system.timing_system import TimingSystem


class WorstResponse(NamedTuple):
    """A worst response in ticks, or why there is none."""

    value: int | None
    tier: ResponseTier
    cause: UnknownCause = UnknownCause()

    def limit_to(self, bound: int | None, tier: ResponseTier) -> WorstResponse:
        """Return the response of another tier where that is the smaller bound, or the only one; what is declared stays."""
        is_smaller = bound is not None and (self.value is None or bound < self.value)
        if not is_smaller or self.tier in {"declared", "unknown"}:
            return self
        return WorstResponse(bound, tier)


EventModels = Mapping[str, EventStreams | UnknownCause]
"""The event model of each activity, or why it has none."""
OVERLOAD_CAUSE, DIVERGED_CAUSE = UnknownCause(notes=("overload",)), UnknownCause(notes=("diverged",))
"""`overload`: there is no bound. `diverged`: none was found, though there may be one."""


@lru_cache(1 << 14)
def work_utilisation(cost: int, streams: EventStreams) -> Fraction:
    """Return the share of a core that an activity takes."""
    numerator, denominator = sum_ratios([stream.max_rate_ratio for stream in streams])
    return Fraction(numerator * cost, denominator)


def find_work(system: TimingSystem, name: str, event_models: EventModels) -> ActivityWork | UnknownCause:
    """Return the work of an activity, or what is missing of it."""
    cost, streams = system.activities[name].wcet, event_models[name]
    if cost == 0:
        return ActivityWork(0, () if isinstance(streams, UnknownCause) else streams)
    if cost is None:  # only what is missing of its events: a note such as `overload` does not say how long it takes
        event_cause = UnknownCause(streams.missing) if isinstance(streams, UnknownCause) else UnknownCause()
        return unite_causes((UnknownCause((name,)), event_cause))
    return streams if isinstance(streams, UnknownCause) else ActivityWork(cost, streams)


@dataclass(frozen=True, slots=True)
class ThreadWork:
    """A unit with its work. The priorities are the least and greatest of its members, None for members without one."""

    unit: ThreadUnit
    works: tuple[ActivityWork, ...]
    cause: UnknownCause | None
    lowest_priority: int | None
    highest_priority: int | None
    share: Fraction
    in_order: bool = True
    """Whether the activations of its only activity begin in the order in which they come, one after the other."""

    @property
    def takes_no_time(self) -> bool:
        """Whether something that works in it has an execution time of 0."""
        return any(not work.cost and work.streams for work in self.works)


class CoreWindow(NamedTuple):
    """The window that bounds the activities of a `thread` on a core: in it `threads` do all that may hold them up."""

    thread: ThreadWork
    threads: Sequence[ThreadWork]
    worst: WorstActivation

    def list_others(self) -> Iterator[ThreadWork]:
        """Yield the other threads for which the thread may have to wait."""
        level = self.thread.lowest_priority
        for each in self.threads:
            if each is not self.thread and (
                level is None or (each.highest_priority is not None and each.highest_priority >= level)
            ):
                yield each


def build_thread(system: TimingSystem, unit: ThreadUnit, event_models: EventModels) -> ThreadWork:
    """Build a unit's thread from the work of its members."""
    # What never fires, or only at the start, interferes with nobody, even if its execution time is unknown.
    idle_ids = {name for name in unit if event_models[name] == () and system.activities[name].wcet is None}
    works_or_causes = [
        ActivityWork(0, ()) if name in idle_ids else find_work(system, name, event_models) for name in unit
    ]
    causes = [item for item in works_or_causes if isinstance(item, UnknownCause)]
    works = tuple(item for item in works_or_causes if isinstance(item, ActivityWork))
    return ThreadWork(
        unit,
        works,
        unite_causes(causes) if causes else None,
        *find_priorities(system, unit),
        sum_fractions(work_utilisation(work.cost, work.streams) for work in works),
        works_in_order(system, system.activities[unit[0]]),
    )


def build_core_threads(
    system: TimingSystem, resource: ProcessingResource, event_models: EventModels
) -> list[ThreadWork]:
    """Build the threads of a core, those of its own units first, with the priorities that they have to wait for."""
    units = (*resource.units, *resource.foreign_units)
    return lower_crowded_threads(system, [build_thread(system, unit, event_models) for unit in units], event_models)


def lower_crowded_threads(
    system: TimingSystem, threads: Sequence[ThreadWork], event_models: EventModels
) -> list[ThreadWork]:
    """Lower the priority of threads that wait for work of less priority than their own.

    In a process with fewer threads than it may ask for, each waits for the least urgent member too. And whatever is as
    urgent as some of its members must let pass the work that piled up while its threads were held: more
    than what comes in a busy period of their priority, but no more than in one of the least urgent member's.
    """
    if all(thread.highest_priority is None for thread in threads):
        return list(threads)
    lowest_of = _lowest_in_crowded(system, threads, event_models)
    lowered_threads = [
        replace(thread, lowest_priority=lowest_of[thread.unit[0]]) if thread.unit[0] in lowest_of else thread
        for thread in threads
    ]
    # Only threads whose priorities differ pass a delay on downwards.
    priority_spans = {
        (thread.lowest_priority, thread.highest_priority)
        for thread in lowered_threads
        if thread.highest_priority is not None and thread.lowest_priority != thread.highest_priority
    }
    return (
        [
            replace(thread, lowest_priority=_lowest_reached(thread.lowest_priority, priority_spans))
            for thread in lowered_threads
        ]
        if priority_spans
        else lowered_threads
    )


def _lowest_in_crowded(
    system: TimingSystem, threads: Sequence[ThreadWork], event_models: EventModels
) -> dict[str, int | None]:
    """Return the least priority in what the members of some threads wait for, by the thread's first member.

    That is the process, where one may wait for one of several threads, else a callback group that is divided.
    """
    # A single thread is one unit and needs no lowering: its members run one after the other anyway. Of what never works
    # nobody has to wait for a thread.
    working_ids = [name for thread in threads for name in thread.unit if event_models[name] != ()]
    crowded_pools = find_crowded_pools(system, [system.activities[name] for name in working_ids])
    unit_counts = Counter(name_lane(system, system.activities[thread.unit[0]]) for thread in threads)
    members_by_pool: dict[ThreadPool | str, list[str]] = {}
    for name in working_ids:
        lane = name_lane(system, system.activities[name])
        if name in crowded_pools or unit_counts[lane] > 1:
            members_by_pool.setdefault(crowded_pools.get(name, lane), []).append(name)
    lowest_by_pool = {key: find_priorities(system, names)[0] for key, names in members_by_pool.items()}
    lowest_of = {name: lowest_by_pool[key] for key, names in members_by_pool.items() for name in names}
    return {
        thread.unit[0]: lowest_of[name]
        for thread in threads
        if (name := next((each for each in thread.unit if each in lowest_of), "")) in lowest_of
    }


def _lowest_reached(priority: int | None, priority_spans: Iterable[tuple[int | None, int | None]]) -> int | None:
    """Return the least priority among all threads that delay something this urgent, directly or through others."""
    # None is less than any priority: once something without a priority is reached, the search is over.
    while priority is not None:
        reached_levels = [lowest for lowest, highest in priority_spans if highest is not None and highest >= priority]
        lowest = (
            None
            if None in reached_levels
            else min((priority, *(level for level in reached_levels if level is not None)))
        )
        if lowest == priority:
            break
        priority = lowest
    return priority


def find_priorities(system: TimingSystem, names: Iterable[str]) -> tuple[int | None, int | None]:
    """Return the least priority of several activities, None where one of them has none, and the greatest."""
    priorities = [system.activities[name].priority for name in names]
    written_priorities = [priority for priority in priorities if priority is not None]
    lowest = min(written_priorities) if len(written_priorities) == len(priorities) else None
    return lowest, max(written_priorities, default=None)
