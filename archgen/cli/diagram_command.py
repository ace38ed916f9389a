"""`archgen diagram`: draw the diagrams."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from archgen.cli import command_support, shared_options
from archgen.frozen import replace

if TYPE_CHECKING:
    from archgen.views.pages.report_outline import DetailLevel

DIAGRAM_FORMATS = ("svg", "png", "pdf", "dot")


@click.command("diagram")
@shared_options.project_argument
@shared_options.variant_option
@shared_options.output_option("The folder", "diagrams")
@click.option(
    "--format",
    "forms",
    default="svg",
    show_default=True,
    metavar="LIST",
    help=f"Formats, separated by commas: {', '.join(DIAGRAM_FORMATS)}.",
)
@click.option(
    "--only",
    metavar="NAME",
    multiple=True,
    help="Draw only this picture (`overview`, `groups/sensing`, ...; `*` for any run); may be given several times.",
)
@shared_options.select_option
@shared_options.level_option
@click.option(
    "--depth",
    type=click.IntRange(min=0),
    default=0,
    metavar="LEVELS",
    help="Open composed components in pictures, so many levels deep, where a view does not say itself how deep. "
    "[default: closed, each with a picture of its own]",
)
@shared_options.keep_going_option
def command(  # noqa: PLR0913 - one for each option
    *,
    project: Path | None,
    output: Path | None,
    forms: str,
    only: tuple[str, ...],
    select: str | None,
    level: DetailLevel | None,
    depth: int,
    keep_going: bool,
) -> None:
    """Draw the architecture of PROJECT: overview, groups, components, ROS graph, hosts, views.

    With --select the overview shows just what is selected, neighbours grey, and only its pictures are drawn.
    """
    from archgen.products import project_outputs

    format_names = tuple(dict.fromkeys(form.strip() for form in forms.split(",") if form.strip()))
    unknown_formats = [form for form in format_names if form not in DIAGRAM_FORMATS]
    if unknown_formats or not format_names:
        raise click.UsageError(f"--format takes {', '.join(DIAGRAM_FORMATS)}, separated by commas, not '{forms}'")
    checked_project = command_support.check_before_writing(project, keep_going=keep_going)
    output_options = replace(command_support.make_drawing_options(checked_project, select, level), depth=depth)
    target = output or checked_project.output_folder / "diagrams"
    with command_support.explain_write_errors():
        count = project_outputs.write_diagrams(checked_project, output_options, target, format_names, only)
    command_support.print_written(target, f"{count} pictures")
    command_support.exit_by_findings(checked_project)
