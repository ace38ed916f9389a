"""`archgen build`: make everything."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from archgen.cli import options, run

if TYPE_CHECKING:
    from archgen.views.report import Level


@click.command("build")
@options.project
@options.output("The folder", "")
@click.option(
    "--backend",
    metavar="NAME",
    multiple=True,
    help="Make this backend's output too (`wiki`, or one in the project's backends/); may be given several times.",
)
@click.option(
    "--template",
    type=click.Path(exists=True, dir_okay=False, path_type=Path),
    help="A .docx or .dotx for the report.",
)
@options.select
@options.level
@options.revision
@options.history
@options.keep_going
@click.option(
    "--trust",
    metavar="REV",
    help="Run the project's own backends only if `review.backends` of its files at this git revision names them.",
)
def command(  # noqa: PLR0913 - one for each option
    *,
    project: Path | None,
    output: Path | None,
    backend: tuple[str, ...],
    template: Path | None,
    select: str | None,
    level: Level | None,
    revision: str | None,
    history: bool,
    keep_going: bool,
    trust: str | None,
) -> None:
    """Make report.docx, site/, diagrams/ and packed.yaml of PROJECT."""
    from archgen import outputs
    from archgen.build import build

    checked = run.ready(project, keep_going=keep_going)
    allowed = run.trusted(project, trust)
    ask = outputs.Ask(
        run.selected(checked, select), select or "", level, revision, run.progress(), run.warn, history, allowed
    )
    target = output or checked.out
    with run.phrased():
        for path in build(checked, ask, target, template, backend):
            run.wrote(path)
    counts = run.counted(checked.findings)
    click.echo(f"archgen check tells more: {counts}" if counts else "no findings")
    run.finish(checked)
