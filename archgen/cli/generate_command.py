"""`archgen generate`: make a workspace by a text backend."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

import click

from archgen.cli import command_support, shared_options

if TYPE_CHECKING:
    from archgen.products.workspace_product import WorkspaceResult
    from archgen.views.pages.report_outline import DetailLevel

_CONFLICT_HELP = {
    "edited": "was changed by hand since archgen wrote it, and stays as it is; `--overwrite {0}` takes the new one, "
    "`--keep {0}` keeps yours for good",
    "foreign": "is a file of yours, and stays as it is; move it away for the new one, or keep it for good with `--keep {0}`",
    "blocked": "cannot be written: {1}; move that away",
}


@click.command("generate")
@shared_options.backend_argument("workspace")
@shared_options.output_option("The folder", "NAME")
@shared_options.select_option
@click.option("--host", metavar="ID", help="Only what runs on this host.")
@click.option("--option", "settings", metavar="KEY=VALUE", multiple=True, help="Set an option of the backend.")
@click.option(
    "--overwrite", metavar="PATH", multiple=True, help="Take the new file in place of one that was changed by hand."
)
@click.option(
    "--keep",
    metavar="PATH",
    multiple=True,
    help="Take a file over as it stands, changed or not: archgen never touches it again.",
)
@click.option("--dry-run", is_flag=True, help="Say what would be done with each file, and do nothing.")
@shared_options.level_option
@shared_options.revision_option
@shared_options.keep_going_option
@shared_options.trust_option
@shared_options.project_option
@shared_options.variant_option
def command(  # noqa: PLR0913 - one for each option
    *,
    name: str,
    output: Path | None,
    select: str | None,
    host: str | None,
    settings: tuple[str, ...],
    overwrite: tuple[str, ...],
    keep: tuple[str, ...],
    dry_run: bool,
    level: DetailLevel | None,
    revision: str | None,
    keep_going: bool,
    trust: str | None,
    project: Path | None,
) -> None:
    """Make the workspace of the backend NAME: a folder that other tools and people work in, too.

    NAME is a backend with `makes: workspace`; `archgen list --of backends` shows them. Files of others are never
    touched, and neither are those that somebody changed since archgen wrote them.
    """
    from archgen.products.output_options import OutputOptions
    from archgen.products.workspace_product import WorkspaceRequest, write_workspace

    checked_project = command_support.check_before_writing(project, keep_going=keep_going)
    if host is not None:
        command_support.require_host(checked_project.architecture, host)
    output_options = OutputOptions(
        command_support.select_or_exit(checked_project, select),
        select or "",
        level,
        revision,
        warn=command_support.print_warning,
        trusted_revision=command_support.find_trusted_revision(project, trust),
    )
    request = WorkspaceRequest(host, _read_settings(settings), overwrite, keep, dry_run)
    with command_support.explain_write_errors():
        result = write_workspace(checked_project, output_options, name, output, request)
    if result.findings:
        command_support.print_findings(result.findings, checked_project, sys.stderr)
    _print_result(result, dry_run=dry_run)
    if not result.is_complete:
        sys.exit(1)
    command_support.exit_by_findings(checked_project)


def _read_settings(settings: tuple[str, ...]) -> dict[str, str]:
    values = {}
    for setting in settings:
        key, equals, value = setting.partition("=")
        if not equals:
            msg = f"`--option` takes KEY=VALUE, not '{setting}'"
            raise click.UsageError(msg)
        values[key.strip()] = value.strip()
    return values


def _print_result(result: WorkspaceResult, *, dry_run: bool) -> None:
    from archgen.diagnostics.safe_text import make_visible

    plan = result.plan
    if plan is None:
        click.echo("Nothing was written.", err=True)
        return
    if dry_run:
        for step in plan.steps:
            click.echo(make_visible(f"{step.verb:<8} {step.path}{f'  ({step.note})' if step.note else ''}"))
    for step in plan.steps:
        if step.verb in _CONFLICT_HELP:
            text = f"{step.path} {_CONFLICT_HELP[step.verb].format(step.path, step.note)}"
            click.echo(f"error: {make_visible(text)}", err=True)
        elif step.note and not dry_run:
            command_support.print_warning(f"{step.path}: {step.note}")
    if not dry_run:
        counts = [
            (plan.count("new"), "new"),
            (plan.count("changed"), "changed"),
            (plan.count("removed"), "removed"),
            (plan.count("same"), "as before"),
        ]
        detail = ", ".join(f"{count} {words}" for count, words in counts if count) or "no files"
        command_support.print_written(result.folder, detail)
