"""Size and progress of an architecture as tables, and how it grew: charts of progress and findings over time."""

from __future__ import annotations

from collections.abc import Container, Iterable
from fractions import Fraction

from archgen.analyses.size_counts import (
    ArchitectureSize,
    ProgressCounts,
    count_declared_properties,
    measure_progress,
    measure_size,
)
from archgen.diagnostics import floor_percent, shorten_hash
from archgen.model.architecture import Architecture
from archgen.model.project_history import FindingCounts, History, HistoryPoint, ProgressRow
from archgen.views import inline_text
from archgen.views.inline_text import count_noun
from archgen.views.picture_shapes import BarSegment, Chart, ChartBar
from archgen.views.shapes import Block, Column, Figure, Inlines, Paragraph, Table, Text

_FIGURE_LABELS = {
    "groups": "Groups of components",
    "components": "Functional components",
    "components_per_group": "Components for each group, mean",
    "largest_group": "Components of the largest group",
    "connections": "Connections",
    "connections_per_component": "Connections for each component, mean",
    "mapped_connections": "Connections mapped to messages",
    "edges": "Edges (pairs of output and input)",
    "inputs": "Inputs",
    "outputs": "Outputs",
    "inputs_per_component": "Inputs for each component, mean",
    "outputs_per_component": "Outputs for each component, mean",
    "nodes": "ROS nodes",
    "planned_nodes": "Nodes still to be decided",
    "topics": "Topics",
    "services": "Services",
    "actions": "Actions",
    "types": "Conceptual types",
    "messages": "Distinct messages",
    "use_cases": "Use cases",
    "requirements": "Requirements",
    "partners": "Partners",
    "hosts": "Hosts",
    "containers": "Containers",
    "links": "Links",
    "chains": "Chains of effect",
    "views": "Views",
    "policies": "Policies",
    "composed": "Composed components",
    "component_types": "Component types",
    "made_connections": "Connections made by themselves",
    "frames": "Coordinate frames",
    "variants": "Variants",
    "steps": "Steps of use cases",
    "programs": "Programs that are no ROS",
    "promises": "Outputs with promises",
    "deprecated": "Deprecated outputs and types",
    "verified": "Requirements that something verifies",
    "property_values": "Values of declared properties",
}
"""Titles of figures; the keys are fields of `Size`, read by name."""
_RARE_FIGURES = frozenset(
    {
        *("composed", "component_types", "made_connections", "frames", "variants", "steps", "programs", "promises"),
        *("deprecated", "verified", "property_values"),
    }
)
"""Figures that are left out where there is nothing to count: most projects compose nothing and name no frames."""
PROGRESS_STEPS = ("described", "typed", "mapped", "timed", "traced")
"""The steps that progress counts, in order; each is a field of `Progress` and of the history's `Row`."""


def list_steps(rows: Iterable[ProgressCounts]) -> tuple[str, ...]:
    """Return the steps of which rows say something: what was seen of a robot only where somebody looked at one."""
    return (*PROGRESS_STEPS, *(("seen",) if any(row.seen is not None for row in rows) else ()))


def format_figures(project_size: ArchitectureSize) -> list[tuple[str, str, str]]:
    """Return key, title and value of each figure."""
    return [
        (key, label, format_count(getattr(project_size, key)))
        for key, label in _FIGURE_LABELS.items()
        if key not in _RARE_FIGURES or getattr(project_size, key)
    ]


def format_count(value: int | Fraction) -> str:
    """Format a count as it is, a mean with one decimal."""
    return f"{float(value):.1f}" if isinstance(value, Fraction) else str(value)


def make_statistics_tables(architecture: Architecture, seen: frozenset[str] | None = None) -> tuple[Table, ...]:
    """Make the tables of size and progress; progress only where there are components. `seen` are those seen on a robot."""
    rows = tuple(
        (inline_text.to_inlines(label), (Text(value, sort_number=value),))
        for _, label, value in format_figures(measure_size(architecture))
    )
    size_table = Table(
        "table:size", "Size of the architecture", (Column("Figure", 3), Column("Value", 1, "right")), rows
    )
    property_tables = tuple(filter(None, [_make_property_table(architecture)]))
    progress_rows = [row for row in measure_progress(architecture, seen=seen) if row.components]
    if not progress_rows:
        return (size_table, *property_tables)
    columns = (
        Column("Of", 2),
        Column("Components", 0.9, "right"),
        *(Column(s.capitalize(), 0.8, "right") for s in list_steps(progress_rows)),
    )
    progress_table = Table(
        "table:progress", "Progress", columns, tuple(_progress_row(architecture, row) for row in progress_rows)
    )
    return (size_table, progress_table, *property_tables)


