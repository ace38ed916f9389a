"""How the architecture grew: charts of progress and findings over time, and tables below them."""

from __future__ import annotations

from collections.abc import Sequence

from archgen.model.history import Findings, History, Point, Row
from archgen.views import words
from archgen.views.bars import Bar, Chart, Stretch
from archgen.views.shapes import Block, Column, Figure, Inlines, Paragraph, Table
from archgen.views.statistics import STEPS
from archgen.views.words import plural

_MOST = 24
"""Bars that can be read at a glance; the table has the older points, too."""
_FINDINGS = "Errors / warnings / notes"


def charts(history: History) -> tuple[Chart, ...]:
    """Make the charts of mapped components and of findings; none for fewer than two points."""
    shown = history.points[-_MOST:]
    if len(shown) < 2:  # noqa: PLR2004 - one point is no history
        return ()
    notes = tuple(_left_out(history, len(shown)))
    first, last = shown[0], shown[-1]
    grown = f"{_count(first)} in {when(first, history)}, {_count(last)} in {when(last, history)}."
    found = f"{_total(first)} findings in {when(first, history)}, {_total(last)} in {when(last, history)}."
    return (
        Chart(
            "history/progress",
            "Components over time",
            "components",
            tuple(_progress(point, history) for point in shown),
            said=f"Components mapped to nodes: {grown}",
            legend=("load: mapped to nodes", "other_load: not yet mapped"),
            notes=notes,
            alt=f"Bars, one for each {history.by}. Components mapped to nodes: {grown}",
        ),
        Chart(
            "history/findings",
            "Findings over time",
            "findings",
            tuple(_findings(point, history) for point in shown),
            said=f"What archgen finds: {found}",
            legend=("missed: errors", "open: warnings", "best: notes"),
            notes=notes,
            alt=f"Bars, one for each {history.by}. What archgen finds: {found}",
        ),
    )


def blocks(history: History, drawn: Sequence[str]) -> tuple[Block, ...]:
    """Return the blocks of the chapter on statistics: charts that were drawn, and tables.

    `drawing_ids` are the ids of all drawings of the document.
    """
    made = charts(history)
    if not made:
        return ()
    figures = tuple(Figure(f"figure:{one.id}", one.id, one.title, one.alt) for one in made if one.id in drawn)
    said = f"How the architecture grew, {'month by month' if history.by == 'month' else 'revision by revision'}."
    if not history.whole:
        said += " The clone that this was made from is shallow: what is older is not in it."
    return (Paragraph(words.text(said)), *figures, table(history), *_groups(history))


def table(history: History) -> Table:
    """List every point, the latest first: size, progress and findings of the whole."""
    columns = (
        Column("Month" if history.by == "month" else "Revision", 1.1),
        *(
            Column(title, 0.9, "right")
            for title in ("Components", "Connections", *map(str.capitalize, STEPS), _FINDINGS)
        ),
    )
    rows = tuple(
        tuple(
            map(
                words.text,
                (
                    when(point, history),
                    str(point.whole.components),
                    str(point.connections),
                    *(share(point.whole, step) for step in STEPS),
                    _slashed(point.whole.findings),
                ),
            )
        )
        for point in reversed(history.points)
    )
    return Table("table:history", "Size, progress and findings over time", columns, rows)


def _groups(history: History) -> tuple[Table, ...]:
    """Compare groups and partners at the first point and at the last."""
    before = {(row.scope, row.id): row for row in history.points[0].rows}
    columns = (
        Column("Of", 2),
        *(Column(title, 1.2, "right") for title in ("Components", "Mapped", "Timed", _FINDINGS)),
    )
    # Rows of the last point only: groups that are gone since the first one are not listed.
    rows = tuple(
        _compared(row, before.get((row.scope, row.id))) for row in history.points[-1].rows if row.scope != "project"
    )
    title = f"Groups and partners, {when(history.points[0], history)} and {when(history.points[-1], history)}"
    return (Table("table:history_parts", title, columns, rows),) if rows else ()


def _compared(row: Row, before: Row | None) -> tuple[Inlines, ...]:
    """Make the row of one group or partner; `first_row` is None where it did not exist yet."""
    pairs = (
        (str(before.components) if before else "", str(row.components)),
        (share(before, "mapped") if before else "", share(row, "mapped")),
        (share(before, "timed") if before else "", share(row, "timed")),
        (_slashed(before.findings) if before else "", _slashed(row.findings)),
    )
    return (words.text(row.title), *(words.text(change(was, now)) for was, now in pairs))


def change(was: str, now: str) -> str:
    """Format two values with an arrow between them, one where they are equal or the old one is empty."""
    return now if was in {now, ""} else f"{was} \u2192 {now}"


def when(point: Point, history: History) -> str:
    """Name a point: its month, or its day and the first digits of its commit."""
    return point.day[:7] if history.by == "month" else f"{point.day} {point.commit[:7]}"


def share(row: Row, step: str) -> str:
    """Format the share of a step in percent, rounded down so that 100 % means all; `-` without components."""
    return f"{100 * getattr(row, step) // row.components} %" if row.components else "-"


def short(findings: Findings) -> str:
    """Format findings by severity: `1 error, 2 notes`; `-` for none."""
    counts = ((findings.error, "error"), (findings.warning, "warning"), (findings.note, "note"))
    return ", ".join(plural(count, name) for count, name in counts if count) or "-"


def _slashed(findings: Findings) -> str:
    """Format findings as `errors / warnings / notes`."""
    return f"{findings.error} / {findings.warning} / {findings.note}"


def _progress(point: Point, history: History) -> Bar:
    whole = point.whole
    rest = whole.components - whole.mapped
    stretches = (
        Stretch(whole.mapped, "load", "", f"{whole.mapped} mapped to nodes"),
        Stretch(rest, "other_load", "", f"{rest} not yet mapped"),
    )
    return Bar(when(point, history), tuple(s for s in stretches if s.length), _count(point))


def _findings(point: Point, history: History) -> Bar:
    of = point.whole.findings
    stretches = (
        Stretch(of.error, "missed", "", plural(of.error, "error")),
        Stretch(of.warning, "open", "", plural(of.warning, "warning")),
        Stretch(of.note, "best", "", plural(of.note, "note")),
    )
    return Bar(when(point, history), tuple(s for s in stretches if s.length), str(_total(point)))


def _count(point: Point) -> str:
    """Format mapped and all components: `3 of 7`."""
    return f"{point.whole.mapped} of {point.whole.components}"


def _total(point: Point) -> int:
    """Count the findings of all severities."""
    of = point.whole.findings
    return of.error + of.warning + of.note


def _left_out(history: History, shown: int) -> list[str]:
    """Return a note on points that only the table has."""
    more = len(history.points) - shown
    return [f"The table has {more} older {history.by}{'s' if more > 1 else ''} too."] if more else []
