"""`archgen diff`: compare two versions of an architecture."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import click

from archgen.cli import options, run

if TYPE_CHECKING:
    from archgen.compare import Comparison
    from archgen.outputs import Ask
    from archgen.sides import Side

Write = Callable[["Comparison", "Side", "Side"], str | bytes]


def _sides(before: str | None, after: str | None, project: Path | None) -> tuple[Side, Side]:
    """Read both versions. What cannot be found is wrong usage."""
    from archgen.findings.escape import visible
    from archgen.git import GitError
    from archgen.project import ProjectNotFoundError
    from archgen.sides import sides

    try:
        return sides(before, after, project)
    except (GitError, ProjectNotFoundError) as error:
        raise click.UsageError(visible(str(error))) from None


def _selected(found: Comparison, old: Side, new: Side, words: str | None) -> Comparison:
    """Keep what touches the selected part of either version. What only one version has is selected there alone."""
    from archgen import outputs
    from archgen.compare.selected import selected
    from archgen.findings.escape import visible
    from archgen.model.selector import Selection

    if words is None:
        return found
    (one, wrong), (other, wrong_too) = (outputs.select(side.checked, words) for side in (old, new))
    # A word that names nothing in one version may name something in the other: only what is wrong in both is wrong.
    problems = [problem for problem in wrong_too if problem.message in {each.message for each in wrong}]
    for problem in problems:
        click.echo(visible(f"{problem.severity}: {problem.message}"), err=True)
        if problem.help:
            click.echo(visible(f"  = help: {problem.help}"), err=True)
    if any(problem.severity == "error" for problem in problems):
        msg = f"the selector '{visible(words)}' cannot be used"
        raise click.UsageError(msg)
    return selected(found, one or Selection(), other or Selection())


def _text(found: Comparison, old: Side, new: Side) -> str:
    from archgen.findings import diff_text
    from archgen.findings.text import wants_colour

    colour = wants_colour(sys.stdout, os.environ)
    lines = [*_broken(old), *_broken(new), *diff_text.render(found, colour=colour)]
    return "".join(f"{line}\n" for line in lines)


def _broken(side: Side) -> list[str]:
    """Return lines that say what of a version could not be read."""
    from archgen.findings import text
    from archgen.findings.escape import visible

    errors = side.checked.unsound
    if not errors:
        return []
    colour = text.wants_colour(sys.stdout, os.environ)
    heading = visible(f"{side.name} is not sound; what could not be read there is left out of the comparison:")
    return [heading, "", *text.render(errors, side.checked.sources, colour=colour), ""]


def _json(found: Comparison, old: Side, new: Side) -> str:
    from archgen.findings import diff_json

    return diff_json.render(found, (old.checked.unsound, new.checked.unsound))


def _markdown(found: Comparison, old: Side, new: Side) -> str:
    from archgen import changes

    return changes.markdown(found, old, new)


def _html(found: Comparison, old: Side, new: Side) -> bytes:
    from archgen import changes

    return changes.html(found, old, new, _ask())


def _svg(found: Comparison, _old: Side, _new: Side) -> bytes:
    from archgen import changes

    return changes.svg(found, _ask())


def _ask() -> Ask:
    from archgen import outputs

    return outputs.Ask(warn=run.warn)


FORMATS: Mapping[str, Write] = {"text": _text, "json": _json, "markdown": _markdown, "html": _html, "svg": _svg}
"""The functions that write a comparison, by the name of the format."""


def _put(made: str | bytes, output: Path | None) -> None:
    """Write a document to a file, all of it or nothing, or to standard output."""
    from archgen.emit import tree

    if output is not None:
        # Colours depend on the terminal, and belong into no file.
        tree.write_file(output, made if isinstance(made, bytes) else click.unstyle(made).encode())
        run.wrote(output)
    elif isinstance(made, bytes):
        sys.stdout.buffer.write(made)
    else:
        sys.stdout.write(made)


@click.command("diff")
@click.argument("before", required=False, metavar="[A]")
@click.argument("after", required=False, metavar="[B]")
@click.option("--format", "form", type=click.Choice(list(FORMATS)), default="text", show_default=True)
@click.option(
    "--breaking", is_flag=True, help="Show only what breaks another partner; end with 1 where the project forbids it."
)
@click.option("-o", "--output", type=click.Path(path_type=Path), help="The file to write.  [default: standard output]")
@click.option("--exit-code", is_flag=True, help="End with 1 if there are changes, with 0 if there are none.")
@options.select
@options.project_option
def command(  # noqa: PLR0913 - the options of the verb, each by its name
    before: str | None,
    after: str | None,
    form: str,
    *,
    breaking: bool,
    output: Path | None,
    exit_code: bool,
    select: str | None,
    project: Path | None,
) -> None:
    """Compare two versions of the architecture: models, not lines.

    A and B are revisions of git (`main`, `v1.2`, `HEAD~3`), folders, or single or packed files. B left out is the working
    tree; A left out is the commit at which the branch left its main line. `A..B` and `A...B` mean what they mean to git.
    Order, comments, formatting and moves between files are no changes.
    """
    from archgen import sides
    from archgen.compare.breaking import only

    old, new = _sides(before, after, project)
    found = _selected(sides.compared(old, new), old, new, select)
    if breaking:
        found = only(found)
    with run.phrased():
        _put(FORMATS[form](found, old, new), output)
    sys.exit(1 if (exit_code and not found.empty) or (breaking and found.failing) else 0)
