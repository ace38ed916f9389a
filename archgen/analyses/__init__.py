"""Analyses: pure functions that compute something of an architecture, and the rules that judge the result."""

from __future__ import annotations

from types import MappingProxyType
from typing import TYPE_CHECKING

from archgen.analyses import (
    answer_times,
    broken_chains,
    completeness,
    component_roles,
    connectivity,
    deprecated_uses,
    frame_tree,
    half_written,
    interface_promises,
    kept_promises,
    name_validity,
    node_mapping,
    parameter_settings,
    policy_violations,
    port_types,
    property_checks,
    qos_compatibility,
    rate_conflicts,
    remapped_names,
    requirement_tracing,
    resource_load,
    ros_facts,
    run_environments,
    start_order,
    started_programs,
    timing_plausibility,
    topic_sources,
    type_mapping,
)
from archgen.diagnostics import Diagnostic, Rule, Span
from archgen.diagnostics.rule_options import read_option_values
from archgen.timing.run_analysis import AnalysisMemory

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping
    from fractions import Fraction

    from archgen.diagnostics import Severity
    from archgen.diagnostics.rule_options import OptionValues, RuleOption
    from archgen.model.architecture import Architecture
    from archgen.timing.analysis import Analysis

    RuleFunction = Callable[..., Iterator[Diagnostic]]
    RuleEntry = tuple[RuleFunction, Severity] | tuple[RuleFunction, Severity, tuple[RuleOption, ...]]

# A rule is a function that yields diagnostics, named as the rule, whose docstring says what it finds. The order is that
# in which rules run; findings are sorted later.
_RULE_FUNCTIONS: tuple[RuleEntry, ...] = (
    *connectivity.RULES,
    *port_types.RULES,
    *component_roles.RULES,
    *node_mapping.RULES,
    *topic_sources.RULES,
    *name_validity.RULES,
    *remapped_names.RULES,
    *qos_compatibility.RULES,
    *run_environments.RULES,
    *requirement_tracing.RULES,
    *ros_facts.RULES,
    *type_mapping.RULES,
    *broken_chains.RULES,
    *half_written.RULES,
    *timing_plausibility.RULES,
    *parameter_settings.RULES,
    *property_checks.RULES,
    *policy_violations.RULES,
    *frame_tree.RULES,
    *interface_promises.RULES,
    *deprecated_uses.RULES,
    *start_order.RULES,
    *started_programs.RULES,
    *completeness.RULES,
)

_TIMING_RULE_FUNCTIONS: tuple[RuleEntry, ...] = (
    *timing_plausibility.TIMING_RULES,
    *rate_conflicts.RULES,
    *resource_load.RULES,
    *answer_times.RULES,
    *kept_promises.RULES,
)
"""These also take the timing analysis of the architecture, which is computed once for all of them."""

RULES: tuple[Rule, ...] = tuple(Rule.from_function(*entry) for entry in (*_RULE_FUNCTIONS, *_TIMING_RULE_FUNCTIONS))
"""All rules that judge an architecture, in the order in which they run."""
TIMING_RULE_NAMES = frozenset(entry[0].__name__.replace("_", "-") for entry in _TIMING_RULE_FUNCTIONS)
"""The rules that judge the timing analysis."""


MAX_LOOKED_FOR = 20_000
"""Findings of one rule that are looked for: 1,000 policies over 300 connections have 300,000, and take seconds to sort."""
NO_LONGER_LOOKED_FOR = f"this rule has more than {MAX_LOOKED_FOR:,} findings: from here on none is looked for"


def analyse_timing(architecture: Architecture, memory: AnalysisMemory) -> Analysis | None:
    """Return the timing analysis that the rules judge, None where the architecture has no `timing`."""
    # Without any `timing` these rules have nothing to find, and the timing analysis need not run.
    return memory.judge_architecture(architecture) if _has_timing(architecture) else None


def check_architecture(
    architecture: Architecture,
    analysis: Analysis | None,
    rule_options: Mapping[str, OptionValues] = MappingProxyType({}),
    waiting_rules: frozenset[str] = frozenset(),
) -> Iterator[Diagnostic]:
    """Run all rules but those that wait, and yield their raw diagnostics, neither sorted nor settled.

    `analysis` is the timing analysis, `rule_options` are the options that the project sets, by rule.
    """
    for entry in _RULE_FUNCTIONS:
        if _name_rule(entry) not in waiting_rules:
            yield from bound_findings(entry[0](architecture, **_option_arguments(entry, rule_options)))
    for entry in _TIMING_RULE_FUNCTIONS if analysis is not None else ():
        # A chain that a slip has torn apart is searched for late runs for seconds.
        if _name_rule(entry) not in waiting_rules:
            yield from bound_findings(entry[0](architecture, analysis, **_option_arguments(entry, rule_options)))


def bound_findings(findings: Iterable[Diagnostic]) -> Iterator[Diagnostic]:
    """Yield the findings of one rule; at the bound one that says so, which silencing all others does not silence."""
    for number, finding in enumerate(findings):
        if number == MAX_LOOKED_FOR:
            # About the file as a whole: a comment at one of its lines is not about this.
            place = Span.of_file(finding.span.file)
            yield Diagnostic(finding.rule, NO_LONGER_LOOKED_FOR, place, finding.severity, help="mend some first")
            return
        yield finding


def _option_arguments(entry: RuleEntry, rule_options: Mapping[str, OptionValues]) -> dict[str, Fraction]:
    """Return the keyword arguments of a rule's function: all its options, as set or by default."""
    # Most rules have none.
    if len(entry) < 3:  # noqa: PLR2004 - function, severity, options
        return {}
    return read_option_values(entry[2], rule_options.get(_name_rule(entry), {}))


def _name_rule(entry: RuleEntry) -> str:
    return entry[0].__name__.replace("_", "-")


def _has_timing(architecture: Architecture) -> bool:
    """Whether any node or component has a `timing`."""
    return any(node.timing for node in architecture.nodes.values()) or any(
        component.timing for component in architecture.list_described_components()
    )
