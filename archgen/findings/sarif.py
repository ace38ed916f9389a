"""Findings as SARIF 2.1.0, for GitHub's code scanning and other viewers.

Only what counts is written: GitHub shows findings that a comment or a baseline silences as open, whatever SARIF's
`suppressions` and `baselineState` say about them, so those are left out.
"""

from __future__ import annotations

import gzip
import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any
from urllib.parse import quote_from_bytes

from archgen.findings import explain
from archgen.findings.escape import json_text, visible
from archgen.findings.place import in_repository
from archgen.identity import numbered
from archgen.source import Span

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from archgen.diagnostic import Diagnostic, Label, Rule

_SCHEMA = "https://docs.oasis-open.org/sarif/sarif/v2.1.0/errata01/os/schemas/sarif-schema-2.1.0.json"
_HOME = "https://github.com/archgen/archgen"
_ROOT = "%SRCROOT%"
_FINGERPRINT = "archgenIdentity/v1"
_BRACKET, _ESCAPED = re.compile(r"([\[\]\\])"), r"\\\1"
_SHOWN, _TAKEN, _BYTES = 5_000, 25_000, 10_000_000
"""GitHub's limits: results of a run that it shows, results that it accepts, and bytes of a file, packed with gzip."""


@dataclass(frozen=True, slots=True)
class Scan:
    """What was checked: the project's id, the file that findings without a place point at, the project's folder from
    the repository's root, and archgen's version. `is_compared` says that findings known from before were left out.
    """

    project: str
    file: str
    folder: str
    version: str
    compared: bool = False


def render(diagnostics: Iterable[Diagnostic], rules: Mapping[str, Rule], scan: Scan) -> str:
    """Return settled findings as a SARIF document."""
    found = tuple(diagnostics)
    used = {name: place for place, name in enumerate(sorted({diagnostic.rule for diagnostic in found}))}
    driver = {"name": "archgen", "informationUri": _HOME, "version": scan.version, "semanticVersion": scan.version}
    run: dict[str, Any] = {
        "tool": {"driver": driver | {"rules": [_rule(rules[name]) for name in used]}},
        "automationDetails": {"id": f"archgen/{scan.project}/"},
        "invocations": [{"executionSuccessful": True}],
        # archgen counts columns in characters, not in UTF-16 code units.
        "columnKind": "unicodeCodePoints",
        "originalUriBaseIds": {_ROOT: {"description": {"text": "The repository's root."}}},
        "results": [
            {"ruleId": diagnostic.rule, "ruleIndex": used[diagnostic.rule]}
            | _result(diagnostic, scan)
            | {"partialFingerprints": {_FINGERPRINT: identity.fingerprint(number)}}
            # GitHub matches alerts between runs by the fingerprint, so a finding that only moved stays the same alert.
            for diagnostic, identity, number in numbered(found)
        ],
    }
    return json_text({"$schema": _SCHEMA, "version": "2.1.0", "runs": [run]})


def limits(document: str, results: int) -> Iterator[str]:
    """Yield sentences where GitHub would refuse a document, or show only a part of it."""
    if results > _TAKEN:
        yield f"GitHub takes at most {_TAKEN:,} results and would refuse these {results:,}: nothing was left out here"
    elif results > _SHOWN:
        yield f"GitHub shows the {_SHOWN:,} gravest of these {results:,} results"
    data = document.encode("utf-8", "surrogatepass")
    # Only a large file is packed to be measured.
    packed = len(gzip.compress(data, 6)) if len(data) > _BYTES else 0
    if packed > _BYTES:
        yield f"GitHub takes files of at most 10 MB packed with gzip, and would refuse this one of {packed / 1e6:.1f} MB"


def _rule(rule: Rule) -> dict[str, Any]:
    """Describe a rule; its whole page is the help."""
    page = explain.page(rule)
    return {
        "id": rule.name,
        "name": "".join(word.capitalize() for word in rule.name.split("-")),
        "shortDescription": {"text": page.summary},
        "fullDescription": {"text": " ".join(page.why.split()) or page.summary},
        "helpUri": f"{_HOME}/blob/main/docs/rules/{rule.name}.md",
        "help": {"text": explain.terminal(rule), "markdown": explain.markdown(rule)},
        "defaultConfiguration": {"level": _level(rule.severity)},
        "properties": {"tags": ["architecture"], "precision": "very-high", "problem.severity": _problem(rule.severity)},
    }


def _level(severity: object) -> str:
    return "none" if severity == "off" else str(severity)


def _problem(severity: object) -> str:
    return {"error": "error", "warning": "warning"}.get(str(severity), "recommendation")


def _result(diagnostic: Diagnostic, scan: Scan) -> dict[str, Any]:
    labels = [(label, place) for label in diagnostic.labels if (place := _place(label.span, scan.folder))]
    # GitHub needs a location for each result.
    place = _place(diagnostic.span, scan.folder) or _place(Span.of_file(scan.file), scan.folder)
    location: dict[str, Any] = {"physicalLocation": place} if place else {}
    if diagnostic.element:
        location["logicalLocations"] = [{"fullyQualifiedName": visible(diagnostic.element), "kind": "element"}]
    result: dict[str, Any] = {"level": str(diagnostic.severity), "message": {"text": _message(diagnostic, labels)}}
    result["locations"] = [location] if location else []
    if scan.compared:
        result["baselineState"] = "new"
    if labels:
        result["relatedLocations"] = [
            {"id": number, "physicalLocation": at, "message": {"text": _plain(label.text)}}
            for number, (label, at) in enumerate(labels, 1)
        ]
    return result


def _message(diagnostic: Diagnostic, labels: Iterable[tuple[Label, object]]) -> str:
    """Return what is wrong and what to do; related places are links to them, which is how GitHub shows them."""
    lines = [_plain(diagnostic.message)]
    lines += [
        f"[{_BRACKET.sub(_ESCAPED, visible(label.text or str(label.span)))}]({number})"
        for number, (label, _) in enumerate(labels, 1)
    ]
    lines += [f"Help: {_plain(diagnostic.help)}"] if diagnostic.help else []
    return "\n".join(lines)


def _plain(text: str) -> str:
    """Return text in which nothing is hidden and nothing becomes a link."""
    shown = visible(text)
    return shown.replace("[", r"\[") if "](" in shown else shown


def _place(span: Span, folder: str) -> dict[str, Any] | None:
    path = in_repository(span.file, folder)
    if path is None:
        return None
    region = {
        "startLine": span.line,
        "startColumn": span.column,
        "endLine": span.end_line,
        "endColumn": span.end_column,
    }
    uri = quote_from_bytes(path.encode("utf-8", "surrogatepass"), safe="/")
    return {"artifactLocation": {"uri": uri, "uriBaseId": _ROOT}, "region": region}
