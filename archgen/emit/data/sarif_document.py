"""Findings as SARIF 2.1.0, for GitHub's code scanning and other viewers.

Only what counts is written: GitHub shows findings that a comment or a baseline silences as open, whatever SARIF's
`suppressions` and `baselineState` say about them, so those are left out.
"""

from __future__ import annotations

import gzip
import re
from collections.abc import Iterable, Iterator, Mapping
from typing import Any
from urllib.parse import quote_from_bytes

from archgen.diagnostics import Diagnostic, Label, Rule, SourceTexts, Span, format_json, make_visible
from archgen.diagnostics.finding_identity import number_findings
from archgen.diagnostics.suggested_fixes import suggest_fix
from archgen.emit.data.findings_data import path_in_repository
from archgen.findings import rule_pages
from archgen.findings.variant_findings import phrase_absence
from archgen.frozen import dataclass
from archgen.resources import HOME_URL

_SCHEMA_URL = "https://docs.oasis-open.org/sarif/sarif/v2.1.0/errata01/os/schemas/sarif-schema-2.1.0.json"
_ROOT_ID = "%SRCROOT%"
_FINGERPRINT_KEY = "archgenIdentity/v1"
_BRACKET_PATTERN, _BRACKET_ESCAPED = re.compile(r"([\[\]\\])"), r"\\\1"
_MAX_SHOWN, _MAX_RESULTS, _MAX_PACKED_BYTES = 5_000, 25_000, 10_000_000
"""GitHub's limits: results of a run that it shows, results that it accepts, and bytes of a file, packed with gzip."""


@dataclass(frozen=True, slots=True)
class SarifScan:
    """What was checked: the project's id, the file that findings without a place point at, the project's folder from
    the repository's root, and archgen's version. `is_compared` says that findings known from before were left out; `sources` are the
    texts of the files, where the edits that helps ask for are wanted.
    """

    project: str
    fallback_file: str
    folder: str
    version: str
    is_compared: bool = False
    sources: SourceTexts | None = None


def format_sarif(diagnostics: Iterable[Diagnostic], rules: Mapping[str, Rule], scan: SarifScan) -> str:
    """Return settled findings as a SARIF document."""
    findings = tuple(diagnostics)
    rule_index = {name: index for index, name in enumerate(sorted({diagnostic.rule for diagnostic in findings}))}
    driver = {"name": "archgen", "informationUri": HOME_URL, "version": scan.version, "semanticVersion": scan.version}
    run: dict[str, Any] = {
        "tool": {"driver": driver | {"rules": [_rule_to_sarif(rules[name]) for name in rule_index]}},
        "automationDetails": {"id": f"archgen/{scan.project}/"},
        "invocations": [{"executionSuccessful": True}],
        # archgen counts columns in characters, not in UTF-16 code units.
        "columnKind": "unicodeCodePoints",
        "originalUriBaseIds": {_ROOT_ID: {"description": {"text": "The repository's root."}}},
        "results": [
            {"ruleId": diagnostic.rule, "ruleIndex": rule_index[diagnostic.rule]}
            | _result_to_sarif(diagnostic, scan)
            | {"partialFingerprints": {_FINGERPRINT_KEY: identity.fingerprint(number)}}
            # GitHub matches alerts between runs by the fingerprint, so a finding that only moved stays the same alert.
            for diagnostic, identity, number in number_findings(findings)
        ],
    }
    return format_json({"$schema": _SCHEMA_URL, "version": "2.1.0", "runs": [run]})


def check_github_limits(document: str, results: int) -> Iterator[str]:
    """Yield sentences where GitHub would refuse a document, or show only a part of it."""
    if results > _MAX_RESULTS:
        yield f"GitHub takes at most {_MAX_RESULTS:,} results and would refuse these {results:,}: nothing was left out here"
    elif results > _MAX_SHOWN:
        yield f"GitHub shows the {_MAX_SHOWN:,} gravest of these {results:,} results"
    data = document.encode("utf-8", "surrogatepass")
    # Only a large file is packed to be measured.
    packed = len(gzip.compress(data, 6)) if len(data) > _MAX_PACKED_BYTES else 0
    if packed > _MAX_PACKED_BYTES:
        yield f"GitHub takes files of at most 10 MB packed with gzip, and would refuse this one of {packed / 1e6:.1f} MB"


