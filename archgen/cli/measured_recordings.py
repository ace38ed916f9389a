"""`archgen timing --measured` and `--adopt`: recordings held against the design, and taken into the project."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import click

from archgen.cli import command_support, shared_options
from archgen.diagnostics import format_json, make_visible
from archgen.diagnostics.text_columns import find_width, wrap_line
from archgen.edit.measured_slice import MeasuredSlice, make_measured_slice
from archgen.emit.terminal import measured_text
from archgen.importers.foreign_import import ReadRecordings, RecordingRefusedError
from archgen.installed_plugins import load_reader
from archgen.model.architecture import Architecture
from archgen.pipeline import CheckedProject
from archgen.project import PROJECT_FILE
from archgen.timing.analysis import Analysis, ChainResult
from archgen.timing.chains.chain_bounds import bound_all_chains
from archgen.timing.chains.measured_comparison import MeasuredComparison, Observation, compare_measured
from archgen.timing.run_analysis import analyse_architecture


def answer_recordings(
    checked_project: CheckedProject,
    architecture: Architecture,
    paths: Sequence[Path],
    slice_path: Path | None,
    *,
    as_json: bool,
) -> None:
    """Print what recordings say beside the design, and write the slice that adopts them if one is asked for.

    `architecture` is the project's with the figures of `--set`. Ends with status 1 where something could not be used.
    """
    if slice_path is not None:
        _refuse_target(checked_project, slice_path)
    recordings, comparisons, has_errors = _compare_recordings(checked_project, architecture, paths)
    measured_slice = None
    if slice_path is not None:
        _refuse_errors(checked_project, has_errors=has_errors)
        measured_slice = _make_slice(checked_project, recordings, slice_path)
    _print_answer(comparisons, recordings, measured_slice, as_json=as_json)
    if measured_slice is not None and slice_path is not None:
        _write_slice(checked_project, measured_slice, slice_path, as_json=as_json)
    if has_errors:
        raise click.exceptions.Exit(1)


def read_recorded_files(checked_project: CheckedProject, paths: Sequence[Path]) -> tuple[Observation, ...]:
    """Return what recordings say; what is wrong with them is printed. Ends with status 1 where something cannot be used."""
    recordings, _, has_errors = _compare_recordings(checked_project, checked_project.architecture, paths)
    if has_errors:
        raise click.exceptions.Exit(1)
    return recordings.observations


def _compare_recordings(
    checked_project: CheckedProject, architecture: Architecture, paths: Sequence[Path]
) -> tuple[ReadRecordings, tuple[MeasuredComparison, ...], bool]:
    """Read recordings and hold them against the design; print what is wrong with them, and return whether that is an error."""
    analysis = analyse_architecture(architecture)
    chains = bound_all_chains(analysis, architecture)
    recordings = _read_recordings(paths, architecture, analysis, chains)
    # So that excerpts below can show the lines of these files too.
    for file, text in recordings.texts:
        checked_project.sources.add_text(file, text)
    comparisons, unknown = compare_measured(analysis, recordings.observations, chains)
    problems = command_support.settle_problems((*recordings.diagnostics, *unknown))
    if problems:
        command_support.print_findings(problems, checked_project, sys.stderr)
    return recordings, comparisons, bool(command_support.exit_status(problems))


def _read_recordings(
    paths: Sequence[Path], architecture: Architecture, analysis: Analysis, chains: Mapping[str, ChainResult]
) -> ReadRecordings:
    read_measured = load_reader("recordings")
    with command_support.explain_write_errors(), command_support.explain_wrong_usage(RecordingRefusedError):
        recordings: ReadRecordings = read_measured(paths, architecture, analysis, chains)
    return recordings


def _print_answer(
    comparisons: tuple[MeasuredComparison, ...],
    recordings: ReadRecordings,
    measured_slice: MeasuredSlice | None,
    *,
    as_json: bool,
) -> None:
    if as_json:
        document = measured_text.measured_to_json(comparisons, recordings.observations, recordings.unmapped)
        adopted = {"adopted": _slice_to_json(measured_slice)} if measured_slice else {}
        click.echo(format_json({**document, **adopted}), nl=False)
        return
    width = find_width(sys.stdout)
    lines = measured_text.format_measured(comparisons, recordings.observations, recordings.unmapped, width)
    for line in (*lines, *(_list_left_out(measured_slice) if measured_slice else ())):
        click.echo("\n".join(wrap_line(make_visible(line), width)))


def _refuse_target(checked_project: CheckedProject, slice_path: Path) -> None:
    if checked_project.loaded_project.first_file != PROJECT_FILE:
        msg = "a project of a single file reads no slices: there is nothing that --adopt could write into"
        raise click.UsageError(msg)
    if slice_path.is_dir():
        msg = f"--adopt takes the name of a file, and {slice_path} is a folder; name the project first, or with -C"
        raise click.UsageError(make_visible(msg))


def _refuse_errors(checked_project: CheckedProject, *, has_errors: bool) -> None:
    if has_errors or checked_project.has_errors:
        click.echo("Nothing was written: there are errors.", err=True)
        raise click.exceptions.Exit(1)


def _make_slice(checked_project: CheckedProject, recordings: ReadRecordings, slice_path: Path) -> MeasuredSlice:
    measured_slice = make_measured_slice(
        checked_project, recordings.observations, _name_slice(checked_project.root, slice_path)
    )
    if measured_slice.errors:
        command_support.print_findings(measured_slice.errors, checked_project, sys.stderr)
        click.echo("Nothing was written: the slice would bring these errors.", err=True)
        raise click.exceptions.Exit(1)
    return measured_slice


def _find_slice(root: Path, slice_path: Path) -> Path:
    """Return where the slice is to be written: the default lies in the project, others where they are named."""
    return root / shared_options.MEASURED_SLICE if str(slice_path) == shared_options.MEASURED_SLICE else slice_path


def _name_slice(root: Path, slice_path: Path) -> str:
    """Return the path of the slice in the project; one that lies elsewhere keeps its own."""
    path = _find_slice(root, slice_path).resolve()
    return path.relative_to(root.resolve()).as_posix() if path.is_relative_to(root.resolve()) else slice_path.name


def _write_slice(
    checked_project: CheckedProject, measured_slice: MeasuredSlice, slice_path: Path, *, as_json: bool
) -> None:
    if not measured_slice.adopted:
        click.echo("Nothing was written: there is nothing to adopt.", err=True)
        return
    path, count = _find_slice(checked_project.root, slice_path), len(measured_slice.adopted)
    detail = None if as_json else f"{count} figure{'s' if count != 1 else ''}, measured and not proven"
    advice = "name another file behind --adopt, or move that one away"
    command_support.write_slice(path, measured_slice, advice, detail)


def _list_left_out(measured_slice: MeasuredSlice) -> Iterator[str]:
    """Yield what was not adopted, with what to write where instead."""
    if not measured_slice.left_out:
        return
    yield ""
    yield f"Not adopted: {len(measured_slice.left_out)}. To let a measured figure count, write it where the old one stands:"
    for figure in measured_slice.left_out:
        place = f"{figure.at}: " if figure.at.file else ""
        yield f"  {place}{figure.element}: {figure.why}; measured is {figure.proposal}"


def _slice_to_json(measured_slice: MeasuredSlice) -> dict[str, Any]:
    return {
        "file": measured_slice.file,
        "read": measured_slice.is_read,
        "figures": [{"id": element, "figure": key} for element, key in measured_slice.adopted],
        "left_out": [
            {
                "id": figure.element,
                "figure": figure.key,
                "why": figure.why,
                "proposal": figure.proposal,
                "at": str(figure.at) if figure.at.file else None,
            }
            for figure in measured_slice.left_out
        ],
    }
