"""Short answers for programs: what a search found, who owns what, which rules there are (`schemas/answers.schema.json`)."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

from archgen.diagnostics import Rule, format_json
from archgen.findings.rule_pages import read_rule_page
from archgen.views.search.search_entry import SearchEntry

if TYPE_CHECKING:
    from archgen.views.partner_ownership import Ownership, OwnershipShare

VERSION = 1


def format_found_json(words: Sequence[str], found: Iterable[SearchEntry]) -> str:
    """Return what was found as one JSON document, the best first, with a line end behind it."""
    entries = [
        {"kind": entry.kind, "id": entry.name, "title": entry.title, "line": entry.line, "text": entry.text}
        for entry in found
    ]
    return format_json({"version": VERSION, "words": list(words), "found": entries})


def format_ownership_json(ownership: Ownership) -> str:
    """Return who owns what as one JSON document, with a line end behind it."""
    return format_json(
        {
            "version": VERSION,
            "partners": [_share_to_json(share) for share in ownership.partners],
            "nobody": _share_to_json(ownership.nobody),
            "shared_files": list(ownership.shared_files),
        }
    )


def _share_to_json(share: OwnershipShare) -> dict[str, Any]:
    partner = share.partner
    return {
        "partner": partner.id if partner else None,
        "title": partner.title if partner else None,
        "reviewers": list(partner.reviewers) if partner else [],
        "elements": {kind: list(ids) for kind, ids in share.elements.items()},
        "files": list(share.files),
    }


def format_rules_json(rules: Iterable[Rule]) -> str:
    """Return rules with their pages as one JSON document, with a line end behind it."""
    return format_json({"version": VERSION, "rules": [_rule_to_json(rule) for rule in rules]})


def _rule_to_json(rule: Rule) -> dict[str, Any]:
    page = read_rule_page(rule)
    return {
        "name": rule.name,
        "severity": str(rule.severity),
        "summary": page.summary,
        "why": page.why,
        "reported": page.bad,
        "not_reported": page.good,
        "options": [
            {"name": option.name, "default": option.default, "words": option.summary} for option in rule.options
        ],
    }
