"""A comparison for programs: the JSON format, version 1, as `schemas/diff.schema.json` describes it."""

from __future__ import annotations

from typing import Any

from archgen.compare import ChainChange, Change, Comparison
from archgen.compare.comparison import (
    BoundaryChange,
    ComparedFigure,
    FigureChange,
    LimitChange,
    LoadChange,
    TravelPath,
    WireNames,
)
from archgen.compare.edits import list_edits
from archgen.compare.figure_noise import FigureNoise
from archgen.compare.type_edits import TypeKey, trace_origins
from archgen.diagnostics import format_json
from archgen.emit.data.findings_data import finding_to_json
from archgen.emit.data.timing_json import duration_to_json, quantity_to_json
from archgen.model.node import Qos
from archgen.model.project_settings import BREAK_CATEGORIES
from archgen.timing.analysis import ChainResult
from archgen.views.changes.comparison_document import ReadingErrors, sort_by_severity
from archgen.views.inline_text import list_qos_settings

FORMAT_VERSION = 1


def write_comparison_json(comparison: Comparison, reading_errors: ReadingErrors) -> str:
    """Return a comparison as one JSON document; programs get all of it, nothing summed up or left out."""
    return format_json(comparison_record(comparison, reading_errors))


def comparison_record(comparison: Comparison, reading_errors: ReadingErrors) -> dict[str, Any]:
    """Return a comparison as plain data."""
    origins = trace_origins(comparison, comparison.changes)
    return {
        "version": FORMAT_VERSION,
        "changes": [change_record(item, origins.get(id(item))) for item in comparison.changes],
        "edits": _list_edit_records(comparison),
        "findings": {
            "new": [finding_to_json(item) for item in sort_by_severity(comparison.new_findings)],
            "cured": [finding_to_json(item) for item in sort_by_severity(comparison.cured_findings)],
            "silenced": [finding_to_json(item) for item in sort_by_severity(comparison.silenced_findings)],
        },
        "chains": [_chain_record(item) for item in comparison.chains],
        "boundaries": [_boundary_record(item) for item in comparison.boundaries],
        "limits": [_limit_record(item) for item in comparison.limits],
        "loads": [_load_record(item) for item in comparison.loads],
        "noise": _noise_record(FigureNoise(comparison)),
        "owners": list(comparison.concerned_owners),
        "breaking": {
            "severity": str(comparison.policy.gravest),
            "policy": {category: str(comparison.policy.severity_of(category)) for category in BREAK_CATEGORIES},
            "fails": comparison.is_refused,
            "judged": comparison.is_judged,
            "idle": [
                {"element": acceptance.element, "key": acceptance.key, "reason": acceptance.reason}
                for acceptance in comparison.idle_acceptances
            ],
        },
        "broken": {
            "before": [finding_to_json(item) for item in reading_errors[0]],
            "after": [finding_to_json(item) for item in reading_errors[1]],
        },
    }


def _list_edit_records(comparison: Comparison) -> list[dict[str, Any]]:
    """Return what people are shown as one item each, with the positions of its changes."""
    positions = {id(change): position for position, change in enumerate(comparison.changes)}
    return [
        {
            "kind": edit.kind,
            "sort": edit.element_kind,
            "element": edit.element_id,
            "related": list(edit.related_ids),
            "confidence": edit.confidence,
            "text": edit.text,
            "changes": [positions[id(change)] for change in edit.changes],
        }
        for edit in list_edits(comparison)
    ]


