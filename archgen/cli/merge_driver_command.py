"""`archgen merge-driver`: what git calls to merge two versions of a slice."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from archgen.cli import command_support
from archgen.diagnostics import make_visible

_FILE = click.Path(exists=True, dir_okay=False, path_type=Path)


@click.command("merge-driver")
@click.argument("base", type=_FILE)
@click.argument("ours", type=_FILE)
@click.argument("theirs", type=_FILE)
@click.argument("name", required=False, default="")
@click.option("--marker-size", type=click.IntRange(1, 100), default=7, show_default=True, help="The length of markers.")
def command(base: Path, ours: Path, theirs: Path, name: str, marker_size: int) -> None:
    """Merge two versions of a YAML file into OURS: element by element where lines conflict and their meaning does not.

    git calls it as a merge driver, with NAME as the path in the project; `archgen init --merge-driver` sets that up.
    Comments and order stay. Where both sides changed one thing, git's markers stand in the file, and the exit status is 1.
    """
    from archgen.emit import file_tree
    from archgen.git import GitError
    from archgen.merge.file_merge import merge_contents
    from archgen.regular_files import read_named_file
    from archgen.syntax.project_files import MAX_BYTES

    with command_support.explain_write_errors():
        try:
            old, own, other = (read_named_file(file, MAX_BYTES) for file in (base, ours, theirs))
            merged = merge_contents(old, own, other, marker_size, name)
        except (GitError, OSError) as error:
            click.echo(make_visible(f"archgen: {name or ours}: {error}"), err=True)
            sys.exit(2)
        # git asks for this very file, which was never archgen's.
        file_tree.replace_file(ours, merged.content)
    if merged.problem:
        click.echo(make_visible(f"archgen: {name or ours}: {merged.problem}"), err=True)
        sys.exit(1)
