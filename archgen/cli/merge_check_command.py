"""`archgen merge-check`: merge open branches as models, before git does."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

import click

from archgen.cli import command_support, shared_options
from archgen.diagnostics import make_visible

if TYPE_CHECKING:
    from archgen.merge.branch_results import BranchMerge


@click.command("merge-check")
@click.argument("main_line", metavar="MAIN")
@click.argument("branches", metavar="OTHER...", nargs=-1, required=True)
@shared_options.format_option("text", "json")
@shared_options.strict_option
@shared_options.project_option
def command(main_line: str, branches: tuple[str, ...], form: str, *, strict: bool, project: Path | None) -> None:
    """Say what would be wrong if open branches were merged: each OTHER into MAIN, then all of them.

    Git's objects are read and nothing is checked out. Findings are shown that neither MAIN nor the branch has, what
    breaks a partner only together and in which order it does not, and conflicts: of the models, and of git alone. In a
    folder that only holds projects, such as the top of a repository, each of them is merged. The exit status is 1 for new
    errors, for breaks that the project forbids (with --strict also for warnings), for conflicts of the models, and where the
    project is gone.
    """
    from archgen.git import GitError
    from archgen.merge.branch_merge import preview_merges
    from archgen.products.merge_breaks import BRANCH_JUDGES
    from archgen.project import ProjectNotFoundError

    folders = _list_folders(project, (main_line, *branches))
    if form == "json" and folders:
        raise click.UsageError(f"this folder only holds projects: name one with -C, such as `-C {folders[0]}`")
    paths = [(project or Path()) / folder for folder in folders] if folders else [project]
    with command_support.explain_wrong_usage(GitError, ProjectNotFoundError):
        merges_by_project = [list(preview_merges(path, main_line, branches, BRANCH_JUDGES)) for path in paths]
    if form == "json":
        from archgen.merge.merge_sentences import format_merges_json

        sys.stdout.write(format_merges_json(main_line, merges_by_project[0]))
    else:
        for folder, branch_merges in zip(folders or [""], merges_by_project, strict=True):
            for branch_merge in branch_merges:
                print_merge(main_line, branch_merge, folder)
    sys.exit(
        1
        if any(
            branch_merge.is_refused or command_support.exit_status(branch_merge.findings, strict=strict)
            for branch_merges in merges_by_project
            for branch_merge in branch_merges
        )
        else 0
    )


def _list_folders(project: Path | None, revisions: tuple[str, ...]) -> list[str]:
    """Return the folders of the projects that some revision holds below a folder that holds none in any of them."""
    from archgen.git import GitError
    from archgen.products.repository_comparison import list_projects_below

    try:
        folders = {folder for revision in revisions for folder in list_projects_below(project, revision)}
    except (GitError, OSError):  # said better by what reads the revisions
        return []
    return [] if "" in folders else sorted(folders)


def print_merge(main_line: str, branch_merge: BranchMerge, folder: str = "") -> None:
    """Print what came out of a merge, with what is wrong with it."""
    from archgen.merge.merge_sentences import describe_conflict, describe_merge

    merged_names = " + ".join((main_line, *branch_merge.branches))
    prefix = f"{folder}: " if folder else ""
    click.echo(make_visible(f"{prefix}{merged_names}: {describe_merge(branch_merge, main_line)}"))
    for sentence in branch_merge.followed:
        click.echo(make_visible(f"  followed: {sentence}"))
    for conflict in branch_merge.conflicts:
        click.echo(make_visible(f"  {describe_conflict(conflict)}"))
    if branch_merge.findings and branch_merge.checked_project:
        command_support.print_findings(branch_merge.findings, branch_merge.checked_project, sys.stdout)
