"""`archgen generate`: make a workspace by a text backend."""

from __future__ import annotations

import sys
from collections.abc import Collection, Iterable
from pathlib import Path
from typing import TYPE_CHECKING

import click

from archgen.cli import command_support, shared_options
from archgen.diagnostics import make_visible
from archgen.products.output_options import OutputOptions

if TYPE_CHECKING:
    from archgen.emit.workspace.workspace_plan import FileStep
    from archgen.pipeline import CheckedProject
    from archgen.products.workspace_product import WorkspaceResult
    from archgen.views.pages.report_outline import DetailLevel

_CONFLICT_HELP = {
    "edited": "was changed by hand since archgen wrote it, and stays as it is; `--overwrite {0}` takes the new one, "
    "`--keep {0}` keeps yours for good",
    "foreign": "is a file of yours, since `.archgen` records nothing of it, and stays as it is; move it away for the new one, "
    "keep it for good with `--keep {0}`, or bring a record back that was lost",
    "blocked": "cannot be written: {1}; move that away",
}


_STALE_WORDS = {
    "new": "it is not there",
    "changed": "it is not as the model says",
    "removed": "the model needs it no more",
    "merged": "it is a merge of two",
}


@click.command("generate")
@shared_options.backend_argument("workspace", required=False)
@shared_options.output_option("The folder", "NAME, or what `generate.into` says,")
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
@click.option(
    "--was",
    "former_id",
    metavar="ID",
    default="",
    help="The id that the project had before: what was made for that is its own.",
)
@click.option("--dry-run", is_flag=True, help="Say what would be done with each file, and do nothing.")
@click.option(
    "--check", "only_check", is_flag=True, help="Say which files are not as the model says, do nothing, and end with 1."
)
@click.option(
    "--patch", is_flag=True, help="Print likely renames in code of yours as a patch of the workspace, and do nothing."
)
@shared_options.level_option
@shared_options.revision_option
@shared_options.keep_going_option
@shared_options.trust_option
@shared_options.project_option
@shared_options.variant_option
def command(  # noqa: C901, PLR0913 - one for each option
    *,
    name: str | None,
    output: Path | None,
    select: str | None,
    host: str | None,
    settings: tuple[str, ...],
    overwrite: tuple[str, ...],
    keep: tuple[str, ...],
    former_id: str,
    dry_run: bool,
    only_check: bool,
    patch: bool,
    level: DetailLevel | None,
    revision: str | None,
    keep_going: bool,
    trust: str | None,
    project: Path | None,
) -> None:
    """Make the workspace of the backend NAME: a folder that other tools and people work in, too.

    NAME is a backend with `makes: workspace`; `archgen list --of backends` shows them. Without one all are made that
    the project lists in `generate`. Files of others are never touched, and neither are those that somebody changed since
    archgen wrote them.
    """
    from archgen.products.workspace_product import WorkspaceRequest, write_workspaces

    if name is None and (overwrite or keep or settings):
        raise click.UsageError("`--overwrite`, `--keep` and `--option` want the backend that they are for")
    try:
        checked_project = command_support.check_before_writing(project, keep_going=keep_going)
    except click.UsageError as error:  # without a project nothing is listed either
        if name is None:
            shared_options.refuse_missing_backend("workspace", f"; {error.message}")
        raise
    listed = checked_project.architecture.generate
    if name is None and not listed.backends:
        shared_options.refuse_missing_backend("workspace", ", or list what to make in `generate` of the project")
    if output is None and (name is None or name in listed.backends):
        output = _find_listed_folder(checked_project)
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
    options = _read_settings(settings)
    is_complete = True
    only_look = dry_run or only_check or patch
    requests = {
        backend: WorkspaceRequest(
            host,
            options,
            overwrite,
            keep,
            only_look,
            usual_options=listed.backends.get(backend, {}),
            former_project=former_id,
        )
        for backend in (listed.backends if name is None else [name])
    }
    results = write_workspaces(checked_project, output_options, requests, output)
    while True:
        with command_support.explain_write_errors():
            backend, result = next(results, ("", None))
        if result is None:
            break
        if result.findings:
            command_support.print_findings(result.findings, checked_project, sys.stderr)
        if patch:
            _print_patch(result)
            continue
        _print_result(result, backend if name is None else "", dry_run=dry_run, only_check=only_check)
        is_complete &= result.is_complete and not (only_check and result.stale_steps)
    if name is None:
        _tell_unlisted_backends(output, listed.backends)
    if not is_complete:
        sys.exit(1)
    command_support.exit_by_findings(checked_project)


