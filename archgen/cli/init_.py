"""`archgen init`: start a project, from answers or from a spreadsheet."""

from __future__ import annotations

import os
import shlex
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from archgen.cli import run

if TYPE_CHECKING:
    from collections.abc import Mapping

    from archgen.importers import Imported
    from archgen.pipeline import Checked
    from archgen.start.answers import Answers
    from archgen.start.plan import Plan

DISTROS = ("jazzy", "kilted", "humble", "rolling", "noetic")


@click.command("init")
@click.argument("folder", required=False, type=click.Path(file_okay=False, path_type=Path))
@click.option("--title", metavar="TEXT", help="The project's title.  [default: made from the folder's name]")
@click.option(
    "--partner",
    "partners",
    metavar="ID=TITLE",
    multiple=True,
    help="A partner, optionally with `@handle` behind; may be repeated.",
)
@click.option(
    "--group",
    "groups",
    metavar="ID=OWNER",
    multiple=True,
    help="A first group and its owner; may be repeated.  [default: sensing, driving]",
)
@click.option("--distro", type=click.Choice(DISTROS), help="The ROS distribution.  [default: jazzy]")
@click.option(
    "--ci", type=click.Choice(["github", "gitlab", "none"]), help="Whose workflow to write.  [default: github]"
)
@click.option(
    "--from",
    "tables",
    metavar="FILE.csv",
    multiple=True,
    type=click.Path(dir_okay=False, path_type=Path),
    help="Start from tables of components and connections, as spreadsheets export them; `-` is the standard input.",
)
@click.option("-y", "--yes", is_flag=True, help="Ask nothing: take the defaults for what no flag says.")
def command(  # noqa: PLR0913, PLR0917 - one for each option
    folder: Path | None,
    title: str | None,
    partners: tuple[str, ...],
    groups: tuple[str, ...],
    distro: str | None,
    ci: str | None,
    tables: tuple[Path, ...],
    *,
    yes: bool,
) -> None:
    """Start a project in FOLDER (the current one if left out): a small robot that checks clean, to be changed.

    On a terminal it asks for what no flag says. With the project come the JSON Schema for editors, settings of Visual
    Studio Code, a workflow, CODEOWNERS, .gitattributes, .gitignore and a README. Files that are there are kept, and
    everything is written or nothing. In a git repository that begins above FOLDER, workflow and CODEOWNERS go to its top,
    since nobody reads them elsewhere.
    """
    from archgen.start.answers import with_partners

    target = folder or Path()
    _see_free(target)
    if tables and groups:
        msg = "--from takes the groups from the table: leave out --group"
        raise click.UsageError(msg)
    answers = _answers(target, title=title, partners=partners, groups=groups, distro=distro, forge=ci or "github")
    # What a flag or the tables answer is not asked. The keys are those that `questions` knows.
    given = {"title": title, "partner": partners or tables, "group": groups or tables, "distro": distro, "ci": ci}
    if not yes and sys.stdin.isatty() and sys.stdout.isatty():
        from archgen.cli import questions

        answers = questions.ask(answers, frozenset(key for key, value in given.items() if value), DISTROS)
    imported = _import(tables, answers.distro) if tables else None
    if imported:
        answers = with_partners(answers, imported.data.get("partners", {}))
    _write(target, answers, imported)


def _see_free(target: Path) -> None:
    """Refuse a folder that has a project already."""
    from archgen.project import MARKER

    if os.path.lexists(target / MARKER):
        msg = f"{target / MARKER} is there already; nothing was written"
        raise click.ClickException(msg)


def _answers(target: Path, **flags: Any) -> Answers:  # noqa: ANN401 - as `gathered` takes them
    from archgen.findings.escape import visible
    from archgen.start import answers

    try:
        return answers.gathered(target.resolve().name, **flags)
    except ValueError as error:
        raise click.UsageError(visible(str(error))) from None


def _import(tables: tuple[Path, ...], distro: str) -> Imported:
    """Read the tables. Print what was not imported; where nothing could be, end with status 1."""
    from archgen import importers
    from archgen.importers import MAX_BYTES

    imported = importers.read([(str(path), run.read_bytes(path, MAX_BYTES)) for path in tables], distro)
    if imported.diagnostics:
        run.excerpts(imported.diagnostics, imported.sources, sys.stderr)
    if not imported.data:
        click.echo("Nothing was written.", err=True)
        sys.exit(1)
    return imported


def _write(target: Path, answers: Answers, imported: Imported | None) -> None:
    from archgen.emit import fresh
    from archgen.start import plan, slices

    others = plan.other_yaml(target)
    files = slices.imported(answers, imported.data, others) if imported else slices.example(answers, others)
    checked = plan.judge(files, answers.id)
    made = plan.plan(target, answers, files, checked)
    _see_slices_free(made, target, files)
    with run.phrased():
        fresh.write_new(made.files, made.top)
    for path in made.files:
        run.wrote(path)
    for path in made.kept:
        click.echo(f"kept {run.shown(path)}: it is there already")
    _say(target, checked, made)


def _see_slices_free(made: Plan, target: Path, files: Mapping[str, bytes]) -> None:
    there = [path for path in made.kept if path in {target.resolve() / name for name in files}]
    if there:
        msg = f"{', '.join(map(str, there))} would have to be replaced; nothing was written"
        raise click.ClickException(msg)


def _say(target: Path, checked: Checked, made: Plan) -> None:
    """Print what there is now, and what comes next."""
    from archgen.findings.text import summary

    size = f"{len(checked.architecture.groups)} groups, {len(checked.architecture.components)} components"
    click.echo(f"\n{checked.architecture.project.title}: {size}; archgen check says: {summary(checked.findings)}.")
    if made.top != target.resolve():
        click.echo(f"The repository begins at {made.top}: what the forge reads stands there.")
    if made.reviewers_missing:
        click.echo(
            "No CODEOWNERS yet: give the partners `reviewers`, then archgen owners --format codeowners > CODEOWNERS"
        )
    change = "" if target.resolve() == Path.cwd() else f"cd {shlex.quote(str(target))}; "
    click.echo(f"Now: {change}archgen check, then archgen build. README.md says how to go on.")
