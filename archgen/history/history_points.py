"""What is counted at one commit: size, progress and findings, of the whole, each group and each partner."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from archgen.analyses.size_counts import count_mapped_connections, measure_progress
from archgen.diagnostics import Diagnostic, Severity, count_by_severity
from archgen.model.architecture import Architecture
from archgen.model.project_history import FindingCounts, HistoryPoint, ProgressRow
from archgen.pipeline import CheckedProject

_COUNTED_FIELDS = ("components", "described", "typed", "mapped", "timed", "traced")


def count_point(checked_project: CheckedProject, commit: str, day: str) -> HistoryPoint:
    """Count a project."""
    architecture = checked_project.architecture
    findings_of = _findings_by_scope(checked_project)
    return HistoryPoint(
        commit=commit,
        day=day,
        groups=len(architecture.groups),
        nodes=sum(node.written for node in architecture.nodes.values()),
        connections=len(architecture.connections),
        mapped_connections=count_mapped_connections(architecture),
        rows=tuple(
            ProgressRow(
                scope=progress_row.scope,
                id=progress_row.id,
                title=progress_row.title,
                **{name: getattr(progress_row, name) for name in _COUNTED_FIELDS},
                findings=_count_findings(
                    findings_of.get(
                        (progress_row.scope, "" if progress_row.scope == "project" else progress_row.id), ()
                    )
                ),
            )
            for progress_row in measure_progress(architecture)
        ),
    )


def point_from_data(data: Mapping[str, Any]) -> HistoryPoint:
    """Return a point from the plain data that `asdict` makes of it. Raise KeyError or TypeError for anything else."""
    rows = tuple(ProgressRow(**{**row, "findings": FindingCounts(**row["findings"])}) for row in data["rows"])
    return HistoryPoint(**{**data, "rows": rows})


def _count_findings(findings: Iterable[Diagnostic]) -> FindingCounts:
    counts = count_by_severity(findings)
    return FindingCounts(counts[Severity.ERROR], counts[Severity.WARNING], counts[Severity.NOTE])


def _findings_by_scope(checked_project: CheckedProject) -> dict[tuple[str, str], list[Diagnostic]]:
    """Return the findings by scope: each once for the whole, for its group, and for each partner who owns its element."""
    element_scopes = _find_scopes(checked_project.architecture)
    findings_of: dict[tuple[str, str], list[Diagnostic]] = {}
    for finding in checked_project.findings:
        findings_of.setdefault(("project", ""), []).append(finding)
        for scope in sorted(element_scopes.get(_known_element(finding.element, element_scopes), ())):
            findings_of.setdefault(scope, []).append(finding)
    return findings_of


ElementScopes = Mapping[str, frozenset[tuple[str, str]]]


def _known_element(name: str | None, element_scopes: ElementScopes) -> str:
    """Return the element that a finding is about, or the nearest element that it is a part of."""
    name = name or ""
    while name and name not in element_scopes:
        name = name.rpartition(".")[0]
    return name


def _find_scopes(architecture: Architecture) -> dict[str, frozenset[tuple[str, str]]]:
    """Return the groups and partners that each group, component and node belongs to."""
    scopes: dict[str, frozenset[tuple[str, str]]] = {}
    for group in architecture.groups.values():
        group_scope = {("group", group.id)}
        scopes[group.id] = frozenset(group_scope | {("partner", owner) for owner in group.owners})
        for component in group.components.values():
            # The partner "" collects the components that nobody owns.
            scopes[component.id] = frozenset(group_scope | {("partner", owner) for owner in component.owners or ("",)})
    for node in architecture.nodes.values():
        implemented_scopes = frozenset[tuple[str, str]]().union(
            *(scopes.get(name, frozenset()) for name in node.implements)
        )
        # A node without an owner belongs to those of the components that it implements.
        owner_scopes = {("partner", owner) for owner in node.owners} or {
            scope for scope in implemented_scopes if scope[0] == "partner"
        }
        scopes.setdefault(
            node.id, frozenset({scope for scope in implemented_scopes if scope[0] == "group"} | owner_scopes)
        )
    return scopes
