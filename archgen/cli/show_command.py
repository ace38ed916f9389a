"""`archgen show`: show an element's card."""

from __future__ import annotations

import json
import sys
import textwrap
from pathlib import Path
from typing import TYPE_CHECKING

import click

from archgen.cli import command_support, shared_options
from archgen.diagnostics import defuse_command, make_visible, measure_width
from archgen.diagnostics.text_columns import find_width, wrap_line

if TYPE_CHECKING:
    from archgen.views.elements.annotation_facts import ElementCard


_TEXT_WIDTH = 96


@click.command("show")
@click.argument("words", nargs=-1, required=True)
@shared_options.format_option("text", "json")
@shared_options.project_option
@shared_options.variant_option
def command(words: tuple[str, ...], form: str, project: Path | None) -> None:
    """Show each element that WORDS name: ports, readers, nodes, place in the files.

    A word is an id (`object_recognition`, `sensing.rgbd_camera.rgbd`, `/camera/rgbd`, `R-12`), the end of one, or a
    title in quotes.
    """
    from archgen.timing.chains.element_index import unknown_name_text
    from archgen.views.elements import element_card, element_names
    from archgen.views.lookup import add_timing, make_lookup

    checked_project = command_support.check_or_exit(project)
    lookup = make_lookup(checked_project.architecture, checked_project.findings)
    timed_kinds = {kind for word in words for kind, _ in element_names.find_elements(lookup, word)}
    is_timed = checked_project.analysis is not None or checked_project.architecture.chains
    if is_timed and not timed_kinds.isdisjoint({"requirement", "chain", "composed", "use case", "component", "node"}):
        # Only these say how often and how late; the bounds of chains take longer than all else here.
        from archgen.views.timing.timing_lookup import complete_with_chains

        lookup = add_timing(lookup, complete_with_chains(checked_project.analysis, checked_project.architecture))
    unknown_words = []
    cards: list[ElementCard] = []
    for word in words:
        matches = element_names.find_elements(lookup, word)
        cards += [element_card.make_card(lookup, kind, name) for kind, name in matches]
        if not matches:
            unknown_words.append(unknown_name_text(word, element_names.kinds_by_id(lookup)))
    if form == "json":
        click.echo(json.dumps([_card_to_data(card) for card in cards], ensure_ascii=False, indent=2))
    for card in cards if form == "text" else ():
        click.echo(format_card(card, find_width(sys.stdout)))
    if unknown_words:
        raise click.UsageError(make_visible("\n".join(unknown_words)))


def _card_to_data(card: ElementCard) -> dict[str, object]:
    place = {"file": card.span.file, "line": card.span.line, "column": card.span.column} if card.span.file else None
    return {
        "kind": card.kind,
        "id": card.id,
        "title": card.title,
        "place": place,
        "facts": dict(card.facts),
        "lists": {name: list(items) for name, items in card.lists},
    }


def format_card(card: ElementCard, width: int | None = None) -> str:
    """Lay out a card for the terminal, with control characters made visible."""
    text_width = min(width or _TEXT_WIDTH, _TEXT_WIDTH)
    span_text = f"   {card.span}" if card.span.file else ""
    title = f" - {card.title}" if card.title != card.id else ""
    name, *further_lines = wrap_line(make_visible(f"{card.kind} {card.id}{title}"), width)
    lines = [click.style(name, bold=True), *further_lines]
    # The place stands behind the name where there is room for it, else below.
    joined_line = f"{lines[-1]}{make_visible(span_text)}"
    has_room = width is None or measure_width(further_lines[-1] if further_lines else name) + len(span_text) <= width
    lines[-1:] = [joined_line] if has_room else [lines[-1], *wrap_line(make_visible(span_text), width)]
    for name, value in card.facts:
        lines += textwrap.wrap(
            make_visible(value), text_width, initial_indent=f"  {name + ':':15} ", subsequent_indent=" " * 18
        )
    for name, items in card.lists:
        lines.append(f"  {name}:" + ("" if items else " none"))
        lines += [line for item in items for line in wrap_line(f"    {make_visible(item)}", width)]
    return "\n".join(map(defuse_command, lines)) + "\n"