def change_record(architecture_change: Change, origin: TypeKey | None = None) -> dict[str, Any]:
    """Return one change with its parts as plain data; `origin` is the component type that it follows, if any."""
    return {
        "kind": architecture_change.kind,
        "sort": architecture_change.element_kind,
        "element": architecture_change.element_id,
        "was": architecture_change.old_id,
        "key": architecture_change.key,
        "before": architecture_change.before,
        "after": architecture_change.after,
        "confidence": architecture_change.confidence,
        # The keys are the format, not the names of attributes: they stay when those change.
        "breaks": list(architecture_change.broken_partners),
        "because": [
            {
                "partner": partner_break.partner,
                "category": partner_break.category,
                "why": partner_break.reason,
                "hash": partner_break.hash,
                "agreed": partner_break.agreement,
                **({"variants": list(partner_break.variants)} if partner_break.variants else {}),
                **(
                    dict(zip(("fallen", "fallen_key"), partner_break.fallen, strict=True))
                    if partner_break.fallen
                    else {}
                ),
            }
            for partner_break in architecture_change.breaks
        ],
        "accepted": architecture_change.acceptance_reason,
        "said": [
            {"file": entry.at.file, "key": entry.key, "reason": entry.reason} for entry in architecture_change.claims
        ],
        "text": architecture_change.text,
        **({"type": origin.component_type} if origin else {}),
        **({"variants": list(architecture_change.variants)} if architecture_change.variants else {}),
        "parts": [change_record(part) for part in architecture_change.parts],
    }


def _chain_record(chain_change: ChainChange) -> dict[str, Any]:
    deadline = duration_to_json(chain_change.deadline)["value"] if chain_change.deadline else None
    return {
        "id": chain_change.id,
        "before": _bound_record(chain_change.before),
        "after": _bound_record(chain_change.after),
        "deadline": deadline,
        "verdicts": [each and each.verdict for each in (chain_change.before, chain_change.after)],
    }


def _bound_record(result: ChainResult | None) -> dict[str, Any] | None:
    return duration_to_json(result.bound) if result else None


_DURATIONS = frozenset({"largest gap", "answers within", "age on arrival"})


def _boundary_record(change: BoundaryChange) -> dict[str, Any]:
    """Return what changed at an interface as plain data; partners by their ids."""
    return {
        "kind": change.kind,
        "interface": change.interface_id,
        "was": change.old_id,
        "from": list(change.givers),
        "given_before_by": list(change.old_givers),
        "to": list(change.takers),
        "taken_before_by": list(change.old_takers),
        "missed_deadline": duration_to_json(change.missed_deadline) if change.missed_deadline else None,
        "figures": [_figure_record(figure) for figure in change.figures],
    }


def _figure_record(change: FigureChange) -> dict[str, Any]:
    name = change.key.name
    return {
        "name": name,
        "node": change.key.node or None,
        "before": _figure_value(name, change.before),
        "after": _figure_value(name, change.after),
    }


def _figure_value(name: str, figure: ComparedFigure | None) -> object:
    if figure is None:
        return None
    if isinstance(figure, Qos):
        return list_qos_settings(figure)
    if isinstance(figure, TravelPath):
        return {"from": list(figure.senders), "to": list(figure.receivers), "over": list(figure.links)}
    if isinstance(figure, WireNames):
        return list(figure.names)
    return duration_to_json(figure) if name in _DURATIONS else quantity_to_json(figure)


def _limit_record(change: LimitChange) -> dict[str, Any]:
    """Return how a promise or a freshness is kept in both versions as plain data."""
    write = quantity_to_json if change.key == "rate" else duration_to_json
    return {
        "element": change.port,
        "key": change.key,
        "reader": change.reader or None,
        "limit": str(change.limit),
        "was": change.old_state,
        "is": change.new_state,
        "before": write(change.before),
        "after": write(change.after),
    }


def _noise_record(noise: FigureNoise) -> dict[str, Any]:
    """Return how many figures people are told in one line, since they moved too little, and the one that moved most."""
    moves = list(noise.list_moves())
    largest = max(moves, key=lambda move: move.share, default=None)
    return {
        "share": float(noise.threshold),
        "count": len(moves),
        "largest": {"element": largest.element, "figure": largest.figure, "share": float(largest.share)}
        if largest
        else None,
    }


def _load_record(change: LoadChange) -> dict[str, Any]:
    """Return the load of a host or a link as plain data."""
    return {
        "sort": change.kind,
        "element": change.id,
        "before": quantity_to_json(change.before) if change.before else None,
        "after": quantity_to_json(change.after),
        "users": sorted(change.users),
    }
