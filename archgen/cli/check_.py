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
_CURED = 20
"""Cured findings that are named; the others are counted."""


@click.command("check")
@options.project
@click.option("--format", "form", type=click.Choice(FORMATS), default="text", show_default=True)
@options.strict
@click.option("-q", "--quiet", is_flag=True, help="Show only what makes the check fail, and nothing else.")
@click.option(
    "--baseline", metavar="FILE", type=click.Path(path_type=Path), help="Keep the findings that FILE knows quiet."
)
@click.option("--update-baseline", is_flag=True, help="Write a baseline that knows all findings of now.")
@click.option(
    "--changed-since",
    metavar="REV",
    help="Show only findings that were not there at a git revision; `main...` is where the branch left main.",
)
def command(  # noqa: PLR0913 - one for each option
    *,
    project: Path | None,
    form: str,
    strict: bool,
    quiet: bool,
    baseline: Path | None,
    update_baseline: bool,
    changed_since: str | None,
) -> None:
    """Find mistakes in the architecture of PROJECT.

    PROJECT is a folder or a single file; left out, it is the project around the current folder. The exit status is 0
    without errors, 1 with errors (with --strict also with warnings, and with findings of the baseline that are cured),
    2 for wrong usage. --update-baseline writes the --baseline, or archgen-baseline.yaml in the project.
    """
    if update_baseline:
        if form != "text" or changed_since is not None:
            msg = (
                "--update-baseline takes in all findings of now and says what it wrote: no --format, no --changed-since"
            )
            raise click.UsageError(msg)
        _update(run.check(project), baseline)
    if baseline is not None and not os.path.lexists(baseline):
        msg = f"there is no baseline {baseline}: `archgen check --update-baseline --baseline {baseline}` writes one"
        raise click.UsageError(msg)
    checked = run.check(project)
    before = None if changed_since is None else _before(project, changed_since)
    from archgen import reported

    found = reported.report(checked, baseline, before)
    least = "warning" if strict else "error"
    shown = [d for d in found.findings if not quiet or d.severity in {least, "error"}]
    _print(form, shown, checked, found, strict=strict, quiet=quiet)
    if not quiet:
        _say_known(found, baseline)
        _say_earlier(found, changed_since)
    sys.exit(run.status(found.findings, strict=strict) or int(strict and bool(found.cured)))


def _before(project: Path | None, revision: str) -> Checked | None:
    """Judge the project at the revision; where what it held there cannot be told, say so: then everything counts."""
    from archgen import reported
    from archgen.git import GitError
    from archgen.project import NotAtRevisionError

    try:
        before = reported.earlier(project, revision)
    except NotAtRevisionError as error:
        run.warn(f"{error}: all findings are shown")
        return None
    except GitError as error:
        raise click.UsageError(visible(str(error))) from None
    if reported.unread(before.findings):
        first = next(finding for finding in before.findings if finding.severity is Severity.ERROR)
        why = f"{first.span}: {first.message}" if first.span.file else first.message
        run.warn(f"at `{revision}` the project could not be read whole ({why}): all findings are shown")
        return None
    return before


def _print(  # noqa: PLR0913 - what the formats need
    form: str, shown: list[Diagnostic], checked: Checked, found: Reported, *, strict: bool, quiet: bool
) -> None:
    from archgen.findings import github, json, junit, sarif

    if form == "json":
        _write(json.render(shown))
    elif form == "github":
        sys.stdout.writelines(f"{line}\n" for line in github.render(shown, folder=_folder(checked.root)))
    elif form == "junit":
        lines = junit.render(shown, checked.sources, checked.all_files, strict=strict)
        _write("".join(f"{line}\n" for line in lines))
    elif form == "sarif":
        document = _sarif(shown, checked, found)
        _write(document)
        for said in sarif.limits(document, len(shown)):
            run.warn(said)
    elif shown:
        run.lines(shown, checked, sys.stdout)
    elif not quiet:
        click.echo("no new findings" if found.known or found.earlier else "no findings")


def _write(document: str) -> None:
    """Print a document, in UTF-8 whatever the terminal has: it is for programs, and says so of itself."""
    click.echo(document.encode(), nl=False)


def _sarif(shown: list[Diagnostic], checked: Checked, found: Reported) -> str:
    from archgen import __version__, reported
    from archgen.findings import sarif

    file = checked.files[0] if checked.files else "archgen.yaml"
    scan = sarif.Scan(
        checked.architecture.project.id, file, _folder(checked.root), __version__, compared=found.compared
    )
    return sarif.render(shown, reported.RULES, scan)


def _say_known(found: Reported, baseline: Path | None) -> None:
    """Say on the error stream what a baseline did: standard output holds findings only."""
    if found.known:
        click.echo(visible(f"not shown: {run.counted(found.known)} that {baseline} knows"), err=True)
    gone = [finding for entry in found.cured for finding in [(entry.rule, entry.message)] * entry.times]
    _cured(gone, "the baseline", f": run `archgen check --update-baseline --baseline {baseline}`")


def _say_earlier(found: Reported, revision: str | None) -> None:
    """Say what a comparison with a revision left out, and what the change cured."""
    if found.earlier:
        click.echo(visible(f"not shown: {run.counted(found.earlier)} that {revision} had already"), err=True)
    _cured([(finding.rule, finding.message) for finding in found.healed], str(revision), "")


def _cured(gone: list[tuple[str, str]], where: str, what_to_do: str) -> None:
    if gone:
        what = "1 finding" if len(gone) == 1 else f"{len(gone)} findings"
        click.echo(visible(f"{what} of {where} {'is' if len(gone) == 1 else 'are'} cured{what_to_do}"), err=True)
        for rule, message in gone[:_CURED]:
            click.echo(visible(f"  {rule}: {message}"), err=True)
        if len(gone) > _CURED:
            click.echo(f"  and {len(gone) - _CURED} more", err=True)


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
