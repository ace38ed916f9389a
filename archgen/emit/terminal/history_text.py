"""A project's history for the terminal, as CSV, and as plain data."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from archgen.emit.terminal import list_formats
from archgen.model.project_history import History, HistoryPoint
from archgen.views.tables.statistics_tables import (
    PROGRESS_STEPS,
    format_change,
    format_finding_counts,
    format_step_share,
    name_point,
)

VERSION = 1
_SHALLOW_NOTE = "this clone is shallow: older commits are not in it (`git fetch --unshallow` brings them)"
_COLUMNS = ("when", "groups", "components", "connections", "nodes", *PROGRESS_STEPS, "findings")
_CSV_COLUMNS = ("commit", "day", "scope", "id", "title", "components", *PROGRESS_STEPS, "errors", "warnings", "notes")


def format_history(history: History, width: int | None = None) -> str:
    """Return a line for each point, newest last, then how each group and partner changed."""
    if not history.points:
        return "no commit holds this project yet\n"
    rows = [_history_row(point, history) for point in history.points]
    shallow_note = "" if history.whole else f"{_SHALLOW_NOTE}\n\n"
    return shallow_note + list_formats.format_columns(_COLUMNS, rows, width) + _format_changes(history, width)


def _history_row(point: HistoryPoint, history: History) -> tuple[str, ...]:
    project_row = point.project_row
    counts = (point.groups, project_row.components, point.connections, point.nodes)
    return (
        name_point(point, history),
        *map(str, counts),
        *(format_step_share(project_row, step) for step in PROGRESS_STEPS),
        format_finding_counts(project_row.findings),
    )


def _format_changes(history: History, width: int | None) -> str:
    first, last = history.points[0], history.points[-1]
    first_rows = {(row.scope, row.id): row for row in first.rows}
    rows = []
    # The first row is the whole project, which the table above shows.
    for row in last.rows[1:]:
        old_row = first_rows.get((row.scope, row.id))
        pairs = [(str(old_row.components) if old_row else "0", str(row.components))]
        pairs += [
            (format_step_share(old_row, step) if old_row else "", format_step_share(row, step))
            for step in PROGRESS_STEPS
        ]
        pairs.append((format_finding_counts(old_row.findings) if old_row else "", format_finding_counts(row.findings)))
        rows.append((f"{row.scope} {row.title}", *(format_change(*pair) for pair in pairs)))
    if not rows or first is last:
        return ""
    return f"\nfrom {name_point(first, history)} to {name_point(last, history)}\n" + list_formats.format_columns(
        ("of", "components", *PROGRESS_STEPS, "findings"), rows, width
    )


def history_to_csv(history: History) -> str:
    """Return a line for each point and, in it, each of the whole, the groups and the partners."""
    rows = [
        (
            *(point.commit, point.day, row.scope, row.id, row.title, str(row.components)),
            *(str(getattr(row, step)) for step in PROGRESS_STEPS),
            *(str(count) for count in (row.findings.error, row.findings.warning, row.findings.note)),
        )
        for point in history.points
        for row in point.rows
    ]
    return list_formats.format_csv(_CSV_COLUMNS, rows)


def history_to_json(history: History) -> dict[str, Any]:
    """Return the history as plain data (`schemas/history.schema.json`)."""
    points = [asdict(point) for point in history.points]
    return {"version": VERSION, "by": history.by, "complete": history.whole, "points": points}
