"""`archgen slides`: write slides for a meeting."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from archgen.cli import command_support, shared_options
from archgen.frozen import replace

if TYPE_CHECKING:
    from archgen.views.pages.report_outline import DetailLevel


@click.command("slides")
@shared_options.project_argument
@shared_options.variant_option
@shared_options.output_option("The file", "slides.pptx")
@shared_options.template_option("A .pptx or .potx of 16:9 whose masters, layouts and fonts are taken.")
@click.option("--since", metavar="REV", help="Say what changed since a version (as `archgen diff` takes it).")
@shared_options.level_option
@shared_options.revision_option
@shared_options.keep_going_option
def command(  # noqa: PLR0913 - one for each option
    *,
    project: Path | None,
    output: Path | None,
    template: Path | None,
    since: str | None,
    level: DetailLevel | None,
    revision: str | None,
    keep_going: bool,
) -> None:
    """Write slides of PROJECT for a meeting, as .pptx (with the library python-pptx): overview, chains, hosts, a slide
    for each partner, open points; with `--since` what changed.

    Tables and text are native, so that people can edit them.
    """
    from archgen.products import project_outputs

    command_support.choose_format(None, output, {".pptx": "pptx"}, "pptx")
    checked_project = command_support.check_before_writing(project, keep_going=keep_going)
    output_options = replace(
        command_support.make_drawing_options(checked_project, None, level, revision),
        changes=command_support.compare_since(since, project, checked_project),
    )
    target = output or checked_project.output_folder / "slides.pptx"
    with command_support.explain_write_errors():
        project_outputs.write_slides(checked_project, output_options, target, template)
    command_support.print_written(target)
    command_support.exit_by_findings(checked_project)
