"""Send samples: at once on one host, over a link with latency and bandwidth between two."""

from __future__ import annotations

from heapq import heappush

from archgen.simulation.sample_arrival import deliver_sample
from archgen.simulation.simulation_run import SAMPLE_ARRIVAL, SimulationRun


def send_sample(run: SimulationRun, now: int, wire: int, sample: int) -> None:
    """Send a sample, over its link if it has one; the samples of one wire keep their order."""
    wires = run.wires
    if wires.is_direct[wire]:
        # Delivered without an event: most wires are local, and the heap is the most expensive part.
        wires.sent_count += 1
        deliver_sample(run, now, wire, sample)
        return
    arrival = now + wires.best_latency[wire]
    spread = wires.latency_spread[wire]
    if spread:
        # The reader's share of extremes is used, since wires have none of their own.
        arrival = run.draw_time(wires.target[wire], arrival, spread)
    if wires.link[wire] >= 0:
        arrival = _queue_on_link(run, now, arrival, wire)
    last_arrival = wires.last_arrival
    if arrival < last_arrival[wire]:
        arrival = last_arrival[wire]
    else:
        last_arrival[wire] = arrival
    heappush(run.heap, (arrival << 2 | SAMPLE_ARRIVAL, wire, sample))


def _queue_on_link(run: SimulationRun, now: int, arrival: int, wire: int) -> int:
    """Queue a sample for a link's bandwidth and return when it arrives.

    A declared latency includes queueing and is kept; without one, queueing is added on top.
    """
    wires = run.wires
    link, transmission = wires.link[wire], wires.transmission[wire]
    free_from = wires.link_free[link]
    sent_at = (free_from if free_from > now else now) + transmission  # noqa: FURB136 - a call costs more than the comparison
    wires.link_free[link] = sent_at
    wires.link_busy[link] += transmission
    wires.link_wait[link] = max(wires.link_wait[link], sent_at - now)
    declared = wires.declared_latency[wire]
    if declared is None:
        return arrival + sent_at - now
    return max(arrival, min(sent_at, now + declared))
