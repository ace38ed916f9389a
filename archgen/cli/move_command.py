"""`archgen move`: put an element into another group, or into another file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from archgen.cli import refactoring_support

if TYPE_CHECKING:
    from archgen.edit.refactoring.judged_version import JudgedVersion
    from archgen.edit.refactoring.refactoring import Refactoring


@click.command("move")
@click.argument("name", metavar="ELEMENT")
@click.argument("group", metavar="[GROUP]", required=False)
@click.option("--file", "file", metavar="FILE", help="The file that takes it, from the project's folder; new or not.")
@click.option("--kind", metavar="KIND", help="What ELEMENT is, where the word names two things.")
@refactoring_support.add_shared_options
def command(  # noqa: PLR0913, PLR0917 - one for each option
    name: str,
    group: str | None,
    file: str | None,
    kind: str | None,
    project: Path | None,
    format_name: str,
    *,
    dry_run: bool,
) -> None:
    """Move ELEMENT into GROUP, or into a file alone, with the comments above it.

    References follow, owners that came from the old group are written out, and `sources` gets a file that it would not
    read. That nothing else changes is proved as for `archgen rename`.
    """
    from archgen.edit.refactoring.element_move import plan_move
    from archgen.edit.refactoring.element_rename import find_element

    def plan(version: JudgedVersion) -> tuple[str, Refactoring]:
        element = find_element(version, name, refactoring_support.read_kind(kind))
        place = " in ".join(filter(None, (group and f"the group `{group}`", file)))
        return f"the {element[0].replace('_', ' ')} `{element[1]}` stands in {place} now", plan_move(
            version, element, group, file
        )

    if group is None and file is None:
        raise click.UsageError("say where to: a group, or a file with --file")
    refactoring_support.run_refactoring(project, plan, format_name, dry_run=dry_run)
