"""`archgen site`: write the static web site."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from archgen.cli import command_support, shared_options
from archgen.frozen import replace

if TYPE_CHECKING:
    from archgen.views.pages.report_outline import DetailLevel


@click.command("site")
@shared_options.project_argument
@shared_options.variant_option
@shared_options.output_option("The folder", "site")
@shared_options.select_option
@shared_options.level_option
@shared_options.revision_option
@click.option(
    "--since",
    metavar="REV",
    help="Show what changed since a version (as `archgen diff` takes it): a page, marks, both versions side by side.",
)
@shared_options.history_option
@shared_options.component_pictures_option
@shared_options.keep_going_option
def command(  # noqa: PLR0913 - one for each option
    *,
    project: Path | None,
    output: Path | None,
    select: str | None,
    level: DetailLevel | None,
    revision: str | None,
    since: str | None,
    history: bool,
    component_pictures: bool | None,
    keep_going: bool,
) -> None:
    """Write the architecture of PROJECT as a web site that opens from the disk."""
    from archgen.products import project_outputs

    checked_project = command_support.check_before_writing(project, keep_going=keep_going)
    output_options = replace(
        command_support.make_drawing_options(checked_project, select, level, revision),
        show_history=history,
        component_pictures=component_pictures,
        changes=command_support.compare_since(since, project, checked_project),
    )
    target = output or checked_project.output_folder / "site"
    with command_support.explain_write_errors():
        project_outputs.write_site(checked_project, output_options, target)
    command_support.print_written(target / "index.html")
    command_support.exit_by_findings(checked_project)
