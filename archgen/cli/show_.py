"""`archgen show`: show an element's card."""

from __future__ import annotations

import textwrap
from pathlib import Path
from typing import TYPE_CHECKING

import click

from archgen.cli import options, run

if TYPE_CHECKING:
    from archgen.views.card import Card


@click.command("show")
@click.argument("words", nargs=-1, required=True)
@options.project_option
def command(words: tuple[str, ...], project: Path | None) -> None:
    """Show each element that WORDS name: ports, readers, nodes, place in the files.

    A word is an id (`object_recognition`, `sensing.rgbd_camera.rgbd`, `/camera/rgbd`, `R-12`), the end of one, or a
    title in quotes.
    """
    from archgen.findings.escape import visible
    from archgen.views import card
    from archgen.views.index import index

    checked = run.check(project)
    view = index(checked.architecture, checked.findings)
    missing = False
    for word in words:
        found = card.matches(view, word)
        for sort, name in found:
            click.echo(laid_out(card.card(view, sort, name)))
        if not found:
            missing = True
            from archgen.suggest import did_you_mean

            guess = did_you_mean(word, [part for key in card.ids(view) for part in (key, key.rpartition(".")[2])])
            click.echo(f"archgen: nothing is called '{visible(word)}'" + (f"; {guess}" if guess else ""), err=True)
    if missing:
        raise click.exceptions.Exit(1)


def laid_out(shown: Card) -> str:
    """Lay out a card for the terminal, with control characters made visible."""
    from archgen.findings.escape import plain_line, visible

    place = f"   {shown.at}" if shown.at.file else ""
    title = f" - {shown.title}" if shown.title != shown.id else ""
    lines = [click.style(visible(f"{shown.sort} {shown.id}{title}"), bold=True) + visible(place)]
    for name, value in shown.facts:
        lines += textwrap.wrap(visible(value), 96, initial_indent=f"  {name + ':':16}", subsequent_indent=" " * 18)
    for name, items in shown.lists:
        lines.append(f"  {name}:" + ("" if items else " none"))
        lines += [f"    {visible(item)}" for item in items]
    return "\n".join(map(plain_line, lines)) + "\n"
