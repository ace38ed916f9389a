"""All rules, in the order in which the stages run, and which of them say that something is missing."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import cache

from archgen import analyses, conformance, findings
from archgen.diagnostics import Diagnostic, Rule, Severity, stage_rules
from archgen.findings import rule_table
from archgen.findings.rule_table import FAILED_RULE
from archgen.installed_plugins import RULES, list_entries

SHIPPED_RULES: tuple[Rule, ...] = (
    *stage_rules.READING_RULES,
    *stage_rules.MERGING_RULES,
    *stage_rules.LINKING_RULES,
    *analyses.RULES,
    *conformance.RULES,
    *findings.RULES,
)
"""The rules that ship, in the order in which the stages run."""
READING_RULES = frozenset(rule.name for rule in stage_rules.READING_RULES)


@cache
def index_all_rules() -> Mapping[str, Rule]:
    """Return all rules by name: those that ship, and those of installed packages. Raise PluginRefusedError."""
    shipped_rules = (*SHIPPED_RULES, FAILED_RULE)
    if not list_entries(RULES):
        return rule_table.index_rules(shipped_rules)
    from archgen.findings.plugged_rules import load_plugged_rules, refuse_taken_names

    plugged_rules = load_plugged_rules()
    refuse_taken_names(plugged_rules, (rule.name for rule in shipped_rules))
    return rule_table.index_rules((*shipped_rules, *(plugged.rule for plugged in plugged_rules)))


def list_structural_errors(diagnostics: Iterable[Diagnostic]) -> list[Diagnostic]:
    """Return the errors among diagnostics behind which something is missing in the architecture."""
    return [d for d in diagnostics if index_all_rules()[d.rule].fixed and d.severity in {None, Severity.ERROR}]
