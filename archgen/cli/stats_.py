"""`archgen stats`: show size and progress."""

from __future__ import annotations

from dataclasses import asdict
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING

import click

from archgen.cli import options, run

if TYPE_CHECKING:
    from archgen.analyses.size import Progress, Size
    from archgen.history import By


@click.command("stats")
@options.project
@click.option("--format", "form", type=click.Choice(["text", "json", "csv"]), default="text", show_default=True)
@click.option("--history", is_flag=True, help="Show how size, progress and findings grew, from git's history.")
@click.option(
    "--by",
    type=click.Choice(["revision", "month"]),
    help="Each revision, or the last of each month.  [default: revision]",
)
def command(project: Path | None, form: str, by: By | None, *, history: bool) -> None:
    """Show how large PROJECT is and how far along: as a whole, for each group and for each partner.

    Described: it has a functionality. Typed: each output has a type. Mapped: a node that somebody wrote implements it.
    Timed: it or all its nodes have a timing. Traced: it names a declared requirement.

    With --history: the same at each revision that changed the project, along the first parents of git's HEAD.
    """
    if history:
        _over_time(project, form, by or "revision")
        return
    if by or form == "csv":
        msg = "--by and --format csv belong to --history"
        raise click.UsageError(msg)
    _now(project, form)


def _now(project: Path | None, form: str) -> None:
    from archgen.analyses.size import progress, size
    from archgen.diagnostic import Severity
    from archgen.findings.escape import json_text

    checked = run.check(project)
    run.report(checked, least=Severity.ERROR)
    found, rows = size(checked.architecture), progress(checked.architecture)
    if form == "json":
        plain = {key: float(v) if isinstance(v, Fraction) else v for key, v in asdict(found).items()}
        data = {"version": 1, **plain, "files": len(checked.files), "progress": [asdict(row) for row in rows]}
        click.echo(json_text(data), nl=False)
    else:
        click.echo(_text(checked.architecture.project.title, found, rows, len(checked.files)), nl=False)
    run.finish(checked)


def _over_time(project: Path | None, form: str, by: By) -> None:
    from archgen import git
    from archgen.emit import kept
    from archgen.findings import history_text
    from archgen.findings.escape import json_text
    from archgen.history import history
    from archgen.project import ProjectNotFoundError

    try:
        found = history(project, by, cache=kept.folder(), progress=run.progress("reading"))
    except (git.GitError, ProjectNotFoundError) as error:
        raise click.UsageError(str(error)) from None
    if form == "json":
        click.echo(json_text(history_text.document(found)), nl=False)
    elif form == "csv":
        click.echo(history_text.csv(found), nl=False)
    else:
        click.echo(history_text.text(found), nl=False)


def _text(title: str, found: Size, rows: tuple[Progress, ...], files: int) -> str:
    from archgen.findings.escape import plain_line, visible
    from archgen.views.statistics import STEPS, figures

    lines = [visible(title), ""]
    lines += [f"  {label:42}{value:>8}" for _, label, value in figures(found)]
    lines += [f"  {'Files':42}{files:>8}", ""]
    measured = [row for row in rows if row.components]
    if measured:
        lines.append(f"  {'Progress':32}{'components':>11}" + "".join(f"{step:>11}" for step in STEPS))
    for row in measured:
        counts = "".join(f"{_share(getattr(row, step), row.components):>11}" for step in STEPS)
        lines.append(f"  {visible(row.title)[:31]:32}{row.components:>11}{counts}")
    return "\n".join(map(plain_line, lines)) + "\n"


def _share(count: int, of: int) -> str:
    return f"{count} ({100 * count // of}%)"
