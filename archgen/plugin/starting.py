"""For generators of what starts a system: the plan of the start-up, its steps, and the words for them."""

from archgen.bringup.dds_profiles import record_dds_profile
from archgen.bringup.plan_shapes import DEFAULT_SECONDS, RosLaunch, StartPlan, StartStep, format_seconds
from archgen.bringup.start_commands import SUBSTITUTION, has_substitution
from archgen.bringup.start_plan import find_looking_variables, find_network_variables, make_start_plan
from archgen.model.process_scheduling import SCHEDULING_SCRIPT
from archgen.views.generation.generation_context import find_wanted_steps
from archgen.views.start_phrases import (
    KIND_WORDS,
    describe_dropped,
    describe_lifecycle,
    describe_ready,
    describe_unknown,
    name_waits,
)

__all__ = ["DEFAULT_SECONDS", "KIND_WORDS", "SCHEDULING_SCRIPT", "SUBSTITUTION", "RosLaunch", "StartPlan", "StartStep"]
__all__ += ["describe_dropped", "describe_lifecycle", "describe_ready", "describe_unknown", "find_looking_variables"]
__all__ += [
    "find_network_variables",
    "find_wanted_steps",
    "format_seconds",
    "has_substitution",
    "make_start_plan",
    "name_waits",
]
__all__ += ["record_dds_profile"]
