"""One file of a project by itself: parsed, validated and normalised. The same text is processed only once.

What reading the files of a project has found so far; and one file of it, parsed once.
"""

from __future__ import annotations

import re
from bisect import bisect_left
from collections import Counter
from collections.abc import Iterator

from archgen.diagnostics import Diagnostic, SourceTexts, Span
from archgen.frozen import dataclass, field, replace
from archgen.model.agreed_terms import is_signature_file
from archgen.model.project_settings import is_agreement_file
from archgen.project.project_search import PROJECT_FILE
from archgen.schema import normalise_document, validate_document
from archgen.syntax import yaml_parser
from archgen.syntax.project_files import ProjectFiles, read_text_file
from archgen.syntax.yaml_tree import MappingNode, SequenceNode, YamlDocument, YamlNode


@dataclass(frozen=True, slots=True)
class ValidatedSlice:
    """The result of validating a slice.

    `lost_keys` are the keys that were taken out of it, and the ids that malformed ones may have been meant to be.
    `partial` is whether a whole section is among them. `settings` is what can be used of a file that is not YAML.
    """

    diagnostics: tuple[Diagnostic, ...]
    lost_keys: tuple[str, ...] = ()
    partial: bool = False
    settings: YamlDocument | None = None


@dataclass(slots=True)
class Slice:
    """A file's document, None where it cannot be parsed, and the sections that it writes.

    `sections` are those of the text: validation may take some of them out of the document.
    """

    file: str
    text: str
    document: YamlDocument | None
    diagnostics: tuple[Diagnostic, ...]
    sections: tuple[str, ...] = ()
    _validated: ValidatedSlice | None = None

    def validate_once(self) -> ValidatedSlice:
        """Validate and normalise the document, in place, on the first call; later calls return the same result."""
        if self._validated is None:
            self._validated = _validate_slice(self)
        return self._validated


ParsedSlices = dict[tuple[str, str], Slice]
"""Cache of slices by file and text, for reading a project at many revisions, most of whose files are the same.

The documents are shared by all revisions, so no tree may change after `Slice.validate_once`.
"""


def parse_slice(file: str, text: str, parsed_slices: ParsedSlices | None = None) -> Slice:
    """Parse a file, or take it from the cache; a newly parsed slice is added to the cache."""
    parsed_slice = parsed_slices.get((file, text)) if parsed_slices is not None else None
    if parsed_slice is None:
        document, diagnostics = yaml_parser.parse_yaml(file, text)
        sections = tuple(document.root.entries) if document is not None else ()
        parsed_slice = Slice(file, text, document, diagnostics, sections)
        if parsed_slices is not None:
            parsed_slices[file, text] = parsed_slice
    return parsed_slice


def _validate_slice(parsed_slice: Slice) -> ValidatedSlice:
    if parsed_slice.document is None:
        return ValidatedSlice(
            parsed_slice.diagnostics,
            # A key may lack just its colon.
            (*find_written_keys(parsed_slice.text), *_LINE_WORD.findall(parsed_slice.text)),
            partial=True,
            settings=_recover_settings(parsed_slice),
        )
    repetitions, schema_diagnostics = _merge_repetitions(parsed_slice, validate_document(parsed_slice.document))
    lost_keys = (
        tuple(_find_lost_keys(parsed_slice, parsed_slice.document, schema_diagnostics)) if schema_diagnostics else ()
    )
    # Both before normalise: it removes empty sections, which are not lost but simply not written.
    partial = len(parsed_slice.document.root.entries) < len(parsed_slice.sections)
    return ValidatedSlice(
        (*repetitions, *schema_diagnostics, *normalise_document(parsed_slice.document)), lost_keys, partial
    )


def _merge_repetitions(
    parsed_slice: Slice, schema_diagnostics: tuple[Diagnostic, ...]
) -> tuple[tuple[Diagnostic, ...], tuple[Diagnostic, ...]]:
    """Return the findings of parsing and of the schema, without repeated keys that an element's wrong column explains.

    An element whose first line alone is indented too far becomes an unknown key of the element above, and its keys
    repeat those of that element: that is one slip.
    """
    if not any(diagnostic.rule == "duplicate-key" for diagnostic in parsed_slice.diagnostics):
        return parsed_slice.diagnostics, schema_diagnostics
    lines_by_column: dict[int, list[int]] = {}
    for span in sorted(d.span for d in schema_diagnostics if d.rule == "unknown-key"):
        lines_by_column.setdefault(span.column, []).append(span.line)
    repetitions: list[Diagnostic] = []
    causes = set[tuple[int, int]]()
    for diagnostic in parsed_slice.diagnostics:
        line = _find_cause(diagnostic, lines_by_column.get(diagnostic.span.column, []))
        if line:
            causes.add((line, diagnostic.span.column))
        else:
            repetitions.append(diagnostic)
    return tuple(repetitions), tuple(
        replace(d, help=_name_column(parsed_slice.text, d.span)) if (d.span.line, d.span.column) in causes else d
        for d in schema_diagnostics
    )


def _name_column(text: str, span: Span) -> str:
    """Return what helps an element whose first line alone is indented too far: the element above it."""
    lines_above = re.split(r"\r\n|\r|\n", text)[: span.line - 1]
    keys = (re.match(r" *([A-Za-z0-9_.-]+):", line) for line in reversed(lines_above))
    above = next((key[1] for key in keys if key and key.start(1) < span.column - 1), None)
    place = f"`{above}`" if above else "the element above it"
    return f"if this is an element of its own, begin it in the column of {place}"


