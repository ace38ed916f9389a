"""Ask the questions of `archgen init`: what no flag has answered. Enter takes the default; Ctrl-C leaves nothing
behind.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

import click

from archgen.frozen import replace
from archgen.start import start_answers
from archgen.start.start_answers import ForgeName, GroupAnswer, PartnerAnswer, StartAnswers

T = TypeVar("T")
FORGE_CHOICES: tuple[ForgeName, ...] = ("github", "gitlab", "none")


def ask_questions(defaults: StartAnswers, answered: frozenset[str], distros: tuple[str, ...]) -> StartAnswers:
    """Ask for everything that no flag has answered. `answered` has the flags' names."""
    click.echo("A few questions; Enter takes what stands in brackets, Ctrl-C leaves everything as it is.\n")
    title = (
        defaults.title if "title" in answered else click.prompt("Title of the project", default=defaults.title).strip()
    )
    distro = defaults.distro
    if "distro" not in answered:
        distro = click.prompt("ROS distribution", default=distro, type=click.Choice(distros))
    partners = defaults.partners if "partner" in answered else _ask_partners()
    groups = defaults.groups if "group" in answered else _ask_groups(defaults.groups, partners)
    forge = defaults.forge
    if "ci" not in answered:
        forge = click.prompt("Where is it reviewed", default=forge, type=click.Choice(FORGE_CHOICES))
    return replace(defaults, title=title, distro=distro, partners=partners, groups=groups, forge=forge)


def _ask_partners() -> tuple[PartnerAnswer, ...]:
    click.echo("\nPartners, one after the other: an id, optionally `id = Title`, and who reviews for them: @handle.")
    partners: list[PartnerAnswer] = []

    def read_partner(words: str) -> PartnerAnswer | None:
        made = start_answers.parse_partner(words) if words.strip() else None
        start_answers.require_distinct([*partners, *([made] if made else [])], "partner")
        return made

    while new_partner := _ask_until(
        f"Partner {len(partners) + 1}, Enter for none" if not partners else "Next, Enter to go on", "", read_partner
    ):
        partners.append(new_partner)
    return tuple(partners)


def _ask_groups(default: tuple[GroupAnswer, ...], partners: tuple[PartnerAnswer, ...]) -> tuple[GroupAnswer, ...]:
    def read_groups(words: str) -> tuple[GroupAnswer, ...]:
        made = tuple(start_answers.parse_group(part, ()) for part in words.split(",") if part.strip())
        start_answers.require_distinct(made, "group")
        return made or default

    chosen_groups = _ask_until(
        "\nFirst functional groups, with commas between", ", ".join(group.id for group in default), read_groups
    )
    if not partners:
        return chosen_groups
    choice = click.Choice([partner.id for partner in partners])
    first = partners[0].id
    return tuple(
        replace(group, owner=click.prompt(f"Owner of {group.title}", default=first, type=choice))
        for group in chosen_groups
    )


def _ask_until(question: str, default: str, read_answer: Callable[[str], T]) -> T:
    """Ask until the answer can be parsed."""

    def parse_answer(words: str) -> T:
        try:
            return read_answer(words)
        except ValueError as error:
            # click asks again after a UsageError of a `value_proc`.
            raise click.UsageError(str(error)) from None

    answer: T = click.prompt(question, default=default, show_default=bool(default), value_proc=parse_answer)
    return answer
