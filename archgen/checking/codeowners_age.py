"""Tell where the CODEOWNERS file that archgen wrote is no longer what follows from the owners in the architecture."""

from __future__ import annotations

import os
from itertools import chain
from pathlib import Path

from archgen.checking.all_rules import index_all_rules
from archgen.checking.checked_project import CheckedProject
from archgen.diagnostics import Diagnostic, Severity, Span, join_words, keep_first, settle_diagnostics
from archgen.findings.rule_table import STALE_CODEOWNERS
from archgen.frozen import replace
from archgen.syntax.folder_files import FolderFiles
from archgen.syntax.project_files import ProjectFiles

_MAX_BYTES = 3_000_000
"""GitHub reads no larger file."""
_MAX_LINES = 3


def add_codeowners_age(checked_project: CheckedProject) -> CheckedProject:
    """Return a checked project with the finding that its CODEOWNERS is out of date, if it is and archgen wrote it."""
    has_reviewers = any(partner.reviewers for partner in checked_project.architecture.partners.values())
    is_asked = checked_project.loaded_project.rule_settings.get(STALE_CODEOWNERS.name) is not Severity.OFF
    # Behind an error something may be missing, also owners.
    if not (has_reviewers and is_asked) or checked_project.structural_errors:
        return checked_project
    found = _read_codeowners(checked_project)
    problem = _judge_age(checked_project, *found) if found else None
    if problem is None:
        return checked_project
    findings = settle_diagnostics([problem], index_all_rules(), checked_project.loaded_project.rule_settings)
    all_findings = (*checked_project.findings, *findings)
    return replace(checked_project, findings=tuple(sorted(all_findings, key=lambda each: each.sort_key)))


def _judge_age(checked_project: CheckedProject, name: str, prefix: str, text: str) -> Diagnostic | None:
    # Late: all that renders comes along.
    from archgen.checking.code_ownership import make_codeowners
    from archgen.emit.codeowners_file import FILE_HEADER

    if FILE_HEADER.partition("\n")[0] not in text:
        return None
    present_lines = {line.strip() for line in text.splitlines()}
    wanted_lines = make_codeowners(checked_project, prefix).text.splitlines()
    missing_lines = [line for line in wanted_lines if line and line[0] != "#" and line not in present_lines]
    if not missing_lines:
        return None
    told_lines = keep_first([f"`{line}`" for line in missing_lines], _MAX_LINES)
    return Diagnostic(
        STALE_CODEOWNERS.name,
        f"CODEOWNERS is out of date: it lacks {join_words(told_lines)}",
        Span.of_file(os.path.relpath(f"/{name}", f"/{prefix}").replace(os.sep, "/")),
        help=f"`archgen owners --format codeowners -o {name}` makes it anew, from the top of the repository; lines of your own go below again",
    )


def _read_codeowners(checked_project: CheckedProject) -> tuple[str, str, str] | None:
    """Return the path and the project's folder from the top of the repository, and the text; None where there is none."""
    from archgen.emit.codeowners_file import CODEOWNERS_PATHS

    names = list(dict.fromkeys(chain(*CODEOWNERS_PATHS.values())))
    files = checked_project.loaded_project.files
    if isinstance(files, FolderFiles):
        root = Path(os.path.realpath(files.root))
        top = next((each for each in (root, *root.parents) if os.path.lexists(each / ".git")), root)
        prefix = root.relative_to(top).as_posix().removeprefix(".")
        found = [(name, _read_unlinked(top / name)) for name in names]
    elif (committed := _read_committed(files, names)) is not None:
        prefix, found = committed
    else:
        return None
    return next(
        ((name, prefix, data.decode("utf-8", "replace")) for name, data in found if data and len(data) <= _MAX_BYTES),
        None,
    )


def _read_committed(files: ProjectFiles, names: list[str]) -> tuple[str, list[tuple[str, bytes | None]]] | None:
    # Imported here: a check of files needs no git.
    from archgen.git import GitError, find_object_ids
    from archgen.syntax.committed_files import CommittedFiles

    if not isinstance(files, CommittedFiles):
        return None
    repository = files.objects.repository
    try:
        blobs = find_object_ids(repository, [f"{files.commit}:{name}" for name in names])
    except GitError:
        return None
    found = [(name, files.objects.read_blob(blob)) for name, blob in zip(names, blobs, strict=True) if blob]
    return os.path.relpath(files.root, repository.top).replace(os.sep, "/").removeprefix("."), found


def _read_unlinked(path: Path) -> bytes | None:
    """Return the first bytes of a file that is reached without links: these may lead out of the repository."""
    if os.path.realpath(path) != str(path) or not path.is_file():
        return None
    try:
        with path.open("rb") as stream:
            return stream.read(_MAX_BYTES + 1)
    except OSError:
        return None
