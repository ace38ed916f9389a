"""What was measured on a robot, beside the activities of its design."""

from archgen.project.observation_reading import read_observations
from archgen.timing.analysis import Analysis, ChainResult
from archgen.timing.chains.measured_comparison import MEASURED_KEYS, Observation
from archgen.timing.chains.sample_statistics import SampleCounter, SampleStatistics, UnmappedSamples
from archgen.timing.figures.figure_wording import format_duration, format_rate
from archgen.timing.system.activity_builder import activity_of_endpoint, endpoint_key, name_activities
from archgen.timing.system.timing_system import Activity, TimingSystem

__all__ = [
    "MEASURED_KEYS",
    "Activity",
    "Analysis",
    "ChainResult",
    "Observation",
    "SampleCounter",
    "SampleStatistics",
    "TimingSystem",
    "UnmappedSamples",
    "activity_of_endpoint",
    "endpoint_key",
    "format_duration",
    "format_rate",
    "name_activities",
    "read_observations",
]
