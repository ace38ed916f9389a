"""`archgen impact`: show what rests on a partner, or on some components."""

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


@click.command("impact")
@shared_options.project_argument
@shared_options.variant_option
@shared_options.partner_option("The id of the partner who is late.")
@click.option(
    "--component",
    "components",
    metavar="ID",
    multiple=True,
    help="Only this component is late, of the partner or of anybody; may be repeated.",
)
@click.option(
    "--until",
    metavar="YYYY-MM-DD",
    help="The day on which they are there: show the milestones before it that need them.",
)
@shared_options.document_format_option
@shared_options.file_option("The file to write.  [default: the terminal]")
def command(  # noqa: PLR0913 - one for each option
    *,
    project: Path | None,
    partner: str | None,
    components: tuple[str, ...],
    until: str | None,
    form: DocumentFormat,
    output: Path | None,
) -> None:
    """Show what rests on a partner of PROJECT, or on some components: what stops if they are late.

    Deadlines, use cases, requirements and partners that rest on them, which interfaces to agree first, and what others
    can work with meanwhile. `archgen impact --partner kth`
    """
    from archgen.products import agreement_documents, partner_documents

    if until is not None:
        with command_support.explain_wrong_usage(ValueError):
            agreement_documents.parse_issue_date(until)
    checked_project = command_support.check_or_exit(project)
    command_support.print_findings_above(checked_project, lowest_severity=Severity.ERROR)
    chosen = command_support.require_partner(checked_project.architecture, partner) if partner else None
    with command_support.explain_wrong_usage(partner_documents.ComponentsError), command_support.explain_write_errors():
        width = find_width(sys.stdout) if output is None else None
        text = partner_documents.write_impact(checked_project, chosen, components, form, width=width, until=until)
        command_support.write_output(text, output)
    command_support.exit_by_findings(checked_project)
