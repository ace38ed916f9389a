"""The options that verbs share."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import click

CommandFunction = Callable[..., Any]

project_argument = click.argument("project", required=False, type=click.Path(path_type=Path))
"""A project's folder or a single file; left out: the project around the current folder."""

project_option = click.option(
    "-C",
    "--project",
    type=click.Path(path_type=Path),
    help="The project's folder or single file.  [default: the project around the current folder]",
)

select_option = click.option(
    "--select",
    metavar="WORDS",
    help="Show only what a selector names, neighbours grey: `owner:certh`, `sensing+`, `a..b`, `tag:safety -x`.",
)
level_option = click.option(
    "--level",
    type=click.Choice(["functional", "implementation"]),
    help="Stop at the functional level, or show the ROS side too.  [default: implementation]",
)
keep_going_option = click.option(
    "--keep-going", is_flag=True, help="Make outputs of what is sound although there are errors; they say so."
)
strict_option = click.option("--strict", is_flag=True, help="Count warnings as errors in the exit status.")
revision_option = click.option("--revision", metavar="TEXT", help="Revision to print.  [default: git's last commit]")

history_option = click.option(
    "--history/--no-history",
    default=True,
    help="Show how the project grew month by month, from git.  [default: history]",
)


def output_option(target: str, default: str) -> Callable[[CommandFunction], CommandFunction]:
    """Make the option `-o` of a verb that writes."""
    return click.option(
        "-o",
        "--output",
        type=click.Path(path_type=Path),
        help=f"{target} to write.  [default: archgen-out/{default} in the project]",
    )
