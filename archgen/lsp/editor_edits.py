"""What an editor can change: what a finding's help says, all that is certain in a file, a comment that silences, or a name,
as `archgen rename` plans and proves it, in the texts as they stand there.
"""

from __future__ import annotations

import re
import string
from collections.abc import Iterable, Iterator, Sequence

from archgen.checking.reference_index import Element
from archgen.diagnostics import Diagnostic, SourceTexts, Span
from archgen.diagnostics.suggested_fixes import TextEdit, apply_edits, suggest_fix
from archgen.edit.certain_fixes import join_edits
from archgen.edit.edit_proof import NewElement, find_consequences
from archgen.edit.element_edit import BYTE_ORDER_MARK, EditRefusedError, FileEdit, insert_element, read_editable
from archgen.edit.element_place import place_in_section
from archgen.edit.refactoring.element_rename import plan_rename
from archgen.edit.refactoring.judged_version import JudgedVersion
from archgen.frozen import NamedTuple
from archgen.language.language_tables import PLAIN_SECTIONS
from archgen.live.warm_project import EditedProject
from archgen.model.path_resolver import title_from_id
from archgen.pipeline import index_all_rules
from archgen.syntax.mended_text import measure_common_lines, split_lines
from archgen.syntax.yaml_parser import parse_yaml
from archgen.syntax.yaml_tree import node_to_data

_WORD_SIGNS = f"{string.ascii_letters}{string.digits}_"


def plan_edits(project: EditedProject, element: Element, new_name: str) -> tuple[list[TextEdit], tuple[str, ...]]:
    """Return what gives an element another name, and sentences on what follows. Raise EditRefusedError."""
    if not project.is_whole:
        project.check_wholly()
    for error in project.warm.list_text_errors(project.checked):
        raise EditRefusedError(f"line {error.span.line} of {error.span.file} cannot be read", "mend it first")
    version = JudgedVersion(project.checked, project.index, project.warm.cache)
    refactoring = plan_rename(version, element, new_name)
    return [edit for file_edit in refactoring.edits for edit in _split_edit(file_edit)], refactoring.notes


def _split_edit(file_edit: FileEdit) -> Iterator[TextEdit]:
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


class QuickFix(NamedTuple):
    """What is offered: its words, its edits of one file, and whether nothing else can be meant."""

    title: str
    edits: tuple[TextEdit, ...]
    is_preferred: bool = False


def list_fixes(project: EditedProject, finding: Diagnostic) -> Iterator[QuickFix]:
    """Yield what can be done about a finding, what its help asks for first."""
    fix = suggest_fix(finding, _read_texts(project, [finding]))
    if fix is not None and finding.help:
        yield QuickFix(_phrase_help(finding.help), fix.edits, fix.is_certain)
    if finding.asked_name is not None and finding.asked_name.kind in _DECLARED_KINDS:
        yield from _declare(project, finding, finding.asked_name.kind)
    choices, is_choice, _ = (finding.help or "").partition(", whichever is meant")
    for choice in re.findall(r"`([^`]+)`", choices) if is_choice else ():
        yield QuickFix(f"write `{choice}`", (TextEdit(finding.span, choice),))
    if not index_all_rules()[finding.rule].fixed and (silencing := _silence(project, finding)):
        yield QuickFix(f"silence `{finding.rule}` here, and say why", (silencing,))


def plan_certain_edits(project: EditedProject, file: str) -> tuple[TextEdit, ...]:
    """Return the edits of a file of which nothing else can have been meant."""
    findings = [finding for finding in project.findings if finding.span.file == file]
    texts = _read_texts(project, findings)
    fixes = (suggest_fix(finding, texts) for finding in findings)
    return join_edits([fix.edits for fix in fixes if fix is not None and fix.is_certain])


def _read_texts(project: EditedProject, findings: Sequence[Diagnostic]) -> SourceTexts:
    """Return the texts of what findings are about as they are written now, not as they were mended."""
    texts = SourceTexts()
    for file in dict.fromkeys(finding.span.file for finding in findings):
        text = project.warm.text_of(file)
        text = project.checked.sources.text_of(file) if text is None else text
        texts.add_text(file, text or "")
    return texts


def _phrase_help(text: str) -> str:
    """Return a help as the name of what it asks for: "did you mean `a`?" is answered by "write `a`"."""
    guess = re.match(r"did you mean (`[^`]+`)\?\Z", text)
    return f"write {guess[1]}" if guess else text


def _silence(project: EditedProject, finding: Diagnostic) -> TextEdit | None:
    """Return the comment that silences a finding, at the end of its line; None where it would not be a comment there."""
    file, number = finding.span.file, finding.span.line
    text, line = project.warm.text_of(file), project.line_of(file, number)
    if text is None or line is None or "#" in line:
        return None
    end = Span(file, number, len(line) + 1, number, len(line) + 1)
    edit = TextEdit(end, f"{'' if line.endswith(' ') else '  '}# archgen: ignore[{finding.rule}] ")
    before, _ = parse_yaml(file, text)
    after, _ = parse_yaml(file, apply_edits(text, [edit]))
    if before is None or after is None or len(after.ignores) == len(before.ignores):
        return None
    return edit if node_to_data(before.root) == node_to_data(after.root) else None


_DECLARED_KINDS = frozenset({"partner", "host", "requirement", "use_case"})
"""Kinds of which a title is enough to begin with."""


def _declare(project: EditedProject, finding: Diagnostic, kind: str) -> Iterator[QuickFix]:
    """Yield what declares the name that nothing has, where the others of its kind stand."""
    span = finding.span
    name = (project.line_of(span.file, span.line) or "")[span.column - 1 : span.end_column - 1].strip("\"'")
    element, checked = NewElement(name, {"title": title_from_id(name)}), project.checked
    place = place_in_section(checked, PLAIN_SECTIONS[kind])
    try:
        content, text = read_editable(checked, place.file)
        new_text = insert_element(place, element, text)
    except EditRefusedError:
        return
    if not find_consequences(checked, place.file, new_text.removeprefix(BYTE_ORDER_MARK), name).errors:
        edits = _split_edit(FileEdit(place.file, content, new_text.encode(), span.line))
        yield QuickFix(f"declare the {kind.replace('_', ' ')} `{name}` in {place.file}", tuple(edits))


def find_findings(project: EditedProject, file: str, first_line: int, last_line: int) -> Iterable[Diagnostic]:
    """Return what is found in some lines of a file."""
    return [
        finding
        for finding in project.findings
        if finding.span.file == file and finding.span.line <= last_line and finding.span.end_line >= first_line
    ]
