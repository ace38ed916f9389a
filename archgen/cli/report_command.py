"""`archgen report`: write the Word report."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from archgen.cli import command_support, shared_options
from archgen.frozen import replace

if TYPE_CHECKING:
    from archgen.views.pages.report_outline import DetailLevel, ReportDocument

_FILE_NAMES = {"deliverable": "report", "data-sheets": "data_sheets", "workbook": "workbook", "full": "report"}
_PAGES = {"full": 3, "data-sheets": 1}
"""The pages that a document has of each component."""
_MAX_PAGES = 900
_FORMAT_BY_ENDING = {".docx": "docx", ".pdf": "pdf", ".xlsx": "xlsx"}


@click.command("report")
@shared_options.project_argument
@shared_options.variant_option
@shared_options.output_option("The file", "report.docx")
@click.option(
    "--format",
    "form",
    type=click.Choice(["docx", "pdf", "xlsx"]),
    help="The format, where the file's ending does not say it.  [default: docx]",
)
@shared_options.template_option("A .docx or .dotx whose styles, cover, headers, footers and paper size are taken.")
@click.option(
    "--document",
    type=click.Choice(["deliverable", "data-sheets", "workbook", "full"]),
    help="What to write: the report to hand in, a page for each component, all lists (.xlsx), or everything in one.  [default: deliverable; workbook for .xlsx]",
)
@click.option("--since", metavar="REV", help="Say what changed since a version (as `archgen diff` takes it).")
@shared_options.select_option
@click.option(
    "--level",
    type=click.Choice(["functional", "implementation"]),
    help="Stop at the functional level, or show the ROS side with each component.  [default: `report.level` of the project, else everything with the ROS side in an annex]",
)
@shared_options.revision_option
@shared_options.history_option
@shared_options.keep_going_option
def command(  # noqa: PLR0913 - one for each option
    *,
    project: Path | None,
    output: Path | None,
    form: str | None,
    template: Path | None,
    document: ReportDocument | None,
    since: str | None,
    select: str | None,
    level: DetailLevel | None,
    revision: str | None,
    history: bool,
    keep_going: bool,
) -> None:
    """Write the architecture of PROJECT as a Word document that can be handed in.

    `--document data-sheets` writes a page for each component, `workbook` all lists as .xlsx (with the library XlsxWriter),
    `full` all of it in one document. `--format pdf` takes LibreOffice.
    """
    from archgen.products import project_outputs

    form = command_support.choose_format(form, output, _FORMAT_BY_ENDING, "xlsx" if document == "workbook" else "docx")
    document = document or ("workbook" if form == "xlsx" else "deliverable")
    if (form == "xlsx") != (document == "workbook"):
        msg = "the workbook is an .xlsx, and of the other documents there is none: `--document workbook` goes with `--format xlsx` alone"
        raise click.UsageError(msg)
    if template is not None and form == "xlsx":
        raise click.UsageError("a workbook takes no template: `--template` goes with docx and pdf")
    checked_project = command_support.check_before_writing(project, keep_going=keep_going)
    output_options = replace(
        command_support.make_drawing_options(checked_project, select, level, revision),
        show_history=history,
        document=document,
        changes=command_support.compare_since(since, project, checked_project),
    )
    components = len(checked_project.architecture.components)
    pages = _PAGES.get(document, 0) * components
    if select is None and pages > _MAX_PAGES:
        command_support.print_warning(
            f"all that is said of {components:,} components fills some {pages:,} pages, which few programs open: `--document deliverable` has what is read, `--select` makes a part"
        )
    target = output or checked_project.output_folder / f"{_FILE_NAMES[document]}.{form}"
    with command_support.explain_write_errors():
        if form == "xlsx":
            project_outputs.write_report_workbook(checked_project, output_options, target)
        elif form == "pdf":
            project_outputs.write_report_pdf(checked_project, output_options, target, template)
        else:
            project_outputs.write_report(checked_project, output_options, target, template)
    command_support.print_written(target)
    command_support.exit_by_findings(checked_project)
