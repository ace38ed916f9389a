"""A project's history for the terminal, as CSV, and as plain data."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from archgen.findings import listing
from archgen.model.history import History, Point
from archgen.views.growth import change, share, short, when
from archgen.views.statistics import STEPS

VERSION = 1
_SHALLOW = "this clone is shallow: older commits are not in it (`git fetch --unshallow` brings them)"
_COLUMNS = ("when", "groups", "components", "connections", "nodes", *STEPS, "findings")
_LONG = ("commit", "day", "scope", "id", "title", "components", *STEPS, "errors", "warnings", "notes")


def text(history: History) -> str:
    """Return a line for each point, newest last, then how each group and partner changed."""
    if not history.points:
        return "no commit holds this project yet\n"
    rows = [_row(point, history) for point in history.points]
    said = "" if history.whole else f"{_SHALLOW}\n\n"
    return said + listing.text(_COLUMNS, rows) + _parts(history)


def _row(point: Point, history: History) -> tuple[str, ...]:
    whole = point.whole
    counts = (point.groups, whole.components, point.connections, point.nodes)
    return (when(point, history), *map(str, counts), *(share(whole, step) for step in STEPS), short(whole.findings))


def _parts(history: History) -> str:
    first, last = history.points[0], history.points[-1]
    before = {(row.scope, row.id): row for row in first.rows}
    rows = []
    # The first row is the whole project, which the table above shows.
    for row in last.rows[1:]:
        was = before.get((row.scope, row.id))
        pairs = [(str(was.components) if was else "0", str(row.components))]
        pairs += [(share(was, step) if was else "", share(row, step)) for step in STEPS]
        pairs.append((short(was.findings) if was else "", short(row.findings)))
        rows.append((f"{row.scope} {row.title}", *(change(*pair) for pair in pairs)))
    if not rows:
        return ""
    return f"\nfrom {when(first, history)} to {when(last, history)}\n" + listing.text(
        ("of", "components", *STEPS, "findings"), rows
    )


def csv(history: History) -> str:
    """Return a line for each point and, in it, each of the whole, the groups and the partners."""
    rows = [
        (
            *(point.commit, point.day, row.scope, row.id, row.title, str(row.components)),
            *(str(getattr(row, step)) for step in STEPS),
            *(str(count) for count in (row.findings.error, row.findings.warning, row.findings.note)),
        )
        for point in history.points
        for row in point.rows
    ]
    return listing.csv(_LONG, rows)


def document(history: History) -> dict[str, Any]:
    """Return the history as plain data (`schemas/history.schema.json`)."""
    points = [asdict(point) for point in history.points]
    return {"version": VERSION, "by": history.by, "complete": history.whole, "points": points}
