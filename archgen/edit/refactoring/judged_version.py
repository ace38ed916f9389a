"""A project as it is, or as some edits of its texts would make it, with the index of its references."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from archgen import pipeline
from archgen.checking.reference_index import ReferenceIndex, index_references
from archgen.diagnostics.suggested_fixes import TextEdit, apply_edits
from archgen.edit.edit_proof import first_file_of
from archgen.edit.element_edit import BYTE_ORDER_MARK, FileEdit, read_editable
from archgen.frozen import dataclass
from archgen.grouping import group_pairs
from archgen.pipeline import CheckedProject, VersionCache
from archgen.project.project_loading import LoadedProject, load_from_files
from archgen.syntax.project_files import OverlaidFiles


@dataclass(frozen=True, slots=True)
class JudgedVersion:
    """A checked project and where its elements are named; `cache` is for the versions that edits make of it."""

    project: CheckedProject
    index: ReferenceIndex
    cache: VersionCache


def judge_version(loaded_project: LoadedProject, cache: VersionCache | None = None) -> JudgedVersion:
    """Judge a loaded project, and find where its elements are named."""
    cache = cache or VersionCache()
    cache.part_memory.heard = []
    project = pipeline.check_loaded_project(loaded_project, cache)
    return JudgedVersion(project, index_references(project, cache.part_memory.heard), cache)


def judge_edited(version: JudgedVersion, contents: Mapping[str, bytes]) -> JudgedVersion:
    """Judge a project with some files' contents replaced, in memory."""
    files = version.project.loaded_project.files
    overlaid = OverlaidFiles(files.root, contents, files)
    first_file = first_file_of(version.project)
    return judge_version(load_from_files(overlaid, first_file, version.cache.parsed_slices), version.cache)


def edit_files(version: JudgedVersion, edits: Sequence[TextEdit]) -> tuple[FileEdit, ...]:
    """Return the files that edits change, in the order of their names. Raise EditRefusedError for one that cannot be read."""
    edits_by_file = group_pairs((edit.span.file, edit) for edit in edits)
    changed = []
    for file, own_edits in sorted(edits_by_file.items()):
        content, text = read_editable(version.project, file)
        mark = BYTE_ORDER_MARK if text.startswith(BYTE_ORDER_MARK) else ""
        new_text = mark + apply_edits(text.removeprefix(mark), own_edits)
        changed.append(FileEdit(file, content, new_text.encode(), min(edit.span.line for edit in own_edits)))
    return tuple(changed)
