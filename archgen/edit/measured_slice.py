"""The slice `measured.yaml`: execution times that were measured, for everything that no other file writes.

It is whole or nothing. What a slice of this name holds already stays in it.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import Any

from archgen import pipeline
from archgen.diagnostics.diagnostic import Diagnostic
from archgen.edit.edit_proof import list_new_errors, load_with_text
from archgen.edit.measured_figures import FigureSorter, LeftOutFigure, collect_times
from archgen.emit.own_file_marks import MEASURED_HEADER
from archgen.frozen import dataclass
from archgen.pipeline import CheckedProject
from archgen.project.project_loading import LoadedProject
from archgen.project.slice_parsing import parse_slice
from archgen.syntax import yaml_parser
from archgen.syntax.project_files import read_text_file
from archgen.syntax.yaml_tree import node_to_data
from archgen.syntax.yaml_writer import write_yaml
from archgen.timing.chains.measured_comparison import Observation


@dataclass(frozen=True, slots=True)
class MeasuredSlice:
    """The text of the slice; which figures are in it, which are not; the errors that it would cause."""

    file: str
    text: str
    adopted: tuple[tuple[str, str], ...]
    left_out: tuple[LeftOutFigure, ...]
    errors: tuple[Diagnostic, ...]
    is_read: bool
    """Whether the project reads the file, by its `sources`."""


def make_measured_slice(
    checked_project: CheckedProject, observations: Iterable[Observation], file: str
) -> MeasuredSlice:
    """Return the slice that adopts what was measured; `file` is its path in the project."""
    files = checked_project.loaded_project.files
    old_file = read_text_file(files, file) if files.has_path(file) else None
    old_text = old_file.text if old_file else ""
    data, diagnostics = _read_data(file, old_text)
    errors = [*diagnostics, *([old_file.problem] if old_file and old_file.problem else [])]
    if errors:
        # What cannot be read cannot be kept either.
        return MeasuredSlice(file, "", (), (), tuple(errors), is_read=True)
    # Without the slice itself, so that what it holds already is not taken for written elsewhere.
    others = pipeline.judge_project(load_with_text(checked_project, file, "{}\n")) if old_text else checked_project
    sorter = FigureSorter(others, data)
    adopted = [entry for times in collect_times(observations) for entry in sorter.add_times(times)]
    text = MEASURED_HEADER + write_yaml(data, dict.fromkeys(sorter.storing_paths, "measured, not proven"))
    loaded_project = load_with_text(checked_project, file, text)
    is_read = file in loaded_project.sources.file_names()
    if not is_read:
        loaded_project = _add_slice(loaded_project, file, text)
    new_errors = tuple(list_new_errors(checked_project, pipeline.judge_project(loaded_project)))
    return MeasuredSlice(file, text, tuple(adopted), tuple(sorter.left_out), new_errors, is_read)


def _read_data(file: str, text: str) -> tuple[dict[str, Any], tuple[Diagnostic, ...]]:
    """Return what a slice holds, and why it cannot be read."""
    if not text.strip():
        return {}, ()
    document, diagnostics = yaml_parser.parse_yaml(file, text)
    data = node_to_data(document.root) if document else None
    return (data, ()) if isinstance(data, dict) else ({}, diagnostics)


def _add_slice(loaded_project: LoadedProject, file: str, text: str) -> LoadedProject:
    """Return a project that reads a slice which its `sources` do not name."""
    parsed_slice = parse_slice(file, text)
    diagnostics = (*loaded_project.diagnostics, *parsed_slice.diagnostics, *parsed_slice.validate_once().diagnostics)
    loaded_project.sources.add_text(file, text)
    documents = (*loaded_project.documents, *([parsed_slice.document] if parsed_slice.document else []))
    return replace(loaded_project, documents=documents, diagnostics=diagnostics)
