"""From a checked project to who owns what in it, and to CODEOWNERS."""

from __future__ import annotations

from pathlib import Path

from archgen.emit import codeowners as emitter
from archgen.emit.codeowners import Codeowners
from archgen.git import NoRepositoryError, repository
from archgen.link.places import places
from archgen.pipeline import Checked
from archgen.views.owners import Ownership
from archgen.views.owners import ownership as sorted_out


def ownership(checked: Checked) -> Ownership:
    """Find out which partner owns which elements and files of a project."""
    # Files come from the merged tree: the architecture keeps one span for an element, but slices may add to it in
    # others.
    return sorted_out(checked.architecture, places(checked.merged), checked.files)


def codeowners(checked: Checked, prefix: str | None = None) -> Codeowners:
    """Make CODEOWNERS.

    `prefix` is the project's folder relative to the root of the repository; None asks git.
    """
    return emitter.codeowners(ownership(checked), _prefix(checked.root) if prefix is None else prefix)


def _prefix(root: Path) -> str:
    """Return the folder of a project relative to its repository, empty outside of any."""
    try:
        return repository(root).prefix
    except NoRepositoryError:
        return ""
