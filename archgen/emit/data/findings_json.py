"""Findings for programs: the JSON format, version 1, as `schemas/diagnostics.schema.json` describes it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from archgen.diagnostics.diagnostic import count_by_severity
from archgen.diagnostics.safe_text import format_json

if TYPE_CHECKING:
    from collections.abc import Iterable

    from archgen.diagnostics.diagnostic import Diagnostic
    from archgen.diagnostics.source_span import Span

VERSION = 1


def format_findings_json(diagnostics: Iterable[Diagnostic]) -> str:
    """Return settled findings as one JSON document, in their order, with a line end behind it."""
    return format_json(findings_to_json(diagnostics))


def findings_to_json(diagnostics: Iterable[Diagnostic]) -> dict[str, Any]:
    """Return settled findings as plain data."""
    diagnostics = tuple(diagnostics)
    return {
        "version": VERSION,
        "summary": {str(severity): count for severity, count in count_by_severity(diagnostics).items()},
        "diagnostics": [finding_to_json(diagnostic) for diagnostic in diagnostics],
    }


def finding_to_json(diagnostic: Diagnostic) -> dict[str, Any]:
    """Return one settled finding as plain data. What it does not have is null, like the span of what nobody wrote."""
    return {
        "rule": diagnostic.rule,
        "severity": str(diagnostic.severity),
        "message": diagnostic.message,
        "help": diagnostic.help,
        "element": diagnostic.element,
        "variants": list(diagnostic.variants),
        "span": _span_to_json(diagnostic.span),
        "labels": [
            {"span": _span_to_json(label.span), "text": label.text} for label in diagnostic.labels if label.span.file
        ],
    }


def _span_to_json(span: Span) -> dict[str, Any] | None:
    if not span.file:
        return None
    return {
        "file": span.file,
        "start": {"line": span.line, "column": span.column},
        "end": {"line": span.end_line, "column": span.end_column},
    }
