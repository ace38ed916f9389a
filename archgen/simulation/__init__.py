"""Simulate the architecture as it is modelled and record what was observed over many runs.

`plan_builder` turns a system into a plan of lists, `event_loop` runs one seed of it, `chain_series` reads reaction
times and data ages off the traces, and `simulate_system` puts the seeds together; `find_late_runs` looks for a seed in
which a chain is late. An observed maximum is a lower bound on the worst case, never the worst case itself.
"""

from archgen.simulation.seeded_runs import find_late_runs, simulate_system
from archgen.simulation.simulation_result import (
    ChainFigures,
    DurationDistribution,
    ObservedActivity,
    ObservedChain,
    ObservedHost,
    ObservedLink,
    SimulationResult,
)

__all__ = ["ChainFigures", "DurationDistribution", "ObservedActivity", "ObservedChain", "ObservedHost", "ObservedLink"]
__all__ += ["SimulationResult", "find_late_runs", "simulate_system"]
