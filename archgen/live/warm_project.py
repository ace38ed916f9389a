"""A project that is checked again and again: what did not change is not made anew, and texts count that are not saved."""

from __future__ import annotations

import re
from pathlib import Path

from archgen.diagnostics import Diagnostic, settle_diagnostics
from archgen.frozen import dataclass, replace
from archgen.pipeline import CheckedProject, VersionCache, check_loaded_project, index_all_rules
from archgen.project.project_loading import load_from_files
from archgen.project.project_search import find_project
from archgen.project.slice_parsing import parse_slice
from archgen.syntax.file_patterns import is_yaml_name
from archgen.syntax.folder_files import FolderFiles
from archgen.syntax.mended_text import MendedText, measure_common_lines, mend_text, split_lines
from archgen.syntax.project_files import OverlaidFiles, ProjectFiles, read_text_file
from archgen.syntax.yaml_parser import parse_yaml
from archgen.syntax.yaml_tree import MappingNode

_WORD = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.-]*+")


@dataclass(slots=True)
class _UnsavedText:
    """A text that stands in an editor, where it was changed last, and as it could be read last."""

    text: str
    cursor_line: int = 0
    good_text: str | None = None
    mended: MendedText | None = None


class WarmProject:
    """The project at a path. Files are named from its folder, with `/`; those of libraries may begin with `../`."""

    def __init__(self, path: Path | None) -> None:
        """Read nothing yet. Raise `ProjectNotFoundError` if there is no project."""
        self._path = path
        self.root, self.first_file = find_project(path)
        self.cache = VersionCache()
        self._unsaved: dict[str, _UnsavedText] = {}

    def set_text(self, file: str, text: str) -> int:
        """Take a text in place of what the file holds, whether there is one or not; return the line that was changed last."""
        known = self._unsaved.setdefault(file, _UnsavedText(text))
        if known.text != text:
            known.cursor_line = _find_changed_line(known.text, text)
            known.text, known.mended = text, None
        return known.cursor_line

    def copy_texts(self, other: WarmProject) -> None:
        """Take the unsaved texts of the same project as they are elsewhere, with the ways in which they were mended."""
        self._unsaved = {file: replace(unsaved) for file, unsaved in other._unsaved.items()}

    def drop_text(self, file: str) -> None:
        """Take the file as it is on the disk again."""
        self._unsaved.pop(file, None)

    def text_of(self, file: str) -> str | None:
        """Return the text that is not saved, None where there is none."""
        unsaved = self._unsaved.get(file)
        return unsaved.text if unsaved else None

    def read_tree(self, file: str) -> MappingNode | None:
        """Return an unsaved text as it is written, mended where need be, before anything in it is judged; None where nothing
        of it can be read.
        """
        unsaved = self._unsaved.get(file)
        document = parse_yaml(file, self._mend(file, unsaved).text)[0] if unsaved and is_yaml_name(file) else None
        return document.root if document else None

    def read_lines(self, file: str) -> list[str]:
        """Return the lines of an unsaved text with their ends, mended where need be; none where there is none."""
        unsaved = self._unsaved.get(file)
        return split_lines(self._mend(file, unsaved).text) if unsaved else []

    def is_mended(self, file: str) -> bool:
        """Whether an unsaved text cannot be read as it is written."""
        unsaved = self._unsaved.get(file)
        return unsaved is not None and bool(self._mend(file, unsaved).errors)

    def read_saved(self, file: str) -> str | None:
        """Return the text of a file on the disk; None where it is none."""
        saved = read_text_file(FolderFiles(self.root), file)
        return None if saved.problem else saved.text

    def check(self, variants: tuple[str, ...] | None = None, *, has_timing: bool = True) -> CheckedProject:
        """Check the project as it is now; `variants` are those that are judged, None for all.

        Texts that are half written are mended: what is wrong with them is told by `list_text_errors`, and by no finding.
        Raises `ProjectNotFoundError` where the project is gone.
        """
        self.root, self.first_file = find_project(self._path)
        mended = {file: self._mend(file, unsaved) for file, unsaved in self._unsaved.items()}
        files: ProjectFiles = FolderFiles(self.root)
        if mended:
            # What is no text is told as it is told of a file: by its bytes.
            contents = {file: each.text.encode("utf-8", "surrogatepass") for file, each in mended.items()}
            files = OverlaidFiles(self.root, contents, files)
        loaded_project = load_from_files(files, self.first_file, self.cache.parsed_slices)
        lost_words = {word for each in mended.values() for word in _WORD.findall(each.lost_text)}
        if lost_words:
            loaded_project = replace(loaded_project, lost_keys=loaded_project.lost_keys | lost_words)
        checked_project = check_loaded_project(loaded_project, self.cache, variants, has_timing=has_timing)
        self.cache.forget_old_slices(checked_project)
        return checked_project

    def list_text_errors(self, checked_project: CheckedProject) -> tuple[Diagnostic, ...]:
        """Return what is wrong with the texts that were mended, as far as the project reads them as slices."""
        loaded_project = checked_project.loaded_project
        read_files = {*checked_project.yaml_files, *loaded_project.library_files}
        errors = [
            error
            for file, unsaved in self._unsaved.items()
            if unsaved.mended and file in read_files
            for error in unsaved.mended.errors
        ]
        return settle_diagnostics(errors, index_all_rules(), loaded_project.rule_settings)

    def _mend(self, file: str, unsaved: _UnsavedText) -> MendedText:
        if unsaved.mended is None:
            unsaved.mended = (
                mend_text(
                    unsaved.text, unsaved.cursor_line, unsaved.good_text, lambda text: self._find_errors(file, text)
                )
                if is_yaml_name(file)
                else MendedText(unsaved.text)
            )
            if not unsaved.mended.errors and unsaved.mended.text == unsaved.text:
                unsaved.good_text = unsaved.text
        return unsaved.mended

    def _find_errors(self, file: str, text: str) -> tuple[Diagnostic, ...]:
        parsed_slice = parse_slice(file, text, self.cache.parsed_slices)
        return parsed_slice.diagnostics if parsed_slice.document is None else ()


def _find_changed_line(old_text: str, new_text: str) -> int:
    """Return the last line that differs in the newer text: the cursor's, or near it."""
    old_lines, new_lines = split_lines(old_text), split_lines(new_text)
    above, below = measure_common_lines(old_lines, new_lines)
    return max(above + 1, len(new_lines) - below)
