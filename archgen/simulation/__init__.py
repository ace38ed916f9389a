"""Simulation of the modelled architecture: what was seen in so many seconds, from so many seeds.

`flatten` makes a system a plan of lists, `engine` runs one seed of it, `series` reads reaction times and data ages off the
traces, and `simulate` puts the seeds together. What is seen is a lower bound on the worst case, never the worst case.
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
