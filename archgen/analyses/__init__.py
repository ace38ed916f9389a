"""Analyses: pure functions that compute something of an architecture, and the rules that judge the result."""

from __future__ import annotations

from typing import TYPE_CHECKING

from archgen.analyses import (
    chains,
    connectivity,
    distribution,
    figures,
    idle,
    latency,
    load,
    mapping,
    messages,
    names,
    policies,
    port_types,
    progress,
    qos,
    requirements,
    roles,
    sections,
    selectors,
    timing,
    topics,
    triggers,
    type_mapping,
)
from archgen.diagnostic import Rule
from archgen.timing.analyse import analyse

if TYPE_CHECKING:
    from collections.abc import Iterator

    from archgen.diagnostic import Diagnostic
    from archgen.model.architecture import Architecture

# A rule is a function that yields diagnostics, named as the rule, with the rule's page as its docstring. The order is
# that in which rules run; findings are sorted later.
_JUDGES = (
    *connectivity.RULES,
    *port_types.RULES,
    *roles.RULES,
    *mapping.RULES,
    *topics.RULES,
    *sections.RULES,
    *names.RULES,
    *qos.RULES,
    *requirements.RULES,
    *distribution.RULES,
    *messages.RULES,
    *type_mapping.RULES,
    *chains.RULES,
    *figures.RULES,
    *idle.RULES,
    *policies.RULES,
    *selectors.RULES,
    *progress.RULES,
)

_TIMED_JUDGES = (*timing.RULES, *triggers.RULES, *load.RULES, *latency.RULES)
"""These also take the timing analysis of the architecture, which is computed once for all of them."""

RULES: tuple[Rule, ...] = tuple(Rule.of(judge, severity) for judge, severity in (*_JUDGES, *_TIMED_JUDGES))
"""All rules that judge an architecture, in the order in which they run."""


def check(architecture: Architecture) -> Iterator[Diagnostic]:
    """Run all rules and yield their raw diagnostics, neither sorted nor settled."""
    for judge, _ in _JUDGES:
        yield from judge(architecture)
    # Without any `timing` these rules have nothing to find, and the timing analysis need not run.
    if _is_timed(architecture):
        found = analyse(architecture, judging=True)
        for judge_timing, _ in _TIMED_JUDGES:
            yield from judge_timing(architecture, found)


def _is_timed(architecture: Architecture) -> bool:
    """Whether any node or component has a `timing`."""
    return any(node.timing for node in architecture.nodes.values()) or any(
        component.timing for component in architecture.components.values()
    )
