"""`archgen start`: print the plan of the start-up. Nothing of it is run."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import click

from archgen.cli import command_support, shared_options
from archgen.diagnostics import Severity


@click.command("start")
@shared_options.project_argument
@shared_options.variant_option
@click.option("--host", metavar="ID", help="Only the steps on this host, with what they wait for elsewhere.")
@shared_options.format_option("text", "json")
def command(project: Path | None, host: str | None, form: str) -> None:
    """Print in which order the nodes and programs of PROJECT start, with which commands, and what each waits for.

    archgen starts nothing itself: it runs no command, program or launch file of a project.
    """
    from archgen.bringup.start_plan import make_start_plan
    from archgen.emit.terminal.start_text import format_plan
    from archgen.views.records.start_plan_record import record_plan

    checked_project = command_support.check_or_exit(project)
    command_support.print_findings_above(checked_project, lowest_severity=Severity.ERROR)
    architecture = checked_project.architecture
    if host is not None:
        command_support.require_host(architecture, host)
    plan = make_start_plan(architecture)
    shown_ids = None if host is None else {step.id for step in plan.steps if step.host == host}
    if form == "json":
        click.echo(json.dumps(record_plan(architecture, plan, shown_ids), ensure_ascii=False, indent=2))
    else:
        # Not wrapped: commands are there to be copied.
        sys.stdout.writelines(f"{line}\n" for line in format_plan(architecture.project.title, plan, shown_ids))
    command_support.exit_by_findings(checked_project)
