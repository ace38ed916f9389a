"""Findings on a pull request: workflow commands that GitHub shows beside the lines concerned."""

from __future__ import annotations

from typing import TYPE_CHECKING

from archgen.diagnostics.diagnostic import Severity
from archgen.diagnostics.safe_text import make_visible
from archgen.emit.data.repository_path import path_in_repository
from archgen.findings.variant_findings import phrase_absence

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from archgen.diagnostics.diagnostic import Diagnostic

_COMMAND_NAMES = {Severity.ERROR: "error", Severity.WARNING: "warning", Severity.NOTE: "notice"}


def format_github_commands(diagnostics: Iterable[Diagnostic], *, folder: str = "") -> Iterator[str]:
    """Yield a command for each settled finding. `folder` is the project's, relative to the repository's root."""
    for diagnostic in diagnostics:
        properties = {**_place_properties(diagnostic, folder), "title": diagnostic.rule}
        property_list = ",".join(f"{key}={_escape_property(str(value))}" for key, value in properties.items())
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


def _escape_property(text: str) -> str:
    return _escape_data(text).replace(":", "%3A").replace(",", "%2C")
