"""Match samples by their stamps, as message_filters does.

`ApproximateTimeMatcher` follows the documented algorithm of ApproximateTime: no sample is used twice, sets do not cross,
and of the sets that hold the pivot the smallest is taken. The pivot is the latest of the samples that come first in their
queues; a set is given out as soon as no later sample could make a smaller one. `ExactTimeMatcher` takes equal stamps only.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from typing import Protocol

StampedSample = tuple[int, int, int]
"""Stamp, wire, and number of the producer's job."""


class TimeMatcher(Protocol):
    """Collects samples of several inputs and gives out sets of one each."""

    dropped_wires: list[int]
    """The wires of samples that will be in no set, to be cleared by the caller."""

    def add_sample(self, slot: int, sample: StampedSample) -> Sequence[Sequence[StampedSample]]:
        """Add a sample of an input and return the sets that are complete now."""


def make_matcher(depths: Sequence[int], within: int) -> TimeMatcher:
    """Return a matcher for inputs with these depths; stamps of a set are at most `within` apart, 0 for equal ones."""
    return ApproximateTimeMatcher(depths, within) if within else ExactTimeMatcher(depths)


class ExactTimeMatcher:
    """Sets of samples with the same stamp. When one is complete, older samples wait no longer."""

    def __init__(self, depths: Sequence[int]) -> None:
        self.slot_count = len(depths)
        self.depth = max(depths, default=0)
        self.waiting: dict[int, dict[int, StampedSample]] = {}
        self.dropped_wires: list[int] = []

    def add_sample(self, slot: int, sample: StampedSample) -> Sequence[Sequence[StampedSample]]:
        """Add a sample of an input and return the set that is complete now, if one is."""
        stamp = sample[0]
        partners = self.waiting.setdefault(stamp, {})
        partners[slot] = sample
        if len(partners) == self.slot_count:
            del self.waiting[stamp]
            self._drop_stamps([old_stamp for old_stamp in self.waiting if old_stamp < stamp])
            return [[partners[index] for index in range(self.slot_count)]]
        if len(self.waiting) > self.depth:
            self._drop_stamps([min(self.waiting)])
        return []

    def _drop_stamps(self, stamps: Sequence[int]) -> None:
        for stamp in stamps:
            self.dropped_wires += [wire for _, wire, _ in self.waiting.pop(stamp).values()]


class ApproximateTimeMatcher:
    """Sets of samples that are as close in time as can be, and at most `within` apart."""

    def __init__(self, depths: Sequence[int], within: int) -> None:
        self.depths = depths
        self.within = within
        self.slots = range(len(depths))
        self.queues: list[deque[StampedSample]] = [deque() for _ in depths]
        self.passed: list[list[StampedSample]] = [[] for _ in depths]
        """Samples that were looked at after the candidate was made: if it is given out, they wait for the next set."""
        self.overflowed = [False] * len(depths)
        """Whether a queue has lost samples, so that its first one cannot be a pivot."""
        self.candidate: list[StampedSample] = []
        self.pivot_slot = -1
        self.dropped_wires: list[int] = []

    def add_sample(self, slot: int, sample: StampedSample) -> Sequence[Sequence[StampedSample]]:
        """Add a sample of an input and return the sets that are complete now."""
        self.queues[slot].append(sample)
        sets = self._find_sets() if len(self.queues[slot]) == 1 else []
        if len(self.queues[slot]) + len(self.passed[slot]) > self.depths[slot]:
            self._give_up_candidate()
            self._drop_first(slot)
            self.overflowed[slot] = True
            sets += self._find_sets()
        return sets

    def _find_sets(self) -> list[list[StampedSample]]:
        sets: list[list[StampedSample]] = []
        while all(self.queues):
            stamps = [queue[0][0] for queue in self.queues]
            start, end = min(stamps), max(stamps)
            first_slot = stamps.index(start)
            last_slot = max(slot for slot in self.slots if stamps[slot] == end)
            for slot in self.slots:
                # What a queue lost cannot have been better than what is there, for the latest is in another one.
                if slot != last_slot:
                    self.overflowed[slot] = False
            if not self.candidate:
                if end - start > self.within or self.overflowed[last_slot]:
                    self._drop_first(first_slot)
                    continue
                self.pivot_slot = last_slot
                self._make_candidate()
            elif end - start < self._candidate_end() - self._candidate_start():
                self._make_candidate()
            self.passed[first_slot].append(self.queues[first_slot].popleft())
            if (
                first_slot == self.pivot_slot
                or not self._may_improve(end)
                or (not all(self.queues) and not self._may_later_samples_improve())
            ):
                sets.append(self._take_candidate())
        return sets

    def _make_candidate(self) -> None:
        # What was passed before is older than the new candidate: the next set cannot use it.
        for samples in self.passed:
            self.dropped_wires += [wire for _, wire, _ in samples]
            samples.clear()
        self.candidate = [queue[0] for queue in self.queues]

    def _candidate_start(self) -> int:
        return min(stamp for stamp, _, _ in self.candidate)

    def _candidate_end(self) -> int:
        return max(stamp for stamp, _, _ in self.candidate)

    def _may_improve(self, end: int) -> bool:
        """Return whether a set that ends at `end` or later could be smaller: it must begin before or at the pivot."""
        pivot_stamp = self.candidate[self.pivot_slot][0]
        return end - self._candidate_end() < pivot_stamp - self._candidate_start()

    def _may_later_samples_improve(self) -> bool:
        """Return whether samples that have not come yet could make a smaller set: they are no older than the last of
        their input, and what is older than the pivot cannot help.
        """
        pivot_stamp = self.candidate[self.pivot_slot][0]
        positions = [0] * len(self.queues)
        while True:
            stamps = []
            for slot in self.slots:
                if positions[slot] < len(self.queues[slot]):
                    stamps.append(self.queues[slot][positions[slot]][0])
                else:
                    newest = self.queues[slot][-1] if self.queues[slot] else self.passed[slot][-1]
                    stamps.append(max(newest[0], pivot_stamp))
            start, end = min(stamps), max(stamps)
            if not self._may_improve(end):
                return False
            if end - self._candidate_end() < start - self._candidate_start():
                return True
            first_slot = stamps.index(start)
            if positions[first_slot] >= len(self.queues[first_slot]):
                return True
            positions[first_slot] += 1

    def _drop_first(self, slot: int) -> None:
        self.dropped_wires.append(self.queues[slot].popleft()[1])

    def _give_up_candidate(self) -> None:
        for slot in self.slots:
            self.queues[slot].extendleft(reversed(self.passed[slot]))
            self.passed[slot].clear()
        self.candidate = []

    def _take_candidate(self) -> list[StampedSample]:
        """Give out the candidate; what was passed since it was made waits for the next set."""
        candidate = self.candidate
        self._give_up_candidate()
        for queue in self.queues:
            queue.popleft()
        return candidate
