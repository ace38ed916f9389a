"""All rules, in the order in which the stages run, and which of them say that something is missing."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import cache

from archgen import analyses, compose, conformance, findings, link, project, schema
from archgen.diagnostics.diagnostic import Diagnostic, Rule, Severity
from archgen.findings import rule_table
from archgen.findings.rule_table import FAILED_RULE
from archgen.installed_plugins import RULES, list_entries
from archgen.syntax import interface_definitions as interface_files

SHIPPED_RULES: tuple[Rule, ...] = (
    *interface_files.RULES,
    *schema.RULES,
    *project.RULES,
    *compose.RULES,
    *link.RULES,
    *analyses.RULES,
    *conformance.RULES,
    *findings.RULES,
)
"""The rules that ship, in the order in which the stages run."""
READING_RULES = frozenset(rule.name for rule in (*interface_files.RULES, *schema.RULES, *project.RULES))


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
