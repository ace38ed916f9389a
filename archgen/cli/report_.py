"""`archgen report`: write the Word report."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from archgen.cli import options, run

if TYPE_CHECKING:
    from archgen.views.report import Level


@click.command("report")
@options.project
@options.output("The file", "report.docx")
@click.option("--format", "form", type=click.Choice(["docx"]), default="docx", show_default=True)
@click.option(
    "--template",
    type=click.Path(exists=True, dir_okay=False, path_type=Path),
    help="A .docx or .dotx whose styles, cover, headers, footers and paper size are taken.",
)
@options.select
@options.level
@options.revision
@options.history
@options.keep_going
def command(  # noqa: PLR0913 - one for each option
    *,
    project: Path | None,
    output: Path | None,
    form: str,
    template: Path | None,
    select: str | None,
    level: Level | None,
    revision: str | None,
    history: bool,
    keep_going: bool,
) -> None:
    """Write the architecture of PROJECT as a Word document that can be handed in."""
    from archgen import outputs

    del form  # one for now; the option is there so that scripts say what they want
    checked = run.ready(project, keep_going=keep_going)
    selection = run.selected(checked, select)
    ask = outputs.Ask(selection, select or "", level, revision, run.progress(), run.warn, history)
    target = output or checked.out / "report.docx"
    with run.phrased():
        outputs.report(checked, ask, target, template)
    run.wrote(target)
    run.finish(checked)
