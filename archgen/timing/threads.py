"""Units with their work: what one thread asks of a processor, its priorities, and what is unknown of it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import lru_cache
from typing import NamedTuple

from archgen.frozen import dataclass
from archgen.timing.analysis import Tier
from archgen.timing.placement import Unit
from archgen.timing.streams import Streams
from archgen.timing.system import System
from archgen.timing.value import Cause, added, summed, united
from archgen.timing.windows import Work, noted


class Found(NamedTuple):
    """A worst response in ticks, or why there is none."""

    value: int | None
    tier: Tier
    cause: Cause = Cause()


Events = Mapping[str, Streams | Cause]
"""The event model of each activity, or why it has none."""
OVERLOAD, UNBOUNDED, DIVERGED = Cause(notes=("overload",)), Cause(notes=("unbounded",)), Cause(notes=("diverged",))


@lru_cache(1 << 14)
def utilisation(cost: int, streams: Streams) -> Fraction:
    """Return the share of a core that an activity takes."""
    above, below = summed([stream.ratio for stream in streams])
    return Fraction(above * cost, below)


def work_of(system: System, name: str, events: Events, known: Mapping[str, Found]) -> Work | Cause:
    """Return the work of an activity, or what is missing of it."""
    cost, streams = system.activities[name].wcet, events[name]
    if cost == 0:
        return Work(0, () if isinstance(streams, Cause) else streams)
    if cost is None:  # only what is missing of its events: a note such as `overload` does not say how long it takes
        late = Cause(streams.missing) if isinstance(streams, Cause) else Cause()
        return united((Cause((name,)), late))
    if isinstance(streams, Cause):
        return streams
    found = known.get(name)
    return noted(cost, streams, (found.value or 0) if found else 0)


@dataclass(frozen=True, slots=True)
class Thread:
    """A unit with its work. The priorities are the least and greatest of its members, None for members without one."""

    unit: Unit
    works: tuple[Work, ...]
    cause: Cause | None
    low: int | None
    high: int | None
    share: Fraction
    container: str | None
    boundless: bool = False
    """Whether no response can be given though nothing is missing: any amount of its work may then be waiting."""


def thread_of(system: System, unit: Unit, events: Events, known: Mapping[str, Found]) -> Thread:
    """Build a unit's thread from the work of its members."""
    # What never fires, or only at the start, interferes with nobody, even if its execution time is unknown.
    idle = {name for name in unit if events[name] == () and system.activities[name].wcet is None}
    found = [Work(0, ()) if name in idle else work_of(system, name, events, known) for name in unit]
    causes = [one for one in found if isinstance(one, Cause)]
    works = tuple(one for one in found if isinstance(one, Work))
    written = [one for name in unit if (one := system.activities[name].priority) is not None]
    return Thread(
        unit,
        works,
        united(causes) if causes else None,
        _least(system, unit),
        max(written, default=None),
        added(utilisation(work.cost, work.streams) for work in works),
        system.activities[unit[0]].container,
        any(name in known and _is_boundless(known[name]) for name in unit),
    )


def _is_boundless(found: Found) -> bool:
    """Whether a response has no bound although nothing is missing."""
    return found.value is None and not found.cause.missing


def crowded(system: System, threads: Sequence[Thread], events: Events) -> list[Thread]:
    """Lower the priority of threads that wait for work of less priority than their own.

    In a container with fewer threads than members, each waits for the least urgent member too. And whatever is as
    urgent as some of the container's members must let pass the work that piled up while its threads were held: more
    than what comes in a busy period of their priority, but no more than in one of the least urgent member's.
    """
    lows = _crowded(system, threads, events)
    lowered = [replace(t, low=lows[t.container]) if t.container and t.container in lows else t for t in threads]
    # Only threads whose priorities differ pass a delay on downwards.
    spans = {(t.low, t.high) for t in lowered if t.high is not None and t.low != t.high}
    return [replace(t, low=_level(t.low, spans)) for t in lowered] if spans else lowered


def _crowded(system: System, threads: Sequence[Thread], events: Events) -> dict[str, int | None]:
    """Return the least priority in each container that has fewer threads (but several) than members that ever work."""
    members: dict[str, list[str]] = {}
    for thread in threads:
        if thread.container is not None:
            members.setdefault(thread.container, []).extend(name for name in thread.unit if events[name] != ())
    return {
        container: _least(system, names)
        for container, names in members.items()
        # A single thread is one unit and needs no lowering: its members run one after the other anyway.
        if 1 < (system.threads.get(container) or 1) < len(names)
    }


def _level(low: int | None, spans: Iterable[tuple[int | None, int | None]]) -> int | None:
    """Return the least priority among all threads that delay something this urgent, directly or through others."""
    # None is less than any priority: once something without a priority is reached, the search is over.
    while low is not None:
        reached = [least for least, most in spans if most is not None and most >= low]
        least = None if None in reached else min((low, *(one for one in reached if one is not None)))
        if least == low:
            break
        low = least
    return low


def _least(system: System, names: Iterable[str]) -> int | None:
    """Return the least priority of several activities, None where one of them has none."""
    priorities = [system.activities[name].priority for name in names]
    written = [one for one in priorities if one is not None]
    return min(written) if len(written) == len(priorities) else None
