"""The analysis of timing: results, chains, activities, and what was measured on a robot."""

from archgen.project.observation_reading import read_observations
from archgen.timing.analysis import Analysis, ChainResult, ChainTerm
from archgen.timing.chains.chain_bounds import bound_all_chains
from archgen.timing.chains.measured_comparison import MEASURED_KEYS, Observation
from archgen.timing.chains.sample_statistics import SampleCounter, SampleStatistics, UnmappedSamples
from archgen.timing.figures.figure_wording import format_duration, format_rate
from archgen.timing.run_analysis import analyse_architecture
from archgen.timing.system.activity_builder import activity_of_endpoint, endpoint_key, name_activities
from archgen.timing.system.timing_system import Activity, Arc, TimingSystem

__all__ = ["MEASURED_KEYS", "Activity", "Analysis", "Arc", "ChainResult", "ChainTerm", "Observation", "SampleCounter"]
__all__ += ["SampleStatistics", "TimingSystem", "UnmappedSamples", "activity_of_endpoint", "analyse_architecture"]
__all__ += ["bound_all_chains", "endpoint_key", "format_duration", "format_rate", "name_activities"]
__all__ += ["read_observations"]
