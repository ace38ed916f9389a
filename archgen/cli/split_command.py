"""`archgen split`: put each group, component or section of a file into a file of its own."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from archgen.cli import refactoring_support

if TYPE_CHECKING:
    from archgen.edit.refactoring.element_move import SplitUnit
    from archgen.edit.refactoring.judged_version import JudgedVersion
    from archgen.edit.refactoring.refactoring import Refactoring


@click.command("split")
@click.argument("file")
@click.option(
    "--by",
    "unit",
    type=click.Choice(("group", "component", "section")),
    help="What gets a file of its own.  [default: groups, components of one group, sections]",
)
@refactoring_support.add_shared_options
def command(file: str, unit: SplitUnit | None, project: Path | None, format_name: str, *, dry_run: bool) -> None:
    """Put each group, component or section of FILE, a path from the project's folder, into a file of its own.

    Whole entries move with the comments above them; `sources` gets files that it would not read. A file that would be
    empty keeps what comes first. That nothing changes is proved as for `archgen rename`.
    """
    from archgen.edit.refactoring.element_move import plan_split

    def plan(version: JudgedVersion) -> tuple[str, Refactoring]:
        return f"{file} is split", plan_split(version, file, unit)

    refactoring_support.run_refactoring(project, plan, format_name, dry_run=dry_run)
