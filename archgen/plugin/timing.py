"""The analysis of timing: its results, chains and what they are made of."""

from archgen.timing.analysis import Analysis, ChainResult, ChainTerm
from archgen.timing.chains.chain_bounds import bound_all_chains
from archgen.timing.run_analysis import analyse_architecture
from archgen.timing.system.timing_system import Arc

__all__ = [
    "Analysis",
    "Arc",
    "ChainResult",
    "ChainTerm",
    "analyse_architecture",
    "bound_all_chains",
]
