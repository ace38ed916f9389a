"""An edit that is proposed and not written: what it would make of the project, judged in memory."""

from __future__ import annotations

import posixpath
from collections import Counter
from collections.abc import Iterable, Sequence

from archgen import pipeline
from archgen.diagnostics import Diagnostic
from archgen.diagnostics.finding_identity import identify_finding
from archgen.edit.edit_proof import first_file_of
from archgen.edit.element_edit import EditRefusedError, FileEdit, read_editable
from archgen.frozen import NamedTuple
from archgen.pipeline import CheckedProject
from archgen.project.project_loading import load_from_files
from archgen.syntax.file_patterns import YAML_ENDINGS
from archgen.syntax.project_files import MAX_BYTES, OverlaidFiles


class TextChange(NamedTuple):
    """A text of a file that stands there once, and what is to stand there; an empty one makes a new file."""

    file: str
    old: str
    new: str


class ProposedEdit(NamedTuple):
    """The files with the edit, and the findings that it brings and takes away."""

    edits: tuple[FileEdit, ...]
    checked_project: CheckedProject
    new_findings: tuple[Diagnostic, ...]
    gone_findings: tuple[Diagnostic, ...]


def judge_proposal(checked_project: CheckedProject, changes: Iterable[TextChange]) -> ProposedEdit:
    """Return what some changes of texts would make of a project. Raise EditRefusedError for what cannot be made."""
    contents: dict[str, tuple[bytes | None, str]] = {}
    for change in changes:
        _refuse_foreign(checked_project, change.file)
        files = checked_project.loaded_project.files
        if change.file not in contents:
            is_there = files.has_path(change.file)
            contents[change.file] = read_editable(checked_project, change.file) if is_there else (None, "")
        old_content, text = contents[change.file]
        contents[change.file] = old_content, _replace_text(change, text)
    if not contents:
        raise EditRefusedError("there is nothing in it", "say which text of which file becomes which other one")
    edits = tuple(_make_edit(file, old, text) for file, (old, text) in sorted(contents.items()))
    files = checked_project.loaded_project.files
    overlaid = OverlaidFiles(files.root, {edit.file: edit.new_content for edit in edits}, files)
    edited = pipeline.judge_project(load_from_files(overlaid, first_file_of(checked_project)))
    return ProposedEdit(
        edits,
        edited,
        _list_missing(edited.findings, checked_project.findings),
        _list_missing(checked_project.findings, edited.findings),
    )


def _refuse_foreign(checked_project: CheckedProject, file: str) -> None:
    """Raise EditRefusedError for a file that is no part of the project and cannot become one."""
    files = checked_project.loaded_project.files
    if (
        posixpath.isabs(file)
        or "\\" in file
        or posixpath.normpath(file) != file
        or file.startswith("..")
        or "\0" in file
    ):
        message = f"`{file}` lies outside of the project, or is not written plainly"
        raise EditRefusedError(message, "name a path from the project's folder, such as `groups/arm.yaml`")
    is_own = file in checked_project.input_files and file not in checked_project.loaded_project.library_files
    is_new = not files.has_path(file) and file.endswith(YAML_ENDINGS)
    if files.is_behind_link(file) or not (is_own or is_new):
        message = f"`{file}` is none of the project's own files"
        raise EditRefusedError(message, "name a file that it reads, or a new one that ends in .yaml")


def _replace_text(change: TextChange, text: str) -> str:
    count = text.count(change.old) if change.old else int(not text)
    if count != 1:
        what = f"stands there {count} times" if change.old and count else "is not in it"
        message = f"`{change.file}`: the old text {what if change.old else 'is empty, and the file is there'}"
        raise EditRefusedError(message, "give a text that stands there once, with some lines around it")
    new_text = text.replace(change.old, change.new) if change.old else change.new
    if len(new_text) > MAX_BYTES:
        raise EditRefusedError(f"`{change.file}` would be too large")
    return new_text


def _make_edit(file: str, old_content: bytes | None, text: str) -> FileEdit:
    try:
        return FileEdit(file, old_content, text.encode(), 1)
    except UnicodeEncodeError:
        raise EditRefusedError(f"`{file}`: the new text is no text") from None


def _list_missing(findings: Sequence[Diagnostic], others: Sequence[Diagnostic]) -> tuple[Diagnostic, ...]:
    """Return the findings that are not among others, each as often as it is missing there."""
    left = Counter(map(identify_finding, others))
    missing = []
    for finding in findings:
        identity = identify_finding(finding)
        if left[identity]:
            left[identity] -= 1
        else:
            missing.append(finding)
    return tuple(missing)
