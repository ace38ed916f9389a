"""`archgen list`: list what a selector names, or all elements of a kind."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from archgen.cli import options, run

SORTS = ("components", "nodes", "groups", "connections", "edges", "topics", "types", "requirements", "chains", "hosts")


@click.command("list")
@click.argument("selector", nargs=-1)
@click.option("--of", "sort", type=click.Choice(SORTS), default="components", show_default=True, help="What to list.")
@click.option("--format", "form", type=click.Choice(["text", "csv", "json"]), default="text", show_default=True)
@options.project_option
def command(selector: tuple[str, ...], sort: str, form: str, project: Path | None) -> None:
    """List what SELECTOR names; without one, everything.

    Put a selector that begins with `-` behind `--`. `archgen list --of connections --format csv` is the table of all
    connections, safe to open in a spreadsheet.
    """
    from archgen import outputs
    from archgen.findings import listing
    from archgen.views import listed

    checked = run.check(project)
    run.report(checked, least=run.ERROR)
    words = " ".join(selector)
    selection = run.selected(checked, words or None)
    columns, rows = listed.listed(outputs.view(checked, outputs.Ask(selection, words)), sort)
    write = {"text": listing.text, "csv": listing.csv, "json": listing.json}[form]
    sys.stdout.write(write(columns, rows))
    run.finish(checked)
