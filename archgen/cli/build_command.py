"""`archgen build`: make everything."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from archgen.cli import command_support, shared_options
from archgen.frozen import replace

if TYPE_CHECKING:
    from archgen.views.pages.report_outline import DetailLevel


@click.command("build")
@shared_options.project_argument
@shared_options.variant_option
@shared_options.output_option("The folder", "")
@click.option(
    "--backend",
    metavar="NAME",
    multiple=True,
    help="Make this backend's output too (`wiki`, or one in the project's backends/); may be given several times.",
    shell_complete=shared_options.complete_backends("documents"),
)
@click.option(
    "--only",
    metavar="NAMES",
    multiple=True,
    help="Make only these: `report`, `site`, `diagrams`, `packed` or backends, separated by commas.",
    shell_complete=shared_options.complete_products,
)
@shared_options.template_option("A .docx or .dotx for the report.")
@shared_options.select_option
@shared_options.level_option
@shared_options.revision_option
@shared_options.history_option
@shared_options.component_pictures_option
@shared_options.keep_going_option
@shared_options.trust_option
def command(  # noqa: PLR0913 - one for each option
    *,
    project: Path | None,
    output: Path | None,
    backend: tuple[str, ...],
    only: tuple[str, ...],
    template: Path | None,
    select: str | None,
    level: DetailLevel | None,
    revision: str | None,
    history: bool,
    component_pictures: bool | None,
    keep_going: bool,
    trust: str | None,
) -> None:
    """Make report.docx, site/, diagrams/ and packed.yaml of PROJECT."""
    from archgen.products.full_build import build_outputs, choose_products
    from archgen.products.product_inputs import ProductInputs

    only_names = tuple(name.strip() for names in only for name in names.split(",") if name.strip())
    if only and not only_names:
        raise click.UsageError("--only takes the names of outputs, separated by commas")
    checked_project = command_support.check_before_writing(project, keep_going=keep_going)
    trusted_revision = command_support.find_trusted_revision(project, trust)
    output_options = replace(
        command_support.make_drawing_options(checked_project, select, level, revision),
        show_history=history,
        trusted_revision=trusted_revision,
        component_pictures=component_pictures,
    )
    target = output or checked_project.output_folder
    with command_support.explain_write_errors():
        products = choose_products(checked_project, only_names, backend, trusted_revision)
        inputs = ProductInputs(checked_project, output_options, template)
        build_outputs(inputs, products, target, command_support.print_written)
    counts = command_support.summarise_counts(checked_project.findings)
    click.echo(f"archgen check tells more: {counts}" if counts else "no findings")
    command_support.exit_by_findings(checked_project)
