"""The times in which a tracer lost events: what went on meanwhile cannot be counted."""

from __future__ import annotations

import heapq

_MAX_LOSSES = 10_000
"""More of them are taken for one, so that a file of warnings takes no more room."""


class LossTimes:
    """The times between which the tracer lost events."""

    def __init__(self) -> None:
        self._times: list[tuple[int, int]] = []
        self._end = -1
        """The end of those that have begun."""

    def add_times(self, start: int, end: int) -> None:
        """Add a time in which events were lost."""
        heapq.heappush(self._times, (start, end))
        if len(self._times) > _MAX_LOSSES:
            self._times = [(self._times[0][0], max(end for _, end in self._times))]

    def has_begun(self, time: int) -> bool:
        """Whether such a time has begun since the last call, or still lasts."""
        has_begun = self.covers(time)
        while self._times and self._times[0][0] <= time:
            self._end = max(self._end, heapq.heappop(self._times)[1])
            has_begun = True
        return has_begun

    def covers(self, time: int) -> bool:
        """Whether events of this time may be lost."""
        return time <= self._end
