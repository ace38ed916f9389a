"""`archgen generate`: make a workspace by a text backend."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from archgen.cli import command_support, shared_options

if TYPE_CHECKING:
    from archgen.views.pages.report_outline import DetailLevel


@click.command("generate")
@click.argument("name", shell_complete=shared_options.complete_workspaces)
@shared_options.output_option("The folder", "NAME")
@shared_options.select_option
@shared_options.level_option
@shared_options.revision_option
@shared_options.keep_going_option
@shared_options.trust_option
@shared_options.project_option
@shared_options.variant_option
def command(  # noqa: PLR0913 - one for each option
    *,
    name: str,
    output: Path | None,
    select: str | None,
    level: DetailLevel | None,
    revision: str | None,
    keep_going: bool,
    trust: str | None,
    project: Path | None,
) -> None:
    """Make the workspace of the backend NAME: a folder that other tools work in.

    NAME is a backend with `makes: workspace`; `archgen list --of backends` shows them. A folder that holds files of
    others is never touched.
    """
    from archgen.products import project_outputs
    from archgen.products.output_options import OutputOptions

    checked_project = command_support.check_before_writing(project, keep_going=keep_going)
    output_options = OutputOptions(
        command_support.select_or_exit(checked_project, select),
        select or "",
        level,
        revision,
        warn=command_support.print_warning,
        trusted_revision=command_support.find_trusted_revision(project, trust),
    )
    with command_support.explain_write_errors():
        target = project_outputs.write_workspace(checked_project, output_options, name, output)
    command_support.print_written(target)
    command_support.exit_by_findings(checked_project)
