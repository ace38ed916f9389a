"""`archgen check`: find mistakes in the architecture."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from archgen.cli import options, run


@click.command("check")
@options.project
@click.option("--format", "form", type=click.Choice(["text", "json", "github"]), default="text", show_default=True)
@options.strict
@click.option("-q", "--quiet", is_flag=True, help="Show errors only (text format).")
def command(project: Path | None, form: str, *, strict: bool, quiet: bool) -> None:
    """Find mistakes in the architecture of PROJECT.

    PROJECT is a folder or a single file; left out, it is the project around the current folder. The exit status is 0
    without errors, 1 with errors (with --strict also with warnings), 2 for wrong usage.
    """
    from archgen.findings import github, json, text

    checked = run.check(project)
    findings = checked.findings
    if form == "json":
        click.echo(json.render(findings), nl=False)
    elif form == "github":
        click.echo(github.render(findings), nl=False)
    else:
        shown = [finding for finding in findings if not quiet or finding.severity == "error"]
        click.echo(text.render(shown, checked.sources, colour=text.wants_colour(sys.stdout)), nl=False)
    run.finish(checked, strict=strict)
