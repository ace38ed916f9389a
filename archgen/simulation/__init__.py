"""Simulation of the modelled architecture: what was seen in so many seconds, from so many seeds.

`plan` flattens a system to lists, `engine` runs one seed of it, `chains` reads reaction times and data ages off the
traces, and `simulate` puts the seeds together. What is seen is a lower bound on the worst case, never the worst case.
"""

from archgen.simulation.simulate import ActivitySeen, ChainSeen, Distribution, HostSeen, LinkSeen, Result, simulate

__all__ = ["ActivitySeen", "ChainSeen", "Distribution", "HostSeen", "LinkSeen", "Result", "simulate"]
