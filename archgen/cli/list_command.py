"""`archgen list`: list what a selector names, or all elements of a kind."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from archgen.cli import command_support, shared_options
from archgen.diagnostics.diagnostic import Severity

LISTABLE_KINDS = (
    "components",
    "nodes",
    "groups",
    "connections",
    "edges",
    "topics",
    "types",
    "requirements",
    "chains",
    "hosts",
)


@click.command("list")
@click.argument("selector", nargs=-1)
@click.option(
    "--of", "sort", type=click.Choice(LISTABLE_KINDS), default="components", show_default=True, help="What to list."
)
@click.option("--format", "form", type=click.Choice(["text", "csv", "json"]), default="text", show_default=True)
@shared_options.project_option
def command(selector: tuple[str, ...], sort: str, form: str, project: Path | None) -> None:
    """List what SELECTOR names; without one, everything.

    Put a selector that begins with `-` behind `--`. `archgen list --of connections --format csv` is the table of all
    connections, safe to open in a spreadsheet.
    """
    from archgen.emit.terminal import list_formats
    from archgen.products import project_outputs
    from archgen.views.tables import element_rows

    checked_project = command_support.check_project(project)
    command_support.print_findings_above(checked_project, lowest_severity=Severity.ERROR)
    selector_text = " ".join(selector)
    selection = command_support.evaluate_selector(checked_project, selector_text or None)
    columns, rows = element_rows.list_element_rows(
        project_outputs.make_scoped_lookup(checked_project, project_outputs.OutputOptions(selection, selector_text)),
        sort,
    )
    write = {
        "text": list_formats.format_columns,
        "csv": list_formats.format_csv,
        "json": list_formats.format_json_rows,
    }[form]
    sys.stdout.write(write(columns, rows))
    command_support.exit_by_findings(checked_project)
