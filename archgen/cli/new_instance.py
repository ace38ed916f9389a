"""`archgen new type`, `archgen new instance` and `archgen new variant`: what other elements are made from, and what is made otherwise."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from archgen.cli import command_support, element_adding, shared_options
from archgen.diagnostics.diagnostic import Diagnostic
from archgen.diagnostics.source_span import NO_SPAN

if TYPE_CHECKING:
    from archgen.pipeline import CheckedProject
    from archgen.syntax.yaml_tree import MappingNode


@click.command("type")
@click.option("--is", "base", metavar="TYPE", help="The type that it is made from.")
@click.option(
    "--generic", metavar="NAME", multiple=True, help="A name that stands for a conceptual type; may be repeated."
)
@click.option("--functionality", metavar="TEXT", help="What it does, in a sentence or two.")
@element_adding.add_shared_options
def add_type(  # noqa: PLR0913, PLR0917 - one for each option
    name: str,
    base: str | None,
    generic: tuple[str, ...],
    functionality: str | None,
    title: str | None,
    owner: str | None,
    project: Path | None,
    *,
    dry_run: bool,
) -> None:
    """Add a component type, in the file that holds most of them."""
    from archgen.edit import element_place

    checked_project = command_support.check_or_exit(project)
    types = checked_project.architecture.component_types
    element_adding.require_free_id(name, "component type", types)
    if base is not None:
        _find_type_body(checked_project, base, name, is_base=True)
    body = element_adding.drop_missing(
        **{"is": base},
        title=element_adding.choose_title(name, title),
        owner=owner,
        generic=tuple(dict.fromkeys(generic)) or None,
    )
    # An empty key would take away what the type that it is made from has.
    open_keys = {"functionality": functionality, "inputs": None, "outputs": None}
    body |= element_adding.drop_missing(functionality=functionality) if base else open_keys
    hints = {
        "functionality": "what it does, in a sentence or two",
        "inputs": "id: conceptual type",
        "outputs": "id: conceptual type",
    }
    place = element_place.place_in_section(checked_project, "component_types")
    element_adding.add_element(checked_project, place, name, body, hints, dry_run=dry_run)


def _complete_types(context: click.Context, _parameter: click.Parameter, incomplete: str) -> list[str]:
    """Complete the name of a component type that the project may name, of a library too."""
    from archgen.cli import component_type_listing

    return [
        name
        for name in component_type_listing.list_type_names(context.params.get("project"))
        if name.startswith(incomplete)
    ]


@click.command("instance")
@click.option("--group", "group_", metavar="GROUP", help="Its group.  [default: the only one]")
@element_adding.add_shared_options
@click.argument("type_text", metavar="TYPE", shell_complete=_complete_types)
def add_instance(  # noqa: PLR0913, PLR0917 - one for each option
    name: str,
    type_text: str,
    group_: str | None,
    title: str | None,
    owner: str | None,
    project: Path | None,
    *,
    dry_run: bool,
) -> None:
    """Add an instance of a component type, with its inputs to be filled. ID is GROUP.ID; TYPE is as in `filter<Pose>`."""
    from archgen.diagnostics.common_wording import join_words
    from archgen.edit import element_place

    checked_project = command_support.check_or_exit(project)
    holder_id, component_id = element_adding.find_place_of_component(checked_project, name, group_)
    full_id = f"{holder_id}.{component_id}"
    input_hints = _describe_open_inputs(_find_type_body(checked_project, type_text, full_id))
    body = element_adding.drop_missing(
        **{"is": type_text.strip()},
        title=element_adding.choose_title(component_id, title),
        owner=owner,
        inputs=dict.fromkeys(input_hints) or None,
    )
    place = element_place.place_for_component(checked_project, holder_id)
    element_adding.add_element(checked_project, place, component_id, body, input_hints, holder_id, dry_run=dry_run)
    if input_hints and not dry_run:
        click.echo(f"Say what feeds {join_words([f'`{port}`' for port in input_hints])}, where nothing does yet.")


def _find_type_body(
    checked_project: CheckedProject, type_text: str, element_id: str, *, is_base: bool = False
) -> MappingNode:
    """Return what a component type has, with what it is made from and generic names bound. Raise UsageError."""
    from archgen.compose import list_type_entries
    from archgen.compose.type_table import TypeTable
    from archgen.diagnostics.safe_text import make_visible
    from archgen.syntax.yaml_tree import MappingNode, ScalarNode

    diagnostics: list[Diagnostic] = []
    table = TypeTable(
        list_type_entries(checked_project.merged_table),
        diagnostics,
        describe_missing_type=checked_project.loaded_project.describe_missing_type,
    )
    expression = table.find_type(ScalarNode(type_text, type_text, NO_SPAN), element_id, is_base=is_base)
    if expression is None:
        msg = "; ".join(make_visible(text) for text in (diagnostics[0].message, diagnostics[0].help) if text)
        raise click.UsageError(msg)
    # A type that is made from itself has no body; the project's findings say so already.
    return table.get_body(expression) or MappingNode({}, NO_SPAN)


def _describe_open_inputs(type_body: MappingNode) -> dict[str, str]:
    """Return, for each input that needs a source, what is to be written there."""
    from archgen.diagnostics.safe_text import make_visible
    from archgen.link import mapping_values

    return {
        name: f"component.output of type {make_visible(type_text)}" if type_text else "component.output"
        for name, _, port in mapping_values.iterate_elements(type_body, "inputs")
        if {"from", "external"}.isdisjoint(port.entries) and not mapping_values.get_flag(port, "optional")
        for type_text in [mapping_values.get_text(port, "type")]
    }


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
    from archgen.model.variant import BASE_NAME

    checked_project = command_support.check_or_exit(project)
    variants = checked_project.architecture.variants
    if name == BASE_NAME:
        msg = f"'{BASE_NAME}' is what the project itself is called where variants are named: choose another id"
        raise click.UsageError(msg)
    element_adding.require_free_id(name, "variant", variants)
    _require_variants(checked_project, bases)
    if without is not None:
        _require_selection(checked_project, without)
    bases = tuple(dict.fromkeys(bases))
    body = element_adding.drop_missing(
        title=element_adding.choose_title(name, title),
        of=bases[0] if len(bases) == 1 else bases or None,
        without=without,
    )
    hints = {"changes": "sections as in any file; what stands here wins"}
    place = element_place.place_in_section(checked_project, "variants")
    element_adding.add_element(checked_project, place, name, {**body, "changes": None}, hints, dry_run=dry_run)


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
