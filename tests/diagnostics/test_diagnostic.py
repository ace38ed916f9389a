"""Severities: their order, and how findings are counted and sorted by them."""

from __future__ import annotations

from archgen.diagnostics.diagnostic import (
    Diagnostic,
    Severity,
    count_by_severity,
    phrase_severity_counts,
    sort_gravest_first,
)
from archgen.diagnostics.source_span import NO_SPAN

OFF, NOTE, WARNING, ERROR = Severity


def finding(message: str, severity: Severity | None) -> Diagnostic:
    return Diagnostic("r", message, NO_SPAN, severity)


def test_severities_compare_by_gravity_and_not_by_letters() -> None:
    assert OFF < NOTE < WARNING < ERROR
    assert ERROR > WARNING > NOTE > OFF
    again = Severity("note")
    assert NOTE <= again <= ERROR
    assert NOTE >= again >= OFF
    for wrong in (ERROR <= NOTE, NOTE >= WARNING, again > NOTE, again < NOTE):
        assert not wrong
    assert max(NOTE, ERROR, WARNING) is ERROR
    assert sorted([ERROR, OFF, WARNING, NOTE]) == [OFF, NOTE, WARNING, ERROR]


def test_findings_are_counted_errors_first_and_none_vanishes() -> None:
    findings = [finding("a", NOTE), finding("b", None), finding("c", NOTE), finding("d", WARNING)]
    assert list(count_by_severity(findings).items()) == [(ERROR, 1), (WARNING, 1), (NOTE, 2)]
    assert phrase_severity_counts(findings) == ["1 error", "1 warning", "2 notes"]
    assert phrase_severity_counts(findings[:1]) == ["1 note"]
    assert phrase_severity_counts([]) == []


def test_the_gravest_finding_comes_first_and_equal_ones_keep_their_order() -> None:
    findings = [finding("a", NOTE), finding("b", WARNING), finding("c", None), finding("d", WARNING)]
    assert [f.message for f in sort_gravest_first(findings)] == ["c", "b", "d", "a"]
