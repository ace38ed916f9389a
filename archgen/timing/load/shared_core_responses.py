"""Response times on several cores that share their work, under any global work-conserving scheduler.

Let t0 be the last instant before an arrival at which a core was idle and nothing waited in the threads of the run that
the arrival begins. From then on until the last step of the run has ended, one of the m cores works for a thread of the
run, or all m are busy with other threads. The former takes at most A, the work of those threads; the latter takes B with
m B = sum of min(W, B) over the other threads, since none works more than B in a time B. So the run has ended A + B after
t0: were it not, more work would have been done than there is. W is what arrives in that time, and what was pending at
t0: at most m - 1 threads had work then, and each pending cascade waits for one of them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from fractions import Fraction
from heapq import nlargest
from typing import NamedTuple, TypeVar

from archgen.frozen import dataclass
from archgen.timing.figures.timing_values import UnknownCause, sum_fractions, unite_causes
from archgen.timing.load.busy_windows import DivergedError, SearchBudget
from archgen.timing.load.cascade_demand import CascadeDemand, LevelCascades, Origin, build_level_cascades, number_arcs
from archgen.timing.load.core_responses import CoreResponses
from archgen.timing.load.event_streams import EventStreams, max_arrivals
from archgen.timing.load.inner_triggers import FiringArc, InnerTriggers
from archgen.timing.load.run_ways import EntryWay, find_entry_ways
from archgen.timing.load.thread_work import DIVERGED_CAUSE, OVERLOAD_CAUSE, UNBOUNDED_CAUSE, WorstResponse
from archgen.timing.system.core_placement import ProcessingResource, ThreadUnit
from archgen.timing.system.timing_system import TimingSystem

_Amount = TypeVar("_Amount", int, Fraction)
_MAX_SWEEPS = 60
"""Sweeps over all runs of some cores before their responses are given up."""


@dataclass(frozen=True, slots=True)
class SharedCores:
    """Cores that share their work, as far as no figure of events matters.

    `crowd_of` is the container whose threads an activity waits for, with the number of its threads.
    """

    system: TimingSystem
    resource: ProcessingResource
    inner_triggers: InnerTriggers
    entering_arcs: tuple[FiringArc, ...]
    cascades: LevelCascades
    ways_to: Mapping[str, tuple[EntryWay, ...]]
    unit_of: Mapping[str, ThreadUnit]
    crowd_of: Mapping[str, tuple[str, int]]
    foreign_ids: frozenset[str]


def prepare_shared_cores(
    system: TimingSystem, resource: ProcessingResource, inner_triggers: InnerTriggers
) -> SharedCores:
    """Find the threads of some cores, and the cascades of what enters them."""
    foreign_ids = tuple(name for unit in resource.foreign_units for name in unit)
    arc_numbers, entering_arcs = number_arcs(inner_triggers)
    cascades = build_level_cascades(system, inner_triggers, arc_numbers, (*resource.members, *foreign_ids), foreign_ids)
    return SharedCores(
        system,
        resource,
        inner_triggers,
        entering_arcs,
        cascades,
        find_entry_ways(system, inner_triggers, arc_numbers),
        {name: unit for unit in (*resource.units, *resource.foreign_units) for name in unit},
        _find_crowds(system, resource),
        frozenset(foreign_ids),
    )


def _find_crowds(system: TimingSystem, resource: ProcessingResource) -> dict[str, tuple[str, int]]:
    """Return the containers that have several threads, but fewer than members."""
    members_by_container: dict[str, list[str]] = {}
    for name in resource.members:
        container = system.activities[name].container
        if container is not None:
            members_by_container.setdefault(container, []).append(name)
    return {
        name: (container, threads)
        for container, names in members_by_container.items()
        if 1 < (threads := system.threads.get(container) or 1) < len(names)
        for name in names
    }


class _Lane(NamedTuple):
    """What one thread, or the threads of one container, are asked for: work by origin in ticks, and the share of a core."""

    works: Mapping[Origin, int]
    share: Fraction


class _Path(NamedTuple):
    """What counts for some steps: their own time, their threads with how many there are, and all that works beside them.

    Nothing of the `inner_origins` is pending where nothing waits in the steps' own threads.
    """

    cost: int
    own_lanes: list[tuple[_Lane, int]]
    inner_origins: frozenset[Origin]
    other_lanes: list[_Lane]
    waiting_lanes: list[_Lane]


def solve_shared_cores(
    cores: SharedCores,
    model_of: Callable[[Origin, FiringArc | None], EventStreams | UnknownCause],
    known_responses: Mapping[str, WorstResponse],
    budget: SearchBudget,
) -> CoreResponses:
    """Return the responses on some cores, for the event models of what enters them (`model_of`).

    `known_responses` have those of the foreign units, which are found elsewhere.
    """

    def find_model(origin: Origin) -> EventStreams | UnknownCause:
        return model_of(origin, cores.entering_arcs[int(origin.key)] if origin.kind == "arc" else None)

    demand = CascadeDemand(cores.cascades, find_model)
    return _SharedCoreSolver(cores, demand, known_responses, budget).solve()


class _SharedCoreSolver:
    def __init__(
        self,
        cores: SharedCores,
        demand: CascadeDemand,
        known_responses: Mapping[str, WorstResponse],
        budget: SearchBudget,
    ) -> None:
        self.cores = cores
        self.demand = demand
        self.known_responses = known_responses
        self.budget = budget
        self.core_count = cores.resource.cores
        self.volumes = {origin: volume for origin, volume in cores.cascades.volumes.items() if volume}
        self.lane_of_unit = {
            unit: self._build_lane(unit) for unit in (*cores.resource.units, *cores.resource.foreign_units)
        }
        self.crowd_lanes = self._build_crowd_lanes()
        self.units_of_origin: dict[Origin, set[ThreadUnit]] = {}
        for unit, lane in self.lane_of_unit.items():
            for origin in lane.works:
                self.units_of_origin.setdefault(origin, set()).add(unit)
        self.paths: dict[tuple[str, ...], _Path] = {}
        self.pending_times: dict[Origin, int] = {}
        self.step_responses: dict[str, int] = {}
        self.whole_ways: set[tuple[str, int]] = set()

    def _build_crowd_lanes(self) -> dict[str, _Lane]:
        """Return the lanes of containers whose members wait for one another's threads."""
        names_by_container: dict[str, list[str]] = {}
        for name, (container, _) in self.cores.crowd_of.items():
            names_by_container.setdefault(container, []).append(name)
        return {container: self._build_lane(names) for container, names in names_by_container.items()}

    def _build_lane(self, names: Iterable[str]) -> _Lane:
        works: dict[Origin, int] = {}
        for name in names:
            cost = self.cores.system.activities[name].wcet
            for origin, multiplicity in self.cores.cascades.activations[name].items() if cost else ():
                works[origin] = works.get(origin, 0) + (cost or 0) * multiplicity
        share = sum_fractions([Fraction(0), *(self.demand.rate_of(origin) * work for origin, work in works.items())])
        return _Lane(works, share)

    def solve(self) -> CoreResponses:
        """Find the responses of all runs together, from below, and those of the activities."""
        cause = self._find_common_cause()
        if cause is not None:
            return self._give_up(cause)
        self.pending_times = dict.fromkeys(self.volumes, 0)
        for name in self.cores.foreign_ids:
            origin = Origin("activity", name)
            if origin in self.volumes:
                self.pending_times[origin] = self.known_responses[name].value or 0
        delays: dict[tuple[str, int], int] = {}
        try:
            for _ in range(_MAX_SWEEPS):
                if not self._sweep_ways(delays):
                    return self._build_responses(delays)
        except DivergedError:
            pass
        return self._give_up(DIVERGED_CAUSE)

    def _find_common_cause(self) -> UnknownCause | None:
        """Return why nothing is known of any response here, None where all is well."""
        if self.demand.share() >= self.core_count or any(lane.share >= 1 for lane in self.lane_of_unit.values()):
            return OVERLOAD_CAUSE
        unknown_costs = [
            UnknownCause((name,))
            for name in self.cores.cascades.unknown_costs
            if name not in self.cores.inner_triggers.silent_ids
        ]
        if unknown_costs or self.demand.causes:
            return unite_causes((*unknown_costs, *self.demand.causes))
        foreign_responses = [self.known_responses.get(name) for name in self.cores.foreign_ids]
        if any(response is not None and response.value is None for response in foreign_responses):
            return UNBOUNDED_CAUSE
        # What has no bound may wait in any amount, and comes in the way of all others at last.
        if any(self._fills_core((name,)) for name in self.cores.inner_triggers.order):
            return UNBOUNDED_CAUSE
        self.whole_ways = {
            (name, number)
            for name, ways in self.cores.ways_to.items()
            for number, way in enumerate(ways)
            if len(way.steps) > 1 and not self._fills_core(way.steps)
        }
        return None

    def _fills_core(self, steps: tuple[str, ...]) -> bool:
        """Whether the threads of some steps, and what keeps all cores busy beside them, fill a core in the long run."""
        path = self._look_at_path(steps)
        own_share = sum_fractions([Fraction(0), *(lane.share / divisor for lane, divisor in path.own_lanes)])
        other_shares = [lane.share for lane in path.other_lanes]
        # Most are far from it, as the plain sum says.
        if own_share + sum_fractions([Fraction(0), *other_shares]) / self.core_count < 1:
            return False
        numerator, denominator = _find_blocked_time(other_shares, Fraction(0), self.core_count)
        return own_share + numerator / denominator >= 1

    def _sweep_ways(self, delays: dict[tuple[str, int], int]) -> bool:
        """Find the delays of all ways anew for what may be pending now, and return whether that grew."""
        spend = self.budget.start_search()
        delays_by_steps: dict[tuple[Origin, tuple[str, ...]], int] = {}
        grown = False
        for name in self.cores.inner_triggers.order:
            step_response = self.step_responses[name] = self._find_delay(
                (name,), self.step_responses.get(name, 0), spend
            )
            for number, way in enumerate(self.cores.ways_to[name]):
                delay = step_response
                if len(way.steps) > 1:
                    delay += delays_by_steps[way.entry, way.steps[:-1]]
                    if (name, number) in self.whole_ways:
                        delay = self._find_delay(way.steps, delays.get((name, number), 0), spend, delay)
                delays[name, number] = delays_by_steps[way.entry, way.steps] = delay
                if delay > self.pending_times.get(way.entry, delay):
                    self.pending_times[way.entry] = delay
                    grown = True
        return grown

    def _find_delay(
        self, steps: tuple[str, ...], start: int, spend: Callable[[int], None], limit: int | None = None
    ) -> int:
        """Return the least window in which some steps are sure to be done, or `limit` where it is not less."""
        path = self._look_at_path(steps)
        window = max(start, path.cost, 1)
        while limit is None or window < limit:
            spend(4 * len(self.volumes) + 1)
            needed = self._time_needed(path, window)
            if needed <= window:
                return needed if window == 1 else window
            window = needed
        return limit

    def _look_at_path(self, steps: tuple[str, ...]) -> _Path:
        """Return what counts for some steps."""
        path = self.paths.get(steps)
        if path is None:
            units = dict.fromkeys(self.cores.unit_of[step] for step in steps)
            crowds = dict.fromkeys(self.cores.crowd_of[step] for step in steps if step in self.cores.crowd_of)
            other_lanes = {unit: lane for unit, lane in self.lane_of_unit.items() if unit not in units}
            path = self.paths[steps] = _Path(
                sum(self.cores.system.activities[step].wcet or 0 for step in steps),
                [
                    *((self.lane_of_unit[unit], 1) for unit in units),
                    *((self.crowd_lanes[name], min(threads, self.core_count)) for name, threads in crowds),
                ],
                frozenset(
                    origin for origin, origin_units in self.units_of_origin.items() if origin_units <= units.keys()
                ),
                list(other_lanes.values()),
                [
                    *(lane for unit, lane in other_lanes.items() if self._takes_core(unit)),
                    *self.crowd_lanes.values(),
                ],
            )
        return path

    def _takes_core(self, unit: ThreadUnit) -> bool:
        """Whether a thread takes a core that is idle as soon as it has work: it waits for no other thread, and no pin."""
        return unit[0] not in self.cores.crowd_of and unit[0] not in self.cores.foreign_ids

    def _time_needed(self, path: _Path, window: int) -> int:
        """Return how long all takes that may come in the way of a path in a window: A + B."""
        # The way's own time at least, also where it works only at the start and so has no events.
        path_work = max(self._path_work(path, window), path.cost)
        arrivals = {origin: max_arrivals(self.demand.streams_of(origin), window) for origin in self.volumes}
        lane_works = [
            sum([arrivals[origin] * work for origin, work in lane.works.items()]) for lane in path.other_lanes
        ]
        pending_work = self._pending_work(path, window, arrivals)
        # The plain quotient is a bound as well, and the exact one where no thread has more work than it.
        blocked_time = -(-(sum(lane_works) + pending_work) // self.core_count)
        if lane_works and max(lane_works) > blocked_time:
            numerator, denominator = _find_blocked_time(lane_works, pending_work, self.core_count)
            blocked_time = -(-numerator // denominator)
        return path_work + blocked_time

    def _path_work(self, path: _Path, window: int) -> int:
        """Return the work of the threads of a path in a window, as the time for which they can hold it up."""
        total = 0
        for lane, divisor in path.own_lanes:
            lane_work = 0
            for origin, work in lane.works.items():
                # At the start of the window nothing waits in the threads of the path themselves.
                pending_time = 0 if divisor == 1 and origin in path.inner_origins else self.pending_times[origin]
                lane_work += work * max_arrivals(self.demand.streams_of(origin), window + pending_time)
            total -= -lane_work // divisor
        return total

    def _pending_work(self, path: _Path, window: int, arrivals: Mapping[Origin, int]) -> int:
        """Return how much may have been pending before a window, while a core was idle.

        That is what waits for m - 1 threads, and all that is foreign, for it may have waited for a core of its own.
        """
        pending: dict[Origin, int] = {}
        for origin, volume in self.volumes.items():
            if origin not in path.inner_origins:
                streams = self.demand.streams_of(origin)
                carried = max_arrivals(streams, window + self.pending_times[origin]) - arrivals[origin]
                if carried:
                    pending[origin] = volume * carried
        if not pending:
            return 0
        foreign_work = sum([work for origin, work in pending.items() if origin.key in self.cores.foreign_ids])
        lane_works = [sum([pending.get(origin, 0) for origin in lane.works]) for lane in path.waiting_lanes]
        return min(sum(nlargest(self.core_count - 1, lane_works)) + foreign_work, sum(pending.values()))

    def _build_responses(self, delays: Mapping[tuple[str, int], int]) -> CoreResponses:
        responses: dict[str, WorstResponse] = {}
        ways_to: dict[str, tuple[EntryWay, ...]] = {}
        for name in self.cores.inner_triggers.order:
            ways = tuple(
                way._replace(delay=delays[name, number]) for number, way in enumerate(self.cores.ways_to[name])
            )
            activity = self.cores.system.activities[name]
            ways_to[name] = ways
            response = min(self.step_responses[name], max((way.delay or 0) - way.best_before for way in ways))
            responses[name] = (
                self._give_up_one(name, UnknownCause())
                if activity.wcet is None or activity.response is not None
                else WorstResponse(response, "executor" if len(self.cores.unit_of[name]) > 1 else "cores")
            )
        return CoreResponses(responses, ways_to)

    def _give_up(self, cause: UnknownCause) -> CoreResponses:
        return CoreResponses(
            {name: self._give_up_one(name, cause) for name in self.cores.inner_triggers.order},
            {name: self.cores.ways_to[name] for name in self.cores.inner_triggers.order},
        )

    def _give_up_one(self, name: str, cause: UnknownCause) -> WorstResponse:
        activity = self.cores.system.activities[name]
        if activity.response is not None:
            return WorstResponse(activity.response, "declared")
        if activity.wcet is None:
            return WorstResponse(None, "unknown", unite_causes((UnknownCause((name,)), cause)))
        return WorstResponse(None, "cores", cause)


def _find_blocked_time(lane_works: Sequence[_Amount], pending_work: _Amount, core_count: int) -> tuple[_Amount, int]:
    """Return the longest time B for which threads can keep all cores busy, as numerator and denominator.

    m B = pending work + sum of min(work, B): no thread works longer than that time.
    """
    rest = pending_work
    for work in lane_works:
        rest += work
    largest_works = nlargest(core_count - 1, lane_works)
    # The k threads with the most work are busy all the time: what is left fills the other m - k cores.
    for busy_count, work in enumerate(largest_works):
        if work * (core_count - busy_count) <= rest:
            return rest, core_count - busy_count
        rest -= work
    return rest, core_count - len(largest_works)
