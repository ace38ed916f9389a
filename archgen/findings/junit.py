"""Findings as test results, for servers that show tests: JUnit's XML, as Jenkins and GitLab read it.

A suite is a file, a case is a finding; a file without findings has one case that passes, since servers take a suite
without cases for a failure. What does not fail the check is a case that passes and says what was found. Names hold no
lines: servers use them to tell what is new and what was fixed.
"""

from __future__ import annotations

import posixpath
from collections import Counter
from itertools import groupby
from typing import TYPE_CHECKING

from archgen.diagnostic import Severity
from archgen.findings.escape import visible
from archgen.findings.text import render_one

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from archgen.diagnostic import Diagnostic
    from archgen.source import Sources

_NO_FILE = "the project"
_LONGEST = 250
"""The most characters of a case's name. The whole message is in its body."""
_NONCHARACTERS = {0xFFFE: "\ufffd", 0xFFFF: "\ufffd"}
"""Characters that print (as nothing) and that XML cannot hold."""


def render(diagnostics: Iterable[Diagnostic], sources: Sources, files: Iterable[str], *, strict: bool) -> Iterator[str]:
    """Yield the lines of the document: a suite for each file, in order; with `strict`, warnings fail too."""
    found: dict[str, tuple[Diagnostic, ...]] = dict.fromkeys(files, ()) | {
        file: tuple(group)
        for file, group in groupby(sorted(diagnostics, key=lambda d: d.span.file), lambda d: d.span.file)
    }
    # The same severities that make `archgen check` fail.
    failing = {Severity.ERROR, Severity.WARNING} if strict else {Severity.ERROR}
    total = sum(max(1, len(group)) for group in found.values())
    failed = sum(d.severity in failing for group in found.values() for d in group)
    yield '<?xml version="1.0" encoding="UTF-8"?>'
    yield f'<testsuites name="archgen" tests="{total}" failures="{failed}" errors="0">'
    for file, group in sorted(found.items()):
        yield from _suite(file, group, sources, failing)
    yield "</testsuites>"


def _suite(file: str, group: Sequence[Diagnostic], sources: Sources, failing: set[Severity]) -> Iterator[str]:
    name = _attribute(file or _NO_FILE)
    group_name = posixpath.splitext(name)[0]  # Jenkins takes what follows a dot for a class's name
    failed = sum(diagnostic.severity in failing for diagnostic in group)
    yield f'  <testsuite name="{name}" tests="{max(1, len(group))}" failures="{failed}" errors="0" skipped="0">'
    if not group:
        yield f'    <testcase classname="{group_name}" name="no findings"/>'
    seen = Counter[str]()
    for diagnostic in group:
        title = _title(diagnostic)
        seen[title] += 1
        count = f" ({seen[title]})" if seen[title] > 1 else ""  # GitLab shows only the first of two with one name
        yield f'    <testcase classname="{group_name}" name="{_attribute(title + count)}">'
        yield from _case(diagnostic, sources, fails=diagnostic.severity in failing)
        yield "    </testcase>"
    yield "  </testsuite>"


def _title(diagnostic: Diagnostic) -> str:
    title = visible(f"{diagnostic.rule}: {diagnostic.message}")
    return title if len(title) <= _LONGEST else f"{title[:_LONGEST]}…"


def _case(diagnostic: Diagnostic, sources: Sources, *, fails: bool) -> Iterator[str]:
    """Yield the finding as a terminal shows it, with lines and marks."""
    said = "\n".join(_text(line) for line in render_one(diagnostic, sources))
    if fails:
        message = _attribute(diagnostic.message)
        yield f'      <failure type="{diagnostic.severity}" message="{message}">{said}</failure>'
    else:
        yield f"      <system-out>{said}</system-out>"


def _attribute(text: str) -> str:
    return _text(text).replace('"', "&quot;")


def _text(text: str) -> str:
    """Escape text for XML; what XML cannot hold, and what hides or reorders text, becomes a visible character."""
    shown = visible(text).translate(_NONCHARACTERS)
    return shown.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")
