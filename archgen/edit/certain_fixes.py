"""Plan what `archgen check --fix` writes: the fixes of which nothing else can have been meant, each file proven first."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Sequence

from archgen import pipeline
from archgen.diagnostics.suggested_fixes import TextEdit, apply_edits, suggest_fix
from archgen.edit import edit_proof
from archgen.edit.element_edit import BYTE_ORDER_MARK, EditRefusedError, FileEdit, read_editable
from archgen.pipeline import CheckedProject
from archgen.syntax import yaml_parser
from archgen.syntax.yaml_tree import node_to_data


def plan_certain_fixes(checked_project: CheckedProject, files: Collection[str] = ()) -> Iterator[tuple[FileEdit, int]]:
    """Yield an edit of each file that has certain fixes, with how many it makes; `files` are those asked for, none for all.

    A fix that cannot be proven is left out. Files of libraries are others' and stay as they are.
    """
    loaded_project = checked_project.loaded_project
    own_files = {*checked_project.yaml_files, *loaded_project.broken_files} - {*loaded_project.library_files}
    by_file: dict[str, list[tuple[TextEdit, ...]]] = {}
    for finding in checked_project.findings:
        fix = suggest_fix(finding, checked_project.sources) if finding.span.file in own_files else None
        if fix is not None and fix.is_certain and (not files or finding.span.file in files):
            by_file.setdefault(finding.span.file, []).append(fix.edits)
    for file, fixes in by_file.items():
        edit = _plan_file(checked_project, file, fixes)
        if edit is not None:
            yield edit


def _plan_file(
    checked_project: CheckedProject, file: str, fixes: Sequence[tuple[TextEdit, ...]]
) -> tuple[FileEdit, int] | None:
    try:
        content, text = read_editable(checked_project, file)
    except EditRefusedError:
        return None
    mark = BYTE_ORDER_MARK if text.startswith(BYTE_ORDER_MARK) else ""
    text = text.removeprefix(mark)
    edits = join_edits(fixes)
    new_text = apply_edits(text, edits)
    proven = edits if _is_proven(checked_project, file, text, new_text) else ()
    if not proven and len(fixes) > 1:  # one of them is wrong: each by itself
        proven = join_edits([fix for fix in fixes if _is_proven(checked_project, file, text, apply_edits(text, fix))])
        new_text = apply_edits(text, proven)
        proven = proven if _is_proven(checked_project, file, text, new_text) else ()
    if not proven or new_text == text:
        return None
    return FileEdit(file, content, f"{mark}{new_text}".encode(), min(edit.span.line for edit in proven)), len(proven)


def join_edits(fixes: Sequence[tuple[TextEdit, ...]]) -> tuple[TextEdit, ...]:
    """Return the edits of several fixes in their order, without those that overlap an earlier one."""
    joined: list[TextEdit] = []
    for edit in sorted({edit for fix in fixes for edit in fix}):
        if not joined or joined[-1].span[3:] <= edit.span[1:3]:
            joined.append(edit)
    return tuple(joined)


def _is_proven(checked_project: CheckedProject, file: str, text: str, new_text: str) -> bool:
    """Whether a text says the same but for case and signs, and the project has other findings, and no more errors.

    Errors may come to light that one which is mended has hidden; in a file that could not be read, any number of them.
    """
    if _fold(text) != _fold(new_text):
        return False
    old_document, _ = yaml_parser.parse_yaml(file, text)
    new_document, _ = yaml_parser.parse_yaml(file, new_text)
    if old_document is not None and (
        new_document is None
        or _fold_data(node_to_data(old_document.root)) != _fold_data(node_to_data(new_document.root))
    ):
        return False
    judged = pipeline.judge_project(edit_proof.load_with_text(checked_project, file, new_text))
    old_names, new_names = (
        {(finding.rule, finding.message, finding.span) for finding in project.findings}
        for project in (checked_project, judged)
    )
    has_more = _count_errors(judged) > _count_errors(checked_project)
    return not old_names <= new_names and (old_document is None or not has_more)


def _count_errors(checked_project: CheckedProject) -> int:
    return sum(finding.severity == "error" for finding in checked_project.findings)


def _fold(text: str) -> str:
    """Return the letters and digits of a text, in one case."""
    return re.sub(r"[\W_]+", "", text.casefold())


def _fold_data(data: object) -> object:
    if isinstance(data, dict):
        return tuple((_fold(str(key)), _fold_data(value)) for key, value in data.items())
    if not isinstance(data, list):
        return _fold(str(data))
    entries = [_fold_data(value) for value in data]
    return entries[0] if len(entries) == 1 else entries  # brackets around one are signs, too
