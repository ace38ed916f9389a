"""`archgen export`: make a single file by a text backend."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

import click

from archgen.cli import command_support, shared_options
from archgen.products.output_options import OutputOptions

if TYPE_CHECKING:
    from archgen.views.pages.report_outline import DetailLevel


_TYPES_BACKEND = "xmi"


@click.command("export")
@shared_options.backend_argument("file")
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path),
    help="The file to write, or `-`.  [default: the standard output]",
)
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
    """Make the single file of the backend NAME, for another tool.

    NAME is a backend with `makes: file`; `archgen list --of backends` shows them.
    """
    from archgen.products import product_writing, project_outputs

    checked_project = command_support.check_before_writing(project, keep_going=keep_going)
    # The selector's word without a value: the component types of a project or a library, and nothing else.
    types_only = name == _TYPES_BACKEND and select is not None and select.strip() == "type:"
    if types_only and not checked_project.architecture.component_types:
        command_support.print_warning("there are no component types here: the model holds no class")
    output_options = OutputOptions(
        None if types_only else command_support.select_or_exit(checked_project, select),
        select or "",
        level,
        revision,
        warn=command_support.print_warning,
        trusted_revision=command_support.find_trusted_revision(project, trust),
        types_only=types_only,
    )
    with command_support.explain_write_errors():
        content = project_outputs.render_exported(checked_project, output_options, name)
        if output is not None and str(output) != "-":
            product_writing.write_product_file(checked_project, output, content)
            command_support.print_written(output)
    if output is None or str(output) == "-":
        _print_content(content)
    command_support.exit_by_findings(checked_project)


def _print_content(content: bytes) -> None:
    if sys.stdout.isatty():
        from archgen.diagnostics import make_visible

        # What a terminal would obey is shown instead: names of the project stand in the file.
        sys.stdout.writelines(f"{make_visible(line)}\n" for line in content.decode().splitlines())
    else:
        # Bytes: the file must be the same whatever the encoding and the line ends of the system are.
        sys.stdout.buffer.write(content)
