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
    spread = wires.spread[wire]
    there = now + (run.between(wires.target[wire], wires.best[wire], spread) if spread else wires.best[wire])
    if wires.link[wire] >= 0:
        there = _over_link(run, now, there, wire)
    there = wires.last[wire] = max(there, wires.last[wire])
    heappush(run.heap, (there << 2 | ARRIVAL, wire, sample))


def _over_link(run: Run, now: int, there: int, wire: int) -> int:
    """Queue for a link's bandwidth. A declared latency holds with the queueing in it, and is kept in any case."""
    wires = run.wires
    link, limit = wires.link[wire], wires.limit[wire]
    sent = max(now, wires.link_free[link]) + wires.transmission[wire]
    wires.link_free[link] = sent
    wires.link_busy[link] += wires.transmission[wire]
    wires.link_wait[link] = max(wires.link_wait[link], sent - now)
    there = max(there, sent)
    return there if limit is None else min(there, now + limit)
