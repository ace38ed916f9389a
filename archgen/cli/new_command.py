"""`archgen new`: add an element in the right file in the right form.

`archgen new type`, `archgen new instance` and `archgen new variant`: what other elements are made from, and what is made otherwise.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, get_args

import click

from archgen.cli import command_support, element_adding, shared_options
from archgen.diagnostics import NO_SPAN, Diagnostic, did_you_mean, join_words, make_visible
from archgen.model.component import ComponentRole
from archgen.model.node import NodeStatus

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
    known_names = checked_project.architecture.variants
    for name in names:
        if name not in known_names:
            known = ", ".join(known_names) or "none yet"
            guess = did_you_mean(name, known_names) or f"there are: {known}"
            raise click.UsageError(make_visible(f"there is no variant '{name}'; {guess}"))


def _require_selection(checked_project: CheckedProject, selector: str) -> None:
    """Raise UsageError for a selector that is wrong; print a warning for a word that selects nothing."""
    from archgen.products import project_views

    _, problems = project_views.select_elements(checked_project, selector)
    command_support.report_selector_problems(problems)


@click.group("new")
def command() -> None:
    """Add a group, a component, a type of components, an instance of one, a node, a partner or a variant.

    It goes into the file where its like stand, in the form that the file has. All else in the file stays as it is,
    byte for byte. Nothing is written where the result would not load, or where another element would change; then it
    says what to write by hand.
    """


command.add_command(add_type)
command.add_command(add_instance)
command.add_command(add_variant)


@command.command("group")
@element_adding.add_shared_options
def add_group(name: str, title: str | None, owner: str | None, project: Path | None, *, dry_run: bool) -> None:
    """Add a functional group, in a file of its own where the others have one."""
    from archgen.edit import element_place

    checked_project = command_support.check_or_exit(project)
    element_adding.require_free_id(name, "group", checked_project.architecture.groups)
    body = element_adding.drop_missing(title=element_adding.choose_title(name, title), owner=owner) | {
        "description": None,
        "components": None,
    }
    hints = {"description": "what the group is for", "components": "`archgen new component` adds one"}
    try:
        target_place = element_place.place_for_group(checked_project, name)
    except element_place.NoPlaceError as error:
        raise click.ClickException(str(error)) from None
    element_adding.add_element(checked_project, target_place, name, body, hints, dry_run=dry_run)


@command.command("component")
@click.option("--group", "group_", metavar="GROUP", help="Its group.  [default: the only one]")
@click.option("--role", type=click.Choice(get_args(ComponentRole)), help="What it does with data.")
@click.option("--functionality", metavar="TEXT", help="What it does, in a sentence or two.")
@element_adding.add_shared_options
def add_component(  # noqa: PLR0913, PLR0917 - one for each option
    name: str,
    group_: str | None,
    role: str | None,
    functionality: str | None,
    title: str | None,
    owner: str | None,
    project: Path | None,
    *,
    dry_run: bool,
) -> None:
    """Add a component to a group, in the file that says most of the group. ID may be written GROUP.ID.

    GROUP.COMPONENT.ID adds it inside of a component that holds components.
    """
    from archgen.edit import element_place

    checked_project = command_support.check_or_exit(project)
    holder_id, component_id = element_adding.find_place_of_component(checked_project, name, group_)
    body = {
        **element_adding.drop_missing(title=element_adding.choose_title(component_id, title), owner=owner, role=role),
        "functionality": functionality,
        "inputs": None,
        "outputs": None,
    }
    hints = {
        "functionality": "what it does, in a sentence or two",
        "inputs": "id: component.output",
        "outputs": "id: conceptual type",
    }
    place = element_place.place_for_component(checked_project, holder_id)
    element_adding.add_element(checked_project, place, component_id, body, hints, holder_id, dry_run=dry_run)


@command.command("node")
@click.option(
    "--implements", metavar="COMPONENT", multiple=True, help="A component that it implements; may be repeated."
)
@click.option("--package", metavar="NAME", help="Its ROS package.")
@click.option("--host", metavar="HOST", help="The computer on which it runs.")
@click.option("--status", type=click.Choice(get_args(NodeStatus)), default="planned", show_default=True)
@element_adding.add_shared_options
def add_node(  # noqa: PLR0913, PLR0917 - one for each option
    name: str,
    implements: tuple[str, ...],
    package: str | None,
    host: str | None,
    status: str,
    title: str | None,
    owner: str | None,
    project: Path | None,
    *,
    dry_run: bool,
) -> None:
    """Add a ROS node, in the file where the nodes of the same components or groups stand."""
    from archgen.edit import edit_proof, element_place

    checked_project = command_support.check_or_exit(project)
    element_adding.require_free_id(
        name, "node", {node.id: node for node in edit_proof.list_written_nodes(checked_project)}
    )
    implemented = implements[0] if len(implements) == 1 else implements or None
    body = element_adding.drop_missing(
        implements=implemented, title=title, owner=owner, package=package, host=host, status=status
    )
    components = tuple(id_ for words in implements if (id_ := _find_component(checked_project, words)))
    place = element_place.place_for_node(checked_project, components)
    element_adding.add_element(checked_project, place, name, body, dry_run=dry_run)


@command.command("partner")
@click.option("--dry-run", is_flag=True, help="Print the difference and write nothing.")
@shared_options.project_option
@click.option("--reviewers", metavar="HANDLES", help="Who reviews its changes, as CODEOWNERS names them.")
@click.option("--title", metavar="TEXT", help="The title.  [default: made from the ID]")
@click.argument("name", metavar="ID")
def add_partner(name: str, title: str | None, reviewers: str | None, project: Path | None, *, dry_run: bool) -> None:
    """Add a partner, with the file in which it agrees to changes that break it."""
    from archgen.edit import element_place

    checked_project = command_support.check_or_exit(project)
    element_adding.require_free_id(name, "partner", checked_project.architecture.partners)
    body = element_adding.drop_missing(title=element_adding.choose_title(name, title), reviewers=reviewers)
    place = element_place.place_in_section(checked_project, "partners")
    element_adding.add_element(checked_project, place, name, body, dry_run=dry_run)
    if not dry_run:
        _add_agreement_file(checked_project, name, element_adding.choose_title(name, title))


def _add_agreement_file(checked_project: CheckedProject, name: str, title: str) -> None:
    """Write the file of a partner's agreements where the project is a folder; say what is left to do."""
    from archgen.emit import file_tree
    from archgen.model.project_settings import agreement_file
    from archgen.products.editor_schema_marks import SCHEMA_FILE
    from archgen.project import PROJECT_FILE
    from archgen.start.start_templates import fill_agreements

    if checked_project.loaded_project.first_file != PROJECT_FILE:
        return
    path = checked_project.root / agreement_file(name)
    with command_support.explain_write_errors():
        if not path.is_symlink() and not path.exists():
            has_schema = (checked_project.root / SCHEMA_FILE).exists()
            file_tree.write_file(path, fill_agreements(title, has_schema=has_schema))
            command_support.print_written(path, "what it agrees on")
    click.echo(
        "`archgen owners --format codeowners` makes CODEOWNERS anew; `owner:` of a group gives it something to own."
    )


def _find_component(checked_project: CheckedProject, reference: str) -> str | None:
    """Return the component that a reference names, or None: the check of the result says what is wrong with it."""
    from archgen.model.path_resolver import PathResolver

    architecture = checked_project.architecture
    components = {**architecture.components, **architecture.shells}
    match = PathResolver({"component": components}).resolve_path(reference, ["component"])
    return match.unique_element.id if match.unique_element else None
