"""What is counted at one commit: size, progress and findings, of the whole, each group and each partner."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

from archgen.analyses.size import mapped_connections, progress
from archgen.diagnostic import Severity
from archgen.model.architecture import Architecture
from archgen.model.history import Findings, Point, Row
from archgen.pipeline import Checked

_COUNTED = ("components", "described", "typed", "mapped", "timed", "traced")


def point(checked: Checked, commit: str, day: str) -> Point:
    """Count a project."""
    a = checked.architecture
    counts = _by_scope(checked)
    return Point(
        commit=commit,
        day=day,
        groups=len(a.groups),
        nodes=sum(node.written for node in a.nodes.values()),
        connections=len(a.connections),
        mapped_connections=mapped_connections(a),
        rows=tuple(
            Row(
                scope=one.scope,
                id=one.id,
                title=one.title,
                **{name: getattr(one, name) for name in _COUNTED},
                findings=_findings(counts.get((one.scope, "" if one.scope == "project" else one.id), Counter())),
            )
            for one in progress(a)
        ),
    )


def plain(one: Point) -> dict[str, Any]:
    """Return a point as plain data."""
    return asdict(one)


def read(data: Mapping[str, Any]) -> Point:
    """Return a point from plain data. Raise KeyError or TypeError for anything else."""
    rows = tuple(Row(**{**row, "findings": Findings(**row["findings"])}) for row in data["rows"])
    return Point(**{**data, "rows": rows})


def _findings(counts: Counter[Severity]) -> Findings:
    return Findings(counts[Severity.ERROR], counts[Severity.WARNING], counts[Severity.NOTE])


def _by_scope(checked: Checked) -> dict[tuple[str, str], Counter[Severity]]:
    """Count findings by severity: each once for the whole, for its group, and for each partner who owns its element."""
    where = _scopes(checked.architecture)
    found: dict[tuple[str, str], Counter[Severity]] = {}
    for finding in checked.findings:
        scopes = {("project", ""), *where.get(_element(finding.element, where), ())}
        for scope in scopes:
            found.setdefault(scope, Counter())[finding.severity or Severity.ERROR] += 1
    return found


Scopes = Mapping[str, frozenset[tuple[str, str]]]


def _element(name: str | None, where: Scopes) -> str:
    """Return the element that a finding is about, or the nearest element that it is a part of."""
    name = name or ""
    while name and name not in where:
        name = name.rpartition(".")[0]
    return name


def _scopes(architecture: Architecture) -> dict[str, frozenset[tuple[str, str]]]:
    """Return the groups and partners that each group, component and node belongs to."""
    found: dict[str, frozenset[tuple[str, str]]] = {}
    for group in architecture.groups.values():
        mine = {("group", group.id)}
        found[group.id] = frozenset(mine | {("partner", owner) for owner in group.owners})
        for component in group.components.values():
            # {("partner", owner) for owner in component.owners or ("",)}) | The partner "" collects the components that
            # nobody owns.
            found[component.id] = frozenset(mine | {("partner", owner) for owner in component.owners or ("",)})
    for node in architecture.nodes.values():
        below = frozenset[tuple[str, str]]().union(*(found.get(name, frozenset()) for name in node.implements))
        # A node without an owner belongs to those of the components that it implements.
        owned = {("partner", owner) for owner in node.owners} or {one for one in below if one[0] == "partner"}
        found.setdefault(node.id, frozenset({one for one in below if one[0] == "group"} | owned))
    return found
