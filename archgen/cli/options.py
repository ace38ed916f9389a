"""The options that verbs share."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import click

Command = Callable[..., Any]

project = click.argument("project", required=False, type=click.Path(path_type=Path))
"""A project's folder or a single file; left out: the project around the current folder."""

project_option = click.option(
    "-C",
    "--project",
    type=click.Path(path_type=Path),
    help="The project's folder or single file.  [default: the project around the current folder]",
)

select = click.option(
    "--select",
    metavar="WORDS",
    help="Show only what a selector names, neighbours grey: `owner:certh`, `sensing+`, `a..b`, `tag:safety -x`.",
)
level = click.option(
    "--level",
    type=click.Choice(["functional", "implementation"]),
    help="Stop at the functional level, or show the ROS side too.  [default: implementation]",
)
keep_going = click.option(
    "--keep-going", is_flag=True, help="Make outputs of what is sound although there are errors; they say so."
)
strict = click.option("--strict", is_flag=True, help="Count warnings as errors in the exit status.")
revision = click.option("--revision", metavar="TEXT", help="Revision to print.  [default: git's last commit]")

history = click.option(
    "--history/--no-history",
    default=True,
    help="Show how the project grew month by month, from git.  [default: history]",
)


def output(what: str, default: str) -> Callable[[Command], Command]:
    """Make the option `-o` of a verb that writes."""
    return click.option(
        "-o",
        "--output",
        type=click.Path(path_type=Path),
        help=f"{what} to write.  [default: archgen-out/{default} in the project]",
    )
