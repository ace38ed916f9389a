"""`archgen rename`: give an element another name wherever it is declared and named."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from archgen.cli import refactoring_support

if TYPE_CHECKING:
    from archgen.edit.refactoring.judged_version import JudgedVersion
    from archgen.edit.refactoring.refactoring import Refactoring


@click.command("rename")
@click.argument("name", metavar="OLD")
@click.argument("new_name", metavar="NEW")
@click.option("--kind", metavar="KIND", help="What OLD is, where the word names two things: `node`, `type`, ...")
@click.option("--keep-topics", is_flag=True, help="Names of nodes and topics stay: they are written out.")
@click.option("--keep-message", is_flag=True, help="The message of a type stays: it is written out.")
@click.option("--keep-title", is_flag=True, help="The title stays that is made of the name: it is written out.")
@click.option("--keep-chapters", is_flag=True, help="Links and ids in the texts of chapters stay.")
@refactoring_support.add_shared_options
def command(  # noqa: PLR0913 - one for each option
    name: str,
    new_name: str,
    kind: str | None,
    project: Path | None,
    format_name: str,
    *,
    keep_topics: bool,
    keep_message: bool,
    keep_title: bool,
    keep_chapters: bool,
    dry_run: bool,
) -> None:
    """Rename the element OLD: a complete id or the end of a path. NEW is its name; a path before it is the one that it has.

    It is renamed in all files, in variants, in selectors, inside of component types (for all instances). A reference
    that would mean something else is written longer. Every other byte stays. That nothing else changes is proved by
    comparing the models; where it would, nothing is written and the reason is said.
    """
    from archgen.edit.refactoring.element_rename import find_element, plan_rename
    from archgen.edit.refactoring.kept_names import KeptNames

    def plan(version: JudgedVersion) -> tuple[str, Refactoring]:
        element = find_element(version, name, refactoring_support.read_kind(kind))
        kept = KeptNames(topics=keep_topics, message=keep_message, title=keep_title, chapters=keep_chapters)
        refactoring = plan_rename(version, element, new_name, kept)
        return f"the {element[0].replace('_', ' ')} `{element[1]}` is `{new_name}` now", refactoring

    refactoring_support.run_refactoring(project, plan, format_name, dry_run=dry_run)