def _rule_to_sarif(rule: Rule) -> dict[str, Any]:
    """Describe a rule; its whole page is the help."""
    page = rule_pages.read_rule_page(rule)
    return {
        "id": rule.name,
        "name": "".join(word.capitalize() for word in rule.name.split("-")),
        "shortDescription": {"text": page.summary},
        "fullDescription": {"text": " ".join(page.why.split()) or page.summary},
        # A rule of a package has no page but its own text.
        **({} if rule.origin else {"helpUri": f"{HOME_URL}/blob/main/docs/rules/{rule.name}.md"}),
        "help": {"text": rule_pages.format_rule_page(rule), "markdown": rule_pages.rule_page_to_markdown(rule)},
        "defaultConfiguration": {"level": ("none" if rule.severity == "off" else str(rule.severity))},
        "properties": {
            "tags": ["architecture"],
            "precision": "very-high",
            "problem.severity": {"error": "error", "warning": "warning"}.get(str(rule.severity), "recommendation"),
        },
    }


def _result_to_sarif(diagnostic: Diagnostic, scan: SarifScan) -> dict[str, Any]:
    labels = [
        (label, location_data)
        for label in diagnostic.labels
        if (location_data := _location_of(label.span, scan.folder))
    ]
    # GitHub needs a location for each result.
    location_data = _location_of(diagnostic.span, scan.folder) or _location_of(
        Span.of_file(scan.fallback_file), scan.folder
    )
    location: dict[str, Any] = {"physicalLocation": location_data} if location_data else {}
    if diagnostic.element:
        location["logicalLocations"] = [{"fullyQualifiedName": make_visible(diagnostic.element), "kind": "element"}]
    result: dict[str, Any] = {"level": str(diagnostic.severity), "message": {"text": _message_text(diagnostic, labels)}}
    result["locations"] = [location] if location else []
    fix = suggest_fix(diagnostic, scan.sources) if scan.sources and location_data else None
    if fix is not None and location_data:
        replacements = [
            {"deletedRegion": _region_of(edit.span), "insertedContent": {"text": edit.text}} for edit in fix.edits
        ]
        change = {"artifactLocation": location_data["artifactLocation"], "replacements": replacements}
        result["fixes"] = [{"description": {"text": _plain_text(diagnostic.help or "")}, "artifactChanges": [change]}]
    if scan.is_compared:
        result["baselineState"] = "new"
    if diagnostic.variants:
        result["properties"] = {"variants": list(diagnostic.variants)}
    if labels:
        result["relatedLocations"] = [
            {"id": number, "physicalLocation": label_place, "message": {"text": _plain_text(label.text)}}
            for number, (label, label_place) in enumerate(labels, 1)
        ]
    return result


def _message_text(diagnostic: Diagnostic, labels: Iterable[tuple[Label, object]]) -> str:
    """Return what is wrong and what to do; related places are links to them, which is how GitHub shows them."""
    lines = [_plain_text(diagnostic.message)]
    lines += [
        f"[{_BRACKET_PATTERN.sub(_BRACKET_ESCAPED, make_visible(label.text or str(label.span)))}]({number})"
        for number, (label, _) in enumerate(labels, 1)
    ]
    absence = phrase_absence(diagnostic)
    lines += [_plain_text(absence[:1].upper() + absence[1:])] if absence else []
    lines += [f"Help: {_plain_text(diagnostic.help)}"] if diagnostic.help else []
    return "\n".join(lines)


def _plain_text(text: str) -> str:
    """Return text in which nothing is hidden and nothing becomes a link."""
    visible_text = make_visible(text)
    return visible_text.replace("[", r"\[") if "](" in visible_text else visible_text


def _location_of(span: Span, folder: str) -> dict[str, Any] | None:
    path = path_in_repository(span.file, folder)
    if path is None:
        return None
    uri = quote_from_bytes(path.encode("utf-8", "surrogatepass"), safe="/")
    return {"artifactLocation": {"uri": uri, "uriBaseId": _ROOT_ID}, "region": _region_of(span)}


def _region_of(span: Span) -> dict[str, int]:
    return {
        "startLine": span.line,
        "startColumn": span.column,
        "endLine": span.end_line,
        "endColumn": span.end_column,
    }
