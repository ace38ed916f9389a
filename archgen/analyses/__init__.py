"""Analyses: pure functions that compute, and right below each the rule that judges."""

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
"""These also take what follows from the architecture's timing, which is found once for all of them."""

RULES: tuple[Rule, ...] = tuple(Rule.of(judge, severity) for judge, severity in (*_JUDGES, *_TIMED_JUDGES))
"""All rules that judge an architecture, in the order in which they run."""


def check(architecture: Architecture) -> Iterator[Diagnostic]:
    """Run all rules. The findings are neither sorted nor settled."""
    for judge, _ in _JUDGES:
        yield from judge(architecture)
    if _is_timed(architecture):
        found = analyse(architecture, judging=True)
        for judge_timing, _ in _TIMED_JUDGES:
            yield from judge_timing(architecture, found)


def _is_timed(architecture: Architecture) -> bool:
    """Say whether anybody has written anything about time yet."""
    return any(node.timing for node in architecture.nodes.values()) or any(
        component.timing for component in architecture.components.values()
    )
