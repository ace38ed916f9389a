"""Findings as test results, for servers that show tests: JUnit's XML, as Jenkins and GitLab read it.

A suite is a file, a case is a finding; a file without findings has one case that passes, since servers take a suite
without cases for a failure. What does not fail the check is a case that passes and says what was found. Names hold no
lines: servers use them to tell what is new and what was fixed.
"""

from __future__ import annotations

import posixpath
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from itertools import groupby

from archgen.diagnostics import Diagnostic, Severity, SourceTexts, make_visible
from archgen.emit.data.findings_data import path_in_repository
from archgen.emit.terminal.findings_text import render_finding_text

_NO_FILE_NAME = "the project"
_MAX_NAME_LENGTH = 250
"""The most characters of a case's name. The whole message is in its body."""
_NONCHARACTERS = {0xFFFE: "\ufffd", 0xFFFF: "\ufffd"}
"""Characters that print (as nothing) and that XML cannot hold."""


def format_junit(
    diagnostics: Iterable[Diagnostic], sources: SourceTexts, files: Iterable[str], *, folder: str = "", strict: bool
) -> Iterator[str]:
    """Yield the lines of the document: a suite for each file, in order; with `strict`, warnings fail too.

    Suites are called by their files' paths from the repository's root. `folder` is the project's, from there.
    """
    findings_by_file: dict[str, tuple[Diagnostic, ...]] = dict.fromkeys(files, ()) | {
        file: tuple(group)
        for file, group in groupby(
            sorted(diagnostics, key=lambda diagnostic: diagnostic.span.file), lambda diagnostic: diagnostic.span.file
        )
    }
    # The same severities that make `archgen check` fail.
    failing_severities = {Severity.ERROR, Severity.WARNING} if strict else {Severity.ERROR}
    total = sum(max(1, len(group)) for group in findings_by_file.values())
    failed = sum(
        diagnostic.severity in failing_severities for group in findings_by_file.values() for diagnostic in group
    )
    yield '<?xml version="1.0" encoding="UTF-8"?>'
    yield f'<testsuites name="archgen" tests="{total}" failures="{failed}" errors="0">'
    for file, group in sorted(findings_by_file.items()):
        suite_name = path_in_repository(file, folder) or file or _NO_FILE_NAME
        yield from _suite_lines(suite_name, group, sources, failing_severities)
    yield "</testsuites>"


def _suite_lines(
    suite_name: str, group: Sequence[Diagnostic], sources: SourceTexts, failing_severities: set[Severity]
) -> Iterator[str]:
    name = _escape_attribute(suite_name)
    group_name = posixpath.splitext(name)[0]  # Jenkins takes what follows a dot for a class's name
    failed = sum(diagnostic.severity in failing_severities for diagnostic in group)
    yield f'  <testsuite name="{name}" tests="{max(1, len(group))}" failures="{failed}" errors="0" skipped="0">'
    if not group:
        yield f'    <testcase classname="{group_name}" name="no findings"/>'
    title_counts = Counter[str]()
    for diagnostic in group:
        title = _case_name(diagnostic)
        title_counts[title] += 1
        count = (
            f" ({title_counts[title]})" if title_counts[title] > 1 else ""
        )  # GitLab shows only the first of two with one name
        yield f'    <testcase classname="{group_name}" name="{_escape_attribute(title + count)}">'
        text = "\n".join(_escape_text(line) for line in render_finding_text(diagnostic, sources))
        if diagnostic.severity in failing_severities:
            message = _escape_attribute(diagnostic.message)
            yield f'      <failure type="{diagnostic.severity}" message="{message}">{text}</failure>'
        else:
            yield f"      <system-out>{text}</system-out>"
        yield "    </testcase>"
    yield "  </testsuite>"


def _case_name(diagnostic: Diagnostic) -> str:
    title = make_visible(f"{diagnostic.rule}: {diagnostic.message}")
    return title if len(title) <= _MAX_NAME_LENGTH else f"{title[:_MAX_NAME_LENGTH]}…"


def _escape_attribute(text: str) -> str:
    return _escape_text(text).replace('"', "&quot;")


def _escape_text(text: str) -> str:
    """Escape text for XML; what XML cannot hold, and what hides or reorders text, becomes a visible character."""
    visible_text = make_visible(text).translate(_NONCHARACTERS)
    return visible_text.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")
