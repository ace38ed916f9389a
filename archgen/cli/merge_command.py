"""`archgen merge`: merge a branch by what both sides say, and follow what was renamed, moved or split off."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

import click

from archgen.cli import command_support, shared_options

if TYPE_CHECKING:
    from archgen.merge.branch_results import BranchMerge


@click.command("merge")
@click.argument("branch", metavar="BRANCH")
@click.option("--dry-run", is_flag=True, help="Say what would come out, and write nothing.")
@click.option(
    "--unsettled",
    is_flag=True,
    help="Write the merge although people have to settle something: with git's markers, or new errors.",
)
@shared_options.format_option("text", "json")
@shared_options.strict_option
@shared_options.project_option
def command(  # noqa: PLR0913 - one for each option
    branch: str, form: str, *, dry_run: bool, unsettled: bool, strict: bool, project: Path | None
) -> None:
    """Merge BRANCH into what is checked out, element by element: what one side renamed, moved or split off takes what the
    other one changed in it, and new references to it follow.

    The merge is judged before a file is touched. It stands in the work tree as one that is to be committed (`git commit`
    ends it, `git merge --abort` takes it back) if nothing conflicts and it brings neither an error that no side has nor a
    break that the project forbids; else nothing is written, and the exit status is 1. Changes that are not committed are refused.
    """
    from archgen.git import GitError
    from archgen.merge.head_merge import merge_into_head
    from archgen.products.merge_breaks import BRANCH_JUDGES
    from archgen.project import ProjectNotFoundError

    def is_sound(branch_merge: BranchMerge) -> bool:
        is_failing = command_support.exit_status(branch_merge.findings, strict=strict) != 0
        return not (branch_merge.is_blocked or branch_merge.is_refused or is_failing)

    with command_support.explain_wrong_usage(GitError, ProjectNotFoundError):
        merge = merge_into_head(
            project, branch, BRANCH_JUDGES, lambda merged: not dry_run and (unsettled or is_sound(merged))
        )
    if form == "json":
        from archgen.merge.merge_sentences import format_merges_json

        sys.stdout.write(format_merges_json(merge.head, [merge.branch_merge], is_written=merge.is_written))
    elif merge.is_needless:
        click.echo(f"{merge.head} has all of {branch} already")
    else:
        from archgen.cli.merge_check_command import print_merge

        print_merge(merge.head, merge.branch_merge)
        click.echo(
            _describe_outcome(merge.branch_merge, is_written=merge.is_written, is_sound=is_sound(merge.branch_merge))
        )
    sys.exit(0 if merge.is_needless or is_sound(merge.branch_merge) else 1)


def _describe_outcome(branch_merge: BranchMerge, *, is_written: bool, is_sound: bool) -> str:
    if is_written:
        end = "`git commit`" if not branch_merge.is_blocked else "what conflicts, then `git add` and `git commit`"
        return f"The merge stands in the work tree: {end} ends it, `git merge --abort` takes it back."
    if is_sound:
        return "Nothing was written: without --dry-run it would be."
    return "Nothing was written. With --unsettled it is, with git's markers where both sides contradict, to be settled by hand."
