"""Plan what `archgen fmt` writes: each file in one style, proven to say the same, with each comment where it was."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Collection, Iterator, Sequence

import yaml

from archgen import pipeline
from archgen.edit.edit_proof import first_file_of, freeze_order
from archgen.edit.element_edit import BYTE_ORDER_MARK, EditRefusedError, FileEdit, read_editable
from archgen.frozen import dataclass
from archgen.pipeline import CheckedProject
from archgen.project.project_loading import load_from_files
from archgen.syntax import slice_layout, yaml_comments, yaml_parser
from archgen.syntax.project_files import OverlaidFiles
from archgen.syntax.yaml_tree import node_to_data


@dataclass(frozen=True, slots=True)
class UnformattedFile:
    """A file that stays as it is, why, and the line that is to blame, 0 where none is."""

    file: str
    reason: str
    line: int = 0


def plan_formatting(
    checked_project: CheckedProject, files: Collection[str] = ()
) -> Iterator[FileEdit | UnformattedFile]:
    """Yield an edit of each file that has another layout, and the files that are left alone; `files`, none for all.

    Files of libraries are others' and stay as they are.
    """
    loaded_project = checked_project.loaded_project
    own_files = {*checked_project.yaml_files, *loaded_project.broken_files} - {*loaded_project.library_files}
    edits: list[FileEdit] = []
    for file in sorted(files or own_files):
        is_own = file in own_files
        planned = (
            _plan_file(checked_project, file) if is_own else UnformattedFile(file, "it is no file of this project")
        )
        if isinstance(planned, UnformattedFile):
            yield planned
        elif planned is not None:
            edits.append(planned)
    # A comment that silences a finding reaches what stands on its line: the findings say whether it still does.
    if edits and not keeps_findings(checked_project, edits):
        kept = [edit for edit in edits if keeps_findings(checked_project, [edit])]
        yield from (
            UnformattedFile(edit.file, "a comment `archgen: ignore` would reach something else", edit.line)
            for edit in edits
            if edit not in kept
        )
        edits = kept
    yield from edits


def _plan_file(checked_project: CheckedProject, file: str) -> FileEdit | UnformattedFile | None:
    try:
        content, text = read_editable(checked_project, file)
        mark = BYTE_ORDER_MARK if text.startswith(BYTE_ORDER_MARK) else ""
        new_text = format_text(text.removeprefix(mark))
    except EditRefusedError as refusal:
        return UnformattedFile(file, refusal.message)
    except slice_layout.UnformattableError as error:
        return UnformattedFile(file, error.reason, error.line)
    new_content = f"{mark}{new_text}".encode()
    return None if new_content == content else FileEdit(file, content, new_content, _find_change(text, new_text))


def _find_change(text: str, new_text: str) -> int:
    pairs = enumerate(zip(text.split("\n"), new_text.split("\n"), strict=False), 1)
    return next((number for number, (old, new) in pairs if old != new), 1)


def format_text(text: str) -> str:
    """Return a file's text, which has no byte-order mark, laid out, with its own line ends. Raise UnformattableError."""
    crlf_count = text.count("\r\n")
    plain = text.replace("\r\n", "\n")
    if "\r" in plain:
        reason = "a line that ends as on no computer of today, with a lone CR"
        raise slice_layout.UnformattableError(reason, plain.count("\n", 0, plain.index("\r")) + 1)
    document, diagnostics = yaml_parser.parse_yaml("", plain)
    problem = next((each for each in diagnostics if each.severity != "note" and each.rule != "swallowed-text"), None)
    if document is None or problem:
        raise slice_layout.UnformattableError(
            problem.message if problem else "no slice", problem.span.line if problem else 0
        )
    formatted = slice_layout.format_slice(plain)
    if formatted == plain:
        return text
    formatted_document, _ = yaml_parser.parse_yaml("", formatted)
    is_same = formatted_document is not None and (
        freeze_order(node_to_data(document.root)) == freeze_order(node_to_data(formatted_document.root))
        and _keeps_comments(plain, formatted)
        and slice_layout.format_slice(formatted) == formatted
    )
    if not is_same:
        reason = "it could not be shown to say the same, with its comments in their places"
        raise slice_layout.UnformattableError(reason, 0)
    return formatted.replace("\n", "\r\n") if crlf_count * 2 > plain.count("\n") else formatted


def _keeps_comments(text: str, formatted: str) -> bool:
    """Whether each comment is there again, before the same value; behind braces that were opened it may be at their head."""
    old_places, new_places = sorted(_place_comments(text)), sorted(_place_comments(formatted))
    return len(old_places) == len(new_places) and all(
        old_comment == new_comment and least <= new_count <= count
        for (old_comment, count, least), (new_comment, new_count, _) in zip(old_places, new_places, strict=True)
    )


def _place_comments(text: str) -> Iterator[tuple[str, int, int]]:
    """Yield each comment with how many scalars stand before it, and before the braces that close on its line."""
    starts: list[int] = []
    flows: list[tuple[int, int]] = []
    open_flows: list[tuple[bool, int]] = []
    quoted_ranges: list[tuple[int, int]] = []
    for event, start, end in yaml_parser.list_events(text):
        if isinstance(event, (yaml.ScalarEvent, yaml.AliasEvent)):
            starts.append(start)
            if getattr(event, "style", None):
                quoted_ranges.append((start, end))
        elif isinstance(event, yaml.CollectionStartEvent):
            open_flows.append((bool(event.flow_style), len(starts)))
        elif isinstance(event, yaml.CollectionEndEvent):
            is_flow, count = open_flows.pop()
            if is_flow:
                flows.append((end, count))
    for start, comment in yaml_comments.find_comments(text, quoted_ranges):
        count = bisect_left(starts, start)
        first, last = bisect_left(flows, (text.rfind("\n", 0, start) + 1, 0)), bisect_right(flows, (start, count))
        yield comment, count, min([count, *(flow_count for _, flow_count in flows[first:last])])


def keeps_findings(checked_project: CheckedProject, edits: Sequence[FileEdit]) -> bool:
    """Whether a project has the same findings after edits, wherever they stand then."""
    files = checked_project.loaded_project.files
    texts = {edit.file: edit.new_content for edit in edits}
    loaded_project = load_from_files(OverlaidFiles(files.root, texts, files), first_file_of(checked_project))
    old, new = (
        sorted((finding.rule, finding.message, finding.severity) for finding in project.findings)
        for project in (pipeline.judge_project(checked_project.loaded_project), pipeline.judge_project(loaded_project))
    )
    return old == new
