"""Findings for programs and servers: the JSON format of `schemas/diagnostics.schema.json`, and commands of GitHub workflows."""

from __future__ import annotations

import posixpath
from collections.abc import Iterable, Iterator
from typing import Any

from archgen.diagnostics import Diagnostic, Severity, SourceTexts, Span, count_by_severity, format_json, make_visible
from archgen.diagnostics.suggested_fixes import suggest_fix
from archgen.findings.variant_findings import phrase_absence

VERSION = 1


def format_findings_json(diagnostics: Iterable[Diagnostic], sources: SourceTexts | None = None) -> str:
    """Return settled findings as one JSON document, in their order, with a line end behind it."""
    return format_json(findings_to_json(diagnostics, sources))


def findings_to_json(diagnostics: Iterable[Diagnostic], sources: SourceTexts | None = None) -> dict[str, Any]:
    """Return settled findings as plain data; with the texts of the files, also the edits that their helps ask for."""
    diagnostics = tuple(diagnostics)
    return {
        "version": VERSION,
        "summary": {str(severity): count for severity, count in count_by_severity(diagnostics).items()},
        "diagnostics": [
            finding_to_json(diagnostic) | ({"fixes": _fixes_to_json(diagnostic, sources)} if sources else {})
            for diagnostic in diagnostics
        ],
    }


def _fixes_to_json(diagnostic: Diagnostic, sources: SourceTexts) -> list[dict[str, Any]]:
    fix = suggest_fix(diagnostic, sources)
    if fix is None:
        return []
    edits = [{"span": _span_to_json(edit.span), "text": edit.text} for edit in fix.edits]
    return [{"title": diagnostic.help, "certain": fix.is_certain, "edits": edits}]


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


_COMMAND_NAMES = {Severity.ERROR: "error", Severity.WARNING: "warning", Severity.NOTE: "notice"}


def format_github_commands(diagnostics: Iterable[Diagnostic], *, folder: str = "") -> Iterator[str]:
    """Yield a command for each settled finding. `folder` is the project's, relative to the repository's root."""
    for diagnostic in diagnostics:
        properties = {**_place_properties(diagnostic, folder), "title": diagnostic.rule}
        property_list = ",".join(
            f"{key}={_escape_data(str(value)).replace(':', '%3A').replace(',', '%2C')}"
            for key, value in properties.items()
        )
        yield f"::{_COMMAND_NAMES[diagnostic.severity or Severity.ERROR]} {property_list}::{_command_text(diagnostic)}"


def _place_properties(diagnostic: Diagnostic, folder: str) -> dict[str, str | int]:
    """Return file and lines; GitHub accepts columns only for a span on one line."""
    span = diagnostic.span
    file = path_in_repository(span.file, folder)
    if file is None:
        return {}
    properties: dict[str, str | int] = {"file": file, "line": span.line, "endLine": span.end_line}
    if span.line == span.end_line:
        properties |= {"col": span.column, "endColumn": span.end_column}
    return properties


def _command_text(diagnostic: Diagnostic) -> str:
    lines = [diagnostic.message]
    lines += [f"{label.span}: {label.text}" for label in diagnostic.labels if label.span.file]
    absence = phrase_absence(diagnostic)
    lines += [absence] if absence else []
    lines += [f"help: {diagnostic.help}"] if diagnostic.help else []
    # GitHub's escape for a line end.
    return "%0A".join(_escape_data(line) for line in lines)


def _escape_data(text: str) -> str:
    """Escape text for a command. Line ends are made visible, like everything that a terminal would obey."""
    return make_visible(text).replace("%", "%25")


def path_in_repository(file: str, folder: str) -> str | None:
    """Return a file's path from the repository's root; None without one, or where it leads out. `folder` is the
    project's.
    """
    path = posixpath.normpath(posixpath.join(folder.strip("/"), file))
    return None if not file or path.startswith(("../", "/")) else path
