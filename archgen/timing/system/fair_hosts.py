"""Hosts that share their cores fairly, as Linux does: which they are, and what is assumed where nobody wrote it."""

from __future__ import annotations

from fractions import Fraction

from archgen.model.declared_timing import ASSUMED_LEAD, ASSUMED_SLICE, ASSUMED_TICK, FairScheduling
from archgen.model.deployment import Host
from archgen.timing.figures.tick_unit import TickUnit
from archgen.timing.system.core_placement import ProcessingResource
from archgen.timing.system.timing_system import FairShare, TimingSystem

PREEMPTIVE_ORDERS = frozenset({None, "fair", "fixed_priority"})
"""The orders of a host on which what has a priority preempts all that is less urgent."""


def build_fair_share(host: Host, tick_unit: TickUnit) -> FairShare:
    """Return how a host shares its cores, with what is assumed of it."""
    written = host.fair or FairScheduling()
    slice_time, tick_time = written.slice or ASSUMED_SLICE, written.tick or ASSUMED_TICK
    lead = written.lead or ASSUMED_LEAD
    figures = f"{lead} times a slice of {slice_time} and a tick of {tick_time}"
    is_all_written = None not in (host.scheduling, written.slice, written.tick, written.lead)
    turn = tick_unit.ns_to_ticks(slice_time.value + tick_time.value)
    other_load = written.other_load or Fraction(0)
    left = 1 - other_load
    return FairShare(
        # What is served takes longer beside other programs, a lead as well.
        -(-lead * turn * left.denominator // left.numerator),
        turn,
        other_load,
        "" if is_all_written else f"threads of {host.id} lead one another by at most {figures}",
        figures,
    )


def find_fair_share(system: TimingSystem, resource: ProcessingResource) -> FairShare | None:
    """Return how the threads of a resource share its cores; None where their order is another one, or not the same."""
    # What may run on other cores as well, or waits for what does, is served elsewhere too: nothing is proven of it.
    if resource.joined or resource.missing or resource.stranger_units:
        return None
    host = resource.host or ""
    orders = {
        order
        for (name, core), order in system.core_orders.items()
        if name == host and (core in resource.core_set or not resource.core_set)
    }
    return system.fair_shares.get(host) if orders <= {"fair"} else None
