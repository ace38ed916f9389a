"""What reading the files of a project has found so far; and one file of it, parsed once."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from archgen.diagnostics.diagnostic import Diagnostic
from archgen.diagnostics.source_span import SourceTexts, Span
from archgen.model.agreed_terms import is_signature_file
from archgen.model.review_settings import is_agreement_file
from archgen.project.project_search import PROJECT_FILE
from archgen.project.slice_parsing import ParsedSlices, Slice, parse_slice
from archgen.syntax.project_files import ProjectFiles, read_text_file

if TYPE_CHECKING:
    from archgen.syntax.yaml_tree import YamlDocument


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
