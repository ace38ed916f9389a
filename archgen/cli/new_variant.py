"""`archgen new variant`: the same project otherwise, with its changes to be filled in."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from archgen.cli import command_support, element_adding, shared_options

if TYPE_CHECKING:
    from archgen.pipeline import CheckedProject


@click.command("variant")
@click.option(
    "--of", "bases", metavar="VARIANT", multiple=True, help="A variant that it is built on; may be repeated, in order."
)
@click.option("--without", metavar="SELECTOR", help="What is not there: `tag:hardware`, `sensing.lidar`.")
@click.option("--dry-run", is_flag=True, help="Print the difference and write nothing.")
@shared_options.project_option
@click.option("--title", metavar="TEXT", help="The title.  [default: made from the ID]")
@click.argument("name", metavar="ID")
def add_variant(  # noqa: PLR0913 - one for each option
    name: str, bases: tuple[str, ...], without: str | None, title: str | None, project: Path | None, *, dry_run: bool
) -> None:
    """Add a variant, in the file that holds most of them. What it changes is written below `changes`."""
    from archgen.edit import element_place
    from archgen.edit.edit_proof import NewElement
    from archgen.model.path_resolver import title_from_id
    from archgen.model.variant import BASE_NAME

    checked_project = command_support.check_or_exit(project)
    variants = checked_project.architecture.variants
    if name == BASE_NAME:
        msg = f"'{BASE_NAME}' is what the project itself is called where variants are named: choose another id"
        raise click.UsageError(msg)
    element_adding.require_free_id(name, "variant", {key: value.at for key, value in variants.items()})
    _require_variants(checked_project, bases)
    if without is not None:
        _require_selection(checked_project, without)
    bases = tuple(dict.fromkeys(bases))
    body = element_adding.drop_missing(
        title=title or title_from_id(name), of=bases[0] if len(bases) == 1 else bases or None, without=without
    )
    hints = {"changes": "sections as in any file; what stands here wins"}
    element_adding.add_element(
        checked_project,
        element_place.place_in_section(checked_project, "variants"),
        NewElement(name, {**body, "changes": None}, hints),
        name,
        dry_run=dry_run,
    )


def _require_variants(checked_project: CheckedProject, names: tuple[str, ...]) -> None:
    """Raise UsageError for a name that is no variant of the project."""
    from archgen.diagnostics.safe_text import make_visible
    from archgen.diagnostics.suggestions import did_you_mean

    known_names = checked_project.architecture.variants
    for name in names:
        if name not in known_names:
            known = ", ".join(known_names) or "none yet"
            guess = did_you_mean(name, known_names) or f"there are: {known}"
            msg = make_visible(f"there is no variant '{name}'; {guess}")
            raise click.UsageError(msg)


def _require_selection(checked_project: CheckedProject, selector: str) -> None:
    """Raise UsageError for a selector that is wrong; print a warning for a word that selects nothing."""
    from archgen.products import project_views

    _, problems = project_views.select_elements(checked_project, selector)
    command_support.report_selector_problems(problems)
