"""`archgen interfaces`: write what flows between two partners, as a document that both can sign."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

import click

from archgen.cli import options, run

if TYPE_CHECKING:
    from archgen.agreements import Format
    from archgen.sides import Side

_FORMATS = ("markdown", "html", "docx")


@click.command("interfaces")
@options.project
@click.option(
    "--between", "pair", nargs=2, metavar="PARTNER PARTNER", required=True, help="The ids of the two partners."
)
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path),
    help="The file to write; its ending (.docx, .md, .html) says the format.  [default: Markdown to the terminal, else "
    "archgen-out/interfaces/ in the project]",
)
@click.option(
    "--format", "form", type=click.Choice(_FORMATS), help="The format, where the file's ending does not say it."
)
@click.option("--since", metavar="REV", help="Mark what changed since a git revision (or a folder or packed file).")
@options.revision
@options.keep_going
def command(  # noqa: PLR0913 - one for each option
    *,
    project: Path | None,
    pair: tuple[str, str],
    output: Path | None,
    form: Format | None,
    since: str | None,
    revision: str | None,
    keep_going: bool,
) -> None:
    """Write the interface agreement of two partners of PROJECT: what flows between them, both ways.

    Each topic, service and action with its message, rate, size, quality of service, chains, requirements, open points,
    and who serves and who reads it. `archgen interfaces --between certh sssa -o certh-sssa.docx`
    """
    from archgen import agreements, outputs
    from archgen.findings.escape import visible

    form = _format(form, output)
    checked = run.ready(project, keep_going=keep_going)
    earlier = _earlier(since, project) if since else None
    try:
        made = agreements.made(checked, *pair, earlier, revision)
    except agreements.PartnersError as error:
        raise click.UsageError(visible(str(error))) from None
    ask = outputs.Ask(progress=run.progress(), warn=run.warn)
    with run.phrased():
        if form == "markdown" and output is None:
            sys.stdout.write(agreements.markdown(made))
            run.finish(checked)
        endings = {"markdown": "md", "html": "html", "docx": "docx"}
        target = output or checked.out / "interfaces" / f"{pair[0]}-{pair[1]}.{endings[form]}"
        agreements.write(made, form, target, ask)
    run.wrote(target, f"{made.interfaces} interfaces" if made.interfaces != 1 else "1 interface")
    run.finish(checked)


def _format(form: Format | None, output: Path | None) -> Format:
    """Return the format that was asked for, else that of the file's ending; Markdown if neither says it."""
    from archgen.agreements import ENDINGS

    if form or output is None:
        return form or "markdown"
    found = ENDINGS.get(output.suffix.lower())
    if found is None:
        msg = f"the ending of `{output.name}` names no format: end it in .docx, .md or .html, or give --format"
        raise click.UsageError(msg)
    return found


def _earlier(words: str, project: Path | None) -> Side:
    """Read the project as it was. A revision that cannot be read is wrong usage."""
    from archgen import sides
    from archgen.findings.escape import visible
    from archgen.git import GitError
    from archgen.project import ProjectNotFoundError

    try:
        return sides.side(words, project)
    except (GitError, ProjectNotFoundError) as error:
        raise click.UsageError(visible(f"--since: {error}")) from None
