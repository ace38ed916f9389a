"""`archgen transform`: write the project that passes make of a project."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

import click

from archgen.cli import command_support, shared_options
from archgen.diagnostics import make_visible
from archgen.syntax.file_patterns import YAML_ENDINGS

if TYPE_CHECKING:
    from archgen.pipeline import CheckedProject
    from archgen.products.trusted_backends import TrustedRevision


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
@click.argument("names", metavar="PASS...", nargs=-1, shell_complete=_complete_passes)
@shared_options.project_option
@shared_options.variant_option
@click.option("--list", "lists_passes", is_flag=True, help="Show all passes: what they do, need and leave true.")
@shared_options.output_option("The file, or the folder (its archgen.yaml)", "transformed.yaml")
@shared_options.keep_going_option
@shared_options.trust_option
def command(  # noqa: PLR0913 - one for each option
    names: tuple[str, ...],
    project: Path | None,
    output: Path | None,
    trust: str | None,
    *,
    lists_passes: bool,
    keep_going: bool,
) -> None:
    """Write what each PASS, one after the other, makes of a project: again a project, of one file.

    A pass that needs others runs behind them. `--list` shows all, and those of the project: files of rules in its folder
    `passes`. The project itself stays as it is.
    """
    if lists_passes:
        _print_passes(project)
        return
    if not names:
        raise click.UsageError("name one pass or several; `archgen transform --list` shows all")
    checked_project = command_support.check_before_writing(project, keep_going=keep_going)
    transformed_project = _transform_or_exit(
        checked_project, names, command_support.find_trusted_revision(project, trust)
    )
    ran = transformed_project.transformed.passes if transformed_project.transformed else ()
    further = [name for name in dict.fromkeys(ran) if name not in names]
    if further:
        click.echo(f"Ran before, since they are needed: {', '.join(further)}.", err=True)
    command_support.print_findings_above(transformed_project)
    findings = transformed_project.transformed.findings if transformed_project.transformed else ()
    if any(each.rule == "wrong-pass" for each in findings):
        click.echo("Nothing was written.", err=True)
        sys.exit(1)
    if command_support.exit_status(transformed_project.findings) and not keep_going:
        click.echo("Nothing was written. With --keep-going it is written with its errors.", err=True)
        sys.exit(1)
    target = output or checked_project.output_folder / "transformed.yaml"
    if target.is_dir() or target.suffix not in YAML_ENDINGS:
        target /= "archgen.yaml"
    from archgen.products import project_outputs

    with command_support.explain_write_errors():
        project_outputs.write_packed(transformed_project, target)
    command_support.print_written(target)
    command_support.exit_by_findings(transformed_project)


def _transform_or_exit(
    checked_project: CheckedProject, names: tuple[str, ...], trusted_revision: TrustedRevision | None
) -> CheckedProject:
    from archgen.passes import UnknownPassError
    from archgen.products import project_passes

    with command_support.explain_write_errors(), command_support.explain_wrong_usage(UnknownPassError):
        passes = project_passes.choose_passes(checked_project, names, trusted_revision)
    dropping = [each.name for each in passes.ordered if not each.keeps_variants]
    if checked_project.variants and dropping:
        variant_names = ", ".join(checked_project.variants)
        click.echo(
            f"`{dropping[0]}` takes the project as it stands: without its variants ({variant_names}), or in the one that"
            " `--variant` names.",
            err=True,
        )
    return project_passes.transform_by_name(checked_project, passes)


def _print_passes(project: Path | None) -> None:
    """Print every pass with what it does, needs and leaves true."""
    from archgen.passes.pass_shape import STATES
    from archgen.passes.patterns.pattern_registry import find_known_passes
    from archgen.project import ProjectNotFoundError, load_project

    try:
        loaded_project = load_project(project)
    except ProjectNotFoundError as error:
        if project is not None:
            raise click.UsageError(str(error)) from None
        loaded_project = None
    for each in find_known_passes(loaded_project).passes.values():
        click.echo(make_visible(f"{each.name}: {each.title}"))
        for words, states in (("needs", each.needs), ("leaves", each.leaves), ("ends", each.ends)):
            for state in states:
                click.echo(f"    {words} {state}: {STATES[state]}")
