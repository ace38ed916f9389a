"""Size and progress of an architecture as tables."""

from __future__ import annotations

from fractions import Fraction

from archgen.analyses.size import Progress, Size, progress, size
from archgen.model.architecture import Architecture
from archgen.views import words
from archgen.views.shapes import Column, Inlines, Table, Text

_LABELS = {
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
}
"""Titles of figures; the keys are fields of `Size`, read by name."""
STEPS = ("described", "typed", "mapped", "timed", "traced")
"""The steps that progress counts, in order; each is a field of `Progress` and of the history's `Row`."""


def figures(found: Size) -> list[tuple[str, str, str]]:
    """Return key, title and value of each figure."""
    return [(key, label, number(getattr(found, key))) for key, label in _LABELS.items()]


def number(value: int | Fraction) -> str:
    """Format a count as it is, a mean with one decimal."""
    return f"{float(value):.1f}" if isinstance(value, Fraction) else str(value)


def statistics(architecture: Architecture) -> tuple[Table, ...]:
    """Make the tables of size and progress; progress only where there are components."""
    rows = tuple((words.text(label), words.text(value)) for _, label, value in figures(size(architecture)))
    sizes = Table("table:size", "Size of the architecture", (Column("Figure", 3), Column("Value", 1, "right")), rows)
    measured = [row for row in progress(architecture) if row.components]
    if not measured:
        return (sizes,)
    columns = (
        Column("Of", 2),
        Column("Components", 0.9, "right"),
        *(Column(s.capitalize(), 0.8, "right") for s in STEPS),
    )
    done = Table("table:progress", "Progress", columns, tuple(_row(architecture, row) for row in measured))
    return (sizes, done)


def _row(architecture: Architecture, row: Progress) -> tuple[Inlines, ...]:
    counts = (getattr(row, step) for step in STEPS)
    return (
        _subject(architecture, row),
        words.text(str(row.components)),
        *(words.text(Text(f"{count} ({_percent(count, row.components)})")) for count in counts),
    )


def _subject(architecture: Architecture, row: Progress) -> Inlines:
    if row.scope == "group":
        return words.text(words.group_link(architecture, row.id))
    if row.scope == "partner" and row.id:
        return words.partner_link(architecture, row.id)
    return words.text(Text(row.title, strong=row.scope == "project"))


def _percent(count: int, of: int) -> str:
    """Format a share in percent, rounded down so that 100 % means all."""
    return f"{100 * count // of} %"
