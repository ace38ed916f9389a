"""`archgen transform`: write the project that passes make of a project."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

import click

from archgen.cli import command_support, shared_options

if TYPE_CHECKING:
    from archgen.pipeline import CheckedProject

_YAML_SUFFIXES = frozenset({".yaml", ".yml"})


def _complete_passes(_context: click.Context, _parameter: click.Parameter, incomplete: str) -> list[str]:
    """Complete the names of passes."""
    from archgen.passes import PASSES

    return [name for name in PASSES if name.startswith(incomplete)]


@click.command("transform")
@click.argument("names", metavar="PASS...", nargs=-1, shell_complete=_complete_passes)
@shared_options.project_option
@shared_options.variant_option
@click.option("--list", "lists_passes", is_flag=True, help="Show all passes: what they do, need and leave true.")
@shared_options.output_option("The file, or the folder (its archgen.yaml)", "transformed.yaml")
@shared_options.keep_going_option
def command(
    names: tuple[str, ...], project: Path | None, output: Path | None, *, lists_passes: bool, keep_going: bool
) -> None:
    """Write what each PASS, one after the other, makes of a project: again a project, of one file.

    A pass that needs others runs behind them. `--list` shows all. The project itself stays as it is.
    """
    if lists_passes:
        _print_passes()
        return
    if not names:
        msg = "name one pass or several; `archgen transform --list` shows all"
        raise click.UsageError(msg)
    _check_names(names)
    checked_project = command_support.check_before_writing(project, keep_going=keep_going)
    transformed_project = _transform_or_exit(checked_project, names)
    _report_further_passes(names, transformed_project)
    command_support.print_findings_above(transformed_project)
    if command_support.exit_status(transformed_project.findings) and not keep_going:
        click.echo("Nothing was written. With --keep-going it is written with its errors.", err=True)
        sys.exit(1)
    target = output or checked_project.output_folder / "transformed.yaml"
    if target.is_dir() or target.suffix not in _YAML_SUFFIXES:
        target /= "archgen.yaml"
    from archgen.products import project_outputs

    with command_support.explain_write_errors():
        project_outputs.write_packed(transformed_project, target)
    command_support.print_written(target)
    command_support.exit_by_findings(transformed_project)


def _check_names(names: tuple[str, ...]) -> None:
    """Refuse names that are none of passes before the project is read."""
    from archgen.diagnostics.safe_text import make_visible
    from archgen.passes import UnknownPassError, order_passes

    try:
        order_passes(names)
    except UnknownPassError as error:
        raise click.UsageError(make_visible(str(error))) from None


def _transform_or_exit(checked_project: CheckedProject, names: tuple[str, ...]) -> CheckedProject:
    from archgen import pipeline
    from archgen.passes import order_passes

    dropping = [each.name for each in order_passes(names) if not each.keeps_variants]
    if checked_project.variants and dropping:
        variant_names = ", ".join(checked_project.variants)
        click.echo(
            f"`{dropping[0]}` takes the project as it stands: without its variants ({variant_names}), or in the one that"
            " `--variant` names.",
            err=True,
        )
    return pipeline.transform_project(checked_project, names)


def _report_further_passes(names: tuple[str, ...], transformed_project: CheckedProject) -> None:
    """Say which passes ran that others needed."""
    ran = transformed_project.transformed.passes if transformed_project.transformed else ()
    further = [name for name in dict.fromkeys(ran) if name not in names]
    if further:
        click.echo(f"Ran before, since they are needed: {', '.join(further)}.", err=True)


def _print_passes() -> None:
    """Print every pass with what it does, needs and leaves true."""
    from archgen.passes import PASSES
    from archgen.passes.pass_shape import STATES

    for each in PASSES.values():
        click.echo(f"{each.name}: {each.title}")
        for words, states in (("needs", each.needs), ("leaves", each.leaves), ("ends", each.ends)):
            for state in states:
                click.echo(f"    {words} {state}: {STATES[state]}")
