"""Findings for programs: the JSON format, version 1, as `schemas/diagnostics.schema.json` describes it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from archgen.findings.escape import json_text
from archgen.findings.text import severity_counts

if TYPE_CHECKING:
    from collections.abc import Iterable

    from archgen.diagnostic import Diagnostic
    from archgen.source import Span

VERSION = 1


def render(diagnostics: Iterable[Diagnostic]) -> str:
    """Return settled findings as one JSON document, in their order, with a line end behind it."""
    return json_text(document(diagnostics))


def document(diagnostics: Iterable[Diagnostic]) -> dict[str, Any]:
    """Return settled findings as plain data."""
    diagnostics = tuple(diagnostics)
    return {
        "version": VERSION,
        "summary": {str(severity): count for severity, count in severity_counts(diagnostics).items()},
        "diagnostics": [record(diagnostic) for diagnostic in diagnostics],
    }


def record(diagnostic: Diagnostic) -> dict[str, Any]:
    """Return one settled finding as plain data. What it does not have is null, like the span of what nobody wrote."""
    return {
        "rule": diagnostic.rule,
        "severity": str(diagnostic.severity),
        "message": diagnostic.message,
        "help": diagnostic.help,
        "element": diagnostic.element,
        "span": _span(diagnostic.span),
        "labels": [{"span": _span(label.span), "text": label.text} for label in diagnostic.labels if label.span.file],
    }


def _span(span: Span) -> dict[str, Any] | None:
    if not span.file:
        return None
    return {
        "file": span.file,
        "start": {"line": span.line, "column": span.column},
        "end": {"line": span.end_line, "column": span.end_column},
    }
