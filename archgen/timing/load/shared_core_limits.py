"""What bounds activities on shared cores without regard to the bounds of others, and what may be spent on smaller bounds."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from archgen.timing.load.busy_windows import SearchBudget
from archgen.timing.load.core_paths import CorePaths
from archgen.timing.load.core_responses import CoreResponses
from archgen.timing.load.idle_backlogs import IdleBacklog
from archgen.timing.load.run_ways import EntryWay
from archgen.timing.load.shared_cores import SharedCores, WayKey
from archgen.timing.load.whole_hosts import HostLimit

_REFINING_TERMS = 80_000
"""Terms for which bounds in any order are looked for below the limits that a backlog gives: some 50 ms' worth."""
_MAX_TERMS_PER_LOOK = 500
"""Terms of one look at all ways: where it takes more, only what needs no search is looked for below the limits."""
_RANKED_TERMS = 300_000
"""The same where there are priorities, for what is urgent has far less in its way than in any order, and without limits."""
_TERMS_PER_CALM_WAY = 16
"""Terms that a way takes where nothing comes twice in its windows."""


class SharedCoreLimits:
    """The limits of the host as a whole (`of_host`), of what was `found` before, and of the cores' backlog, once it is known."""

    def __init__(
        self,
        ways_to: Mapping[str, Sequence[EntryWay]],
        of_host: Mapping[str, HostLimit],
        found: CoreResponses | None = None,
    ) -> None:
        """Begin without a backlog."""
        self.ways_to, self.of_host = ways_to, of_host
        self.found_ways = {
            name: found.ways_to[name]
            for name, response in (found.response_of if found else {}).items()
            if response.value is not None and found and all(way.delay is not None for way in found.ways_to[name])
        }
        self.found_responses = {name: found.response_of[name].value or 0 for name in self.found_ways} if found else {}
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
        return (
            name in self.of_host
            or name in self.found_ways
            or (self.backlog is not None and (name, 0) in self.backlog.delays)
        )

    def limit_delay(self, key: WayKey) -> int | None:
        """Return the limit of a way."""
        if key not in self._delays:
            limit = self.of_host.get(key[0])
            delays = [limit.delay] if limit else []
            if key[0] in self.found_ways:
                delays.append(self.found_ways[key[0]][key[1]].delay or 0)
            if self.backlog and key in self.backlog.delays:
                delays.append(self.backlog.delays[key])
            self._delays[key] = min(delays, default=None)
        return self._delays[key]

    def limit_response(self, name: str) -> int | None:
        """Return the limit of a response."""
        if name not in self._responses:
            limit = self.of_host.get(name)
            responses = [limit.response] if limit else []
            if name in self.found_responses:
                responses.append(self.found_responses[name])
            if self.backlog and (name, 0) in self.backlog.delays:
                ways = enumerate(self.ways_to[name])
                responses.append(max(self.backlog.delays[name, number] - way.best_before for number, way in ways))
            self._responses[name] = min(responses, default=None)
        return self._responses[name]


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
