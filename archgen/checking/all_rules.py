"""All rules, in the order in which the stages run, and which of them say that something is missing."""

from __future__ import annotations

from collections.abc import Iterable

from archgen import analyses, compose, findings, link, project, schema
from archgen.diagnostics.diagnostic import Diagnostic, Rule, Severity
from archgen.findings import rule_table
from archgen.syntax import interface_definitions as interface_files

ALL_RULES: tuple[Rule, ...] = (
    *interface_files.RULES,
    *schema.RULES,
    *project.RULES,
    *compose.RULES,
    *link.RULES,
    *analyses.RULES,
    *findings.RULES,
)
"""All rules, in the order in which the stages run."""
RULES_BY_NAME = rule_table.index_rules(ALL_RULES)
READING_RULES = frozenset(rule.name for rule in (*interface_files.RULES, *schema.RULES, *project.RULES))


def list_structural_errors(diagnostics: Iterable[Diagnostic]) -> list[Diagnostic]:
    """Return the errors among diagnostics behind which something is missing in the architecture."""
    return [d for d in diagnostics if RULES_BY_NAME[d.rule].fixed and d.severity in {None, Severity.ERROR}]
