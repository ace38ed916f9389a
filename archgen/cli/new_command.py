"""`archgen new`: add an element in the right file in the right form."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, get_args

import click

from archgen.cli import command_support, element_adding, new_instance, shared_options
from archgen.model.component import ComponentRole
from archgen.model.node import NodeStatus

if TYPE_CHECKING:
    from archgen.pipeline import CheckedProject


@click.group("new")
def command() -> None:
    """Add a group, a component, a type of components, an instance of one, a node, a partner or a variant.

    It goes into the file where its like stand, in the form that the file has. All else in the file stays as it is,
    byte for byte. Nothing is written where the result would not load, or where another element would change; then it
    says what to write by hand.
    """


command.add_command(new_instance.add_type)
command.add_command(new_instance.add_instance)
command.add_command(new_instance.add_variant)


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
    from archgen.model.review_settings import agreement_file
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
