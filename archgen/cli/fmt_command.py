"""`archgen fmt`: lay the files out in one style."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

import click

from archgen.cli import command_support, shared_options

if TYPE_CHECKING:
    from archgen.edit.element_edit import FileEdit


@click.command("fmt")
@click.argument("paths", metavar="[PROJECT | FILE...]", nargs=-1, type=click.Path(path_type=Path))
@shared_options.project_option
@click.option(
    "--check", "only_checks", is_flag=True, help="Write nothing; name the files, and end with 1 if there are any."
)
@click.option("--diff", "shows_diff", is_flag=True, help="Write nothing; print the difference.")
def command(*, paths: tuple[Path, ...], project: Path | None, only_checks: bool, shows_diff: bool) -> None:
    """Lay the files of PROJECT out in one style, or those FILEs of it.

    Indents of two, lists two below their key, one blank line at most, blanks in braces, comments two blanks behind. What
    stands in braces stays there while it fits into 120 columns; else it is opened, an entry a line. No value, key or
    comment changes, and none changes its place: each file is proven to say the same before it is written. What cannot be
    laid out stays as it is and is named.
    """
    project, files = command_support.find_asked_files(paths, project)
    checked_project = command_support.check_or_exit(project)

    from archgen.edit.formatted_slices import UnformattedFile, plan_formatting

    edits: list[FileEdit] = []
    is_left = False
    for planned in plan_formatting(checked_project, command_support.name_files(checked_project, files)):
        if isinstance(planned, UnformattedFile):
            place = f"{planned.file}:{planned.line}" if planned.line else planned.file
            command_support.print_warning(f"{place}: {planned.reason}: the file stays as it is")
            is_left = True
        else:
            edits.append(planned)
    for edit in edits:
        if shows_diff:
            command_support.print_diff(edit)
        elif only_checks:
            click.echo(command_support.shorten_path(checked_project.root / edit.file))
        else:
            command_support.write_edit(checked_project.root, edit, _count_changed_lines(edit))
    if not edits and not is_left:
        click.echo("all files are as they should be")
    sys.exit(int(only_checks and bool(edits or is_left)))


def _count_changed_lines(edit: FileEdit) -> str:
    count = sum(line.startswith("-") for line in edit.unified_diff()) - 1
    return f"{count} line{'s' * (count != 1)} laid out anew"
