"""`archgen pack`: write one validated YAML file that holds the whole project."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from archgen.cli import command_support, shared_options
from archgen.diagnostics import make_visible
from archgen.products.output_options import OutputOptions
from archgen.syntax.file_patterns import YAML_ENDINGS


@click.command("pack")
@shared_options.project_argument
@shared_options.variant_option
@shared_options.output_option("The file, or `-` for standard output,", "packed.yaml", takes_dash=True)
@click.option(
    "--resolved",
    is_flag=True,
    help="Write what was derived too (edges, nodes, topics, messages), for other programs; by its own schema.",
)
@shared_options.select_option
@shared_options.keep_going_option
def command(project: Path | None, output: Path | None, select: str | None, *, resolved: bool, keep_going: bool) -> None:
    """Write PROJECT as one validated YAML file, which is itself a project.

    With --resolved it is a record for other programs instead (`resolved.yaml`); --select then names a part of it.
    """
    from archgen.products import product_writing, project_outputs

    if select and not resolved:
        raise click.UsageError("--select goes with --resolved: a packed project is whole")
    if output is not None and output != Path("-") and output.suffix not in {"", *YAML_ENDINGS}:
        raise click.UsageError(make_visible(f"what is packed is YAML: end `{output.name}` in .yaml"))
    checked_project = command_support.check_before_writing(project, keep_going=keep_going)
    with command_support.explain_write_errors():
        if resolved:
            selection = command_support.select_or_exit(checked_project, select)
            content = project_outputs.render_resolved(checked_project, OutputOptions(selection, select or ""))
        else:
            content = project_outputs.render_packed(checked_project)
        if output == Path("-"):
            sys.stdout.buffer.write(content)
        else:
            target = output or checked_project.output_folder / ("resolved.yaml" if resolved else "packed.yaml")
            product_writing.write_product_file(checked_project, target, content)
            command_support.print_written(target)
    command_support.exit_by_findings(checked_project)
