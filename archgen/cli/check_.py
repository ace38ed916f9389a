"""`archgen check`: find mistakes in the architecture."""

from __future__ import annotations

import os
import sys
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, NoReturn

import click

from archgen.cli import documents, options, run
from archgen.diagnostic import Severity
from archgen.findings.escape import visible

if TYPE_CHECKING:
    from archgen.pipeline import Checked
    from archgen.reported import Reported

_CURED = 20
"""This many lines for cured findings; the rest is counted."""


@click.command("check")
@options.project
@click.option("--format", "form", type=click.Choice(["text", *documents.FORMATS]), default="text", show_default=True)
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
    if form != "text":
        _print(form, replace(found, findings=tuple(shown)), checked, strict=strict)
    elif shown:
        run.lines(shown, checked, sys.stdout)
    elif not quiet:
        click.echo("no new findings" if found.known or found.earlier else "no findings")
    if not quiet:
        _say_known(found, baseline)
        _say_earlier(found, changed_since)
    # With --strict a cured finding fails, so that the baseline is updated and the fault cannot come back unseen.
    sys.exit(run.status(found.findings, strict=strict) or int(strict and bool(found.cured)))


def _before(project: Path | None, revision: str) -> Checked | None:
    """Check the project at a revision. Return None, with a warning, where it cannot be read there: then everything
    counts.
    """
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
    first = reported.unread(before.findings)
    if first is not None:
        why = f"{first.span}: {first.message}" if first.span.file else first.message
        run.warn(f"at `{revision}` the project could not be read whole ({why}): all findings are shown")
        return None
    return before


def _print(form: str, shown: Reported, checked: Checked, *, strict: bool) -> None:
    from archgen.findings import sarif

    document = documents.document(form, shown, checked, strict=strict)
    if form == "github":  # in what everything else is in that a workflow prints
        sys.stdout.write(document)
    else:
        click.echo(document.encode(), nl=False)  # UTF-8 whatever the terminal has: so it says of itself
    for said in sarif.limits(document, len(shown.findings)) if form == "sarif" else ():
        run.warn(said)


def _say_known(found: Reported, baseline: Path | None) -> None:
    """Print on the error stream what a baseline did: standard output has findings only."""
    if found.known:
        click.echo(visible(f"not shown: {run.counted(found.known)} that {baseline} knows"), err=True)
    gone = [f"{entry.rule}: {entry.message}{f' ({entry.times} times)' * (entry.times > 1)}" for entry in found.cured]
    count = sum(entry.times for entry in found.cured)
    _cured(gone, count, "the baseline", f": run `archgen check --update-baseline --baseline {baseline}`")


def _say_earlier(found: Reported, revision: str | None) -> None:
    """Print what a comparison with a revision left out, and what the change cured."""
    if found.earlier:
        click.echo(visible(f"not shown: {run.counted(found.earlier)} that {revision} had already"), err=True)
    gone = [f"{finding.rule}: {finding.message}" for finding in found.healed]
    _cured(gone, len(gone), str(revision), "")


def _cured(gone: list[str], count: int, where: str, what_to_do: str) -> None:
    if gone:
        what = f"1 finding of {where} is" if count == 1 else f"{count} findings of {where} are"
        click.echo(visible(f"{what} cured{what_to_do}"), err=True)
        for line in gone[:_CURED]:
            click.echo(visible(f"  {line}"), err=True)
        if len(gone) > _CURED:
            click.echo(f"  and {len(gone) - _CURED} more", err=True)


def _update(checked: Checked, baseline: Path | None) -> NoReturn:
    """Write the baseline. Errors of reading come first, since what they hide would be missing in it."""
    from archgen import reported

    if reported.unread(checked.findings) is not None:
        run.report(checked, least=Severity.ERROR)
        click.echo("No baseline was written: nobody knows what is behind errors of reading. Mend them first.", err=True)
        sys.exit(1)
    with run.phrased():
        done = reported.update(checked, baseline or checked.root / reported.FILE)
    run.wrote(done.path, f"{done.known} known: {done.added} added, {done.cured} cured")
    sys.exit(0)
