"""The number of findings of a rule is limited, and the rest counted."""

from __future__ import annotations

from archgen.diagnostics.diagnostic import Diagnostic, Severity
from archgen.diagnostics.source_span import Span
from archgen.findings.finding_limit import MAX_FINDINGS_PER_RULE, limit_findings


def _findings(rule: str, count: int) -> list[Diagnostic]:
    return [Diagnostic(rule, f"{rule} {i}", Span("a.yaml", i, 1, i, 2), Severity.WARNING) for i in range(1, count + 1)]


def test_few_findings_stay_as_they_are() -> None:
    findings = _findings("unread-output", MAX_FINDINGS_PER_RULE)
    assert limit_findings(findings) == tuple(findings)


def test_the_rest_of_a_rule_is_counted_at_its_first_place() -> None:
    findings = [*_findings("unread-output", MAX_FINDINGS_PER_RULE + 1234), *_findings("unused-type", 2)]
    limited = limit_findings(findings)
    assert limited[:MAX_FINDINGS_PER_RULE] == tuple(findings[:MAX_FINDINGS_PER_RULE])
    rest = limited[MAX_FINDINGS_PER_RULE]
    assert rest.message == "1,234 more findings of this rule, from here on, are left out"
    assert (rest.span.line, rest.severity, rest.rule) == (MAX_FINDINGS_PER_RULE + 1, Severity.WARNING, "unread-output")
    assert limited[MAX_FINDINGS_PER_RULE + 1 :] == tuple(findings[-2:])
