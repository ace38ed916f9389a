"""`archgen check`: find mistakes in the architecture."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import click

from archgen.cli import options, run


@click.command("check")
@options.project
@click.option("--format", "form", type=click.Choice(["text", "json", "github"]), default="text", show_default=True)
@options.strict
@click.option("-q", "--quiet", is_flag=True, help="Show errors only (text format).")
def command(project: Path | None, form: str, *, strict: bool, quiet: bool) -> None:
    """Find mistakes in the architecture of PROJECT.

    PROJECT is a folder or a single file; left out, it is the project around the current folder. The exit status is 0
    without errors, 1 with errors (with --strict also with warnings), 2 for wrong usage.
    """
    from archgen.findings import github, json

    checked = run.check(project)
    findings = checked.findings
    if form == "json":
        sys.stdout.write(json.render(findings))
    elif form == "github":
        sys.stdout.writelines(f"{line}\n" for line in github.render(findings, folder=_folder(checked.root)))
    else:
        shown = [finding for finding in findings if not quiet or finding.severity == "error"]
        run.lines(shown, checked, sys.stdout)
    run.finish(checked, strict=strict)


def _folder(root: Path) -> str:
    """Give the project's folder relative to the workspace, whose root GitHub's annotations are relative to."""
    workspace = Path(os.environ.get("GITHUB_WORKSPACE") or Path.cwd()).resolve()
    resolved = root.resolve()
    return resolved.relative_to(workspace).as_posix() if resolved.is_relative_to(workspace) else ""