def _find_listed_folder(checked_project: CheckedProject) -> Path | None:
    """Return the folder that the project names for its workspace. A project may write into its own repository alone."""
    written = checked_project.architecture.generate.into
    if written is None:
        return None
    folder = checked_project.root / written
    if not folder.resolve().is_relative_to(command_support.find_repository_folder(checked_project.root)):
        msg = f"`generate.into` leads out of the project's repository: {written}; name that folder with `-o`"
        raise click.UsageError(msg)
    return folder


def _tell_unlisted_backends(folder: Path | None, listed: Collection[str]) -> None:
    """Say whose files in the workspace nobody renews: those of backends that the project lists no more."""
    from archgen.emit.workspace.run_record import list_recorded_backends

    for backend in list_recorded_backends(folder) if folder else ():
        if backend not in listed:
            command_support.print_warning(
                f"{folder} has files of the backend `{backend}`, which `generate` does not list: they stay as they are; "
                f"`archgen generate {backend} -o {folder}` renews them, and who needs them no more removes them "
                f"with .archgen/{backend}.json"
            )


def _read_settings(settings: tuple[str, ...]) -> dict[str, str]:
    values = {}
    for setting in settings:
        key, equals, value = setting.partition("=")
        if not equals:
            raise click.UsageError(f"`--option` takes KEY=VALUE, not '{setting}'")
        values[key.strip()] = value.strip()
    return values


def _print_patch(result: WorkspaceResult) -> None:
    from archgen.products.own_code_patch import plan_renames

    for edit in plan_renames(result):
        command_support.print_diff(edit)


def _print_result(result: WorkspaceResult, backend: str, *, dry_run: bool, only_check: bool) -> None:
    plan = result.plan
    if plan is None:
        click.echo(f"{backend}: nothing was written." if backend else "Nothing was written.", err=True)
        return
    if dry_run:
        for step in plan.steps:
            click.echo(make_visible(f"{step.verb:<8} {step.path}{f'  ({step.note})' if step.note else ''}"))
    for step in plan.steps:
        _print_code_findings(step)
        if step.note and not (step.verb in _CONFLICT_HELP or dry_run or only_check):
            command_support.print_warning(f"{step.path}: {step.note}")
    _print_conflicts(plan.conflicts)
    if only_check:
        for step in result.stale_steps:
            click.echo(make_visible(f"stale: {step.path} ({_STALE_WORDS[step.verb]})"))
    elif not dry_run:
        counts = [
            (plan.count("new"), "new"),
            (plan.count("changed"), "changed"),
            (plan.count("merged"), "merged by git, made anew"),
            (plan.count("removed"), "removed"),
            (plan.count("same"), "as before"),
        ]
        detail = ", ".join(f"{count} {words}" for count, words in counts if count) or "no files"
        command_support.print_written(result.folder, f"{backend}: {detail}" if backend else detail)


def _print_conflicts(steps: Iterable[FileStep]) -> None:
    """Say of each file that stays why, but once of all for which one thing is in the way."""
    from archgen.diagnostics import make_visible

    alike: dict[tuple[str, str], list[FileStep]] = {}
    for step in steps:
        alike.setdefault((step.verb, step.note or step.path), []).append(step)
    for (verb, _), (step, *others) in alike.items():
        text = f"{step.path} {_CONFLICT_HELP[verb].format(step.path, step.note)}"
        text += f" ({len(others)} more for the same reason)" if others else ""
        click.echo(f"error: {make_visible(text)}", err=True)


def _print_code_findings(step: FileStep) -> None:
    for finding in step.findings:
        path = finding.path or step.path
        place = f"{path}:{finding.line}:{finding.column}" if finding.line else path
        severity = "note" if finding.is_note else "error"
        click.echo(f"{severity}: {make_visible(f'{place}: {finding.message}')}", err=True)
