"""`archgen pack`: write one validated YAML file that holds the whole project."""

from __future__ import annotations

from pathlib import Path

import click

from archgen.cli import options, run


@click.command("pack")
@options.project
@options.output("The file", "packed.yaml")
@click.option(
    "--resolved",
    is_flag=True,
    help="Write what was derived too (edges, nodes, topics, messages), for other programs; by its own schema.",
)
@options.select
@options.keep_going
def command(project: Path | None, output: Path | None, select: str | None, *, resolved: bool, keep_going: bool) -> None:
    """Write PROJECT as one validated YAML file, which is itself a project.

    With --resolved it is a record for other programs instead (`resolved.yaml`); --select then names a part of it.
    """
    from archgen import outputs

    if select and not resolved:
        msg = "--select goes with --resolved: a packed project is whole"
        raise click.UsageError(msg)
    checked = run.ready(project, keep_going=keep_going)
    target = output or checked.out / ("resolved.yaml" if resolved else "packed.yaml")
    with run.phrased():
        if resolved:
            outputs.resolved(checked, outputs.Ask(run.selected(checked, select), select or ""), target)
        else:
            outputs.pack(checked, target)
    run.wrote(target)
    run.finish(checked)
