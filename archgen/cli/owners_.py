"""`archgen owners`: show who owns what, or write CODEOWNERS."""

from __future__ import annotations

import sys
import textwrap
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import click

from archgen.cli import options, run

if TYPE_CHECKING:
    from archgen.views.owners import Owned, Ownership


@click.command("owners")
@options.project
@click.option("--format", "form", type=click.Choice(["text", "codeowners"]), default="text", show_default=True)
@click.option("-o", "--output", type=click.Path(path_type=Path), help="The file to write.  [default: the terminal]")
@options.keep_going
def command(project: Path | None, form: str, output: Path | None, *, keep_going: bool) -> None:
    """Show which partner of PROJECT owns which elements and files, and what nobody owns.

    With `--format codeowners` it is the file CODEOWNERS, which asks the owners of a changed file for their review. Who
    that is stands in `reviewers` of each partner. `archgen owners --format codeowners -o .github/CODEOWNERS`
    """
    from archgen import ownership

    if form == "codeowners":
        checked = run.ready(project, keep_going=keep_going)
        made = ownership.codeowners(checked)
        for warning in made.warnings:
            run.warn(warning)
        text = made.text
    else:
        checked = run.check(project)
        run.report(checked, least=run.ERROR)
        text = _text(ownership.ownership(checked))
    if output is None:
        sys.stdout.write(text)
    else:
        from archgen.emit import tree

        with run.phrased():
            tree.write_file(output, text.encode())
        run.wrote(output)
    run.finish(checked)


def _text(found: Ownership) -> str:
    from archgen.findings.escape import plain_line, visible

    lines = [f"{'Partner':32}{'groups':>9}{'components':>12}{'nodes':>8}{'files':>8}  reviewers"]
    rows = [*found.partners, *([found.nobody] if any(found.nobody.elements.values()) or found.nobody.files else [])]
    lines += [_row(owned) for owned in rows]
    for owned in rows:
        lines += ["", *_listed(owned)]
    return "".join(f"{plain_line(visible(line))}\n" for line in lines)


def _row(owned: Owned) -> str:
    name = f"{owned.partner.title} ({owned.partner.id})" if owned.partner else "(nobody)"
    counts = [len(each) for each in owned.elements.values()]
    reviewers = ", ".join(owned.partner.reviewers) if owned.partner else ""
    figures = f"{counts[0]:>9}{counts[1]:>12}{counts[2]:>8}{len(owned.files):>8}"
    return f"{name[:31]:32}{figures}  {reviewers}".rstrip()


def _listed(owned: Owned) -> Iterator[str]:
    yield f"{owned.partner.title}:" if owned.partner else "Nobody owns:"
    for name, items in (*((f"{sort}s", ids) for sort, ids in owned.elements.items()), ("files", owned.files)):
        if items:
            said = ", ".join(items)
            yield from textwrap.wrap(
                said, 96, initial_indent=f"  {name + ':':12}", subsequent_indent=" " * 14, break_on_hyphens=False
            )
