"""Analyses: pure functions that compute something of an architecture, and the rules that judge the result."""

from __future__ import annotations

from typing import TYPE_CHECKING

from archgen.analyses import (
    broken_chains,
    chain_latency,
    completeness,
    component_roles,
    connectivity,
    ineffective_timing,
    name_validity,
    node_mapping,
    policy_violations,
    port_sections,
    port_types,
    qos_compatibility,
    rate_conflicts,
    requirement_tracing,
    resource_load,
    ros_distribution,
    ros_messages,
    selector_checks,
    slow_responses,
    timing_plausibility,
    topic_sources,
    trigger_cycles,
    type_mapping,
)
from archgen.diagnostics.diagnostic import Rule
from archgen.timing.run_analysis import AnalysisMemory

if TYPE_CHECKING:
    from collections.abc import Iterator

    from archgen.diagnostics.diagnostic import Diagnostic
    from archgen.model.architecture import Architecture
    from archgen.timing.analysis import Analysis

# A rule is a function that yields diagnostics, named as the rule, with the rule's page as its docstring. The order is
# that in which rules run; findings are sorted later.
_RULE_FUNCTIONS = (
    *connectivity.RULES,
    *port_types.RULES,
    *component_roles.RULES,
    *node_mapping.RULES,
    *topic_sources.RULES,
    *port_sections.RULES,
    *name_validity.RULES,
    *qos_compatibility.RULES,
    *requirement_tracing.RULES,
    *ros_distribution.RULES,
    *ros_messages.RULES,
    *type_mapping.RULES,
    *broken_chains.RULES,
    *timing_plausibility.RULES,
    *ineffective_timing.RULES,
    *policy_violations.RULES,
    *selector_checks.RULES,
    *completeness.RULES,
)

_TIMING_RULE_FUNCTIONS = (
    *rate_conflicts.RULES,
    *trigger_cycles.RULES,
    *resource_load.RULES,
    *slow_responses.RULES,
    *chain_latency.RULES,
)
"""These also take the timing analysis of the architecture, which is computed once for all of them."""

RULES: tuple[Rule, ...] = tuple(
    Rule.from_function(judge, severity) for judge, severity in (*_RULE_FUNCTIONS, *_TIMING_RULE_FUNCTIONS)
)
"""All rules that judge an architecture, in the order in which they run."""


def analyse_timing(architecture: Architecture, memory: AnalysisMemory) -> Analysis | None:
    """Return the timing analysis that the rules judge, None where the architecture has no `timing`."""
    # Without any `timing` these rules have nothing to find, and the timing analysis need not run.
    return memory.judge_architecture(architecture) if _has_timing(architecture) else None


def check_architecture(architecture: Architecture, analysis: Analysis | None) -> Iterator[Diagnostic]:
    """Run all rules and yield their raw diagnostics, neither sorted nor settled. `analysis` is the timing analysis."""
    for rule_function, _ in _RULE_FUNCTIONS:
        yield from rule_function(architecture)
    if analysis is not None:
        for timing_rule_function, _ in _TIMING_RULE_FUNCTIONS:
            yield from timing_rule_function(architecture, analysis)


def _has_timing(architecture: Architecture) -> bool:
    """Whether any node or component has a `timing`."""
    return any(node.timing for node in architecture.nodes.values()) or any(
        component.timing for component in architecture.components.values()
    )
