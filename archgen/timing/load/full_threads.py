"""Threads that may be busy all the time, on cores that share their work, and the cores that are left beside them.

What is full has no bound, nor has what it fires. But a thread works on one core at a time. Leave f full threads out, and let
the others have m' = m - f cores. Whenever one of these others is ready and does not run, all m cores are busy, at
most f of them with full threads, so that at least m' others run. Let t0 be the last instant at which nothing waited in the
threads of a path and fewer than m' others ran. Then a core was idle (or busy with something less urgent), so that
whatever had work of the others was running: in fewer than m' threads. So all that is said of m cores holds of m' and the
others, with "m' of the others run" for "all m cores are busy", and "fewer than m' of them run" for "a core is idle".
"""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import replace
from fractions import Fraction

from archgen.timing.figures.timing_values import sum_fractions
from archgen.timing.load.busy_cores import find_blocked_time
from archgen.timing.load.cascade_demand import CascadeDemand
from archgen.timing.load.core_paths import CorePath
from archgen.timing.load.shared_cores import SharedCores, prepare_shared_cores
from archgen.timing.system.core_placement import ProcessingResource
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


def find_full_ids(cores: SharedCores, full_units: Iterable[ThreadUnit]) -> frozenset[str]:
    """Return what is in full threads, and in those and the containers that wait for them."""
    full_ids = {name for unit in full_units for name in unit}
    has_grown = bool(full_ids)
    while has_grown:
        crowds = {cores.crowd_of[name] for name in full_ids if name in cores.crowd_of}
        new_ids = {
            member
            for name, unit in cores.unit_of.items()
            if name not in full_ids and (_is_fed_by(cores, name, full_ids) or cores.crowd_of.get(name) in crowds)
            for member in unit
        }
        has_grown = bool(new_ids)
        full_ids |= new_ids
    return frozenset(full_ids)


def _is_fed_by(cores: SharedCores, name: str, full_ids: Collection[str]) -> bool:
    return any(each.arc.source in full_ids for each in cores.inner_triggers.inner_arcs.get(name, ())) or any(
        step in full_ids for way in cores.ways_to.get(name, ()) for step in way.steps
    )


def leave_out_threads(cores: SharedCores, full_ids: Collection[str]) -> SharedCores | None:
    """Return the cores that are left beside what is full, without it; None where nothing is left."""
    full_units = [unit for unit in cores.job_numbers if unit[0] in full_ids]
    widths: dict[object, int] = {}
    for unit in full_units:
        crowd = cores.crowd_of.get(unit[0])
        lane = crowd or unit
        width = widths.get(lane, 0) + cores.reentrant_units.get(unit, 1)
        widths[lane] = min(width, crowd[1]) if crowd else width
    core_count = cores.core_count - sum(widths.values())
    own_units = tuple(unit for unit in cores.own_units if unit not in full_units)
    if core_count < 1 or not own_units:
        return None
    foreign_units = tuple(unit for unit in cores.job_numbers if unit[0] in cores.foreign_ids and unit not in full_units)
    order = tuple(name for name in cores.inner_triggers.order if name not in full_ids)
    resource = ProcessingResource("left", None, core_count, own_units, foreign_units)
    return prepare_shared_cores(cores.system, resource, replace(cores.inner_triggers, order=order))


def find_demand_left(cores: SharedCores, demand: CascadeDemand) -> CascadeDemand:
    """Return the demand of the cores that are left, of which all that enters is known."""
    return CascadeDemand(cores.cascades, demand.streams_of)


def _round_up(share: Fraction) -> int:
    return -((-share.numerator << _SHARE_BITS) // share.denominator)
