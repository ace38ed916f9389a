"""`archgen check-requests`: hold the open requests of a repository against each other. A nightly CI job calls it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from archgen.cli import command_support, shared_options
from archgen.diagnostics import make_visible
from archgen.frozen import replace

if TYPE_CHECKING:
    from collections.abc import Sequence

    from archgen.forge.pull_request import OpenRequest
    from archgen.merge.branch_results import BranchMerge


@click.command("check-requests")
@click.option("--list-refs", is_flag=True, help="Only print what `git fetch --stdin origin` has to fetch beforehand.")
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path, dir_okay=False),
    help="Write what is to be said on each request, for `archgen comment`.",
)
@shared_options.project_option
def command(*, list_refs: bool, output: Path | None, project: Path | None) -> None:
    """Merge all open requests as merge-check does, and say of each what it breaks together with the others.

    It runs in a job of GitHub Actions (GITHUB_TOKEN, permission pull-requests: read) or GitLab CI (ARCHGEN_TOKEN), on the
    branch that the requests are to be merged into, checked out with its history. It asks the forge which requests are open,
    and reads of them what was fetched; nothing of them is run. The exit status is 0 whatever is found: that is said on the
    requests.
    """
    from archgen.forge import ForgeError
    from archgen.forge.pull_request import find_target_branch, list_open_requests

    try:
        requests, branch = list_open_requests(), find_target_branch()
    except ForgeError as error:
        raise click.ClickException(make_visible(str(error))) from None
    if list_refs:
        for request in requests:
            click.echo(request.refspec)
        return
    requests = _keep_fetched(requests, project)
    merges = _merge_requests(requests, branch, project)
    if output is not None:
        from archgen.emit import file_tree
        from archgen.forge.request_comments import format_request_comments, write_request_comments

        with command_support.explain_write_errors():
            file_tree.write_file(
                output, format_request_comments(write_request_comments(branch, requests, merges)).encode()
            )
        command_support.print_written(output)


def _keep_fetched(requests: Sequence[OpenRequest], project: Path | None) -> tuple[OpenRequest, ...]:
    """Return the requests whose commits are in this clone; say of the others, which are newer, that they are not."""
    from archgen.git import find_repository
    from archgen.git.repository_lookup import look_up_commit

    with command_support.explain_missing_versions():
        repository = find_repository(project or Path.cwd())
    fetched_requests = tuple(request for request in requests if look_up_commit(repository, request.ref))
    for request in requests:
        if request not in fetched_requests:
            command_support.print_warning(f"#{request.number} was not fetched, and is left out")
    return fetched_requests


def _merge_requests(requests: Sequence[OpenRequest], branch: str, project: Path | None) -> list[BranchMerge]:
    """Merge the requests into the branch that is checked out, and print what comes out."""
    from archgen.cli.merge_check_command import print_merge
    from archgen.git import GitError
    from archgen.merge.branch_merge import preview_merges
    from archgen.products.merge_breaks import BRANCH_JUDGES
    from archgen.project import ProjectNotFoundError

    names = {request.ref: f"#{request.number}" for request in requests}
    merges = []
    with command_support.explain_wrong_usage(GitError, ProjectNotFoundError):
        for merge in preview_merges(project, "HEAD", [*names], BRANCH_JUDGES, leaves_out_unmergeable=True):
            merges.append(merge)
            ours, theirs = (tuple(names[ref] for ref in side) for side in merge.sides)
            print_merge(branch, replace(merge, sides=(ours, theirs)))
    return merges
