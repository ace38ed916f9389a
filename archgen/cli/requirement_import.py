"""`archgen import` of requirements: take requirements over, and bring them up to date."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

import click

from archgen.cli import command_support
from archgen.diagnostics import make_visible
from archgen.edit.requirement_slice import RequirementSlice, make_requirement_slice
from archgen.importers.foreign_import import ForeignFileError, ImportedRequirements
from archgen.importers.import_formats import ImportFormat
from archgen.pipeline import CheckedProject
from archgen.project import PROJECT_FILE

DEFAULT_SLICE = "requirements.yaml"


def import_requirements(
    import_format: ImportFormat, file: Path, into: Path | None, project: Path | None, *, dry_run: bool
) -> None:
    """Take the requirements of a file into the project, and print what became of each object.

    Nothing is written where the result would bring errors.
    """
    checked_project = command_support.check_or_exit(project)
    _refuse_single_file(checked_project)
    imported = _read_file(import_format, file, checked_project)
    for line in _summarise_objects(file, imported):
        click.echo(make_visible(line))
    if not imported.requirements:
        click.echo("Nothing was written: there is no requirement in the file.", err=True)
        raise click.exceptions.Exit(1)
    requirement_slice = _make_slice(checked_project, imported, into)
    for line in _summarise_slice(requirement_slice):
        click.echo(make_visible(line))
    if not dry_run:
        target = _find_target(checked_project, into)
        command_support.write_slice(target, requirement_slice, "name another file behind --into")


def _refuse_single_file(checked_project: CheckedProject) -> None:
    if checked_project.loaded_project.first_file != PROJECT_FILE:
        raise click.UsageError("a project of a single file reads no slices: put it into a folder as archgen.yaml first")


def _read_file(import_format: ImportFormat, file: Path, checked_project: CheckedProject) -> ImportedRequirements:
    try:
        imported: ImportedRequirements = import_format.load_reader()(
            file, checked_project.architecture.requirements.values()
        )
    except ForeignFileError as error:
        click.echo(make_visible(f"error: {error.span}: {error.message}"), err=True)
        click.echo(make_visible(f"  = help: {error.help_line}"), err=True)
        click.echo("Nothing was written.", err=True)
        raise click.exceptions.Exit(1) from None
    except OSError as error:
        raise click.ClickException(make_visible(f"{file} cannot be read: {error.strerror}")) from None
    return imported


def _summarise_objects(file: Path, imported: ImportedRequirements) -> Iterator[str]:
    """Yield the account of the file: how many objects were taken, and each that was not, with the reason."""
    fates = [account.fate for account in imported.accounts]
    counts = ", ".join(f"{fates.count(fate)} {fate}" for fate in ("taken", "left out", "not taken") if fate in fates)
    yield f"{file.name}: {len(fates)} object{'s' * (len(fates) != 1)}{': ' if counts else ''}{counts}"
    for account in imported.accounts:
        if account.fate != "taken":
            yield f"  {account.fate}: {account.place} `{account.name[:80]}`: {account.reason}"
        elif account.reason and account.id:
            yield f"  taken as `{account.id}`: {account.place}: {account.reason}"
    for name, count in sorted(imported.unread_attributes.items()):
        yield f"  attribute not taken: `{name}` of {count} object{'s' * (count != 1)}"
    for name, count in sorted(imported.unread_relations.items()):
        yield f"  relations not taken: {count} of the type `{name}`"
    for name, parent in imported.closing_relations:
        yield f"  relation not taken: `{name}` is a part of `{parent}`, which would be a part of itself"


def _make_slice(checked_project: CheckedProject, imported: ImportedRequirements, into: Path | None) -> RequirementSlice:
    target = _find_target(checked_project, into)
    root = checked_project.root.resolve()
    if not target.is_relative_to(root):
        raise click.UsageError(make_visible(f"{into} does not lie in the project's folder"))
    sections = {"use_cases": imported.use_cases, "requirements": imported.requirements}
    requirement_slice = make_requirement_slice(checked_project, sections, target.relative_to(root).as_posix())
    if requirement_slice.errors:
        command_support.print_findings(
            command_support.settle_problems(requirement_slice.errors), checked_project, sys.stderr
        )
        click.echo("Nothing was written: these errors stand in the slice, or would come with it.", err=True)
        raise click.exceptions.Exit(1)
    return requirement_slice


def _find_target(checked_project: CheckedProject, into: Path | None) -> Path:
    return (into if into is not None else checked_project.root / DEFAULT_SLICE).resolve()


def _summarise_slice(requirement_slice: RequirementSlice) -> Iterator[str]:
    counts = (
        (len(requirement_slice.added), "new"),
        (len(requirement_slice.changed), "changed"),
        (len(requirement_slice.unchanged), "as before"),
    )
    yield f"{requirement_slice.file}: {', '.join(f'{count} {word}' for count, word in counts)}"
    yield from (f"  no longer in the file, kept: {name}" for name in requirement_slice.missing)
    yield from (f"  said otherwise in another file, kept: {key}" for key in requirement_slice.written_elsewhere)
    if requirement_slice.is_rewritten:
        yield "  written anew: comments could not stay in their places, and stand at the beginning"
