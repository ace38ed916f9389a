"""`archgen schema`: write the JSON Schema of a project, with which editors offer its names."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from archgen.cli import command_support, shared_options


@click.command("schema")
@shared_options.project_argument
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path, allow_dash=True),
    help="The file to write, `-` for the terminal.  [default: .vscode/archgen.schema.json in the project]",
)
def command(project: Path | None, output: Path | None) -> None:
    """Write the JSON Schema of PROJECT, so that editors complete its own names: partners, components, types, ...

    `archgen init` sets editors up for it. `archgen check` renews the file when it runs on a terminal and git ignores the
    file; call this verb after a clone, and where something else looks for the schema.
    """
    from archgen.products import editor_schema_file

    checked_project = command_support.check_or_exit(project)
    if checked_project.architecture.partial:
        command_support.print_warning("names of what cannot be read are missing: `archgen check` says what to mend")
    if output == Path("-"):
        sys.stdout.write(editor_schema_file.render_schema(checked_project).decode())
        return
    with command_support.explain_write_errors():
        path, is_new = editor_schema_file.write_schema(checked_project, output)
    if is_new:
        command_support.print_written(path)
    else:
        click.echo(f"{command_support.shorten_path(path)} is up to date")
    advice = editor_schema_file.explain_set_up(checked_project, path)
    if advice:
        command_support.print_warning(advice)
