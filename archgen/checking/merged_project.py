"""A loaded project whose slices and libraries are one table."""

from __future__ import annotations

from archgen import project
from archgen.checking.all_rules import list_structural_errors
from archgen.diagnostics import Diagnostic
from archgen.frozen import dataclass
from archgen.link import library_merging, slice_merging
from archgen.link.variants import variant_order
from archgen.project import LoadedProject
from archgen.syntax.yaml_tree import MappingNode


@dataclass(frozen=True, slots=True)
class MergedProject:
    """A loaded project whose slices and libraries are one table, and what was found on the way."""

    loaded_project: LoadedProject
    table: MappingNode
    diagnostics: tuple[Diagnostic, ...]
    reading_errors: tuple[Diagnostic, ...]
    damaged_elements: frozenset[str]

    @property
    def is_folder(self) -> bool:
        """Whether it is a folder: a project of one file is a whole, and what it names, like its `sources`, lies elsewhere."""
        return self.loaded_project.first_file == project.PROJECT_FILE


def merge_project(loaded_project: LoadedProject) -> MergedProject:
    """Return a loaded project as one table, with what was found in merging it."""
    # These errors mean that something is missing in the architecture: the findings that they explain wait, so that one
    # mistake is reported once.
    reading_errors = tuple(list_structural_errors(loaded_project.diagnostics))
    damaged_elements = frozenset(error.element for error in reading_errors if error.element)
    merged_table, merge_findings = slice_merging.merge_documents(
        loaded_project.documents, loaded_project.lost_keys, damaged_elements
    )
    merged_table, library_findings = library_merging.merge_libraries(merged_table, loaded_project.libraries)
    variant_findings = (
        tuple(variant_order.check_variant_order(merged_table, loaded_project.lost_keys))
        if "variants" in merged_table.entries
        else ()
    )
    pass_findings = _find_wrong_passes(loaded_project)
    all_findings = (*merge_findings, *library_findings, *variant_findings, *pass_findings)
    return MergedProject(loaded_project, merged_table, all_findings, reading_errors, damaged_elements)


def _find_wrong_passes(loaded_project: LoadedProject) -> tuple[Diagnostic, ...]:
    is_folder = loaded_project.first_file == project.PROJECT_FILE
    if not is_folder or not loaded_project.files.has_path(project.PASS_FOLDER.rstrip("/")):
        return ()
    # Imported here: hardly any project has passes of its own.
    from archgen.passes.patterns.pattern_registry import find_wrong_passes

    return tuple(find_wrong_passes(loaded_project.files, loaded_project.sources))
