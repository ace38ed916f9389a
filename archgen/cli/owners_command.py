"""`archgen owners`: show who owns what, or write CODEOWNERS."""

from __future__ import annotations

import sys
import textwrap
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import click

from archgen.cli import command_support, shared_options
from archgen.diagnostics.diagnostic import Severity

if TYPE_CHECKING:
    from archgen.views.partner_ownership import Ownership, OwnershipShare


@click.command("owners")
@shared_options.project_argument
@click.option("--format", "form", type=click.Choice(["text", "codeowners"]), default="text", show_default=True)
@click.option("-o", "--output", type=click.Path(path_type=Path), help="The file to write.  [default: the terminal]")
@shared_options.keep_going_option
def command(project: Path | None, form: str, output: Path | None, *, keep_going: bool) -> None:
    """Show which partner of PROJECT owns which elements and files, and what nobody owns.

    With `--format codeowners` it is the file CODEOWNERS, which asks the owners of a changed file for their review. Who
    that is stands in `reviewers` of each partner. `archgen owners --format codeowners -o .github/CODEOWNERS`
    """
    from archgen.products import code_ownership

    if form == "codeowners":
        checked_project = command_support.check_before_writing(project, keep_going=keep_going)
        codeowners_file = code_ownership.make_codeowners(checked_project)
        for warning in codeowners_file.warnings:
            command_support.print_warning(warning)
        text = codeowners_file.text
    else:
        checked_project = command_support.check_or_exit(project)
        command_support.print_findings_above(checked_project, lowest_severity=Severity.ERROR)
        text = _format_ownership(code_ownership.find_ownership(checked_project))
    if output is None:
        sys.stdout.write(text)
    else:
        from archgen.emit import file_tree

        with command_support.explain_write_errors():
            file_tree.write_file(output, text.encode())
        command_support.print_written(output)
    command_support.exit_by_findings(checked_project)


def _format_ownership(ownership: Ownership) -> str:
    from archgen.diagnostics.safe_text import defuse_command, make_visible

    lines = [f"{'Partner':32}{'groups':>9}{'components':>12}{'nodes':>8}{'files':>8}  reviewers"]
    owned_parts = [
        *ownership.partners,
        *([ownership.nobody] if any(ownership.nobody.elements.values()) or ownership.nobody.files else []),
    ]
    lines += [_format_owner_row(owned) for owned in owned_parts]
    for owned in owned_parts:
        lines += ["", *_list_elements(owned)]
    return "".join(f"{defuse_command(make_visible(line))}\n" for line in lines)


def _format_owner_row(owned: OwnershipShare) -> str:
    name = f"{owned.partner.title} ({owned.partner.id})" if owned.partner else "(nobody)"
    counts = [len(each) for each in owned.elements.values()]
    reviewers = ", ".join(owned.partner.reviewers) if owned.partner else ""
    figures = f"{counts[0]:>9}{counts[1]:>12}{counts[2]:>8}{len(owned.files):>8}"
    return f"{name[:31]:32}{figures}  {reviewers}".rstrip()


def _list_elements(owned: OwnershipShare) -> Iterator[str]:
    yield f"{owned.partner.title}:" if owned.partner else "Nobody owns:"
    for name, items in (*((f"{sort}s", ids) for sort, ids in owned.elements.items()), ("files", owned.files)):
        if items:
            joined_items = ", ".join(items)
            yield from textwrap.wrap(
                joined_items,
                96,
                initial_indent=f"  {name + ':':12}",
                subsequent_indent=" " * 14,
                break_on_hyphens=False,
            )
