"""`archgen todo`: show what a partner has to do."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

import click

from archgen.cli import command_support, shared_options
from archgen.diagnostics import Severity
from archgen.diagnostics.text_columns import find_width

if TYPE_CHECKING:
    from archgen.products.partner_documents import DocumentFormat


@click.command("todo")
@shared_options.project_argument
@shared_options.variant_option
@shared_options.partner_option("The id of the partner.", required=True)
@click.option(
    "--since", metavar="REV", help="Show what others changed for the partner since a version, as `archgen diff`."
)
@shared_options.document_format_option
@shared_options.file_option("The file to write.  [default: the terminal]")
def command(
    *, project: Path | None, partner: str, since: str | None, form: DocumentFormat, output: Path | None
) -> None:
    """Show what a partner of PROJECT has to do, in one list: what most rests on first.

    Terms that are open, contradictions, chains and nodes not shown to be in time, findings, requirements that nothing
    verifies; whom the partner waits for, and what is still to be made. `archgen todo --partner tum --since v1`
    """
    from archgen.products import comparison_documents, partner_documents

    checked_project = command_support.check_or_exit(project)
    command_support.print_findings_above(checked_project, lowest_severity=Severity.ERROR)
    chosen = command_support.require_partner(checked_project.architecture, partner)
    earlier_version = None
    if since is not None:
        with command_support.explain_missing_versions():
            earlier_version = comparison_documents.read_version_before(since, project, checked_project)
    with command_support.explain_write_errors():
        width = find_width(sys.stdout) if output is None else None
        text = partner_documents.write_tasks(checked_project, chosen, earlier_version, form, width)
        command_support.write_output(text, output)
    command_support.exit_by_findings(checked_project)
