"""`archgen new`: add an element in the right file in the right form."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn, get_args

import click

from archgen.cli import command_support, shared_options
from archgen.model.component import ComponentRole
from archgen.model.node import NodeStatus

if TYPE_CHECKING:
    from archgen.diagnostics.source_span import Span
    from archgen.edit.element_place import ElementPlace
    from archgen.edit.new_element import NewElement
    from archgen.pipeline import CheckedProject


@click.group("new")
def command() -> None:
    """Add a group, a component, a node or a partner: in the file where its like stand, in the form that the file has.

    All else in the file stays as it is, byte for byte. Nothing is written where the result would not load, or where
    another element would change; then it says what to write by hand.
    """


def _add_shared_options(function: Callable[..., Any]) -> Callable[..., Any]:
    # click lists options in the reverse order of application: the first of these is the last in the help.
    for option in (
        click.option("--dry-run", is_flag=True, help="Print the difference and write nothing."),
        shared_options.project_option,
        click.option("--owner", metavar="PARTNER", help="The partner whose it is."),
        click.option("--title", metavar="TEXT", help="The title.  [default: made from the ID]"),
        click.argument("name", metavar="ID"),
    ):
        function = option(function)
    return function


@command.command("group")
@_add_shared_options
def add_group(name: str, title: str | None, owner: str | None, project: Path | None, *, dry_run: bool) -> None:
    """Add a functional group, in a file of its own where the others have one."""
    from archgen.edit import element_place
    from archgen.edit.new_element import NewElement
    from archgen.model.path_resolver import title_from_id

    checked_project = command_support.check_or_exit(project)
    _require_free_id(name, "group", {key: value.at for key, value in checked_project.architecture.groups.items()})
    body = _drop_missing(title=title or title_from_id(name), owner=owner) | {"description": None, "components": None}
    hints = {"description": "what the group is for", "components": "`archgen new component` adds one"}
    with _explain_no_place():
        target_place = element_place.place_for_group(checked_project, name)
    _add_element(checked_project, target_place, NewElement(name, body, hints), name, dry_run=dry_run)


@command.command("component")
@click.option("--group", "group_", metavar="GROUP", help="Its group.  [default: the only one]")
@click.option("--role", type=click.Choice(get_args(ComponentRole)), help="What it does with data.")
@click.option("--functionality", metavar="TEXT", help="What it does, in a sentence or two.")
@_add_shared_options
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
    """Add a component to a group, in the file that says most of the group. ID may be written GROUP.ID."""
    from archgen.edit import element_place
    from archgen.edit.new_element import NewElement
    from archgen.model.path_resolver import title_from_id

    checked_project = command_support.check_or_exit(project)
    group_id, dot, component_id = name.rpartition(".")
    if dot and group_ not in {None, group_id}:
        msg = f"'{name}' is in the group '{group_id}', and --group says '{group_}'"
        raise click.UsageError(msg)
    group_id = _find_group(checked_project, group_id or group_)
    sibling_spans = {
        key.partition(".")[2]: c.at for key, c in checked_project.architecture.components.items() if c.group == group_id
    }
    _require_free_id(component_id, "component", sibling_spans)
    body = {
        **_drop_missing(title=title or title_from_id(component_id), owner=owner, role=role),
        "functionality": functionality,
        "inputs": None,
        "outputs": None,
    }
    hints = {
        "functionality": "what it does, in a sentence or two",
        "inputs": "id: component.output",
        "outputs": "id: conceptual type",
    }
    _add_element(
        checked_project,
        element_place.place_for_component(checked_project, group_id),
        NewElement(component_id, body, hints),
        f"{group_id}.{component_id}",
        dry_run=dry_run,
    )


@command.command("node")
@click.option(
    "--implements", metavar="COMPONENT", multiple=True, help="A component that it implements; may be repeated."
)
@click.option("--package", metavar="NAME", help="Its ROS package.")
@click.option("--host", metavar="HOST", help="The computer on which it runs.")
@click.option("--status", type=click.Choice(get_args(NodeStatus)), default="planned", show_default=True)
@_add_shared_options
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
    from archgen.edit import element_place
    from archgen.edit.new_element import NewElement

    checked_project = command_support.check_or_exit(project)
    _require_free_id(
        name, "node", {key: value.at for key, value in checked_project.architecture.nodes.items() if value.written}
    )
    implemented = implements[0] if len(implements) == 1 else implements or None
    body = _drop_missing(implements=implemented, title=title, owner=owner, package=package, host=host, status=status)
    components = tuple(id_ for words in implements if (id_ := _find_component(checked_project, words)))
    _add_element(
        checked_project,
        element_place.place_for_node(checked_project, components),
        NewElement(name, body),
        name,
        dry_run=dry_run,
    )


@command.command("partner")
@click.option("--dry-run", is_flag=True, help="Print the difference and write nothing.")
@shared_options.project_option
@click.option("--reviewers", metavar="HANDLES", help="Who reviews its changes, as CODEOWNERS names them.")
@click.option("--title", metavar="TEXT", help="The title.  [default: made from the ID]")
@click.argument("name", metavar="ID")
def add_partner(name: str, title: str | None, reviewers: str | None, project: Path | None, *, dry_run: bool) -> None:
    """Add a partner, with the file in which it agrees to changes that break it."""
    from archgen.edit import element_place
    from archgen.edit.new_element import NewElement
    from archgen.model.path_resolver import title_from_id

    checked_project = command_support.check_or_exit(project)
    _require_free_id(name, "partner", {key: value.at for key, value in checked_project.architecture.partners.items()})
    body = _drop_missing(title=title or title_from_id(name), reviewers=reviewers)
    _add_element(
        checked_project,
        element_place.place_for_partner(checked_project),
        NewElement(name, body),
        name,
        dry_run=dry_run,
    )
    if not dry_run:
        _add_agreement_file(checked_project, name, title or title_from_id(name))


def _add_agreement_file(checked_project: CheckedProject, name: str, title: str) -> None:
    """Write the file of a partner's agreements where the project is a folder; say what is left to do."""
    from archgen.emit import file_tree
    from archgen.model.review_settings import agreement_file
    from archgen.products.schema_renewal import SCHEMA_FILE
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


