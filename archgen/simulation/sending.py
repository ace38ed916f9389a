"""Send samples: at once on one host, over a link with latency and bandwidth between two."""

from __future__ import annotations

from heapq import heappush

from archgen.simulation.arriving import deliver
from archgen.simulation.run import ARRIVAL, Run


def send(run: Run, now: int, wire: int, sample: int) -> None:
    """Send a sample, over its link if it has one; the samples of one wire keep their order."""
    wires = run.wires
    if wires.direct[wire]:
        # Delivered without an event: most wires are local, and the heap is the most expensive part.
        wires.sent += 1
        deliver(run, now, wire, sample)
        return
    there = now + wires.best[wire]
    spread = wires.spread[wire]
    if spread:
        # The reader's share of extremes is used, since wires have none of their own.
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
    """Queue a sample for a link's bandwidth and return when it arrives.

    A declared latency includes queueing and is kept; without one, queueing is added on top.
    """
    wires = run.wires
    link, transmission = wires.link[wire], wires.transmission[wire]
    free = wires.link_free[link]
    sent = (free if free > now else now) + transmission  # noqa: FURB136 - a call costs more than the comparison
    wires.link_free[link] = sent
    wires.link_busy[link] += transmission
    wires.link_wait[link] = max(wires.link_wait[link], sent - now)
    limit = wires.limit[wire]
    if limit is None:
        return there + sent - now
    return max(there, min(sent, now + limit))
