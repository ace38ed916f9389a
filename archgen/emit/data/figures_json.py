"""Changed figures for programs: of interfaces between partners, and the loads of hosts and links.

Part of the format of comparisons, `schemas/diff.schema.json`. Durations are in milliseconds, rates in Hz, sizes in B,
traffic in B/s, loads are shares.
"""

from __future__ import annotations

from typing import Any

from archgen.compare.figure_changes import (
    BoundaryChange,
    ComparedFigure,
    FigureChange,
    LimitChange,
    LoadChange,
    TravelPath,
    WireNames,
)
from archgen.compare.figure_noise import FigureNoise
from archgen.emit.data.timing_json import duration_to_json, quantity_to_json
from archgen.model.node import Qos
from archgen.views.inline_text import list_qos_settings

_DURATIONS = frozenset({"largest gap", "answers within", "age on arrival"})


def boundary_record(change: BoundaryChange) -> dict[str, Any]:
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


def limit_record(change: LimitChange) -> dict[str, Any]:
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


def noise_record(noise: FigureNoise) -> dict[str, Any]:
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


def load_record(change: LoadChange) -> dict[str, Any]:
    """Return the load of a host or a link as plain data."""
    return {
        "sort": change.kind,
        "element": change.id,
        "before": quantity_to_json(change.before) if change.before else None,
        "after": quantity_to_json(change.after),
        "users": sorted(change.users),
    }
