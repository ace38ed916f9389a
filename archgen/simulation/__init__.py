"""Simulate the architecture as it is modelled and record what was observed over many runs.

`plan_builder` turns a system into a plan of lists, `event_loop` runs one seed of it, `chain_series` reads reaction
times and data ages off the traces, and `simulate_system` puts the seeds together. An observed maximum is a lower bound
on the worst case, never the worst case itself.
"""

from archgen.simulation.result import ActivitySeen, ChainSeen, Distribution, Figures, HostSeen, LinkSeen, Result
from archgen.simulation.simulate import simulate

__all__ = [
    "ActivitySeen",
    "ChainSeen",
    "Distribution",
    "Figures",
    "HostSeen",
    "LinkSeen",
    "Result",
    "simulate",
]
