"""How long messages are on a link of which only the bandwidth is written: until all that can wait before it is sent.

In whatever order messages are sent, each has left at the end of the longest busy period. That delays what comes next,
and makes what this sends in turn burstier; so links and everything else are looked at in turns, from below, until
nothing changes.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from itertools import count

from archgen.timing.propagate import State, propagate
from archgen.timing.sending import sent
from archgen.timing.system import Arc, System, grouped
from archgen.timing.ticks import SECOND
from archgen.timing.triggers import Triggers, triggers
from archgen.timing.value import Cause, summed, united
from archgen.timing.windows import Budget, DivergedError, Load, Work, busy

_TURNS = 24
"""Turns after which links that still change are given up."""
_LONGEST = 20 * SECOND
"""A computed latency (ns) above this is not given: the link counts as unknown."""
SATURATED, DIVERGED = Cause(notes=("unbounded",)), Cause(notes=("diverged",))


def settled(system: System) -> tuple[System, Triggers, State]:
    """Return the system with the latencies of its links, where only the bandwidth is written, and its state."""
    waits: dict[str, int | None] = {arc.link: 0 for arc in system.arcs if _asks(system, arc) and arc.link is not None}
    # One budget for all turns: a search that never ends must not begin anew with each of them.
    budget = Budget()
    for turn in count(1):
        tried = _with(system, waits) if waits else system
        firing = triggers(tried)
        state = propagate(tried, firing, budget)
        crossing = grouped((arc.link or "", arc) for arc in tried.arcs if arc.link in waits)
        found = {link: None if was is None else _wait(state, link, crossing[link]) for link, was in waits.items()}
        if found == waits:
            break
        # Every so many turns whatever still changes is given up, so that the others can settle without it. None stays
        # None, thus the loop ends.
        waits = found if turn % _TURNS else {link: was if was == waits[link] else None for link, was in found.items()}
    return tried, firing, state


def _asks(system: System, arc: Arc) -> bool:
    """Whether an arc's latency is to be computed from its link's bandwidth."""
    return arc.link is not None and arc.worst is None and bool(system.bandwidths.get(arc.link))


def _with(system: System, waits: Mapping[str, int | None]) -> System:
    """Return the system with computed latencies, on top of the best ones that are written."""

    def laid(arc: Arc) -> Arc:
        wait = waits.get(arc.link) if arc.link is not None and arc.worst is None else None
        return arc if wait is None else replace(arc, best=arc.best or 0, worst=(arc.best or 0) + wait)

    arcs = tuple(laid(arc) for arc in system.arcs)
    return replace(
        system,
        arcs=arcs,
        into=grouped((arc.target, arc) for arc in arcs),
        out_of=grouped((arc.source, arc) for arc in arcs),
        queued=frozenset(link for link, wait in waits.items() if wait is not None),
    )


def _wait(state: State, link: str, arcs: Iterable[Arc]) -> int | None:
    """Return the computed wait for a link in ticks, None where there is none."""
    found = longest(state, link, arcs)
    return None if isinstance(found, Cause) or found * state.system.tick > _LONGEST else found


def longest(state: State, link: str, arcs: Iterable[Arc]) -> int | Cause:
    """Return the longest busy period of a link in ticks (rounded up), or why there is none."""
    bandwidth = state.system.bandwidths[link]
    if not bandwidth:
        return Cause((link,))
    # Ticks per byte. A bandwidth is in B/s here: one byte takes 1 / bandwidth seconds.
    above, below = (SECOND / (bandwidth * state.system.tick)).as_integer_ratio()
    works: list[Work] = []
    causes: list[Cause] = []
    for arc in arcs:
        events = sent(state, arc)
        if isinstance(events, Cause):
            causes.append(events if events.missing else Cause((arc.source,), events.notes))
        elif arc.size is None and events:
            causes.append(Cause((arc.topic,)))
        elif arc.size:
            works.append(Work(-(-arc.size * above // below), events))
    sent_, room = summed((stream.ratio[0] * work.cost, stream.ratio[1]) for work in works for stream in work.streams)
    # Before the causes: what is known fills the link already, whatever else comes.
    if sent_ >= room:
        return SATURATED
    if causes:
        return united(causes)
    try:
        return busy(Load(works).demand(), Budget()) if works else 0
    except DivergedError:
        return DIVERGED