def _make_property_table(architecture: Architecture) -> Table | None:
    """Return how many elements have each declared property, and how many of the kinds that it names lack it."""
    rows = tuple(
        (
            inline_text.to_inlines(declared.title),
            *((Text(str(count), sort_number=str(count)),) for count in (have, lack)),
        )
        for declared, have, lack in count_declared_properties(architecture)
    )
    columns = (Column("Property", 3), Column("Have it", 0.8, "right"), Column("Lack it", 0.8, "right"))
    return Table("table:declared", "Declared properties", columns, rows) if rows else None


def _progress_row(architecture: Architecture, row: ProgressCounts) -> tuple[Inlines, ...]:
    counts = (getattr(row, step) for step in list_steps((row,)))
    return (
        _subject_cell(architecture, row),
        inline_text.to_inlines(str(row.components)),
        *((Text(f"{count} ({floor_percent(count, row.components)} %)", sort_number=str(count)),) for count in counts),
    )


def _subject_cell(architecture: Architecture, row: ProgressCounts) -> Inlines:
    if row.scope == "group":
        return inline_text.to_inlines(inline_text.group_link(architecture, row.id))
    if row.scope == "partner" and row.id:
        return inline_text.partner_link(architecture, row.id)
    return inline_text.to_inlines(Text(row.title, strong=row.scope == "project"))


_MAX_BARS = 24
"""Bars that can be read at a glance; the table has the older points, too."""
_FINDINGS_TITLE = "Errors / warnings / notes"


def make_growth_charts(history: History) -> tuple[Chart, ...]:
    """Make the charts of mapped components and of findings; none for fewer than two points."""
    shown_points = history.points[-_MAX_BARS:]
    if len(shown_points) < 2:  # noqa: PLR2004 - one point is no history
        return ()
    older_count = len(history.points) - len(shown_points)
    plural = "s" if older_count > 1 else ""
    notes = (f"The table has {older_count} older {history.by}{plural} too.",) if older_count else ()
    first, last = shown_points[0], shown_points[-1]
    progress_text = f"{_format_mapped(first)} in {name_point(first, history)}, {_format_mapped(last)} in {name_point(last, history)}."
    findings_text = f"{count_findings(first)} findings in {name_point(first, history)}, {count_findings(last)} in {name_point(last, history)}."
    return (
        Chart(
            "history/progress",
            "Components over time",
            "components",
            tuple(_progress_bar(point, history) for point in shown_points),
            conclusion=f"Components mapped to nodes: {progress_text}",
            legend=("load: mapped to nodes", "other_load: not yet mapped"),
            notes=notes,
            alt=f"Bars, one for each {history.by}. Components mapped to nodes: {progress_text}",
        ),
        Chart(
            "history/findings",
            "Findings over time",
            "findings",
            tuple(_findings_bar(point, history) for point in shown_points),
            conclusion=f"What archgen finds: {findings_text}",
            legend=("missed: errors", "open: warnings", "best: notes"),
            notes=notes,
            alt=f"Bars, one for each {history.by}. What archgen finds: {findings_text}",
        ),
    )


def make_growth_blocks(history: History, drawing_ids: Container[str]) -> tuple[Block, ...]:
    """Return the blocks of the chapter on statistics: charts that were drawn, and tables.

    `drawing_ids` are the ids of all drawings of the document.
    """
    growth_charts = make_growth_charts(history)
    if not growth_charts:
        return ()
    figures = tuple(
        Figure(f"figure:{chart.id}", chart.id, chart.title, chart.alt)
        for chart in growth_charts
        if chart.id in drawing_ids
    )
    lead = f"How the architecture grew, {'month by month' if history.by == 'month' else 'revision by revision'}."
    if not history.whole:
        lead += " The clone that this was made from is shallow: what is older is not in it."
    return (Paragraph(inline_text.to_inlines(lead)), *figures, _make_growth_table(history), *_compare_groups(history))


def _make_growth_table(history: History) -> Table:
    """List every point, the latest first: size, progress and findings of the whole."""
    columns = (
        Column("Month" if history.by == "month" else "Revision", 1.1),
        *(
            Column(title, 0.9, "right")
            for title in ("Components", "Connections", *map(str.capitalize, PROGRESS_STEPS), _FINDINGS_TITLE)
        ),
    )
    rows = tuple(
        (
            inline_text.to_inlines(name_point(point, history)),
            inline_text.to_inlines(str(point.project_row.components)),
            inline_text.to_inlines(str(point.connections)),
            *(_step_cell(point.project_row, step) for step in PROGRESS_STEPS),
            inline_text.to_inlines(_format_slashed(point.project_row.findings)),
        )
        for point in reversed(history.points)
    )
    return Table("table:history", "Size, progress and findings over time", columns, rows)


