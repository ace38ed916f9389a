"""`archgen transform`: rewrite a project by passes, and write what they make as a project."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from archgen.cli import command_support, shared_options


def _complete_passes(_context: click.Context, _parameter: click.Parameter, incomplete: str) -> list[str]:
    """Complete the names of passes: those of archgen, and those of the project around the current folder."""
    from archgen.passes.patterns.pattern_registry import find_known_passes
    from archgen.project import ProjectNotFoundError, load_project

    try:
        loaded_project = load_project(None)
    except ProjectNotFoundError:
        loaded_project = None
    return [name for name in find_known_passes(loaded_project).passes if name.startswith(incomplete)]


@click.command("transform")
@click.argument("names", nargs=-1, metavar="PASS...", shell_complete=_complete_passes)
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path),
    help="The file, or the folder for an archgen.yaml.  [default: archgen-out/transformed.yaml]",
)
@click.option("--list", "is_listing", is_flag=True, help="List the passes: what they do, need, and leave true.")
@shared_options.keep_going_option
@shared_options.trust_option
@shared_options.project_option
@shared_options.variant_option
def command(  # noqa: PLR0913 - one for each option
    *,
    names: tuple[str, ...],
    output: Path | None,
    is_listing: bool,
    keep_going: bool,
    trust: str | None,
    project: Path | None,
) -> None:
    """Rewrite a project by passes, in this order, and write what they make: again a project, in one file.

    Each PASS runs behind those that it needs. A project's own are files of rules in its folder `passes`.
    """
    from archgen.products import project_outputs, project_passes

    if is_listing:
        _print_list(project)
        return
    if not names:
        msg = "name a pass; `archgen transform --list` shows all"
        raise click.UsageError(msg)
    checked_project = command_support.check_before_writing(project, keep_going=keep_going)
    target = _find_target(output) if output else checked_project.output_folder / "transformed.yaml"
    with command_support.explain_write_errors():
        trusted_revision = command_support.find_trusted_revision(project, trust)
        transformed = project_passes.transform_by_name(checked_project, names, trusted_revision)
        problems = transformed.transformed.findings if transformed.transformed else ()
        errors = [each for each in transformed.findings if each.rule in {problem.rule for problem in problems}]
        if command_support.exit_status(errors):
            command_support.print_findings(errors, transformed, sys.stderr)
            click.echo("Nothing was written.", err=True)
            sys.exit(1)
        project_outputs.write_packed(transformed, target)
    command_support.print_findings_above(transformed)
    command_support.print_written(target)
    command_support.exit_by_findings(transformed)


def _find_target(output: Path) -> Path:
    is_file = output.suffix in {".yaml", ".yml"} and not output.is_dir()
    return output if is_file else output / "archgen.yaml"


def _print_list(project: Path | None) -> None:
    from archgen.diagnostics.safe_text import make_visible
    from archgen.diagnostics.text_columns import find_width, format_table
    from archgen.pipeline import check_project
    from archgen.products import project_passes
    from archgen.project import ProjectNotFoundError

    try:
        checked_project = check_project(project)
    except ProjectNotFoundError as error:
        if project is not None:
            raise click.UsageError(str(error)) from None
        checked_project = None
    rows = [
        [make_visible(each.name), each.origin, make_visible(each.title), ", ".join(each.needs), ", ".join(each.leaves)]
        for each in project_passes.list_pass_rows(checked_project)
    ]
    for line in format_table(["pass", "from", "does", "needs", "leaves"], rows, width=find_width(sys.stdout)):
        click.echo(line)
