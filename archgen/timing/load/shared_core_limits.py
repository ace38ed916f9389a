"""What bounds activities on shared cores without regard to the bounds of others, and what may be spent on smaller bounds."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from fractions import Fraction

from archgen.timing.figures.timing_values import sum_fractions
from archgen.timing.load.busy_windows import SHARE_BITS, SearchBudget, find_blocked_time, round_up_share
from archgen.timing.load.core_paths import CorePath, CorePaths
from archgen.timing.load.idle_backlogs import IdleBacklog
from archgen.timing.load.level_cascades import CascadeDemand, EntryWay
from archgen.timing.load.shared_cores import SharedCores, WayKey
from archgen.timing.load.whole_hosts import HostLimit
from archgen.timing.system.thread_pools import ThreadUnit

_REFINING_TERMS = 80_000
"""Terms for which bounds in any order are looked for below the limits that a backlog gives: some 50 ms' worth."""
_MAX_TERMS_PER_LOOK = 500
"""Terms of one look at all ways: where it takes more, only what needs no search is looked for below the limits."""
_RANKED_TERMS = 300_000
"""The same where there are priorities, for what is urgent has far less in its way than in any order, and without limits."""
_TERMS_PER_CALM_WAY = 16
"""Terms that a way takes where nothing comes twice in its windows."""


class SharedCoreLimits:
    """The limits of the host as a whole (`of_host`), and those of the backlog of the cores, once it is found."""

    def __init__(self, ways_to: Mapping[str, Sequence[EntryWay]], of_host: Mapping[str, HostLimit]) -> None:
        """Begin without a backlog."""
        self.ways_to, self.of_host = ways_to, of_host
        self.backlog: IdleBacklog | None = None
        # Each sweep asks for all of them.
        self._delays: dict[WayKey, int | None] = {}
        self._responses: dict[str, int | None] = {}

    def note_backlog(self, backlog: IdleBacklog | None) -> None:
        """Take the limits of a backlog."""
        self.backlog = backlog
        self._delays.clear()
        self._responses.clear()

    def has_limit(self, name: str) -> bool:
        """Whether an activity has a limit."""
        return name in self.of_host or (self.backlog is not None and (name, 0) in self.backlog.delays)

    def limit_delay(self, key: WayKey) -> int | None:
        """Return the limit of a way."""
        if key not in self._delays:
            limit = self.of_host.get(key[0])
            delays = [limit.delay] if limit and limit.delay is not None else []
            if self.backlog and key in self.backlog.delays:
                delays.append(self.backlog.delays[key])
            self._delays[key] = min(delays, default=None)
        return self._delays[key]

    def limit_response(self, name: str) -> int | None:
        """Return the limit of a response."""
        if name not in self._responses:
            limit = self.of_host.get(name)
            responses = [limit.response] if limit else []
            if self.backlog and (name, 0) in self.backlog.delays:
                ways = enumerate(self.ways_to[name])
                responses.append(max(self.backlog.delays[name, number] - way.best_before for number, way in ways))
            self._responses[name] = min(responses, default=None)
        return self._responses[name]


class CoreShares:
    """The shares of all threads of some cores, for given event models."""

    def __init__(self, cores: SharedCores, demand: CascadeDemand) -> None:
        """Add up what each thread does."""
        self.cores = cores
        self._job_shares = [demand.rate_of(job.origin) * job.work for job in cores.jobs]
        self._unit_shares = {unit: self._sum_jobs(numbers) for unit, numbers in cores.job_numbers.items()}
        # Whole numbers, rounded up, for what is asked of each path: most are far from filling a core.
        self._rough_shares = {unit: round_up_share(share) for unit, share in self._unit_shares.items()}
        self._rough_total = sum(self._rough_shares.values())

    def _sum_jobs(self, job_numbers: Iterable[int]) -> Fraction:
        return sum_fractions(self._job_shares[number] for number in job_numbers)

    def fills_thread(self, unit: ThreadUnit) -> bool:
        """Whether a thread is busy all the time."""
        return self._unit_shares[unit] >= self.cores.reentrant_units.get(unit, 1)

    def fills_core(self, steps: tuple[str, ...], path: CorePath) -> bool:
        """Whether the threads of some steps, and what keeps all cores busy beside them, fill a core in the long run."""
        units = {unit: None for step in steps if (unit := self.cores.unit_of[step]) not in self.cores.reentrant_units}
        core_count = self.cores.core_count
        rough_share = sum([self._rough_shares[unit] for unit in units])
        if not path.crowds and rough_share * (core_count - 1) + self._rough_total < core_count << SHARE_BITS:
            return False
        own_share = sum_fractions(
            [
                *(self._unit_shares[unit] for unit in units),
                *(self._sum_jobs(numbers) / threads for numbers, threads in path.crowds),
            ]
        )
        other_shares = [
            self._unit_shares[self.cores.jobs[lane[0]].unit] / width
            for lane, width in zip(path.other_lanes, path.lane_widths, strict=True)
            for _ in range(width)
        ]
        if path.crowds:
            return own_share + sum_fractions(other_shares) / core_count >= 1
        numerator, denominator = find_blocked_time(other_shares, Fraction(0), core_count)
        return own_share + numerator / denominator >= 1


def has_priorities(cores: SharedCores) -> bool:
    """Whether anything on some cores has a priority."""
    return any(thread.highest_priority is not None for thread in cores.threads.values())


def open_refining_budget(budget: SearchBudget, paths: CorePaths, backlog: IdleBacklog | None) -> SearchBudget:
    """Return what may be spent on bounds below those of a backlog: where it is too little for some sweeps, next to nothing."""
    if backlog is None or has_priorities(paths.cores):
        return budget.open_part(_RANKED_TERMS)
    way_count = len(paths.way_works)
    terms_per_look = way_count * (len(backlog.streams) + len(paths.cores.jobs))
    return budget.open_part(
        _REFINING_TERMS if terms_per_look <= _MAX_TERMS_PER_LOOK else _TERMS_PER_CALM_WAY * way_count
    )
