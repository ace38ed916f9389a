"""`archgen owners`: show who owns what, or write CODEOWNERS."""

from __future__ import annotations

import sys
import textwrap
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import click

from archgen.cli import command_support, shared_options
from archgen.diagnostics import Severity, defuse_command, make_visible
from archgen.diagnostics.text_columns import find_width, format_table

if TYPE_CHECKING:
    from archgen.views.partner_ownership import Ownership, OwnershipShare


_TEXT_WIDTH = 96


@click.command("owners")
@shared_options.project_argument
@shared_options.variant_option
@shared_options.format_option("text", "codeowners", "json")
@shared_options.file_option("The file to write.  [default: the terminal]")
@shared_options.keep_going_option
def command(project: Path | None, form: str, output: Path | None, *, keep_going: bool) -> None:
    """Show which partner of PROJECT owns which elements and files, and what nobody owns.

    With `--format codeowners` it is the file CODEOWNERS, which asks the owners of a changed file for their review. Who
    that is stands in `reviewers` of each partner. `archgen owners --format codeowners -o .github/CODEOWNERS`
    """
    from archgen.checking import code_ownership

    if form == "codeowners":
        checked_project = command_support.check_before_writing(project, keep_going=keep_going)
        codeowners_file = code_ownership.make_codeowners(checked_project)
        for warning in codeowners_file.warnings:
            command_support.print_warning(warning)
        text = codeowners_file.text
    else:
        checked_project = command_support.check_or_exit(project)
        command_support.print_findings_above(checked_project, lowest_severity=Severity.ERROR)
        ownership = code_ownership.find_ownership(checked_project)
        if form == "json":
            from archgen.emit.data.answers_json import format_ownership_json

            text = format_ownership_json(ownership)
        else:
            text = _format_ownership(ownership, find_width(sys.stdout) if output is None else None)
    with command_support.explain_write_errors():
        command_support.write_output(text, output)
    command_support.exit_by_findings(checked_project)


def _format_ownership(ownership: Ownership, width: int | None) -> str:
    owned_parts = [
        *ownership.partners,
        *([ownership.nobody] if any(ownership.nobody.elements.values()) or ownership.nobody.files else []),
    ]
    headings = ("Partner", *(f"{sort}s" for sort in ownership.nobody.elements), "files", "reviewers")
    lines = list(format_table(headings, map(_make_owner_row, owned_parts), width, has_figures=True))
    for owned in owned_parts:
        title = f"{owned.partner.title}:" if owned.partner else "Nobody owns:"
        lists = {**{f"{sort}s": ids for sort, ids in owned.elements.items()}, "files": owned.files}
        lines += ["", title, *_wrap_lists(lists, width)]
    if ownership.shared_files:
        lines += ["", "All partners share:", *_wrap_lists({"files": ownership.shared_files}, width)]
    return "".join(f"{defuse_command(make_visible(line))}\n" for line in lines)


def _make_owner_row(owned: OwnershipShare) -> tuple[str, ...]:
    name = f"{owned.partner.title} ({owned.partner.id})" if owned.partner else "(nobody)"
    reviewers = ", ".join(owned.partner.reviewers) if owned.partner else ""
    return name, *(str(len(each)) for each in (*owned.elements.values(), owned.files)), reviewers


def _wrap_lists(lists: Mapping[str, tuple[str, ...]], width: int | None) -> Iterator[str]:
    for name, items in lists.items():
        if items:
            yield from textwrap.wrap(
                ", ".join(items),
                min(width or _TEXT_WIDTH, _TEXT_WIDTH),
                initial_indent=f"  {name + ':':12}",
                subsequent_indent=" " * 14,
                break_on_hyphens=False,
            )
