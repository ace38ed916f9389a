"""What a project names beside its YAML: chapters, pictures, parameter files, results of tests."""

from __future__ import annotations

from archgen.checking.linked_project import LinkedProject, PartMemory
from archgen.checking.merged_project import MergedProject
from archgen.diagnostics.diagnostic import Diagnostic
from archgen.frozen import replace
from archgen.link import (
    hint_checks,
    named_files,
    node_parameter_files,
    report_chapters,
    verification_files,
)
from archgen.link.report_chapters import ReportChapters


def read_named_contents(
    merged_project: MergedProject, linked_project: LinkedProject, part_memory: PartMemory | None = None
) -> tuple[ReportChapters, tuple[Diagnostic, ...]]:
    """Return the chapters of a project's report, and what is wrong with the files that the project names."""
    loaded_project, merged_table = merged_project.loaded_project, merged_project.table
    is_folder = merged_project.is_folder
    project_chapters, chapter_findings = report_chapters.read_chapters(merged_table, loaded_project.files)
    missing_pictures = report_chapters.find_missing_pictures(
        project_chapters, report_chapters.locate_packed_texts(merged_table), loaded_project.sources
    )
    files_by_element = tuple(
        named_files.list_named_files(merged_table, part_memory.named_files if part_memory else None)
    )
    project_chapters = replace(project_chapters, image_paths=named_files.list_image_paths(files_by_element))
    named_file_findings = named_files.find_missing_files(files_by_element, project_chapters, is_folder=is_folder)
    missing_files = (
        tuple(node_parameter_files.find_missing_parameter_files(merged_table, loaded_project.files))
        if is_folder
        else ()
    )
    missing_verifications = verification_files.find_missing_verifications(
        linked_project.linked_architecture, loaded_project.files if is_folder else None
    )
    wrong_hints = (
        tuple(hint_checks.find_wrong_hints(linked_project.linked_architecture, loaded_project.files))
        if is_folder
        else ()
    )
    problems = (
        *chapter_findings,
        *missing_pictures,
        *missing_files,
        *named_file_findings,
        *missing_verifications,
        *wrong_hints,
    )
    return project_chapters, problems
