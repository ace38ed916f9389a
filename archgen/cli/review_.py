"""`archgen review`: what the review of a change needs, in one folder. A CI job calls it, and so may you."""

from __future__ import annotations

import os
import re
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import click

from archgen.cli import documents, run
from archgen.findings.escape import visible

if TYPE_CHECKING:
    from archgen.pipeline import Checked
    from archgen.reported import Reported

FOLDER = "archgen-out/review"


@click.command("review")
@click.argument("project", required=False, type=click.Path(path_type=Path), envvar="ARCHGEN_PROJECT")
@click.option(
    "--base",
    metavar="REV",
    envvar="ARCHGEN_BASE",
    help="Say what changed since the branch left this revision (in a workflow: the branch that is merged into).",
)
@click.option("--strict", is_flag=True, envvar="ARCHGEN_STRICT", help="Count warnings as errors in the exit status.")
@click.option(
    "--baseline",
    metavar="FILE",
    type=click.Path(path_type=Path, exists=True, dir_okay=False),
    envvar="ARCHGEN_BASELINE",
    help="Keep the findings that FILE knows quiet.",
)
@click.option(
    "--build/--no-build",
    default=True,
    envvar="ARCHGEN_BUILD",
    help="Make report, site, diagrams and packed file too.  [default: build]",
)
@click.option(
    "--backend",
    metavar="NAME",
    multiple=True,
    envvar="ARCHGEN_BACKENDS",
    help="Make this backend's output too. With --base, the project's own run only if `review.backends` of REV names them.",
)
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path, file_okay=False),
    envvar="ARCHGEN_OUTPUT",
    help=f"The folder to write to.  [default: {FOLDER} in the project]",
)
def command(  # noqa: PLR0913 - one for each option
    *,
    project: Path | None,
    base: str | None,
    strict: bool,
    baseline: Path | None,
    build: bool,
    backend: tuple[str, ...],
    output: Path | None,
) -> None:
    """Check PROJECT, say what a change of it means, and make its outputs: all that a reviewer needs, in one folder.

    It prints the findings, as annotations in a workflow of GitHub, and writes findings.sarif, findings.xml (JUnit) and, with
    --base, comment.md (for the pull request), diff.json and diff.html; below outputs/ the report, the site, the diagrams and
    the packed file. Every option can be set by the environment: ARCHGEN_PROJECT, ARCHGEN_BASE, ARCHGEN_STRICT and so on.

    The exit status is 0 if all is well, 1 with errors or with a breaking change that the project does not accept, 2 for
    wrong usage.
    """
    from archgen import reported

    checked = run.check(project)
    target = output or checked.root / FOLDER
    merged = _merged_into(base)
    allowed = run.trusted(project, merged)
    found = reported.report(checked, baseline)
    bad = run.status(found.findings, strict=strict)
    _print(found, checked, strict=strict)
    with run.phrased():
        for name, form in (("findings.sarif", "sarif"), ("findings.xml", "junit")):
            _write(target / name, documents.document(form, found, checked, strict=strict))
        if merged:
            # `REV...` is where the branch left REV. The first parent of GitHub's merge commit needs no dots:
            # HEAD has all of it.
            bad |= _compare(project, merged if merged != base else f"{base}...", target)
        if build:
            bad |= _build(checked, target / "outputs", backend, allowed)
    sys.exit(bad)


def _merged_into(base: str | None) -> str | None:
    """Return the revision that the change is merged into, or None.

    GitHub makes a merge commit of a pull request: its first parent is that revision, and what the event names as base
    may be older.
    """
    made = re.fullmatch(r"refs/pull/\d+/merge", os.environ.get("GITHUB_REF", ""))
    return "HEAD^1" if base and made else base or None


def _print(found: Reported, checked: Checked, *, strict: bool) -> None:
    if os.environ.get("GITHUB_ACTIONS"):
        sys.stdout.write(documents.document("github", found, checked, strict=strict))
    elif found.findings:
        run.lines(found.findings, checked, sys.stdout)
    else:
        click.echo("no findings")


def _write(path: Path, made: str | bytes) -> None:
    from archgen.emit import tree

    tree.write_file(path, made if isinstance(made, bytes) else made.encode())
    run.wrote(path)


def _compare(project: Path | None, start: str, target: Path) -> int:
    """Write what changed. Return the exit status that the project's policy asks for."""
    from archgen import changes, git, outputs
    from archgen.findings import diff_json
    from archgen.project import NotAtRevisionError
    from archgen.sides import compared, sides

    try:
        before, after = sides(start, None, project)
    except NotAtRevisionError as error:
        run.warn(f"{error}: there is nothing to compare with")
        return 0
    except git.GitError as error:
        raise click.UsageError(visible(str(error))) from None
    found = compared(before, after)
    comment = changes.markdown(found, before, after)
    _write(target / "comment.md", comment)
    _write(target / "diff.json", diff_json.render(found, (before.checked.unsound, after.checked.unsound)))
    _write(target / "diff.html", changes.html(found, before, after, outputs.Ask(warn=run.warn)))
    summary = os.environ.get("GITHUB_STEP_SUMMARY")
    if summary:
        with Path(summary).open("a", encoding="utf-8") as stream:
            stream.write(comment)
    return int(found.failing)


def _build(checked: Checked, target: Path, backends: tuple[str, ...], allowed: tuple[str, ...] | None) -> int:
    """Build the outputs of what is sound. Return 0: outputs do not decide the status."""
    from archgen import build, outputs

    ask = outputs.Ask(progress=run.progress(), warn=run.warn, allowed=allowed)
    for path in build.build(checked, ask, target, None, backends):
        run.wrote(path)
    return 0
