"""What an editor can do about a finding: what its help says, all that is certain in a file, or a comment that silences it."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence

from archgen.diagnostics import Diagnostic, SourceTexts, Span
from archgen.diagnostics.suggested_fixes import TextEdit, apply_edits, suggest_fix
from archgen.edit.certain_fixes import join_edits
from archgen.edit.edit_proof import NewElement, find_consequences
from archgen.edit.element_edit import BYTE_ORDER_MARK, EditRefusedError, FileEdit, insert_element, read_editable
from archgen.edit.element_place import place_in_section
from archgen.frozen import NamedTuple
from archgen.language.language_tables import PLAIN_SECTIONS
from archgen.live.edited_project import EditedProject
from archgen.lsp.rename_request import split_edit
from archgen.model.path_resolver import title_from_id
from archgen.pipeline import index_all_rules
from archgen.syntax.yaml_parser import parse_yaml
from archgen.syntax.yaml_tree import node_to_data


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
        edits = split_edit(FileEdit(place.file, content, new_text.encode(), span.line))
        yield QuickFix(f"declare the {kind.replace('_', ' ')} `{name}` in {place.file}", tuple(edits))


def find_findings(project: EditedProject, file: str, first_line: int, last_line: int) -> Iterable[Diagnostic]:
    """Return what is found in some lines of a file."""
    return [
        finding
        for finding in project.findings
        if finding.span.file == file and finding.span.line <= last_line and finding.span.end_line >= first_line
    ]