def _drop_missing(**keys: Any) -> dict[str, Any]:  # noqa: ANN401 - text, tuples of text, None
    return {key: value for key, value in keys.items() if value is not None}


def _require_free_id(element_id: str, kind: str, existing_spans: dict[str, Span]) -> None:
    """Raise UsageError where a text is not a valid id, or the id is taken."""
    from archgen.diagnostics.safe_text import make_visible
    from archgen.model import element_ids

    if not element_ids.is_id(element_id):
        suggestion = element_ids.make_id(element_id, kind)
        msg = f"'{make_visible(element_id)}' is no id: lower-case words joined by '_', at most 64 characters; write '{suggestion}'"
        raise click.UsageError(msg)
    if element_id in existing_spans:
        msg = f"there is a {kind} '{element_id}' already: {make_visible(str(existing_spans[element_id]))}"
        raise click.UsageError(msg)


def _find_group(checked_project: CheckedProject, group_id: str | None) -> str:
    from archgen.diagnostics.safe_text import make_visible
    from archgen.diagnostics.suggestions import did_you_mean

    groups = checked_project.architecture.groups
    if group_id is None and len(groups) == 1:
        return next(iter(groups))
    if group_id is None:
        msg = f"say in which group with --group: {', '.join(groups)}" if groups else "no group yet: `archgen new group`"
        raise click.UsageError(msg)
    if group_id not in groups:
        guess = did_you_mean(group_id, groups) or f"`archgen new group {make_visible(group_id)}` makes one"
        msg = f"there is no group '{make_visible(group_id)}'; {guess}"
        raise click.UsageError(msg)
    return group_id


def _find_component(checked_project: CheckedProject, reference: str) -> str | None:
    """Return the component that a reference names, or None: the check of the result says what is wrong with it."""
    from archgen.model.path_resolver import PathResolver

    match = PathResolver({"component": checked_project.architecture.components}).resolve_path(reference, ["component"])
    return match.unique_element.id if match.unique_element else None


def _explain_no_place() -> Any:  # noqa: ANN401 - a context
    # Made inside, since the exception's module is imported only where something is to be placed.
    from contextlib import contextmanager

    from archgen.edit.element_place import NoPlaceError

    @contextmanager
    def phrased() -> Any:  # noqa: ANN401 - a generator
        try:
            yield
        except NoPlaceError as error:
            raise click.ClickException(str(error)) from None

    return phrased()


def _add_element(
    checked_project: CheckedProject, place: ElementPlace, element: NewElement, full_id: str, *, dry_run: bool
) -> None:
    from archgen.diagnostics.safe_text import make_visible
    from archgen.edit import element_edit
    from archgen.emit import file_tree

    try:
        edit = element_edit.plan_edit(checked_project, place, element, full_id)
    except element_edit.EditRefusedError as error:
        _raise_refusal(checked_project, error)
    if dry_run:
        sys.stdout.writelines(f"{make_visible(line)}\n" for line in edit.unified_diff())
        return
    target = (checked_project.root / edit.file).resolve()
    with command_support.explain_write_errors():
        # `write_file` puts a new file in place of the old one, which would lose its permissions.
        mode = target.stat().st_mode if edit.old_content is not None else None
        file_tree.write_file(target, edit.new_content)
        if mode is not None:
            target.chmod(mode)
    command_support.print_written(checked_project.root / edit.file, f"`{full_id}` at line {edit.line}")
    click.echo("`archgen check` says what it still lacks.")


def _raise_refusal(checked_project: CheckedProject, error: Any) -> NoReturn:  # noqa: ANN401 - imported where it is needed
    from archgen.diagnostics.safe_text import make_visible

    if error.errors:
        command_support.print_findings(error.errors, checked_project, sys.stderr)
    by_hand = "".join(f"\n{make_visible(line)}" for line in error.by_hand.split("\n")) if error.by_hand else ""
    msg = f"{make_visible(error.message)}; nothing was written{by_hand}"
    raise click.ClickException(msg)
