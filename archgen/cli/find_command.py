"""`archgen find`: what some words name or what is said with them, the best first."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

import click

from archgen.cli import command_support, shared_options
from archgen.diagnostics import make_visible
from archgen.diagnostics.text_columns import align_rows, find_width

if TYPE_CHECKING:
    from archgen.views.search.search_entry import SearchEntry


@click.command("find")
@click.argument("words", nargs=-1, required=True)
@shared_options.format_option("text", "json")
@shared_options.project_option
@shared_options.variant_option
def command(words: tuple[str, ...], form: str, project: Path | None) -> None:
    """Find what WORDS name, or what is said with them: ids, titles, topics, messages with their fields, texts, findings.

    All words must stand in it, as wholes or as parts, in any case of letters; those of questions are left out ("who reads
    the pose"). What is called so comes first. The exit status is 1 where nothing is found. `archgen find pose base`
    """
    from archgen.views.lookup import make_lookup
    from archgen.views.search import make_search_entries
    from archgen.views.search.entry_ranking import rank_entries

    checked_project = command_support.check_or_exit(project)
    entries = make_search_entries(make_lookup(checked_project.architecture, checked_project.findings), ())
    found = rank_entries(entries, [part for word in words for part in word.split()])
    if form == "json":
        from archgen.emit.data.answers_json import format_found_json

        sys.stdout.write(format_found_json(words, found))
    else:
        rows = ((entry.kind, make_visible(_name_entry(entry)), make_visible(entry.line)) for entry in found)
        for line in align_rows(rows, find_width(sys.stdout), indent=""):
            click.echo(line)
        if not found:
            click.echo("nothing is called or described so")
    sys.exit(0 if found else 1)


def _name_entry(entry: SearchEntry) -> str:
    return entry.title if entry.name == entry.title else f"{entry.title} ({entry.name})"
