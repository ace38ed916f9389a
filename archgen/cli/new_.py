"""`archgen new`: add an element in the right file in the right form."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

import click

from archgen.cli import options, run

if TYPE_CHECKING:
    from archgen.edit.element import Element
    from archgen.edit.place import Place
    from archgen.pipeline import Checked
    from archgen.source import Span

ROLES = ("source", "filter", "sink", "reactive")
STATUSES = ("planned", "adapted", "existing")


@click.group("new")
def command() -> None:
    """Add a group, a component or a node: in the file where its like stand, in the form that the file has.

    All else in the file stays as it is, byte for byte. Nothing is written where the result would not load, or where
    another element would change; then it says what to write by hand.
    """


def _shared(function: Callable[..., Any]) -> Callable[..., Any]:
    # click lists options in the reverse order of application: the first of these is the last in the help.
    for option in (
        click.option("--dry-run", is_flag=True, help="Print the difference and write nothing."),
        options.project_option,
        click.option("--owner", metavar="PARTNER", help="The partner whose it is."),
        click.option("--title", metavar="TEXT", help="The title.  [default: made from the ID]"),
        click.argument("name", metavar="ID"),
    ):
        function = option(function)
    return function


@command.command("group")
@_shared
def group(name: str, title: str | None, owner: str | None, project: Path | None, *, dry_run: bool) -> None:
    """Add a functional group, in a file of its own where the others have one."""
    from archgen.edit import place
    from archgen.edit.element import Element
    from archgen.model.names import made_title

    checked = run.check(project)
    _free(name, "group", {key: value.at for key, value in checked.architecture.groups.items()})
    body = _given(title=title or made_title(name), owner=owner) | {"description": None, "components": None}
    hints = {"description": "what the group is for", "components": "`archgen new component` adds one"}
    with _placed():
        found = place.of_group(checked, name)
    _add(checked, found, Element(name, body, hints), name, dry_run=dry_run)


@command.command("component")
@click.option("--group", "group_", metavar="GROUP", help="Its group.  [default: the only one]")
@click.option("--role", type=click.Choice(ROLES), help="What it does with data.")
@click.option("--functionality", metavar="TEXT", help="What it does, in a sentence or two.")
@_shared
def component(  # noqa: PLR0913, PLR0917 - one for each option
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
    from archgen.edit import place
    from archgen.edit.element import Element
    from archgen.model.names import made_title

    checked = run.check(project)
    outer, dot, inner = name.rpartition(".")
    if dot and group_ not in {None, outer}:
        msg = f"'{name}' is in the group '{outer}', and --group says '{group_}'"
        raise click.UsageError(msg)
    outer = _group(checked, outer or group_)
    known = {key.partition(".")[2]: c.at for key, c in checked.architecture.components.items() if c.group == outer}
    _free(inner, "component", known)
    body = {
        **_given(title=title or made_title(inner), owner=owner, role=role),
        "functionality": functionality,
        "inputs": None,
        "outputs": None,
    }
    hints = {
        "functionality": "what it does, in a sentence or two",
        "inputs": "id: component.output",
        "outputs": "id: conceptual type",
    }
    _add(checked, place.of_component(checked, outer), Element(inner, body, hints), f"{outer}.{inner}", dry_run=dry_run)


@command.command("node")
@click.option(
    "--implements", metavar="COMPONENT", multiple=True, help="A component that it implements; may be repeated."
)
@click.option("--package", metavar="NAME", help="Its ROS package.")
@click.option("--host", metavar="HOST", help="The computer on which it runs.")
@click.option("--status", type=click.Choice(STATUSES), default="planned", show_default=True)
@_shared
def node(  # noqa: PLR0913, PLR0917 - one for each option
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
    from archgen.edit import place
    from archgen.edit.element import Element

    checked = run.check(project)
    _free(name, "node", {key: value.at for key, value in checked.architecture.nodes.items() if value.written})
    told = implements[0] if len(implements) == 1 else implements or None
    body = _given(implements=told, title=title, owner=owner, package=package, host=host, status=status)
    components = tuple(id_ for words in implements if (id_ := _component(checked, words)))
    _add(checked, place.of_node(checked, components), Element(name, body), name, dry_run=dry_run)


def _given(**keys: Any) -> dict[str, Any]:  # noqa: ANN401 - text, tuples of text, None
    return {key: value for key, value in keys.items() if value is not None}


def _free(name: str, sort: str, known: dict[str, Span]) -> None:
    """Raise UsageError where a text is not a valid id, or the id is taken."""
    from archgen.findings.escape import visible
    from archgen.model import ids

    if not ids.is_id(name):
        better = ids.made(name, sort)
        msg = f"'{visible(name)}' is no id: lower-case words joined by '_', at most 64 characters; write '{better}'"
        raise click.UsageError(msg)
    if name in known:
        msg = f"there is a {sort} '{name}' already: {visible(str(known[name]))}"
        raise click.UsageError(msg)


def _group(checked: Checked, name: str | None) -> str:
    from archgen.findings.escape import visible
    from archgen.suggest import did_you_mean

    groups = checked.architecture.groups
    if name is None and len(groups) == 1:
        return next(iter(groups))
    if name is None:
        msg = f"say in which group with --group: {', '.join(groups)}" if groups else "no group yet: `archgen new group`"
        raise click.UsageError(msg)
    if name not in groups:
        guess = did_you_mean(name, groups) or f"`archgen new group {visible(name)}` makes one"
        msg = f"there is no group '{visible(name)}'; {guess}"
        raise click.UsageError(msg)
    return name


def _component(checked: Checked, words: str) -> str | None:
    """Return the component that a reference names, or None: the check of the result says what is wrong with it."""
    from archgen.model.names import Names

    found = Names({"component": checked.architecture.components}).find(words, ["component"])
    return found.one.id if found.one else None


def _placed() -> Any:  # noqa: ANN401 - a context
    # Made inside, since the exception's module is imported only where something is to be placed.
    from contextlib import contextmanager

    from archgen.edit.place import NoPlaceError

    @contextmanager
    def phrased() -> Any:  # noqa: ANN401 - a generator
        try:
            yield
        except NoPlaceError as error:
            raise click.ClickException(str(error)) from None

    return phrased()


def _add(checked: Checked, place: Place, element: Element, own: str, *, dry_run: bool) -> None:
    from archgen.edit import add
    from archgen.emit import tree
    from archgen.findings.escape import visible

    try:
        edit = add.add(checked, place, element, own)
    except add.RefusedError as error:
        _refuse(checked, error)
    if dry_run:
        sys.stdout.writelines(f"{visible(line)}\n" for line in edit.diff())
        return
    target = (checked.root / edit.file).resolve()
    with run.phrased():
        # `write_file` puts a new file in place of the old one, which would lose its permissions.
        mode = target.stat().st_mode if edit.before is not None else None
        tree.write_file(target, edit.after)
        if mode is not None:
            target.chmod(mode)
    run.wrote(checked.root / edit.file, f"`{own}` at line {edit.line}")
    click.echo("`archgen check` says what it still lacks.")


def _refuse(checked: Checked, error: Any) -> NoReturn:  # noqa: ANN401 - imported where it is needed
    from archgen.findings.escape import visible

    if error.errors:
        run.lines(error.errors, checked, sys.stderr)
    hand = "".join(f"\n{visible(line)}" for line in error.by_hand.split("\n")) if error.by_hand else ""
    msg = f"{visible(error.message)}; nothing was written{hand}"
    raise click.ClickException(msg)
