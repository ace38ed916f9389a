"""Samples leave: at once on one host, over a link with its latency and bandwidth between two."""

from __future__ import annotations

from heapq import heappush

from archgen.simulation.arriving import deliver
from archgen.simulation.run import ARRIVAL, Run


def send(run: Run, now: int, wire: int, sample: int) -> None:
    """Send a sample, over the link if there is one; samples of one wire keep their order."""
    wires = run.wires
    if wires.direct[wire]:
        wires.sent += 1
        deliver(run, now, wire, sample)
        return
    there = now + wires.best[wire]
    spread = wires.spread[wire]
    if spread:
        there = run.between(wires.target[wire], there, spread)
    if wires.link[wire] >= 0:
        there = _over_link(run, now, there, wire)
    last = wires.last
    if there < last[wire]:
        there = last[wire]
    else:
        last[wire] = there
    heappush(run.heap, (there << 2 | ARRIVAL, wire, sample))


def _over_link(run: Run, now: int, there: int, wire: int) -> int:
    """Queue for a link's bandwidth. A declared latency holds with the queueing in it, and is kept in any case."""
    wires = run.wires
    link, transmission = wires.link[wire], wires.transmission[wire]
    free = wires.link_free[link]
    sent = (free if free > now else now) + transmission  # noqa: FURB136 - a call costs more than the comparison
    wires.link_free[link] = sent
    wires.link_busy[link] += transmission
    wires.link_wait[link] = max(wires.link_wait[link], sent - now)
    if sent <= there:
        return there
    limit = wires.limit[wire]
    return sent if limit is None or sent <= now + limit else now + limit
