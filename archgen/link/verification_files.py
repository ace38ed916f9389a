"""Look for the files that requirements name as what verifies them."""

from __future__ import annotations

import posixpath
from collections.abc import Iterator

from archgen.diagnostics import Diagnostic, did_you_mean
from archgen.model.architecture import Architecture
from archgen.model.requirement import Requirement, Verification
from archgen.syntax.project_files import ProjectFiles

_MAX_GUESSES = 50
"""So many get a guess; it is looked for among all use cases and chains."""


def find_missing_verifications(architecture: Architecture, files: ProjectFiles | None) -> Iterator[Diagnostic]:
    """Report what requirements name in `verified_by` and is neither a use case, nor a chain, nor a file of the project.

    `files` are those of the project's folder, None for a project of one file.
    """
    search = _FileSearch(files)
    guess_count = 0
    for requirement in architecture.requirements.values():
        for verification in requirement.verified_by:
            if verification.kind != "file" or _may_be_unread(architecture, verification):
                continue
            if search.is_missing(verification):
                guess_count += 1
                names = (*architecture.use_cases, *architecture.chains) if guess_count <= _MAX_GUESSES else ()
                yield _diagnose_missing(requirement, verification, did_you_mean(verification.text, names))


def _may_be_unread(architecture: Architecture, verification: Verification) -> bool:
    """Whether what could not be read may declare it."""
    sections = {verification.text, "use_cases", "chains"}
    return architecture.partial or not sections.isdisjoint(architecture.unread_keys)


def _diagnose_missing(requirement: Requirement, verification: Verification, guess: str | None) -> Diagnostic:
    return Diagnostic(
        "missing-verification",
        f"`{verification.text}` is neither a use case, nor a chain, nor a file of the project",
        verification.at,
        help=guess or "write the path of a file from the project's folder, or a sentence with a blank",
        element=requirement.id,
    )


class _FileSearch:
    """Looks for each file once: a thousand requirements may name one."""

    def __init__(self, files: ProjectFiles | None) -> None:
        self._files = files
        self._present_paths: dict[str, bool] = {}

    def is_missing(self, verification: Verification) -> bool:
        """Whether a file is not where it should be."""
        if not verification.file:
            return True
        if self._files is None:
            return "/" not in verification.file and "." not in verification.file
        folders = dict.fromkeys(["", posixpath.dirname(verification.at.file)])
        return not any(self._is_present(posixpath.join(folder, verification.file)) for folder in folders)

    def _is_present(self, path: str) -> bool:
        path = posixpath.normpath(path)
        # Nothing outside is looked at, not even whether it exists.
        if self._files is None or path.startswith(("../", "/")) or path == "..":
            return False
        if path not in self._present_paths:
            self._present_paths[path] = self._files.has_path(path) and not self._files.is_behind_link(path)
        return self._present_paths[path]
