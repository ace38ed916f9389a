"""Tests of findings as SARIF: held against OASIS's schema and Microsoft's validator with GitHub's rules."""

from __future__ import annotations

import json
import random
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from archgen.diagnostics.diagnostic import Diagnostic, Label, Severity
from archgen.diagnostics.source_span import NO_SPAN, Span
from archgen.emit.data import sarif_document
from archgen.findings import rule_pages
from archgen.pipeline import SHIPPED_RULES, index_all_rules
from tests.findings import judges
from tests.findings.hostile_findings import HOSTILE, hostile_findings
from tests.hostile import controls

_SCAN = sarif_document.SarifScan("robot", "archgen.yaml", "robots/one", "1.2.3")
_FINDING = Diagnostic(
    "unread-output",
    "nobody reads `x`",
    Span("groups/a b.yaml", 41, 11, 41, 36),
    Severity.ERROR,
    (Label(Span("groups/b.yaml", 12, 5, 12, 23), "declared [here]"),),
    "did you mean `y`?",
    "g.c",
)


def _run(findings: list[Diagnostic], scan: sarif_document.SarifScan = _SCAN) -> dict[str, Any]:
    run: dict[str, Any] = json.loads(sarif_document.format_sarif(findings, index_all_rules(), scan))["runs"][0]
    return run


def test_a_result_says_what_where_and_how_to_know_it_again() -> None:
    (result,) = _run([_FINDING])["results"]
    assert result == {
        "ruleId": "unread-output",
        "ruleIndex": 0,
        "level": "error",
        "message": {"text": "nobody reads `x`\n[declared \\[here\\]](1)\nHelp: did you mean `y`?"},
        "locations": [
            {
                "physicalLocation": {
                    "artifactLocation": {"uri": "robots/one/groups/a%20b.yaml", "uriBaseId": "%SRCROOT%"},
                    "region": {"startLine": 41, "startColumn": 11, "endLine": 41, "endColumn": 36},
                },
                "logicalLocations": [{"fullyQualifiedName": "g.c", "kind": "element"}],
            }
        ],
        "relatedLocations": [
            {
                "id": 1,
                "physicalLocation": {
                    "artifactLocation": {"uri": "robots/one/groups/b.yaml", "uriBaseId": "%SRCROOT%"},
                    "region": {"startLine": 12, "startColumn": 5, "endLine": 12, "endColumn": 23},
                },
                "message": {"text": "declared [here]"},
            }
        ],
        "partialFingerprints": {"archgenIdentity/v1": "37275d5288246d7f79200dc7aab8bb87"},
    }


def test_the_run_says_who_looked_at_what() -> None:
    run = _run([_FINDING])
    driver = run["tool"]["driver"]
    assert (driver["name"], driver["version"]) == ("archgen", "1.2.3")
    assert (run["automationDetails"], run["columnKind"]) == ({"id": "archgen/robot/"}, "unicodeCodePoints")
    assert run["invocations"] == [{"executionSuccessful": True}]


def test_rules_carry_their_whole_pages() -> None:
    (rule,) = _run([_FINDING, _FINDING])["tool"]["driver"]["rules"]
    assert (rule["id"], rule["defaultConfiguration"]) == ("unread-output", {"level": "warning"})
    assert rule["helpUri"].endswith("/docs/rules/unread-output.md")
    assert rule["help"] == {
        "text": rule_pages.format_rule_page(index_all_rules()["unread-output"]),
        "markdown": rule_pages.rule_page_to_markdown(index_all_rules()["unread-output"]),
    }


def test_a_rule_of_a_package_has_no_page_of_ours() -> None:
    rules = {"unread-output": replace(index_all_rules()["unread-output"], origin="toys 1.0")}
    (rule,) = json.loads(sarif_document.format_sarif([_FINDING], rules, _SCAN))["runs"][0]["tool"]["driver"]["rules"]
    assert "helpUri" not in rule
    assert rule["help"]["text"].startswith("unread-output (warning, of toys 1.0)\n")


def format_all_rules() -> str:
    """Return a document with a finding of each rule."""
    findings = [replace(_FINDING, rule=rule.name, severity=Severity.NOTE) for rule in SHIPPED_RULES]
    return sarif_document.format_sarif(findings, index_all_rules(), _SCAN)


@pytest.mark.slow  # half a minute of the judge
def test_the_judge_finds_nothing_in_any_rule(tmp_path: Path) -> None:
    assert judges.sarif(format_all_rules(), tmp_path) == []


def test_every_rule_is_described_within_githubs_limits() -> None:
    text = format_all_rules()
    assert judges.sarif_schema(text) == []
    rules = json.loads(text)["runs"][0]["tool"]["driver"]["rules"]
    assert len(rules) == len(SHIPPED_RULES)
    assert [
        r["id"] for r in rules if len(r["fullDescription"]["text"]) > 1024 or not r["shortDescription"]["text"]
    ] == []


def test_a_finding_without_a_place_stands_at_the_projects_file() -> None:
    nowhere = replace(_FINDING, span=NO_SPAN, labels=(Label(NO_SPAN, "left out"),))
    outside = replace(_FINDING, span=Span("../../../x.yaml", 1, 1, 1, 2), labels=())
    text = sarif_document.format_sarif([nowhere, outside], index_all_rules(), _SCAN)
    assert judges.sarif_schema(text) == []
    places = [r["locations"][0]["physicalLocation"] for r in json.loads(text)["runs"][0]["results"]]
    assert [place["artifactLocation"]["uri"] for place in places] == ["robots/one/archgen.yaml"] * 2


def test_what_was_compared_is_new() -> None:
    (result,) = _run([_FINDING], replace(_SCAN, is_compared=True))["results"]
    assert result["baselineState"] == "new"


@pytest.mark.parametrize("kind", HOSTILE)
def test_hostile_texts(kind: str) -> None:
    document = sarif_document.format_sarif(hostile_findings(HOSTILE[kind]), index_all_rules(), _SCAN)
    assert judges.sarif_schema(document) == []
    assert controls(document) == []
    for result in json.loads(document)["runs"][0]["results"]:
        assert controls(result["message"]["text"]) == []


@pytest.mark.slow  # as above
def test_hostile_texts_before_a_judge(tmp_path: Path) -> None:
    findings = [finding for text in HOSTILE.values() for finding in hostile_findings(text)]
    assert judges.sarif(sarif_document.format_sarif(findings, index_all_rules(), _SCAN), tmp_path) == []


def test_text_from_a_file_is_no_link() -> None:
    (result,) = _run([replace(_FINDING, message="a [b](javascript:c)", labels=(), help="[d] e")])["results"]
    assert result["message"]["text"] == "a \\[b](javascript:c)\nHelp: [d] e"


@pytest.mark.parametrize(
    ("count", "said"),
    [
        (5_000, []),
        (5_001, ["GitHub shows the 5,000 gravest of these 5,001 results"]),
        (25_001, ["GitHub takes at most 25,000 results and would refuse these 25,001: nothing was left out here"]),
    ],
)
def test_what_github_would_not_take_is_said(count: int, said: list[str]) -> None:
    assert list(sarif_document.check_github_limits("{}", count)) == said


@pytest.mark.slow
def test_a_file_that_is_too_large_is_said() -> None:
    text = random.Random(1).randbytes(11_000_000).hex()  # noqa: S311 - what cannot be packed smaller than that
    (said,) = sarif_document.check_github_limits(text, 1)
    assert said.startswith("GitHub takes files of at most 10 MB packed with gzip, and would refuse this one of 1")
