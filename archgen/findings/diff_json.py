"""A comparison for programs: the JSON format, version 1, as `schemas/diff.schema.json` describes it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from archgen.compare import ChainChange, Change, Comparison
from archgen.diagnostic import Diagnostic
from archgen.findings.escape import json_text
from archgen.findings.json import record
from archgen.findings.timing_json import time
from archgen.timing.analysis import ChainResult

VERSION = 1
Broken = tuple[Sequence[Diagnostic], Sequence[Diagnostic]]


def render(found: Comparison, broken: Broken) -> str:
    """Return a comparison as one JSON document; `broken` are the errors of reading either version."""
    return json_text(document(found, broken))


def document(found: Comparison, broken: Broken) -> dict[str, Any]:
    """Return a comparison as plain data."""
    return {
        "version": VERSION,
        "changes": [change(each) for each in found.changes],
        "findings": {
            "new": [record(each) for each in found.new],
            "cured": [record(each) for each in found.cured],
            "silenced": [record(each) for each in found.silenced],
        },
        "chains": [_chain(each) for each in found.chains],
        "owners": list(found.owners),
        "breaking": {
            "severity": str(found.breaking),
            "fails": found.failing,
            "idle": [{"element": one.element, "key": one.key, "reason": one.reason} for one in found.idle],
        },
        "broken": {"before": [record(each) for each in broken[0]], "after": [record(each) for each in broken[1]]},
    }


def change(each: Change) -> dict[str, Any]:
    """Return one change with its parts as plain data."""
    return {
        "kind": each.kind,
        "sort": each.sort,
        "element": each.element,
        "was": each.was,
        "key": each.key,
        "before": each.before,
        "after": each.after,
        "confidence": each.confidence,
        # The keys are the format, not the names of attributes: they stay when those change.
        "breaks": list(each.broken),
        "because": [{"partner": one.partner, "why": one.why} for one in each.breaks],
        "accepted": each.accepted,
        "text": each.text,
        "parts": [change(part) for part in each.parts],
    }


def _chain(each: ChainChange) -> dict[str, Any]:
    deadline = time(each.deadline)["value"] if each.deadline else None
    return {"id": each.id, "before": _bound(each.before), "after": _bound(each.after), "deadline": deadline}


def _bound(result: ChainResult | None) -> dict[str, Any] | None:
    return time(result.bound) if result else None
