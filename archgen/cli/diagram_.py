"""`archgen diagram`: draw the diagrams."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from archgen.cli import options, run

if TYPE_CHECKING:
    from archgen.views.report import Level

FORMATS = ("svg", "png", "pdf", "dot")


@click.command("diagram")
@options.project
@options.output("The folder", "diagrams")
@click.option(
    "--format",
    "forms",
    default="svg",
    show_default=True,
    metavar="LIST",
    help=f"Formats, separated by commas: {', '.join(FORMATS)}.",
)
@click.option(
    "--only",
    metavar="NAME",
    multiple=True,
    help="Draw only this picture (`overview`, `groups/sensing`, ...; `*` for any run); may be given several times.",
)
@options.select
@options.level
@options.keep_going
def command(  # noqa: PLR0913 - one for each option
    *,
    project: Path | None,
    output: Path | None,
    forms: str,
    only: tuple[str, ...],
    select: str | None,
    level: Level | None,
    keep_going: bool,
) -> None:
    """Draw the architecture of PROJECT: overview, groups, components, ROS graph, hosts, views.

    With --select the overview shows just what is selected, neighbours grey, and only its pictures are drawn.
    """
    from archgen import outputs

    wanted = tuple(dict.fromkeys(form.strip() for form in forms.split(",") if form.strip()))
    unknown = [form for form in wanted if form not in FORMATS]
    if unknown or not wanted:
        msg = f"--format takes {', '.join(FORMATS)}, separated by commas, not '{forms}'"
        raise click.UsageError(msg)
    checked = run.ready(project, keep_going=keep_going)
    ask = outputs.Ask(run.selected(checked, select), select or "", level, None, run.progress(), run.warn)
    target = output or checked.out / "diagrams"
    with run.phrased():
        count = outputs.diagrams(checked, ask, target, wanted, only)
    run.wrote(target, f"{count} pictures")
    run.finish(checked)
