"""`archgen check`: find mistakes in the architecture."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING, NoReturn

import click

from archgen.cli import options, run
from archgen.diagnostic import Diagnostic, Severity
from archgen.findings.escape import visible

if TYPE_CHECKING:
    from archgen.pipeline import Checked
    from archgen.reported import Reported

FORMATS = ["text", "json", "github", "sarif", "junit"]


@click.command("check")
@options.project
@click.option("--format", "form", type=click.Choice(FORMATS), default="text", show_default=True)
@options.strict
@click.option("-q", "--quiet", is_flag=True, help="Show only what makes the check fail, and nothing else.")
@click.option(
    "--baseline", metavar="FILE", type=click.Path(path_type=Path), help="Keep the findings that FILE knows quiet."
)
@click.option("--update-baseline", is_flag=True, help="Write a baseline that knows all findings of now.")
def command(  # noqa: PLR0913 - one for each option
    *, project: Path | None, form: str, strict: bool, quiet: bool, baseline: Path | None, update_baseline: bool
) -> None:
    """Find mistakes in the architecture of PROJECT.

    PROJECT is a folder or a single file; left out, it is the project around the current folder. The exit status is 0
    without errors, 1 with errors (with --strict also with warnings, and with findings of the baseline that are cured),
    2 for wrong usage. --update-baseline writes the --baseline, or archgen-baseline.yaml in the project.
    """
    if update_baseline:
        if form != "text":
            msg = "--update-baseline says what it wrote, in no other format"
            raise click.UsageError(msg)
        _update(run.check(project), baseline)
    if baseline is not None and not os.path.lexists(baseline):
        msg = f"there is no baseline {baseline}: `archgen check --update-baseline --baseline {baseline}` writes one"
        raise click.UsageError(msg)
    checked = run.check(project)
    from archgen import reported

    found = reported.beyond(checked, baseline) if baseline else reported.Reported(checked.findings)
    least = "warning" if strict else "error"
    shown = [d for d in found.findings if not quiet or d.severity in {least, "error"}]
    _print(form, shown, checked, found if baseline else None, strict=strict, quiet=quiet)
    if baseline and not quiet:
        _say(found, baseline)
    sys.exit(run.status(found.findings, strict=strict) or int(strict and bool(found.cured)))


def _print(  # noqa: PLR0913 - what the formats need
    form: str, shown: list[Diagnostic], checked: Checked, found: Reported | None, *, strict: bool, quiet: bool
) -> None:
    from archgen.findings import github, json, junit, sarif

    if form == "json":
        sys.stdout.write(json.render(shown))
    elif form == "github":
        sys.stdout.writelines(f"{line}\n" for line in github.render(shown, folder=_folder(checked.root)))
    elif form == "junit":
        lines = junit.render(shown, checked.sources, checked.all_files, strict=strict)
        sys.stdout.writelines(f"{line}\n" for line in lines)
    elif form == "sarif":
        document = _sarif(shown, checked, found)
        sys.stdout.write(document)
        for said in sarif.limits(document, len(shown)):
            run.warn(said)
    elif shown:
        run.lines(shown, checked, sys.stdout)
    elif not quiet:
        click.echo("no new findings" if found and found.known else "no findings")


def _sarif(shown: list[Diagnostic], checked: Checked, found: Reported | None) -> str:
    from archgen import __version__, reported
    from archgen.findings import sarif

    baseline = {"known": len(found.known), "cured": sum(entry.times for entry in found.cured)} if found else None
    file = checked.files[0] if checked.files else "archgen.yaml"
    scan = sarif.Scan(checked.architecture.project.id, file, _folder(checked.root), __version__, baseline)
    return sarif.render(shown, reported.RULES, scan)


def _say(found: Reported, baseline: Path) -> None:
    """Say on the error stream what a baseline did: standard output holds findings only."""
    if found.known:
        click.echo(f"{run.counted(found.known)} not shown: {baseline} knows of {_it(len(found.known))}", err=True)
    count = sum(entry.times for entry in found.cured)
    if count:
        what = "1 finding of the baseline is" if count == 1 else f"{count} findings of the baseline are"
        click.echo(f"{what} cured: run `archgen check --update-baseline --baseline {baseline}`", err=True)
        for entry in found.cured:
            times = f" ({entry.times} times)" if entry.times > 1 else ""
            click.echo(visible(f"  {entry.rule}: {entry.message}{times}"), err=True)


def _it(count: int) -> str:
    return "it" if count == 1 else "them"


def _update(checked: Checked, baseline: Path | None) -> NoReturn:
    """Write the baseline; errors of reading come first, since what is behind them would be lost from it."""
    from archgen import reported

    if reported.unread(checked.findings):
        run.report(checked, least=Severity.ERROR)
        click.echo("No baseline was written: nobody knows what is behind errors of reading. Mend them first.", err=True)
        sys.exit(1)
    with run.phrased():
        done = reported.update(checked, baseline or checked.root / reported.FILE)
    run.wrote(done.path, f"{done.known} known: {done.added} added, {done.cured} cured")
    sys.exit(0)


def _folder(root: Path) -> str:
    """Give the project's folder from the repository's root, from which servers name files.

    On GitHub that is the workspace; elsewhere the folder that holds `.git`, or else the current one.
    """
    resolved = root.resolve()
    workspace = os.environ.get("GITHUB_WORKSPACE")
    above = (folder for folder in (resolved, *resolved.parents) if os.path.lexists(folder / ".git"))
    top = Path(workspace).resolve() if workspace else next(above, Path.cwd().resolve())
    return resolved.relative_to(top).as_posix() if resolved.is_relative_to(top) else ""
