"""Tests of findings for programs: JSON by its schema, and GitHub's workflow commands."""

from __future__ import annotations

import json

import jsonschema_rs

from archgen import resources
from archgen.diagnostics.diagnostic import Diagnostic, Label, Severity
from archgen.diagnostics.source_span import NO_SPAN, Span
from archgen.emit.data import findings_data

_FINDING = Diagnostic(
    "unknown-reference",
    "no output named `x`: 100 %,\nsaid ::error::",
    Span("groups/a, b.yaml", 41, 11, 41, 36),
    Severity.ERROR,
    (Label(Span("groups/b.yaml", 12, 5, 12, 23), "declared here"),),
    "did you mean `y`?",
    "g.c",
)


def test_json_says_everything_by_its_schema() -> None:
    nowhere = Diagnostic("missing-detail", "m", NO_SPAN, Severity.NOTE, (Label(NO_SPAN, "left out"),))
    document = json.loads(findings_data.format_findings_json([_FINDING, nowhere]))
    schema = json.loads(resources.resource_path("schemas", "diagnostics.schema.json").read_text(encoding="utf-8"))
    jsonschema_rs.meta.validate(schema)
    jsonschema_rs.validate(schema, document)
    assert document["version"] == 1
    assert document["summary"] == {"error": 1, "warning": 0, "note": 1}
    assert document["diagnostics"][0] == {
        "rule": "unknown-reference",
        "severity": "error",
        "message": "no output named `x`: 100 %,\nsaid ::error::",
        "help": "did you mean `y`?",
        "element": "g.c",
        "variants": [],
        "span": {
            "file": "groups/a, b.yaml",
            "start": {"line": 41, "column": 11},
            "end": {"line": 41, "column": 36},
        },
        "labels": [
            {
                "span": {
                    "file": "groups/b.yaml",
                    "start": {"line": 12, "column": 5},
                    "end": {"line": 12, "column": 23},
                },
                "text": "declared here",
            }
        ],
    }
    assert (document["diagnostics"][1]["span"], document["diagnostics"][1]["labels"]) == (None, [])


def test_workflow_commands_escape_what_they_carry() -> None:
    assert list(findings_data.format_github_commands([_FINDING], folder="robots/one/")) == [
        (
            "::error file=robots/one/groups/a%2C b.yaml,line=41,endLine=41,col=11,endColumn=36,title=unknown-reference"
            "::no output named `x`: 100 %25,␊said ::error::"
            "%0Agroups/b.yaml:12:5: declared here%0Ahelp: did you mean `y`?"
        )
    ]


def test_columns_stand_only_in_spans_of_one_line() -> None:
    findings = [
        Diagnostic("r", "m", Span("a.yaml", 1, 4, 3, 2), Severity.NOTE),
        Diagnostic("r", "m", NO_SPAN, Severity.WARNING),
    ]
    assert list(findings_data.format_github_commands(findings)) == [
        "::notice file=a.yaml,line=1,endLine=3,title=r::m",
        "::warning title=r::m",
    ]
