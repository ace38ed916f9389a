"""The shares of cores that threads take in the long run: where they fill a core, nothing beside them has a bound."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction

from archgen.timing.figures.timing_values import sum_fractions
from archgen.timing.load.busy_cores import find_blocked_time
from archgen.timing.load.cascade_demand import CascadeDemand
from archgen.timing.load.core_paths import CorePath
from archgen.timing.load.shared_cores import SharedCores
from archgen.timing.system.core_sets import ThreadUnit

_SHARE_BITS = 64


class CoreShares:
    """The shares of all threads of some cores, for given event models."""

    def __init__(self, cores: SharedCores, demand: CascadeDemand) -> None:
        """Add up what each thread does."""
        self.cores = cores
        self._job_shares = [demand.rate_of(job.origin) * job.work for job in cores.jobs]
        self._unit_shares = {unit: self._sum_jobs(numbers) for unit, numbers in cores.job_numbers.items()}
        # Whole numbers, rounded up, for what is asked of each path: most are far from filling a core.
        self._rough_shares = {unit: _round_up(share) for unit, share in self._unit_shares.items()}
        self._rough_total = sum(self._rough_shares.values())

    def _sum_jobs(self, job_numbers: Iterable[int]) -> Fraction:
        return sum_fractions([Fraction(0), *(self._job_shares[number] for number in job_numbers)])

    def fills_thread(self, unit: ThreadUnit) -> bool:
        """Whether a thread is busy all the time."""
        return self._unit_shares[unit] >= self.cores.reentrant_units.get(unit, 1)

    def choose_full_units(self) -> list[ThreadUnit]:
        """Return the threads that are busy all the time; else the one that comes nearest, if it leaves no backlog an end."""
        full_units = [unit for unit in self._unit_shares if self.fills_thread(unit)]
        if full_units or not self._unit_shares:
            return full_units
        unit, share = max(self._unit_shares.items(), key=lambda pair: pair[1])
        core_count = self.cores.core_count
        total = sum_fractions(self._unit_shares.values())
        return [unit] if share * (core_count - 1) + total >= core_count else []

    def fills_core(self, steps: tuple[str, ...], path: CorePath) -> bool:
        """Whether the threads of some steps, and what keeps all cores busy beside them, fill a core in the long run."""
        units = {unit: None for step in steps if (unit := self.cores.unit_of[step]) not in self.cores.reentrant_units}
        core_count = self.cores.core_count
        rough_share = sum([self._rough_shares[unit] for unit in units])
        if not path.crowds and rough_share * (core_count - 1) + self._rough_total < core_count << _SHARE_BITS:
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
            return own_share + sum_fractions([Fraction(0), *other_shares]) / core_count >= 1
        numerator, denominator = find_blocked_time(other_shares, Fraction(0), core_count)
        return own_share + numerator / denominator >= 1


def _round_up(share: Fraction) -> int:
    return -((-share.numerator << _SHARE_BITS) // share.denominator)
