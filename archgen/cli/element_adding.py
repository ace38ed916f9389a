"""What the verbs of `archgen new` share: their options, ids that are free, and the edit that is proven before it is written."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, NoReturn

import click

from archgen.cli import command_support, shared_options
from archgen.diagnostics import did_you_mean, make_visible

if TYPE_CHECKING:
    from archgen.diagnostics import Span
    from archgen.edit.element_place import ElementPlace
    from archgen.model.component import Component
    from archgen.pipeline import CheckedProject


def add_shared_options(function: Callable[..., Any]) -> Callable[..., Any]:
    """Add the options that all verbs share but `new partner`, and the argument ID."""
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


def drop_missing(**keys: Any) -> dict[str, Any]:  # noqa: ANN401 - text, tuples of text, None
    """Return the keys that have a value."""
    return {key: value for key, value in keys.items() if value is not None}


def choose_title(element_id: str, title: str | None) -> str:
    """Return the title that is asked for, else one that is made from the id."""
    from archgen.model.path_resolver import title_from_id

    return title or title_from_id(element_id)


def require_free_id(element_id: str, kind: str, elements: Mapping[str, Any]) -> None:
    """Raise UsageError where a text is not a valid id, or the id is taken."""
    from archgen.model import element_ids

    if not element_ids.is_id(element_id):
        suggestion = element_ids.make_id(element_id, kind)
        msg = f"'{make_visible(element_id)}' is no id: lower-case words joined by '_', at most 64 characters; write '{suggestion}'"
        raise click.UsageError(msg)
    if element_id in elements:
        msg = f"there is a {kind} '{element_id}' already: {make_visible(str(elements[element_id].at))}"
        raise click.UsageError(msg)


def find_group(checked_project: CheckedProject, group_id: str | None) -> str:
    """Return a group by its id, or the only one. Raise UsageError."""
    groups = checked_project.architecture.groups
    if group_id is None and len(groups) == 1:
        return next(iter(groups))
    if group_id is None:
        msg = f"say in which group with --group: {', '.join(groups)}" if groups else "no group yet: `archgen new group`"
        raise click.UsageError(msg)
    if group_id not in groups:
        guess = did_you_mean(group_id, groups) or f"`archgen new group {make_visible(group_id)}` makes one"
        raise click.UsageError(f"there is no group '{make_visible(group_id)}'; {guess}")
    return group_id


def find_place_of_component(checked_project: CheckedProject, name: str, group: str | None) -> tuple[str, str]:
    """Return what takes a new component (a group, or a composed component) and its id there. Raise UsageError."""
    holder_id, dot, component_id = name.rpartition(".")
    if dot and group not in {None, holder_id}:
        raise click.UsageError(f"'{name}' is in the group '{holder_id}', and --group says '{group}'")
    holder_id = _find_holder(checked_project, holder_id or group)
    architecture = checked_project.architecture
    siblings = {
        component.id.rpartition(".")[2]: component
        for component in architecture.list_described_components()
        if (component.parent or component.group) == holder_id
    }
    require_free_id(component_id, "component", siblings)
    return holder_id, component_id


def _find_holder(checked_project: CheckedProject, holder_id: str | None) -> str:
    """Return the group, or the composed component, of this complete id. Raise UsageError."""
    if holder_id is None or "." not in holder_id:
        return find_group(checked_project, holder_id)
    architecture = checked_project.architecture
    holder = architecture.find_component(holder_id)
    if holder is None:
        _find_holder(checked_project, holder_id.rpartition(".")[0])
        guess = did_you_mean(holder_id, architecture.shells) or f"`archgen new component {make_visible(holder_id)}`"
        raise click.UsageError(f"there is no component '{make_visible(holder_id)}'; {guess}")
    instance = next((each for each in (holder, *architecture.list_around(holder)) if each.component_type), None)
    if instance is not None:
        raise click.UsageError(
            f"'{instance.id}' is an instance of the type '{make_visible(instance.component_type or '')}', which says "
            f"what is inside; add it to the type: {make_visible(str(_find_type_span(checked_project, instance)))}"
        )
    if holder_id not in architecture.shells:
        msg = f"'{holder_id}' holds no components yet; write `components:` with the first one below it: {make_visible(str(holder.at))}"
        raise click.UsageError(msg)
    return holder_id


def _find_type_span(checked_project: CheckedProject, instance: Component) -> Span:
    component_type = checked_project.architecture.component_types.get(instance.type_name)
    return component_type.at if component_type else instance.at


def add_element(  # noqa: PLR0913, PLR0917 - what is written, and where
    checked_project: CheckedProject,
    place: ElementPlace,
    element_id: str,
    body: dict[str, Any],
    hints: dict[str, str] | None = None,
    holder_id: str = "",
    *,
    dry_run: bool,
) -> None:
    """Write an element to its place, or print the difference; refuse what is not proven. `hints` say what an open key takes."""
    from archgen.edit import element_edit
    from archgen.edit.edit_proof import NewElement

    full_id = f"{holder_id}.{element_id}" if holder_id else element_id
    try:
        edit = element_edit.plan_edit(checked_project, place, NewElement(element_id, body, hints or {}), full_id)
    except element_edit.EditRefusedError as error:
        raise_refusal(checked_project, error)
    for old_id, new_id in edit.renamed_nodes:
        click.echo(f"the node `{old_id}` gets the id `{new_id}`, since its id follows from its component", err=True)
    if dry_run:
        command_support.print_diff(edit)
        return
    command_support.write_edit(checked_project.root, edit, f"`{full_id}` at line {edit.line}")
    click.echo("`archgen check` says what it still lacks.")


def raise_refusal(checked_project: CheckedProject, error: Any) -> NoReturn:  # noqa: ANN401 - imported where it is needed
    """Print why an edit is refused, and what to do, and end."""
    if error.errors:
        command_support.print_findings(error.errors, checked_project, sys.stderr)
    by_hand = "".join(f"\n{make_visible(line)}" for line in error.by_hand.split("\n")) if error.by_hand else ""
    raise click.ClickException(f"{make_visible(error.message)}; nothing was written{by_hand}")
