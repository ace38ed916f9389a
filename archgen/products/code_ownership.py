"""From a checked project to who owns what in it, and to CODEOWNERS."""

from __future__ import annotations

from pathlib import Path

from archgen.emit import codeowners_file as emitter
from archgen.emit.codeowners_file import CodeownersFile
from archgen.git import NoRepositoryError, find_repository
from archgen.link.element_files import find_element_files
from archgen.pipeline import CheckedProject
from archgen.views.partner_ownership import Ownership
from archgen.views.partner_ownership import assign_ownership as sorted_out


def find_ownership(checked_project: CheckedProject) -> Ownership:
    """Find out which partner owns which elements and files of a project."""
    # Files come from the merged tree: the architecture keeps one span for an element, but slices may add to it in
    # others.
    return sorted_out(
        checked_project.architecture, find_element_files(checked_project.merged_table), checked_project.yaml_files
    )


def make_codeowners(checked_project: CheckedProject, prefix: str | None = None) -> CodeownersFile:
    """Make CODEOWNERS.

    `prefix` is the project's folder relative to the root of the repository; None asks git.
    """
    return emitter.render_codeowners(
        find_ownership(checked_project), _repository_prefix(checked_project.root) if prefix is None else prefix
    )


def _repository_prefix(root: Path) -> str:
    """Return the folder of a project relative to its repository, empty outside of any."""
    try:
        return find_repository(root).prefix
    except NoRepositoryError:
        return ""
