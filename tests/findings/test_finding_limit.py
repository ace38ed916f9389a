"""The number of findings of a rule is limited, and the rest counted."""

from __future__ import annotations

from archgen.analyses import MAX_LOOKED_FOR
from archgen.diagnostics.diagnostic import Diagnostic, Severity
from archgen.diagnostics.source_span import Span
from archgen.findings.instance_findings import MAX_FINDINGS_PER_RULE, limit_findings
from tests.judged_projects import check_text


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


def _write_forbidden_project(policy_count: int, ignore: str = "") -> str:
    """Return a project with a ring of 150 connections, each of which every policy forbids."""
    ring = "".join(
        f"      c{i}: {{outputs: {{o: T}}, inputs: {{i: c{(i + 1) % 150}.o}}}}{ignore}\n" for i in range(150)
    )
    policies = "".join(f"  p{i}: {{title: No, forbid: {{from: g, to: g}}}}\n" for i in range(policy_count))
    return f"archgen: 1\ngroups:\n  g:\n    components:\n{ring}policies:\n{policies}"


def test_more_findings_than_anybody_can_read_are_not_looked_for() -> None:
    for policy_count, rest in ((100, "14,000 more"), (133, "18,950 more"), (140, "at least 19,001 more")):
        findings = [
            each for each in check_text(_write_forbidden_project(policy_count)) if each.rule == "forbidden-flow"
        ]
        assert len(findings) == MAX_FINDINGS_PER_RULE + 1
        assert findings[-1].message == f"{rest} findings of this rule, from here on, are left out"


def test_what_is_not_looked_for_is_not_silenced_by_silencing_the_others() -> None:
    text = _write_forbidden_project(140, "  # archgen: ignore[forbidden-flow] all is well")
    findings = [each for each in check_text(text) if each.rule == "forbidden-flow"]
    assert [each.message for each in findings] == [
        f"this rule has more than {MAX_LOOKED_FOR:,} findings: from here on none is looked for"
    ]
    assert findings[0].severity is Severity.ERROR
