"""`archgen show`: show an element's card."""

from __future__ import annotations

import textwrap
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import click

from archgen.cli import command_support, shared_options

if TYPE_CHECKING:
    from archgen.views.elements.element_card import ElementCard


@click.command("show")
@click.argument("words", nargs=-1, required=True)
@shared_options.project_option
def command(words: tuple[str, ...], project: Path | None) -> None:
    """Show each element that WORDS name: ports, readers, nodes, place in the files.

    A word is an id (`object_recognition`, `sensing.rgbd_camera.rgbd`, `/camera/rgbd`, `R-12`), the end of one, or a
    title in quotes.
    """
    from archgen.diagnostics.safe_text import make_visible
    from archgen.views.elements import element_card
    from archgen.views.lookup import make_lookup

    checked_project = command_support.check_or_exit(project)
    lookup = make_lookup(checked_project.architecture, checked_project.findings)
    timed_kinds = {kind for word in words for kind, _ in element_card.find_elements(lookup, word)}
    if checked_project.analysis is not None and not timed_kinds.isdisjoint({"requirement", "chain"}):
        # Only these say whether deadlines are met; the bounds of chains take longer than all else here.
        from archgen.timing.chains.chain_bounds import bound_all_chains
        from archgen.views.timing.timing_lookup import make_timing_lookup

        chain_results = bound_all_chains(checked_project.analysis, checked_project.architecture).values()
        lookup = replace(lookup, timing=make_timing_lookup(checked_project.analysis, chain_results))
    any_missing = False
    for word in words:
        matches = element_card.find_elements(lookup, word)
        for kind, name in matches:
            click.echo(format_card(element_card.make_card(lookup, kind, name)))
        if not matches:
            any_missing = True
            from archgen.diagnostics.suggestions import did_you_mean

            guess = did_you_mean(
                word, [part for key in element_card.kinds_by_id(lookup) for part in (key, key.rpartition(".")[2])]
            )
            click.echo(f"archgen: nothing is called '{make_visible(word)}'" + (f"; {guess}" if guess else ""), err=True)
    if any_missing:
        raise click.exceptions.Exit(1)


def format_card(card: ElementCard) -> str:
    """Lay out a card for the terminal, with control characters made visible."""
    from archgen.diagnostics.safe_text import defuse_command, make_visible

    span_text = f"   {card.span}" if card.span.file else ""
    title = f" - {card.title}" if card.title != card.id else ""
    lines = [click.style(make_visible(f"{card.kind} {card.id}{title}"), bold=True) + make_visible(span_text)]
    for name, value in card.facts:
        lines += textwrap.wrap(make_visible(value), 96, initial_indent=f"  {name + ':':16}", subsequent_indent=" " * 18)
    for name, items in card.lists:
        lines.append(f"  {name}:" + ("" if items else " none"))
        lines += [f"    {make_visible(item)}" for item in items]
    return "\n".join(map(defuse_command, lines)) + "\n"