def _find_cause(repetition: Diagnostic, unknown_lines: list[int]) -> int:
    """Return the line of the unknown key between a key and its repetition, in their column; 0 where there is none."""
    position = bisect_left(unknown_lines, repetition.span.line)
    line = unknown_lines[position - 1] if position else 0
    first_lines = [label.span.line for label in repetition.labels]
    return line if repetition.rule == "duplicate-key" and first_lines and first_lines[0] < line else 0


_WRITTEN_KEY = re.compile(r"(?<![A-Za-z0-9_.-])([A-Za-z0-9][A-Za-z0-9_.-]*+)[\"']?[ \t]*+:")
"""A word before a colon. It starts only at a word's beginning, and possessive quantifiers (`*+`) never backtrack: a
long word without a colon is scanned once, not once for each of its letters.
"""


_SETTINGS_BLOCKS = tuple(
    re.compile(rf"^{section}:.*(?:\n(?![A-Za-z\"']).*)*", re.MULTILINE) for section in ("sources", "libraries", "ros")
)


def _recover_settings(parsed_slice: Slice) -> YamlDocument | None:
    """Return `sources`, `libraries` and `ros` of a file that is not YAML, where they are sound by themselves; None if there are none.

    Without them other files would be read than the project names, and messages judged by no distribution: a slip in one
    line of archgen.yaml would be a hundred findings.
    """
    # Of a merge conflict neither side is read.
    if any(diagnostic.rule != "syntax-error" for diagnostic in parsed_slice.diagnostics):
        return None
    root = MappingNode({}, Span.of_file(parsed_slice.file))
    # The first of each: a second one is a mistake, and a stranger's file may hold a million.
    for block in filter(None, (pattern.search(parsed_slice.text) for pattern in _SETTINGS_BLOCKS)):
        # Blank lines above keep the positions as they are in the file.
        text = "\n" * parsed_slice.text.count("\n", 0, block.start()) + block[0]
        document, _ = yaml_parser.parse_yaml(parsed_slice.file, text)
        if document is not None:
            root.entries = {**document.root.entries, **root.entries}
    document = YamlDocument(parsed_slice.file, root)
    validate_document(document)
    normalise_document(document)
    return document if root.entries else None


_LINE_WORD = re.compile(r"^[ \t]*+([A-Za-z][A-Za-z0-9_.-]*+)", re.MULTILINE)


def find_written_keys(text: str) -> list[str]:
    """Return everything in a text that looks like a key; works on text that cannot be parsed."""
    return _WRITTEN_KEY.findall(text)


def _find_lost_keys(
    parsed_slice: Slice, document: YamlDocument, schema_diagnostics: tuple[Diagnostic, ...]
) -> Iterator[str]:
    """Yield the keys that were taken out of a document, and the ids that malformed keys may have been meant to be."""
    from archgen.schema.schema_wording import suggest_ids

    # Counted, not a set: of two elements with the same id in different sections one may be lost and the other not.
    yield from Counter(find_written_keys(parsed_slice.text)) - Counter(_list_keys(document.root))
    lines = parsed_slice.text.replace("\r\n", "\n").replace("\r", "\n").split("\n")
    for diagnostic in schema_diagnostics:
        span = diagnostic.span
        line = lines[span.line - 1] if 0 < span.line <= len(lines) else ""
        yield from suggest_ids(line[span.column - 1 : span.end_column - 1])


def _list_keys(node: YamlNode) -> Iterator[str]:
    if isinstance(node, MappingNode):
        for entry in node:
            yield entry.key
            yield from _list_keys(entry.value)
    elif isinstance(node, SequenceNode):
        for item in node.items:
            yield from _list_keys(item)


@dataclass(slots=True)
class ReadingState:
    """What has been read so far; readers of slices and sources add to it."""

    files: ProjectFiles
    sources: SourceTexts = field(default_factory=SourceTexts)
    documents: list[YamlDocument] = field(default_factory=list)
    diagnostics: list[Diagnostic] = field(default_factory=list)
    parsed_slices: ParsedSlices | None = None
    seen_files: set[str] = field(default_factory=set)
    broken_files: list[str] = field(default_factory=list)
    lost_keys: set[str] = field(default_factory=set)
    """The keys of what was not understood, and the ids that malformed ones may have been meant to be."""
    partial: bool = False
    """Whether a whole file or section was not understood."""
    skipped_folders: frozenset[str] = frozenset()
    """Folders in the project's own that are libraries: nothing in them is a source."""
    library_files: list[str] = field(default_factory=list)
    unread_names: dict[str, frozenset[str]] = field(default_factory=dict)
    """What slices declare that are not read, by their files."""

    def is_library_file(self, file: str) -> bool:
        """Whether a file lies in a library inside of the project's folder."""
        return any(file.startswith(f"{folder}/") for folder in self.skipped_folders)


def parse_file(state: ReadingState, file: str) -> Slice:
    """Read and parse one file; only its text is recorded, for excerpts."""
    # A lone surrogate or a line break in a name could not be written to a terminal or a report.
    if not file.isprintable():
        message = f"a file's name cannot be read as text: {file!a}"
        diagnostic = Diagnostic("syntax-error", message, Span.of_file(PROJECT_FILE), help="rename the file")
        return Slice(file, "", None, (diagnostic,))
    if (is_agreement_file(file) or is_signature_file(file)) and state.files.is_behind_link(file):
        # Whoever may write the file that the link leads to would agree for this partner.
        message = "what partners agree on stands behind a symbolic link: whoever may write there could agree for them"
        diagnostic = Diagnostic("syntax-error", message, Span.of_file(file), help="write them into the file itself")
        return Slice(file, "", None, (diagnostic,))
    file_text = read_text_file(state.files, file)
    state.sources.add_text(file, file_text.text)
    return (
        Slice(file, file_text.text, None, (file_text.problem,))
        if file_text.problem
        else parse_slice(file, file_text.text, state.parsed_slices)
    )
