"""Say which files hold a part of an architecture and are not read, and why: a slice is never lost in silence."""

from __future__ import annotations

import posixpath
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence

from archgen.diagnostics import Diagnostic, Severity, Span, join_words
from archgen.frozen import replace
from archgen.language.language_tables import COMMON_SECTIONS, SECTION_KINDS
from archgen.project.project_search import PROJECT_FILE
from archgen.project.slice_parsing import ReadingState, parse_slice
from archgen.schema.language_schema import list_keys, load_schema, resembles_slice
from archgen.syntax.project_files import read_text_file
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, list_entries

_REASONS = {
    "left_out": (
        "`sources` names no file of that name",
        "add it to `sources` if it belongs to this project",
    ),
    "misnamed": ("only names in .yaml and .yml are read", "give it such a name if it belongs to this project"),
    "hidden": (
        "hidden files, outputs and the folder `backends` are not searched",
        "move it, or name it in `sources`, if it belongs to this project",
    ),
}
"""Why files are not read, and what to do about it."""
_PROJECT_LINE = re.compile(r"^project[ \t]*+:", re.MULTILINE)


def name_unread_slices(
    state: ReadingState,
    candidates: Mapping[str, Sequence[str]],
    projects: Sequence[str],
    sources_entry: MappingEntry | None,
) -> None:
    """Report the candidates that hold elements of the language, and the projects below this one, in a note for each reason.

    What left-out files declare is kept for the references that ask for it.
    """
    span = sources_entry.key_span if sources_entry else Span.of_file(PROJECT_FILE)
    for reason, files in candidates.items():
        slices = [file for file in files if _is_slice(state, file)]
        if slices:
            cause, help_line = _REASONS[reason]
            message = f"{_quote(slices)} {'hold' if len(slices) > 1 else 'holds'} a part of an architecture and {_are(slices)} not read: {cause}"
            state.diagnostics.append(Diagnostic("ignored-file", message, span, severity=Severity.NOTE, help=help_line))
    if projects:
        folders = [f"{posixpath.dirname(file)}/" for file in projects]
        message = f"{_quote(folders)} {_are(folders)} no part of this project: {PROJECT_FILE} there makes a project of its own"
        help_line = f"take that {PROJECT_FILE} away if the files beside it belong to this one"
        state.diagnostics.append(Diagnostic("ignored-file", message, span, severity=Severity.NOTE, help=help_line))


def _quote(files: Iterable[str]) -> str:
    return join_words([f"`{file if file.isprintable() else ascii(file)}`" for file in files])


def _are(files: Sequence[str]) -> str:
    return "are" if len(files) > 1 else "is"


def _is_slice(state: ReadingState, file: str) -> bool:
    """Whether a file is a slice by what it holds; what it declares is kept then."""
    text = read_text_file(state.files, file).text
    # A project of its own, mostly what `archgen build` packed: to parse it costs as much as to parse the whole project.
    if _PROJECT_LINE.search(text):
        return False
    document = parse_slice(file, text, state.parsed_slices).document
    if document is None:  # with a slip, or notes of another program between
        return any(f"{key}:" in text or f'{key}":' in text for key in ("components", "implements"))
    root = document.root
    sections = root.entries.keys() & load_schema()["properties"].keys() - {"archgen", "project"}
    is_whole = sections == root.entries.keys() - {"archgen"} and not sections <= COMMON_SECTIONS
    if "project" in root.entries or not (resembles_slice(root) or (is_whole and resembles_slice(root) is None)):
        return False
    state.unread_names[file] = frozenset(_list_declared(root))
    return True


def _list_declared(root: MappingNode) -> Iterator[str]:
    """Yield the paths and ids of what a slice declares."""
    for entry in root:
        kind = SECTION_KINDS.get(entry.key)
        if kind is not None:
            for element in list_entries(entry.value):
                yield from _list_paths(element, kind, "")


def _list_paths(element: MappingEntry, kind: str, prefix: str) -> Iterator[str]:
    path = f"{prefix}{element.key}"
    yield path
    for key, part_kind in (("components", "component"), ("inputs", "input"), ("outputs", "output")):
        if key in list_keys(kind):
            for part in list_entries(element.value, key):
                yield from _list_paths(part, part_kind, f"{path}.")


def blame_unread_files(
    diagnostics: Iterable[Diagnostic], unread_names: Mapping[str, frozenset[str]]
) -> Iterator[Diagnostic]:
    """Yield diagnostics; one of a name that only a file declares which is not read says so, instead of a guess."""
    for diagnostic in diagnostics:
        name = diagnostic.message.partition("`")[2].partition("`")[0]
        files = (
            [file for file, names in unread_names.items() if any(_means(name, declared) for declared in names)]
            if diagnostic.rule.startswith("unknown-")
            else []
        )
        if files:
            help_line = f"{_quote(files)} {'declare' if len(files) > 1 else 'declares'} it, and {_are(files)} not read: add {'them' if len(files) > 1 else 'it'} to `sources` of {PROJECT_FILE}"
            yield replace(diagnostic, help=help_line, labels=(), asked_name=None)
        else:
            yield diagnostic


def _means(name: str, declared: str) -> bool:
    return bool(name) and f".{declared}".endswith(f".{name}")
