"""A project that is checked again and again: what did not change is not made anew, and texts count that are not saved.

What is shown of it while somebody types: what a quick check finds, with what only a whole one could judge as it was. Rules
of timing, variants, and rules that wait for a slip to be mended lag behind: their findings stay, moved with their lines.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import cache
from pathlib import Path

from archgen.analyses import TIMING_RULE_NAMES
from archgen.checking.reference_index import ReferenceIndex, index_references
from archgen.diagnostics import Diagnostic, SourceTexts, Span, settle_diagnostics
from archgen.findings.variant_findings import MISSING_RULES, UNUSED_RULES
from archgen.frozen import NamedTuple, dataclass, replace
from archgen.link.reference_resolution import HeardReferences
from archgen.model.variant import BASE_NAME
from archgen.pipeline import CheckedProject, VersionCache, check_loaded_project, index_all_rules
from archgen.products.editor_schema_marks import list_project_names
from archgen.project.project_loading import load_from_files
from archgen.project.project_search import find_project
from archgen.project.slice_parsing import parse_slice
from archgen.syntax.file_patterns import is_yaml_name
from archgen.syntax.folder_files import FolderFiles
from archgen.syntax.mended_text import MendedText, measure_common_lines, mend_text, split_lines
from archgen.syntax.project_files import OverlaidFiles, ProjectFiles, read_text_file
from archgen.syntax.yaml_parser import parse_yaml
from archgen.syntax.yaml_tree import MappingNode
from archgen.timing.figures.timing_values import TimingValue
from archgen.views.lookup import Lookup, add_timing, make_lookup
from archgen.views.offered_names import OfferedNames
from archgen.views.timing.timing_lookup import complete_with_chains

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


def join_quick_findings(
    checked_project: CheckedProject, shown: Iterable[Diagnostic], shown_sources: SourceTexts, cursor: tuple[str, int]
) -> tuple[Diagnostic, ...]:
    """Return the findings to show after a check without timing and variants; `shown` are those that are shown until now, of
    the files as they were then. What is new in the line of the cursor comes later: half a word is no slip yet.
    """
    lagging_rules = checked_project.waiting_rules | TIMING_RULE_NAMES | {"unused-ignore"}
    if checked_project.architecture.variants:
        lagging_rules |= UNUSED_RULES | MISSING_RULES
    moved = list(_move_findings(shown, shown_sources, checked_project.sources))
    by_identity = {_identify(finding): finding for finding in moved}
    quick: dict[Diagnostic, None] = {}
    for finding in checked_project.findings:
        known = by_identity.get(_identify(finding))
        if finding.rule not in lagging_rules and (known or (finding.span.file, finding.span.line) != cursor):
            variants = (known.variants, known.absent_variants) if known else ((), ())
            quick[replace(finding, variants=variants[0], absent_variants=variants[1])] = None
    kept = (
        finding
        for finding in moved
        if finding.rule in lagging_rules or (finding.variants and BASE_NAME not in finding.variants)
    )
    return tuple(sorted({**quick, **dict.fromkeys(kept)}, key=lambda finding: finding.sort_key))


def keep_waiting_findings(
    checked_project: CheckedProject, shown: Iterable[Diagnostic], shown_sources: SourceTexts
) -> tuple[Diagnostic, ...]:
    """Return the findings of a whole check, with those that are shown of rules that wait for a slip to be mended."""
    if not checked_project.waiting_rules:
        return checked_project.findings
    moved = _move_findings(shown, shown_sources, checked_project.sources)
    kept = (finding for finding in moved if finding.rule in checked_project.waiting_rules)
    findings = dict.fromkeys((*checked_project.findings, *kept))
    return tuple(sorted(findings, key=lambda finding: finding.sort_key))


def _identify(finding: Diagnostic) -> tuple[str, str, str | None]:
    return finding.rule, finding.message, finding.element


def _move_findings(
    findings: Iterable[Diagnostic], old_sources: SourceTexts, new_sources: SourceTexts
) -> Iterator[Diagnostic]:
    """Yield findings of older texts at the lines where the same is written now; without those of lines that are gone."""

    @cache
    def measure_shift(file: str) -> tuple[int, int, int]:
        return _measure_shift(old_sources.text_of(file), new_sources.text_of(file))

    def move_span(span: Span) -> Span | None:
        first_gone, first_below, lines_down = measure_shift(span.file)
        if span.line >= first_below:
            return span._replace(line=span.line + lines_down, end_line=span.end_line + lines_down)
        return span if span.line < first_gone else None

    for finding in findings:
        span = move_span(finding.span)
        if span is not None:
            labels = tuple(label._replace(span=move_span(label.span) or label.span) for label in finding.labels)
            yield replace(finding, span=span, labels=labels)


def _measure_shift(old_text: str | None, new_text: str | None) -> tuple[int, int, int]:
    """Return the first line that is gone, the first one below these, and by how many lines that is further down."""
    if old_text is None or new_text is None or old_text == new_text:
        return 0, 0, 0
    old_lines, new_lines = split_lines(old_text), split_lines(new_text)
    _, below = measure_common_lines(old_lines, new_lines)
    first_below = len(old_lines) - below + 1
    return min(first_below, len(new_lines) - below + 1), first_below, len(new_lines) - len(old_lines)


class WholeCheck(NamedTuple):
    """What a whole check found, of the project as it was at some time."""

    generation: int
    checked: CheckedProject
    heard: HeardReferences


class EditedProject:
    """The project at a path, with what is shown of it: `check_quickly` after a key, `check_wholly` soon after, then `settle`."""

    def __init__(self, path: Path) -> None:
        """Read nothing yet. Raise `ProjectNotFoundError` if there is no project."""
        self.warm = WarmProject(path)
        self._background = WarmProject(path)
        self.generation = 0
        """Counts the changes."""
        self._checked: CheckedProject | None = None
        self._findings: tuple[Diagnostic, ...] = ()
        self._texts = SourceTexts()
        self._cursor = ("", 0)
        self._heard: HeardReferences = []
        self._index: ReferenceIndex | None = None
        self._is_whole = False
        self._lookup: Lookup | None = None
        self._names: OfferedNames | None = None
        self.chain_bounds: Mapping[str, TimingValue] = {}
        """What chains take, as it was judged last, since `lookup` was asked for."""
        self.is_current = False
        """Whether no text has changed since the last check."""

    @property
    def checked(self) -> CheckedProject:
        """The project as it is now, checked quickly if need be. Raises `ProjectNotFoundError`."""
        if not self.is_current or self._checked is None:
            self.check_quickly()
        assert self._checked is not None  # noqa: S101 - what was just made
        return self._checked

    @property
    def last_checked(self) -> CheckedProject | None:
        """The project as it was checked last, None before that."""
        return self._checked

    @property
    def index(self) -> ReferenceIndex:
        """Where elements are declared and named now; in variants only at rest. Raises `ProjectNotFoundError`."""
        checked = self.checked
        self._index = self._index or index_references(checked, self._heard)
        return self._index

    @property
    def lookup(self) -> Lookup:
        """What views need, with the timing where it was judged. Raises `ProjectNotFoundError`."""
        checked = self.checked
        if self._lookup is None:
            self._lookup = make_lookup(checked.architecture, checked.findings)
            if checked.analysis is not None and not checked.waiting_rules:
                timing = complete_with_chains(checked.analysis, checked.architecture)
                self._lookup = add_timing(self._lookup, timing)
                self.chain_bounds = {result.id: result.bound for result in timing.chains}
        return self._lookup

    @property
    def offered_names(self) -> OfferedNames:
        """The names that fit somewhere. Raises `ProjectNotFoundError`."""
        checked = self.checked
        self._names = self._names or list_project_names(checked)
        return self._names

    @property
    def findings(self) -> tuple[Diagnostic, ...]:
        """What is shown, sorted, with what is wrong in texts that cannot be read."""
        if self._checked is None:
            return ()
        return tuple(
            sorted((*self._findings, *self.warm.list_text_errors(self._checked)), key=lambda finding: finding.sort_key)
        )

    @property
    def is_whole(self) -> bool:
        """Whether timing and variants are judged of the project as it is now."""
        return self.is_current and self._is_whole

    def set_text(self, file: str, text: str) -> bool:
        """Take a text that is not saved; return whether that is another one than was checked."""
        was_text = self.warm.text_of(file)
        line = self.warm.set_text(file, text)
        self._texts.add_text(file, text)
        if was_text in {None, text} and self._is_checked(file, text):
            return False
        self._cursor = (file, line)
        self.look_again()
        return True

    def drop_text(self, file: str) -> bool:
        """Take a file as it is on the disk again; return whether that is another one than was checked."""
        text = self.warm.text_of(file)
        is_same = text is not None and self._is_checked(file, text) and self.warm.read_saved(file) == text
        self.warm.drop_text(file)
        if not is_same:
            self.look_again()
        return not is_same

    def _is_checked(self, file: str, text: str) -> bool:
        """Whether the last check holds still, and read a file with this text, as it is written."""
        return (
            self.is_current
            and self._checked is not None
            and self._checked.sources.text_of(file) == text
            and not self.warm.is_mended(file)
        )

    def look_again(self) -> None:
        """Know that something has changed, here or on the disk."""
        self.generation += 1
        self.is_current = False

    def line_of(self, file: str, number: int) -> str | None:
        """Return a line of a file as it is written now, without its end; None where there is none."""
        if self.warm.text_of(file) is not None:
            return self._texts.line_of(file, number)
        return self._checked.sources.line_of(file, number) if self._checked else None

    def check_quickly(self) -> None:
        """Check all but timing and variants; what is found there stays as it was. Raises `ProjectNotFoundError`."""
        self._heard = self.warm.cache.part_memory.heard = []
        checked = self.warm.check((), has_timing=False)
        old_sources = self._checked.sources if self._checked else checked.sources
        self._keep(checked, join_quick_findings(checked, self._findings, old_sources, self._cursor), is_whole=False)

    def check_wholly(self) -> None:
        """Check everything; what waits for a slip to be mended stays as it was. Raises `ProjectNotFoundError`."""
        # Not in the background's project: a thread may be at work there.
        heard = self.warm.cache.part_memory.heard = []
        self.take_whole_check(WholeCheck(self.generation, self.warm.check(), heard))

    def start_whole_check(self) -> Callable[[], WholeCheck]:
        """Return what checks everything as it is now: it may run in a thread, of which there is one at a time."""
        self._background.copy_texts(self.warm)
        generation = self.generation

        def check() -> WholeCheck:
            heard = self._background.cache.part_memory.heard = []
            return WholeCheck(generation, self._background.check(), heard)

        return check

    def take_whole_check(self, whole: WholeCheck) -> bool:
        """Take in what was found if nothing has changed since it was started; return whether that is so."""
        if whole.generation != self.generation:
            return False
        old_sources = self._checked.sources if self._checked else whole.checked.sources
        self._heard = whole.heard
        self._keep(whole.checked, keep_waiting_findings(whole.checked, self._findings, old_sources), is_whole=True)
        return True

    def settle(self) -> None:
        """Show what a check of the project says, and nothing else, after `check_wholly`."""
        if self._checked is not None and self.is_whole:
            self._findings = self._checked.findings

    def _keep(self, checked: CheckedProject, findings: tuple[Diagnostic, ...], *, is_whole: bool) -> None:
        self._checked, self._findings, self.is_current = checked, findings, True
        self._is_whole = is_whole
        self._index = self._lookup = self._names = None
