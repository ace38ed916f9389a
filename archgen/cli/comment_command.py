"""`archgen comment`: put a text on the pull request that a CI job runs for."""

from __future__ import annotations

import os
from pathlib import Path

import click

from archgen.diagnostics import make_visible


@click.command("comment")
@click.argument("file", type=click.Path(exists=True, dir_okay=False, path_type=Path))
@click.option("--key", default="diff", show_default=True, help="Which of archgen's comments this is.")
def command(file: Path, key: str) -> None:
    """Put the Markdown in FILE on the pull request as one comment, which later runs change instead of adding more.

    A FILE that ends in .json is what `archgen check-requests -o` wrote: each open request gets the text that is for it.
    It runs in a job of GitHub Actions (GITHUB_TOKEN, permission pull-requests: write) or GitLab CI (ARCHGEN_TOKEN). A token
    that may not write, as in a pull request from a fork, is no failure: the text goes to the job's summary instead.
    """
    from archgen.forge import ForgeError, post_comment

    try:
        text = file.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError):
        raise click.ClickException(f"{make_visible(str(file))} cannot be read as UTF-8 text") from None
    if file.suffix == ".json":
        _post_on_requests(text, key)
        return
    try:
        click.echo(f"comment {post_comment(text, key)}")
    except ForgeError as error:
        summary = os.environ.get("GITHUB_STEP_SUMMARY")
        # What a forge answers to a token that may not write: GitHub says 404 where the token may not even read.
        if error.status not in {401, 403, 404} or not summary:
            raise click.ClickException(make_visible(str(error))) from None
        with Path(summary).open("a", encoding="utf-8") as stream:
            stream.write(f"{text.strip()}\n")
        click.echo(make_visible(f"warning: {error}; the text is in the job's summary instead"), err=True)


def _post_on_requests(text: str, key: str) -> None:
    """Put each text on its request. One that cannot be put there fails at the end, after all others."""
    from archgen.forge import ForgeError
    from archgen.forge.request_comments import post_request_comments, read_request_comments

    try:
        comments = read_request_comments(text)
    except ForgeError as error:
        raise click.ClickException(make_visible(str(error))) from None
    failed_count = 0
    for comment, outcome in post_request_comments(comments, key):
        is_failure = isinstance(outcome, ForgeError)
        failed_count += is_failure
        click.echo(
            make_visible(f"#{comment.number}: {outcome if is_failure else f'comment {outcome}'}"), err=is_failure
        )
    if failed_count:
        raise click.ClickException(f"{failed_count} of {len(comments)} comments could not be put")
