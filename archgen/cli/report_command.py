"""`archgen report`: write the Word report."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from archgen.cli import command_support, shared_options

if TYPE_CHECKING:
    from archgen.views.pages.report_outline import DetailLevel


@click.command("report")
@shared_options.project_argument
@shared_options.output_option("The file", "report.docx")
@click.option("--format", "form", type=click.Choice(["docx"]), default="docx", show_default=True)
@click.option(
    "--template",
    type=click.Path(exists=True, dir_okay=False, path_type=Path),
    help="A .docx or .dotx whose styles, cover, headers, footers and paper size are taken.",
)
@shared_options.select_option
@shared_options.level_option
@shared_options.revision_option
@shared_options.history_option
@shared_options.keep_going_option
def command(  # noqa: PLR0913 - one for each option
    *,
    project: Path | None,
    output: Path | None,
    form: str,
    template: Path | None,
    select: str | None,
    level: DetailLevel | None,
    revision: str | None,
    history: bool,
    keep_going: bool,
) -> None:
    """Write the architecture of PROJECT as a Word document that can be handed in."""
    from archgen.products import project_outputs
    from archgen.products.output_options import OutputOptions

    del form  # one for now; the option is there so that scripts say what they want
    checked_project = command_support.check_before_writing(project, keep_going=keep_going)
    selection = command_support.select_or_exit(checked_project, select)
    output_options = OutputOptions(
        selection,
        select or "",
        level,
        revision,
        command_support.make_progress_printer(),
        command_support.print_warning,
        history,
    )
    target = output or checked_project.output_folder / "report.docx"
    with command_support.explain_write_errors():
        project_outputs.write_report(checked_project, output_options, target, template)
    command_support.print_written(target)
    command_support.exit_by_findings(checked_project)
