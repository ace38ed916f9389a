"""Ask the questions of `archgen init`: what no flag has answered. Enter takes the default; Ctrl-C leaves nothing
behind.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TypeVar

import click

from archgen.start import answers
from archgen.start.answers import Answers, Forge, Group, Partner

T = TypeVar("T")
FORGES: tuple[Forge, ...] = ("github", "gitlab", "none")


def ask(given: Answers, said: frozenset[str], distros: tuple[str, ...]) -> Answers:
    """Ask for everything that no flag has answered. `answered` has the flags' names."""
    click.echo("A few questions; Enter takes what stands in brackets, Ctrl-C leaves everything as it is.\n")
    title = given.title if "title" in said else click.prompt("Title of the project", default=given.title).strip()
    distro = given.distro
    if "distro" not in said:
        distro = click.prompt("ROS distribution", default=distro, type=click.Choice(distros))
    partners = given.partners if "partner" in said else _partners()
    groups = given.groups if "group" in said else _groups(given.groups, partners)
    forge = given.forge
    if "ci" not in said:
        forge = click.prompt("Where is it reviewed", default=forge, type=click.Choice(FORGES))
    return replace(given, title=title, distro=distro, partners=partners, groups=groups, forge=forge)


def _partners() -> tuple[Partner, ...]:
    click.echo("\nPartners, one after the other: an id, optionally `id = Title`, and who reviews for them: @handle.")
    found: list[Partner] = []

    def read(words: str) -> Partner | None:
        made = answers.partner(words) if words.strip() else None
        answers.distinct([*found, *([made] if made else [])], "partner")
        return made

    while one := _until(f"Partner {len(found) + 1}, Enter for none" if not found else "Next, Enter to go on", "", read):
        found.append(one)
    return tuple(found)


def _groups(default: tuple[Group, ...], partners: tuple[Partner, ...]) -> tuple[Group, ...]:
    def read(words: str) -> tuple[Group, ...]:
        made = tuple(answers.group(part, ()) for part in words.split(",") if part.strip())
        answers.distinct(made, "group")
        return made or default

    found = _until("\nFirst functional groups, with commas between", ", ".join(group.id for group in default), read)
    if not partners:
        return found
    choice = click.Choice([partner.id for partner in partners])
    first = partners[0].id
    return tuple(
        replace(group, owner=click.prompt(f"Owner of {group.title}", default=first, type=choice)) for group in found
    )


def _until(question: str, default: str, read: Callable[[str], T]) -> T:
    """Ask until the answer can be parsed."""

    def checked(words: str) -> T:
        try:
            return read(words)
        except ValueError as error:
            # click asks again after a UsageError of a `value_proc`.
            raise click.UsageError(str(error)) from None

    answer: T = click.prompt(question, default=default, show_default=bool(default), value_proc=checked)
    return answer
