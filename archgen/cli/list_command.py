"""`archgen list`: list what a selector names, all elements of a kind, component types, or the backends."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from archgen.cli import command_support, shared_options
from archgen.diagnostics import Severity
from archgen.diagnostics.text_columns import find_width
from archgen.language.language_tables import SECTION_KINDS
from archgen.products.output_options import OutputOptions

if TYPE_CHECKING:
    from archgen.pipeline import CheckedProject

_FURTHER_KINDS = (
    *("components", "connections", "edges", "topics", "steps", "parameters", "operations", "start_up", "backends"),
)
"""What can be listed and is no section of elements."""
_UNLISTED_SECTIONS = frozenset({"libraries"})
"""What they hold is listed as `component_types`."""
LISTABLE_KINDS = tuple(sorted({*_FURTHER_KINDS, *SECTION_KINDS} - _UNLISTED_SECTIONS))
_SELECTED_KINDS = frozenset(
    {*_FURTHER_KINDS, "nodes", "groups", "types", "requirements", "use_cases", "chains", "hosts", "frames", "variants"}
    - {"backends"}
)
"""Kinds of which a selector names some."""


@click.command("list")
@click.argument("selector", nargs=-1)
@click.option("--select", metavar="WORDS", help="The same as SELECTOR.")
@click.option(
    "--of", "sort", type=click.Choice(LISTABLE_KINDS), default="components", show_default=True, help="What to list."
)
@click.option(
    "--library",
    metavar="ID",
    help="With `--of component_types`: only those of this library; `builtin` are those that ship with archgen.",
)
@shared_options.format_option("text", "csv", "json")
@shared_options.project_option
@shared_options.variant_option
def command(  # noqa: PLR0913 - one for each option
    *, selector: tuple[str, ...], select: str | None, sort: str, library: str | None, form: str, project: Path | None
) -> None:
    """List what SELECTOR names; without one, everything.

    Put a selector that begins with `-` behind `--`. `archgen list --of connections --format csv` is the table of all
    connections, safe to open in a spreadsheet. `--of backends` lists what can be made: by archgen, and by the project's own
    backends. `--of component_types` lists what `is` may name, of libraries also what nobody uses yet.
    """
    from archgen.cli import component_type_listing
    from archgen.emit.terminal import list_formats

    # What ships is looked at before there is a project.
    checked_project = (
        component_type_listing.check_no_project(project) if library == component_type_listing.SHIPPED_LIBRARY else None
    ) or command_support.check_or_exit(project)
    command_support.print_findings_above(checked_project, lowest_severity=Severity.ERROR)
    selector_text = " ".join((*selector, *([select] if select else [])))
    if selector_text and sort not in _SELECTED_KINDS:
        raise click.UsageError(f"a selector names elements: `--of {sort}` takes none")
    if library is not None and sort != "component_types":
        raise click.UsageError("`--library` goes with `--of component_types`")
    if sort == "backends":
        columns, rows = _list_backends(checked_project)
    elif sort == "component_types":
        columns, rows = component_type_listing.list_component_types(checked_project, library)
    else:
        columns, rows = _list_elements(checked_project, selector_text, sort)
    if form == "text":
        text = list_formats.format_columns(columns, rows, find_width(sys.stdout))
    else:
        text = {"csv": list_formats.format_csv, "json": list_formats.format_json_rows}[form](columns, rows)
    sys.stdout.write(text)
    command_support.exit_by_findings(checked_project)


def _list_elements(
    checked_project: CheckedProject, selector_text: str, kind: str
) -> tuple[Sequence[str], Sequence[Sequence[str]]]:
    """Return the columns and rows of elements."""
    from archgen.products import project_views

    # Who writes the kind where a selector stands means `--of`, unless an element is called so.
    meant_kind = next((each for each in LISTABLE_KINDS if selector_text in {each, each.removesuffix("s")}), None)
    if meant_kind and any(
        p.severity == "error" for p in project_views.select_elements(checked_project, selector_text)[1]
    ):
        raise click.UsageError(f"nothing is called `{selector_text}`; did you mean `archgen list --of {meant_kind}`?")
    selection = command_support.select_or_exit(checked_project, selector_text or None)
    return project_views.list_rows(checked_project, OutputOptions(selection, selector_text), kind)


def _list_backends(checked_project: CheckedProject) -> tuple[Sequence[str], Sequence[Sequence[str]]]:
    """Return the columns and rows of backends; what is wrong with a manifest is a warning."""
    from archgen.emit.backend_manifests import find_backends

    backends, problems = find_backends(checked_project.root)
    for problem in problems:
        command_support.print_warning(f"{problem.span}: {problem.message}")
    rows = [
        (
            backend.id,
            backend.title,
            backend.makes,
            backend.emitter,
            ", ".join(backend.views),
            "own" if backend.from_project else backend.origin or "shipped",
        )
        for backend in backends.values()
    ]
    return ("id", "title", "makes", "emitter", "view", "origin"), rows
