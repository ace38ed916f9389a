"""The start page at a glance: five figures with their reasons, then chains, open points, requirements, progress, changes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise

from archgen.analyses.size_counts import ProgressCounts, measure_progress
from archgen.diagnostics import join_words, phrase_severity_counts
from archgen.frozen import replace
from archgen.model.project_history import History, HistoryPoint
from archgen.views import element_references, inline_text, requirement_servers
from archgen.views.inline_text import count_noun
from archgen.views.lookup import Lookup
from archgen.views.pages.report_outline import DocumentEdition
from archgen.views.shapes import (
    Bullets,
    Column,
    Dashboard,
    DashboardCard,
    Inlines,
    KeyFigure,
    Meter,
    Paragraph,
    Table,
    Text,
    make_columns,
)
from archgen.views.tables import finding_tables, requirement_tables, statistics_tables
from archgen.views.tables.statistics_tables import PROGRESS_STEPS
from archgen.views.timing import chain_status, timing_tables, timing_verdicts, value_format

_MAX_CHAINS = 8
_MAX_POINTS = 4
_MANY_POINTS = 50
"""More points than these are told by how many they are: one less is shown."""
_MAX_PARTNERS = 8
_FIRST_PARTNERS = 6
"""The partners that are shown where there are more than `_MAX_PARTNERS`."""
_MAX_CELLS = 80
"""More requirements than these are one bar."""
_MAX_CHANGES = 5


def make_dashboard(lookup: Lookup, edition: DocumentEdition) -> Dashboard:
    """Make the dashboard of the start page, of all that the project has."""
    cards = (
        _chain_card(lookup),
        _point_card(lookup),
        _requirement_card(lookup),
        _progress_card(lookup),
        _change_card(edition.history),
    )
    return Dashboard(tuple(_list_figures(lookup, edition)), tuple(card for card in cards if card))


def _list_figures(lookup: Lookup, edition: DocumentEdition) -> Iterator[KeyFigure]:
    """Yield the figures, each with the reason why it is not better."""
    chains = timing_verdicts.list_silent_chains(lookup)
    parts = [*phrase_severity_counts(lookup.findings), *([count_noun(len(chains), "chain")] if chains else [])]
    severities = {finding.severity for finding in lookup.findings}
    worst = "missed" if "error" in severities else "warning" if "warning" in severities else "open" if parts else "met"
    count = len(lookup.findings) + len(chains)
    yield KeyFigure(
        "Open points", str(count), "", _make_note(worst, join_words(parts) or "nothing is open"), "page:findings"
    )
    if lookup.timing and lookup.timing.chains:
        yield _chain_figure(lookup)
    if requirements := requirement_tables.shown_requirements(lookup):
        free_ids = [r.id for r in requirements if not requirement_servers.is_served(lookup, r)]
        served_count = len(requirements) - len(free_ids)
        note = _list_some(free_ids, "has no component", "have none") if free_ids else "all of them"
        note_cell = _make_note("uncovered" if free_ids else "met", note)
        yield KeyFigure(
            "Requirements served", str(served_count), str(len(requirements)), note_cell, "page:requirements"
        )
    project_row = measure_progress(lookup.architecture)[0]
    if project_row.components:
        gap_count = project_row.components - project_row.traced
        note = (
            f"{count_noun(gap_count, 'component')} without a requirement" if gap_count else "each serves a requirement"
        )
        note_cell = _make_note("uncovered" if gap_count else "met", note)
        yield KeyFigure(
            "Components traced", str(project_row.traced), str(project_row.components), note_cell, "page:progress"
        )
    if lookup.timing and lookup.timing.analysis.hosts and edition.level == "implementation":
        yield _host_figure(lookup)


def _make_note(status: str, text: str) -> Inlines:
    """Return the line below a figure; its state gives it icon and colour."""
    return (Text(text, status=status),)  # type: ignore[arg-type]


def _list_some(names: Sequence[str], singular: str, plural: str) -> str:
    """Name one, or count several: `R-80 has no component`, `3 have none`."""
    return f"{names[0]} {singular}" if len(names) == 1 else f"{len(names)} {plural}"


def _chain_figure(lookup: Lookup) -> KeyFigure:
    results = [r for r in lookup.timing.chains if not chain_status.lacks_deadline(r)] if lookup.timing else []
    counts = {name: sum(r.verdict == name for r in results) for name in ("missed", "not proven", "open")}
    worst = next((name for name, count in counts.items() if count), "met")
    words = [f"{count} {name}" for name, count in counts.items() if count]
    if words and not counts["missed"]:
        words.append("none missed")
    met_count = len(results) - sum(counts.values())
    note = _make_note(worst, join_words(words) or "every deadline is met")
    return KeyFigure("Chains proven in time", str(met_count), str(len(results)), note, "page:chains")


def _host_figure(lookup: Lookup) -> KeyFigure:
    hosts = timing_tables.rank_hosts(lookup.timing) if lookup.timing else []
    words = {"overload": "overloaded", "undecided": "not proven", "unknown": "unknown"}
    counts = {verdict: sum(load.verdict == verdict for _, load in hosts) for verdict in words}
    worst = next((timing_tables.LOAD_STATES[name] for name, count in counts.items() if count), "met")
    note = join_words([f"{count} {words[name]}" for name, count in counts.items() if count]) or "all of them"
    proven_count = len(hosts) - sum(counts.values())
    return KeyFigure("Hosts proven in time", str(proven_count), str(len(hosts)), _make_note(worst, note), "page:hosts")


def _chain_card(lookup: Lookup) -> DashboardCard | None:
    if not lookup.timing or not lookup.timing.chains:
        return None
    rows = tuple(
        (
            inline_text.to_inlines(Text(lookup.architecture.chains[result.id].title, ref=f"chain:{result.id}")),
            chain_status.chain_meter(result),
            timing_tables.duration_cell(result.bound),
            timing_tables.deadline_cell(result, is_narrow=True),
            chain_status.margin_cell(result),
            chain_status.verdict_chip(result),
        )
        for result in lookup.timing.chains[:_MAX_CHAINS]
        if result.id in lookup.architecture.chains
    )
    columns = make_columns(
        ("Chain", 2.4),
        "Of the deadline",
        ("At the latest", 1, "right"),
        ("Deadline", 1, "right"),
        ("Margin", 1, "right"),
        "Verdict",
    )
    table = Table("table:worst_chains", "Chains of effect, worst first", columns, rows)
    link = Text(f"All {len(lookup.timing.chains)}", ref="page:chains")
    return DashboardCard("Chains of effect", (table,), 8, "worst first", link, "chains") if rows else None


def _point_card(lookup: Lookup) -> DashboardCard | None:
    findings = sorted(lookup.findings, key=lambda finding: -finding.effective_severity.rank)
    points: list[Inlines] = [
        (
            *finding_tables.finding_chip(finding),
            Text(" "),
            *element_references.answering_cell(lookup, finding.element, finding.span),
            *_on_new_line(element_references.link_message(lookup.architecture, finding)),
            *_on_new_line(element_references.place_cell(lookup, finding)),
        )
        for finding in findings
    ]
    points += make_chain_points(lookup)
    if not points:
        return None  # the figure above says so
    link = Text(f"All {len(points)}, by owner and rule", ref="page:findings")
    shown_count = _MAX_POINTS if len(points) <= _MANY_POINTS else _MAX_POINTS - 1
    return DashboardCard("Open points", (Bullets(tuple(points[:shown_count])),), 4, "", link, "points")


def make_chain_points(lookup: Lookup) -> list[Inlines]:
    """Return a point for each chain that is not shown to meet its deadline, and that no finding is about."""
    points: list[Inlines] = []
    for result in timing_verdicts.list_silent_chains(lookup) if lookup.timing else ():
        if lookup.timing:
            chain = lookup.architecture.chains[result.id]
            title = Text(chain.title, ref=f"chain:{result.id}", line_break=True)
            missing = value_format.describe_missing(result.bound, lookup.timing.analysis, 3)
            missing_line = Text(missing, muted=True, line_break=True)
            partners = element_references.answering_cell(lookup, result.id, chain.at)
            chip = (*chain_status.chain_chip(result), Text(" "), *partners)
            points.append((*chip, title, *([missing_line] if missing else [])))
    return points


def _on_new_line(runs: Inlines) -> Inlines:
    """Return runs that begin on a line of their own."""
    return (replace(runs[0], line_break=True), *runs[1:]) if runs else ()


def _requirement_card(lookup: Lookup) -> DashboardCard | None:
    requirements = requirement_tables.shown_requirements(lookup)
    if not requirements:
        return None
    free_ids = {r.id for r in requirements if not requirement_servers.is_served(lookup, r)}
    cells = tuple(
        Text(r.id, ref=f"requirement:{r.id}", status=lookup.requirement_trace.judge(r.id))
        for r in sorted(requirements, key=lambda each: each.id not in free_ids)
    )
    served_count = len(requirements) - len(free_ids)
    counts = f"{served_count} of {len(requirements)} served"
    meter = Text("", meter=Meter(served_count / len(requirements), "uncovered" if free_ids else "met"))
    # Above the limit only what is missing has a cell of its own.
    shown_cells = cells if len(cells) <= _MAX_CELLS else (meter, *cells[: min(len(free_ids), _MAX_CELLS)])
    blocks = (Paragraph(inline_text.join_inlines(((cell,) for cell in shown_cells), " ")),)
    link = Text(f"All {len(requirements)}", ref="page:requirements")
    return DashboardCard("Requirements", blocks, 3, counts, link, "cells")


def _count_missing_steps(row: ProgressCounts) -> int:
    """Return how many steps are still to be done, over all components."""
    done_counts: list[int] = [getattr(row, step) for step in PROGRESS_STEPS]
    return row.components * len(done_counts) - sum(done_counts)


def _progress_card(lookup: Lookup) -> DashboardCard | None:
    partner_rows = [row for row in measure_progress(lookup.architecture) if row.scope == "partner" and row.components]
    if not partner_rows:
        return None
    # Who has most left to do comes first.
    partner_rows.sort(key=_count_missing_steps, reverse=True)
    columns = (
        Column("Partner", 1.6),
        Column("Components", 1, "right"),
        *(Column(step.capitalize(), 1, "right") for step in PROGRESS_STEPS),
    )
    shown_count = _MAX_PARTNERS if len(partner_rows) <= _MAX_PARTNERS else _FIRST_PARTNERS
    rows = tuple(_progress_row(lookup, row) for row in partner_rows[:shown_count])
    hidden_count = len(partner_rows) - len(rows)
    table = Table("table:partner_progress", "Progress by partner, the least complete first", columns, rows)
    link = Text(f"{hidden_count} more, and by group" if hidden_count else "By group", ref="page:progress")
    return DashboardCard("Progress by partner", (table,), 6, "least complete first", link, "progress")


def _progress_row(lookup: Lookup, row: ProgressCounts) -> tuple[Inlines, ...]:
    name = inline_text.partner_link(lookup.architecture, row.id) if row.id else inline_text.to_inlines(row.title)
    count = (Text(str(row.components), sort_number=str(row.components)),)
    return (name, count, *(_step_cell(getattr(row, step), row.components) for step in PROGRESS_STEPS))


def _step_cell(count: int, total: int) -> Inlines:
    """Return the bar and the number of components that have got so far."""
    status = "met" if count == total else "warning"
    return (Text("", meter=Meter(count / total, status)), Text(f" {count}", sort_number=str(count)))  # type: ignore[arg-type]


def _change_card(history: History) -> DashboardCard | None:
    points = history.points
    if len(points) < 2:  # noqa: PLR2004 - one point is no change
        return None
    pairs = list(pairwise(points))[::-1][:_MAX_CHANGES]
    items = tuple(
        (
            Text(statistics_tables.name_point(after, history), ref="page:progress"),
            Text(_describe_step(before, after), muted=True, line_break=True),
        )
        for before, after in pairs
    )
    link = Text("All", ref="page:progress")
    return DashboardCard("Last changes", (Bullets(items),), 3, f"by {history.by}", link, "changes")


def _describe_step(before: HistoryPoint, after: HistoryPoint) -> str:
    """Describe what changed between two points of the history, in counts."""
    old, new = before.project_row, after.project_row
    figures = (
        ("components", old.components, new.components),
        ("connections", before.connections, after.connections),
        ("mapped", old.mapped, new.mapped),
        ("timed", old.timed, new.timed),
        ("traced", old.traced, new.traced),
        ("open points", statistics_tables.count_findings(before), statistics_tables.count_findings(after)),
    )
    return ", ".join(f"{name} {first} → {last}" for name, first, last in figures if first != last) or "same counts"
