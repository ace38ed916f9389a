"""Rename from an editor: the plan and the proof of `archgen rename`, of the texts as they stand there."""

from __future__ import annotations

import string
from collections.abc import Iterator

from archgen.checking.reference_index import Element
from archgen.diagnostics import Span
from archgen.diagnostics.suggested_fixes import TextEdit
from archgen.edit.element_edit import BYTE_ORDER_MARK, EditRefusedError, FileEdit
from archgen.edit.refactoring.element_rename import plan_rename
from archgen.edit.refactoring.judged_version import JudgedVersion
from archgen.live.edited_project import EditedProject
from archgen.syntax.mended_text import measure_common_lines, split_lines

_WORD_SIGNS = f"{string.ascii_letters}{string.digits}_"


def plan_edits(project: EditedProject, element: Element, new_name: str) -> tuple[list[TextEdit], tuple[str, ...]]:
    """Return what gives an element another name, and sentences on what follows. Raise EditRefusedError."""
    if not project.is_whole:
        project.check_wholly()
    for error in project.warm.list_text_errors(project.checked):
        raise EditRefusedError(f"line {error.span.line} of {error.span.file} cannot be read", "mend it first")
    version = JudgedVersion(project.checked, project.index, project.warm.cache)
    refactoring = plan_rename(version, element, new_name)
    return [edit for file_edit in refactoring.edits for edit in split_edit(file_edit)], refactoring.notes


def split_edit(file_edit: FileEdit) -> Iterator[TextEdit]:
    """Yield the edits of single words that make a file's new text; where lines came in, of all between the first and the last."""
    old_lines, new_lines = (
        split_lines((content or b"").decode().removeprefix(BYTE_ORDER_MARK))
        for content in (file_edit.old_content, file_edit.new_content)
    )
    if len(old_lines) != len(new_lines):
        above, below = measure_common_lines(old_lines, new_lines)
        last = len(old_lines) - below
        end = (last + 1, 1) if below else (last, len(old_lines[-1]) + 1)
        yield TextEdit(Span(file_edit.file, above + 1, 1, *end), "".join(new_lines[above : len(new_lines) - below]))
        return
    for number, (old, new) in enumerate(zip(old_lines, new_lines, strict=True), 1):
        if old != new:
            start, end_length = measure_common_lines(old, new)
            # Whole words, for people who look at them first.
            start = len(old[:start].rstrip(_WORD_SIGNS))
            end_length = len(old[len(old) - end_length :].lstrip(_WORD_SIGNS))
            span = Span(file_edit.file, number, start + 1, number, len(old) - end_length + 1)
            yield TextEdit(span, new[start : len(new) - end_length])
