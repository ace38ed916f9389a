"""`archgen undo`: take back the last `rename`, `move` or `split`."""

from __future__ import annotations

from pathlib import Path

import click

from archgen.cli import command_support, shared_options


@click.command("undo")
@shared_options.project_option
def command(project: Path | None) -> None:
    """Take back the last `rename`, `move` or `split`: its files are as they were, each byte.

    Where one of them was edited since, nothing is undone, and the file is named.
    """
    from archgen.products.written_edits import undo_last
    from archgen.project.project_search import ProjectNotFoundError, find_project

    try:
        root, _ = find_project(project)
    except ProjectNotFoundError as error:
        raise click.ClickException(str(error)) from None
    with command_support.explain_write_errors():
        undone = undo_last(root)
    click.echo(f"undone: {undone.title}")
    for file in undone.files:
        click.echo(f"  {command_support.shorten_path(root / file)}")
