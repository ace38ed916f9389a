"""`archgen site`: write the static web site."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from archgen.cli import options, run

if TYPE_CHECKING:
    from archgen.views.report import Level


@click.command("site")
@options.project
@options.output("The folder", "site")
@options.select
@options.level
@options.revision
@options.history
@options.keep_going
def command(  # noqa: PLR0913 - one for each option
    *,
    project: Path | None,
    output: Path | None,
    select: str | None,
    level: Level | None,
    revision: str | None,
    history: bool,
    keep_going: bool,
) -> None:
    """Write the architecture of PROJECT as a web site that opens from the disk."""
    from archgen import outputs

    checked = run.ready(project, keep_going=keep_going)
    ask = outputs.Ask(run.selected(checked, select), select or "", level, revision, run.progress(), run.warn, history)
    target = output or checked.out / "site"
    with run.phrased():
        outputs.site(checked, ask, target)
    run.wrote(target / "index.html")
    run.finish(checked)
