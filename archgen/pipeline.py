"""All stages in order, from YAML files to findings. Read this module first for an overview of archgen.

project -> syntax -> schema -> compose -> link -> model -> derivation -> analyses -> findings

`archgen.checking` holds what happens between a loaded project and its findings; `archgen.products` goes on from there:
views -> emit -> files.
"""

from __future__ import annotations

import gc
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from archgen import project
from archgen.checking.all_rules import SHIPPED_RULES, index_all_rules
from archgen.checking.checked_project import CheckedProject
from archgen.checking.codeowners_age import add_codeowners_age
from archgen.checking.derived_projects import (
    UnknownVariantError,
    judge_in_variants,
    keep_variant_findings,
    list_variant_names,
    read_origins,
    stand_in_variants,
    transform_project,
)
from archgen.checking.linked_project import PartMemory, merge_project
from archgen.project import LoadedProject, ParsedSlices
from archgen.timing.run_analysis import AnalysisMemory

if TYPE_CHECKING:
    from archgen.model.architecture import Architecture
    from archgen.project import TrackedProject

__all__ = ["SHIPPED_RULES", "CheckedProject", "UnknownVariantError", "VersionCache", "check_at_revision"]
__all__ += ["check_loaded_project", "check_project", "check_tracked_project", "index_all_rules"]
__all__ += ["judge_project", "keep_variant_findings", "link_slices", "list_variant_names", "stand_in_variants"]
__all__ += ["transform_project"]


class VersionCache:
    """What versions of one project share; checks fill it.

    Pass the same one for all of them: files that are the same are parsed once, components and nodes in these that mean
    the same are linked once, and timing that is as in the version before is not analysed again.
    """

    def __init__(self) -> None:
        """Start empty."""
        self.parsed_slices: ParsedSlices = {}
        self.analysis_memory = AnalysisMemory()
        self.analysis_memory.make_room(2)
        self.part_memory = PartMemory()

    def forget_old_slices(self, checked_project: CheckedProject) -> None:
        """Forget the files as they were before: a day of editing has thousands of versions."""
        for file, text in list(self.parsed_slices):
            if checked_project.sources.text_of(file) != text:
                del self.parsed_slices[file, text]


def check_project(
    path: Path | None = None, version_cache: VersionCache | None = None, variants: Sequence[str] | None = None
) -> CheckedProject:
    """Read and check the project at a path (a folder, a file, or None for the one around the current folder).

    `variants` are those that are asked for: others are not judged; None is all of them. Raises `project.ProjectNotFoundError` if there is no project.
    """
    with _pause_garbage_collection():
        loaded_project = project.load_project(path, version_cache.parsed_slices if version_cache else None)
        return judge_project(loaded_project, version_cache, variants)


def check_at_revision(path: Path | None, revision: str, version_cache: VersionCache | None = None) -> CheckedProject:
    """Check the project at a path as it is at a revision of its repository, read from git's objects.

    Raises `git.GitError`, `project.NotAtRevisionError` if the project does not exist at the revision, and
    `project.ProjectNotFoundError` if there is neither a project nor a repository.
    """
    return check_tracked_project(project.find_tracked_project(path), revision, version_cache)


def check_tracked_project(
    tracked_project: TrackedProject, revision: str, version_cache: VersionCache | None = None
) -> CheckedProject:
    """Check a tracked project at a revision. For many revisions, find the project once, and share a cache."""
    version_cache = version_cache or VersionCache()
    with _pause_garbage_collection():
        loaded_project = project.load_at_revision(tracked_project, revision, version_cache.parsed_slices)
        return judge_project(loaded_project, version_cache)


def check_loaded_project(
    loaded_project: LoadedProject,
    version_cache: VersionCache,
    variants: Sequence[str] | None = None,
    *,
    has_timing: bool = True,
) -> CheckedProject:
    """Check a project that is loaded already; `variants` as for `check_project`."""
    with _pause_garbage_collection():
        return judge_project(loaded_project, version_cache, variants, has_timing=has_timing)


@contextmanager
def _pause_garbage_collection() -> Iterator[None]:
    """Pause the garbage collector: trees and models contain no cycles, and it walks all of them again and again."""
    # The command line has disabled it for good; this is for users of the Python API, whose setting is restored.
    was_enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_enabled:
            gc.enable()


def link_slices(data: Mapping[str, Any]) -> Architecture:
    """Return the architecture of a project that is at hand as plain data, with the names that count on the robot."""
    # Imported here: only what makes projects needs them.
    from archgen.project.project_loading import load_from_files
    from archgen.syntax.project_files import OverlaidFiles
    from archgen.syntax.yaml_writer import write_yaml

    text = write_yaml(data).encode()
    loaded_project = load_from_files(OverlaidFiles(Path(), {project.PROJECT_FILE: text}), project.PROJECT_FILE)
    return judge_project(loaded_project).architecture


def judge_project(
    loaded_project: LoadedProject,
    version_cache: VersionCache | None = None,
    variant_names: Sequence[str] | None = None,
    *,
    has_timing: bool = True,
) -> CheckedProject:
    """Run all stages on a loaded project, up to its findings; of one with variants, on it in each of them, too.

    `variant_names` are those that are asked for, None for all of them. What `version_cache` knows is not made anew; without
    one, nothing is remembered for another version. Without `has_timing` the rules that need its analysis find nothing.

    No stage stops at errors: each yields its diagnostics and passes on what is sound.
    """
    analysis_memory = version_cache.analysis_memory if version_cache else AnalysisMemory()
    part_memory = version_cache.part_memory if version_cache else None
    checked_project = judge_in_variants(
        merge_project(loaded_project), analysis_memory if has_timing else None, variant_names, part_memory
    )
    return add_codeowners_age(read_origins(checked_project))