def _compare_groups(history: History) -> tuple[Table, ...]:
    """Compare groups and partners at the first point and at the last."""
    first_rows = {(row.scope, row.id): row for row in history.points[0].rows}
    columns = (
        Column("Of", 2),
        *(Column(title, 1.2, "right") for title in ("Components", "Mapped", "Timed", _FINDINGS_TITLE)),
    )
    # Rows of the last point only: groups that are gone since the first one are not listed.
    rows = tuple(
        _comparison_row(row, first_rows.get((row.scope, row.id)))
        for row in history.points[-1].rows
        if row.scope != "project"
    )
    title = (
        f"Groups and partners, {name_point(history.points[0], history)} and {name_point(history.points[-1], history)}"
    )
    return (Table("table:history_parts", title, columns, rows),) if rows else ()


def _comparison_row(row: ProgressRow, first_row: ProgressRow | None) -> tuple[Inlines, ...]:
    """Make the row of one group or partner; `first_row` is None where it did not exist yet."""
    pairs = (
        (str(first_row.components) if first_row else "", str(row.components)),
        (format_step_share(first_row, "mapped") if first_row else "", format_step_share(row, "mapped")),
        (format_step_share(first_row, "timed") if first_row else "", format_step_share(row, "timed")),
        (_format_slashed(first_row.findings) if first_row else "", _format_slashed(row.findings)),
    )
    return (
        inline_text.to_inlines(row.title),
        *(inline_text.to_inlines(format_change(old_value, new_value)) for old_value, new_value in pairs),
    )


def format_change(old_value: str, new_value: str) -> str:
    """Format two values with an arrow between them, one where they are equal or the old one is empty."""
    return new_value if old_value in {new_value, ""} else f"{old_value} \u2192 {new_value}"


def name_point(point: HistoryPoint, history: History) -> str:
    """Name a point: its month, or its day and the first digits of its commit."""
    return point.day[:7] if history.by == "month" else f"{point.day} {shorten_hash(point.commit)}"


def format_step_share(row: ProgressRow, step: str) -> str:
    """Format the share of a step in percent, rounded down so that 100 % means all; `-` without components."""
    return f"{floor_percent(getattr(row, step), row.components)} %" if row.components else "-"


def _step_cell(row: ProgressRow, step: str) -> Inlines:
    """Return the cell of a step's share, sorted by the exact share."""
    share = str(Fraction(getattr(row, step), row.components)) if row.components else None
    return (Text(format_step_share(row, step), sort_number=share),)


def format_finding_counts(findings: FindingCounts) -> str:
    """Format findings by severity: `1 error, 2 notes`; `-` for none."""
    counts = ((findings.error, "error"), (findings.warning, "warning"), (findings.note, "note"))
    return ", ".join(count_noun(count, name) for count, name in counts if count) or "-"


def _format_slashed(findings: FindingCounts) -> str:
    """Format findings as `errors / warnings / notes`."""
    return f"{findings.error} / {findings.warning} / {findings.note}"


def _progress_bar(point: HistoryPoint, history: History) -> ChartBar:
    project_row = point.project_row
    unmapped_count = project_row.components - project_row.mapped
    segments = (
        BarSegment(project_row.mapped, "load", "", f"{project_row.mapped} mapped to nodes"),
        BarSegment(unmapped_count, "other_load", "", f"{unmapped_count} not yet mapped"),
    )
    return ChartBar(
        name_point(point, history), tuple(segment for segment in segments if segment.length), _format_mapped(point)
    )


def _findings_bar(point: HistoryPoint, history: History) -> ChartBar:
    findings = point.project_row.findings
    segments = (
        BarSegment(findings.error, "missed", "", count_noun(findings.error, "error")),
        BarSegment(findings.warning, "open", "", count_noun(findings.warning, "warning")),
        BarSegment(findings.note, "best", "", count_noun(findings.note, "note")),
    )
    return ChartBar(
        name_point(point, history),
        tuple(segment for segment in segments if segment.length),
        str(count_findings(point)),
    )


def _format_mapped(point: HistoryPoint) -> str:
    """Format mapped and all components: `3 of 7`."""
    return f"{point.project_row.mapped} of {point.project_row.components}"


def count_findings(point: HistoryPoint) -> int:
    """Count the findings of all severities."""
    findings = point.project_row.findings
    return findings.error + findings.warning + findings.note
