"""`archgen stats`: show size and progress."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterable
from dataclasses import asdict
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING

import click

from archgen.cli import command_support, shared_options
from archgen.diagnostics import Severity, defuse_command, floor_percent, format_json, make_visible
from archgen.diagnostics.text_columns import find_width, format_table, wrap_line

if TYPE_CHECKING:
    from archgen.analyses.size_counts import ArchitectureSize, ProgressCounts
    from archgen.history import HistoryInterval

_NARROW = 100
"""In fewer columns the table of progress has shares alone, so that 80 hold it."""


@click.command("stats")
@shared_options.project_argument
@shared_options.variant_option
@click.option(
    "--select", metavar="WORDS", help="Count only the selected components: `owner:certh`, `sensing`, `tag:safety -x`."
)
@shared_options.format_option("text", "json", "csv")
@click.option("--history", is_flag=True, help="Show how size, progress and findings grew, from git's history.")
@click.option(
    "--by",
    type=click.Choice(["revision", "month"]),
    help="Each revision, or the last of each month.  [default: revision]",
)
def command(project: Path | None, select: str | None, form: str, by: HistoryInterval | None, *, history: bool) -> None:
    """Show how large PROJECT is and how far along: as a whole, for each group and for each partner.

    Described: it has a functionality. Typed: each output has a type. Mapped: a node that somebody wrote implements it.
    Timed: it or all its nodes have a timing. Traced: it names a declared requirement. Seen: each of its ends was seen on a
    robot (`archgen conform --keep`).

    With --history: the same at each revision that changed the project, along the first parents of git's HEAD.
    """
    if history and select is not None:
        raise click.UsageError("--history counts the whole project: no --select")
    if history:
        _print_history(project, form, by or "revision")
        return
    if by or form == "csv":
        raise click.UsageError("--by and --format csv belong to --history")
    _print_current(project, form, select)


def _print_current(project: Path | None, form: str, select: str | None) -> None:
    from archgen.analyses.size_counts import measure_progress, measure_size
    from archgen.products.seen_robots import find_seen_components, read_seen_robots

    checked_project = command_support.check_or_exit(project)
    command_support.print_findings_above(checked_project, lowest_severity=Severity.ERROR)
    selection = command_support.select_or_exit(checked_project, select)
    project_size = measure_size(checked_project.architecture)
    _, obstacle = read_seen_robots(checked_project)
    if obstacle:
        command_support.print_warning(obstacle)
    seen = find_seen_components(checked_project)
    rows = measure_progress(checked_project.architecture, selection.components if selection else None, seen)
    if selection:
        # How large a project is says nothing of a part: only how far that is.
        rows = tuple(row for row in rows if row.components)
    if form == "json":
        plain = {key: float(v) if isinstance(v, Fraction) else v for key, v in asdict(project_size).items()}
        size = {} if selection else {**plain, "files": len(checked_project.yaml_files)}
        data = {
            "version": 1,
            **size,
            "progress": [asdict(row) for row in rows],
        }
        click.echo(format_json(data), nl=False)
    else:
        lines = _format_statistics(
            checked_project.architecture.project.title,
            None if selection else project_size,
            rows,
            len(checked_project.yaml_files),
        )
        click.echo("\n".join(_paint(lines)))
    command_support.exit_by_findings(checked_project)


def _print_history(project: Path | None, form: str, by: HistoryInterval) -> None:
    from archgen import git
    from archgen.emit.terminal import history_text
    from archgen.history import count_history
    from archgen.products import report_cache
    from archgen.project import ProjectNotFoundError

    try:
        project_history = count_history(
            project, by, cache=report_cache.cache_folder(), progress=command_support.make_progress_printer("reading")
        )
    except git.NoRepositoryError as error:
        raise click.UsageError(f"{make_visible(str(error))}; the history is read from its commits") from None
    except (git.GitError, ProjectNotFoundError) as error:
        raise click.UsageError(str(error)) from None
    if form == "json":
        click.echo(format_json(history_text.history_to_json(project_history)), nl=False)
    elif form == "csv":
        click.echo(history_text.history_to_csv(project_history), nl=False)
    else:
        lines = history_text.format_history(project_history, find_width(sys.stdout)).splitlines()
        click.echo("\n".join(_paint(lines)))


def _format_statistics(
    title: str, project_size: ArchitectureSize | None, rows: tuple[ProgressCounts, ...], files: int
) -> Iterable[str]:
    from archgen.views.tables.statistics_tables import format_figures, list_steps

    width = find_width(sys.stdout)
    lines = [*wrap_line(make_visible(title), width), ""]
    if project_size is not None:
        figures = [*((label, value) for _, label, value in format_figures(project_size)), ("Files", str(files))]
        lines += [line for label, value in figures for line in wrap_line(f"  {label:42}{value:>8}", width)]
        lines.append("")
    steps = list_steps(rows)
    is_narrow = width is not None and width < _NARROW
    populated_rows = [
        (
            row.title,
            str(row.components),
            *(_format_share(getattr(row, step), row.components, is_short=is_narrow) for step in steps),
        )
        for row in rows
        if row.components
    ]
    if populated_rows:
        headings = ("Components", "total", *steps)
        table_lines = format_table(headings, populated_rows, width and width - 2, has_figures=True)
        lines += [f"  {line}" for line in table_lines]
    return map(defuse_command, lines)


def _paint(lines: Iterable[str]) -> Iterable[str]:
    """Return the lines, on a terminal that shows colours with those of the site."""
    from archgen.emit.terminal.findings_text import wants_colour
    from archgen.emit.terminal.state_paint import paint_progress

    return paint_progress(lines) if wants_colour(sys.stdout, os.environ) else lines


def _format_share(count: int, total: int, *, is_short: bool) -> str:
    share = f"{floor_percent(count, total)}%"
    return share if is_short else f"{count} ({share})"
