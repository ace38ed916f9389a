"""Tests of what a baseline keeps quiet, and of how it is written."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import jsonschema_rs
import pytest
import yaml

from archgen import resources
from archgen.diagnostics.diagnostic import Diagnostic, Severity
from archgen.diagnostics.source_span import Span
from archgen.pipeline import index_all_rules
from archgen.products import check_findings
from archgen.project import baseline_reading as reading
from tests.findings.hostile_findings import HOSTILE, hostile_findings


def _finding(rule: str, element: str | None, message: str, line: int = 1) -> Diagnostic:
    return Diagnostic(rule, message, Span("a.yaml", line, 1, line, 2), Severity.WARNING, element=element)


_READ = _finding("unread-output", "g.c", "nobody reads `x`")
_FED = _finding("unfed-input", "g.d", "nothing feeds `y`", 7)
_BROKEN = _finding("syntax-error", None, "this `[` is not closed")


def _divide(now: list[Diagnostic], then: list[Diagnostic], folder: Path) -> tuple[list[int], int, list[str]]:
    """Give the lines of what is new, how much is known, what is cured, by a baseline that was written and read again."""
    file = folder / "b.yaml"
    file.write_text(check_findings.format_baseline(then, index_all_rules()), encoding="utf-8")
    _, known, problems = reading.read_baseline(file, "b.yaml", index_all_rules())
    assert problems == ()
    new, old, cured = check_findings.divide_by_baseline(now, known, index_all_rules())
    return (
        [finding.span.line for finding in new],
        len(old),
        [f"{entry.message} x{entry.occurrences}" for entry in cured],
    )


def test_it_is_sorted_and_says_no_more_than_it_must() -> None:
    text = check_findings.format_baseline([_READ, _FED, replace(_READ, span=_FED.span), _BROKEN], index_all_rules())
    assert (
        text.partition("archgen_baseline")[2]
        == """\
: 1
findings:
  - rule: unfed-input
    element: g.d
    message: nothing feeds `y`
  - rule: unread-output
    element: g.c
    message: nobody reads `x`
    count: 2
"""
    )


def test_it_follows_its_schema() -> None:
    schema = json.loads(resources.resource_path("schemas", "baseline.schema.json").read_text(encoding="utf-8"))
    jsonschema_rs.meta.validate(schema)
    for findings in ([], [_READ, _READ, _FED, replace(_FED, element=None)]):
        jsonschema_rs.validate(schema, yaml.safe_load(check_findings.format_baseline(findings, index_all_rules())))
    wrong = {"archgen_baseline": 1, "findings": [{"rule": "unread-output", "message": "m", "line": 3}]}
    assert not jsonschema_rs.is_valid(schema, wrong)


def test_what_moved_is_known(tmp_path: Path) -> None:
    moved = [replace(_FED, span=Span("b.yaml", 2, 1, 2, 3)), replace(_READ, span=Span("b.yaml", 9, 9, 9, 9))]
    assert _divide(moved, [_READ, _FED], tmp_path) == ([], 2, [])


def test_one_more_of_the_same_is_new(tmp_path: Path) -> None:
    again = replace(_READ, span=Span("a.yaml", 5, 1, 5, 2))
    assert _divide([_READ, again], [_READ], tmp_path) == ([5], 1, [])


def test_what_is_cured_is_said(tmp_path: Path) -> None:
    assert _divide([_READ], [_READ, _READ, _READ, _FED], tmp_path) == (
        [],
        1,
        ["nothing feeds `y` x1", "nobody reads `x` x2"],
    )


def test_entries_that_a_merge_doubled_count_together(tmp_path: Path) -> None:
    file = tmp_path / "b.yaml"
    entry = "  - {rule: unread-output, element: g.c, message: nobody reads `x`}\n"
    file.write_text(f"archgen_baseline: 1\nfindings:\n{entry}{entry}", encoding="utf-8")
    _, known, _ = reading.read_baseline(file, "b.yaml", index_all_rules())
    new, old, cured = check_findings.divide_by_baseline([_READ, _READ, _READ], known, index_all_rules())
    assert (len(new), len(old), cured) == (1, 2, ())


def test_errors_of_reading_are_never_known(tmp_path: Path) -> None:
    assert _divide([_BROKEN], [_BROKEN], tmp_path) == ([1], 0, [])


@pytest.mark.parametrize("kind", HOSTILE)
def test_hostile_texts_come_back(kind: str, tmp_path: Path) -> None:
    findings = [replace(finding, element=finding.message[:500]) for finding in hostile_findings(HOSTILE[kind])]
    assert _divide(findings, findings, tmp_path) == ([], 6, [])
