"""Size and progress of an architecture as tables."""

from __future__ import annotations

from fractions import Fraction

from archgen.analyses.size_counts import (
    ArchitectureSize,
    ProgressCounts,
    count_declared_properties,
    measure_progress,
    measure_size,
)
from archgen.diagnostics.common_wording import floor_percent
from archgen.model.architecture import Architecture
from archgen.views import inline_text
from archgen.views.shapes import Column, Inlines, Table, Text

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
        "composed",
        "component_types",
        "made_connections",
        "frames",
        "variants",
        "steps",
        "programs",
        "promises",
        "deprecated",
        "verified",
        "property_values",
    }
)
"""Figures that are left out where there is nothing to count: most projects compose nothing and name no frames."""
PROGRESS_STEPS = ("described", "typed", "mapped", "timed", "traced")
"""The steps that progress counts, in order; each is a field of `Progress` and of the history's `Row`."""


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


def make_statistics_tables(architecture: Architecture) -> tuple[Table, ...]:
    """Make the tables of size and progress; progress only where there are components."""
    rows = tuple(
        (inline_text.to_inlines(label), (Text(value, sort_number=value),))
        for _, label, value in format_figures(measure_size(architecture))
    )
    size_table = Table(
        "table:size", "Size of the architecture", (Column("Figure", 3), Column("Value", 1, "right")), rows
    )
    property_tables = tuple(filter(None, [_make_property_table(architecture)]))
    progress_rows = [row for row in measure_progress(architecture) if row.components]
    if not progress_rows:
        return (size_table, *property_tables)
    columns = (
        Column("Of", 2),
        Column("Components", 0.9, "right"),
        *(Column(s.capitalize(), 0.8, "right") for s in PROGRESS_STEPS),
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
    counts = (getattr(row, step) for step in PROGRESS_STEPS)
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
