"""Findings on a pull request: workflow commands that GitHub shows beside the lines concerned."""

from __future__ import annotations

from typing import TYPE_CHECKING

from archgen.diagnostic import Severity
from archgen.findings.escape import visible
from archgen.findings.place import in_repository

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from archgen.diagnostic import Diagnostic

_COMMANDS = {Severity.ERROR: "error", Severity.WARNING: "warning", Severity.NOTE: "notice"}


def render(diagnostics: Iterable[Diagnostic], *, folder: str = "") -> Iterator[str]:
    """Yield a command for each settled finding. `folder` is the project's, relative to the repository's root."""
    for diagnostic in diagnostics:
        properties = {**_place(diagnostic, folder), "title": diagnostic.rule}
        listed = ",".join(f"{key}={_property(str(value))}" for key, value in properties.items())
        yield f"::{_COMMANDS[diagnostic.severity or Severity.ERROR]} {listed}::{_text(diagnostic)}"


def _place(diagnostic: Diagnostic, folder: str) -> dict[str, str | int]:
    """Return file and lines; GitHub accepts columns only for a span on one line."""
    span = diagnostic.span
    file = in_repository(span.file, folder)
    if file is None:
        return {}
    place: dict[str, str | int] = {"file": file, "line": span.line, "endLine": span.end_line}
    if span.line == span.end_line:
        place |= {"col": span.column, "endColumn": span.end_column}
    return place


def _text(diagnostic: Diagnostic) -> str:
    lines = [diagnostic.message]
    lines += [f"{label.span}: {label.text}" for label in diagnostic.labels if label.span.file]
    lines += [f"help: {diagnostic.help}"] if diagnostic.help else []
    # GitHub's escape for a line end.
    return "%0A".join(_data(line) for line in lines)


def _data(text: str) -> str:
    """Escape text for a command. Line ends are made visible, like everything that a terminal would obey."""
    return visible(text).replace("%", "%25")


def _property(text: str) -> str:
    return _data(text).replace(":", "%3A").replace(",", "%2C")
