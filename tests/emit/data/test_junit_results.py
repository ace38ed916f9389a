"""Tests of findings as JUnit's test results, by the schema with which Jenkins reads them."""

from __future__ import annotations

from dataclasses import replace

import pytest
from lxml import etree

from archgen.diagnostics.diagnostic import Diagnostic, Severity
from archgen.diagnostics.source_span import NO_SPAN, SourceTexts, Span
from archgen.emit.data import junit_results
from tests.findings import judges
from tests.findings.hostile_findings import HOSTILE, hostile_findings
from tests.hostile import controls

_FINDING = Diagnostic(
    "unread-output", "nobody reads `x` & co", Span("groups/a.yaml", 2, 3, 2, 4), Severity.ERROR, (), "mend <it>", "g.c"
)


def _render(*findings: Diagnostic, files: tuple[str, ...] = (), strict: bool = False) -> str:
    sources = SourceTexts()
    sources.add_text("groups/a.yaml", 'g:\n  "x": 1 < 2\n')
    return "\n".join(junit_results.format_junit(findings, sources, files, strict=strict)) + "\n"


def test_a_suite_for_each_file_a_case_for_each_finding() -> None:
    warning = replace(_FINDING, severity=Severity.WARNING, help=None, span=Span("groups/a.yaml", 1, 1, 1, 2))
    assert (
        _render(_FINDING, warning, files=("archgen.yaml", "groups/a.yaml"))
        == """\
<?xml version="1.0" encoding="UTF-8"?>
<testsuites name="archgen" tests="3" failures="1" errors="0">
  <testsuite name="archgen.yaml" tests="1" failures="0" errors="0" skipped="0">
    <testcase classname="archgen" name="no findings"/>
  </testsuite>
  <testsuite name="groups/a.yaml" tests="2" failures="1" errors="0" skipped="0">
    <testcase classname="groups/a" name="unread-output: nobody reads `x` &amp; co">
      <failure type="error" message="nobody reads `x` &amp; co">error[unread-output]: nobody reads `x` &amp; co
  --&gt; groups/a.yaml:2:3
   2 |   "x": 1 &lt; 2
     |   ^
   = help: mend &lt;it&gt;</failure>
    </testcase>
    <testcase classname="groups/a" name="unread-output: nobody reads `x` &amp; co (2)">
      <system-out>warning[unread-output]: nobody reads `x` &amp; co
  --&gt; groups/a.yaml:1:1
   1 | g:
     | ^</system-out>
    </testcase>
  </testsuite>
</testsuites>
"""
    )


def test_files_have_their_paths_in_the_repository() -> None:
    findings = [
        replace(_FINDING, span=Span(file, 1, 1, 1, 2)) for file in ("../lib/parts.yaml", "../../out.yaml", "a.yaml")
    ]
    lines = junit_results.format_junit(findings, SourceTexts(), ("b.yaml",), folder="robot", strict=False)
    names = [suite.get("name") for suite in etree.fromstring("\n".join(lines).encode()).iter("testsuite")]
    assert names == ["../../out.yaml", "lib/parts.yaml", "robot/a.yaml", "robot/b.yaml"]


def test_with_strict_warnings_fail_and_notes_do_not() -> None:
    found = [replace(_FINDING, severity=severity) for severity in (Severity.WARNING, Severity.NOTE)]
    root = etree.fromstring(_render(*found, strict=True).encode())
    assert (root.get("tests"), root.get("failures")) == ("2", "1")
    assert [failure.get("type") for failure in root.iter("failure")] == ["warning"]


def test_what_has_no_file_stands_in_a_suite_of_its_own() -> None:
    text = _render(replace(_FINDING, span=NO_SPAN))
    assert '<testsuite name="the project" tests="1" failures="1"' in text
    assert judges.junit(text) == []


def test_a_sound_project_has_cases_that_pass() -> None:
    text = _render(files=("archgen.yaml",))
    assert judges.junit(text) == []
    assert '<testsuites name="archgen" tests="1" failures="0" errors="0">' in text


@pytest.mark.parametrize("kind", HOSTILE)
def test_hostile_texts(kind: str) -> None:
    document = _render(*hostile_findings(HOSTILE[kind]), files=("archgen.yaml",), strict=True)
    assert judges.junit(document) == []
    assert controls(document) == []
    root = etree.fromstring(document.encode())
    assert {element.tag for element in root.iter()} == {
        *("testsuites", "testsuite", "testcase", "failure", "system-out")
    }
    names = [(case.get("classname"), case.get("name")) for case in root.iter("testcase")]
    assert len(set(names)) == len(names) == 6
