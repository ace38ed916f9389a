"""Read the files of a project in the order of `sources`, each normalised by itself."""

from __future__ import annotations

import posixpath
import re
from collections.abc import Iterator
from itertools import islice
from pathlib import PurePosixPath

from archgen.diagnostics import Diagnostic, Severity, Span, find_closest, join_first
from archgen.language.language_tables import COMMON_SECTIONS
from archgen.model.agreed_terms import SIGNATURE_FOLDER
from archgen.model.project_settings import agreement_file
from archgen.project import baseline_reading
from archgen.project.project_search import PROJECT_FILE
from archgen.project.slice_parsing import ReadingState, Slice, parse_file
from archgen.project.source_patterns import (
    SKIPPED_FOLDERS,
    expand_source_pattern,
    report_missing_sources,
    report_other_endings,
    report_unread_slices,
)
from archgen.schema import list_sections
from archgen.schema.language_schema import resembles_slice
from archgen.syntax import file_patterns, yaml_parser
from archgen.syntax.yaml_tree import MappingNode, ScalarNode, SequenceNode, YamlDocument, find_value, list_entries

IgnoredFile = tuple[str, str | None]
"""A file that is not read, and the section that its first key nearly names."""
PASS_FOLDER = "passes/"  # noqa: S105 - not a password
"""Where a project's own passes stand; a file there whose `rules` are a list is one."""
_RECORD_FOLDER = ".archgen"
_NAMED_FILES = 24
_MAX_SECTIONS = 100
"""The first keys of a file without sections that are looked at for misspelt ones: there are 20 sections."""
PROJECT_KEY = "archgen"
"""The key that marks a project: it stands in `archgen.yaml`."""
_OTHER_FILE_KEYS = frozenset({PROJECT_KEY, baseline_reading.BASELINE_KEY})
"""Keys of files that are not slices: projects of their own (a packed one, for instance) and baselines."""


def read_slice(state: ReadingState, file: str) -> None:
    """Read one file as a slice, whatever it holds."""
    state.seen_files.add(file)
    _keep_slice(state, parse_file(state, file))


def _keep_slice(state: ReadingState, parsed_slice: Slice) -> None:
    validated = parsed_slice.validate_once()
    state.diagnostics.extend(validated.diagnostics)
    state.lost_keys.update(validated.lost_keys)
    state.partial |= validated.partial
    if parsed_slice.document is None:
        state.broken_files.append(parsed_slice.file)
    document = parsed_slice.document or validated.settings
    if document is not None:
        state.documents.append(document)


def read_sources(state: ReadingState) -> None:
    """Read the files that `sources` names, or all YAML files below where it is not written; name what may be lost."""
    sources_entry = state.documents[0].root.entries.get("sources") if state.documents else None
    ignored_files: list[IgnoredFile] = []
    walked = file_patterns.walk_project(state.files, SKIPPED_FOLDERS)
    if sources_entry is None:
        for file in filter(file_patterns.is_yaml_name, walked.files):
            if file not in state.seen_files and not state.is_library_file(file):
                _read_found_slice(state, file, ignored_files)
    elif isinstance(sources_entry.value, SequenceNode):
        _read_listed_slices(state, sources_entry.value, ignored_files)
    _report_ignored_files(state, ignored_files)
    # With a broken archgen.yaml it is unknown whether it has `sources`: what is said of others could be wrong.
    if PROJECT_FILE not in state.broken_files:
        report_unread_slices(state, walked, sources_entry)


def _read_listed_slices(state: ReadingState, patterns: SequenceNode, ignored_files: list[IgnoredFile]) -> None:
    unmatched_patterns = list[ScalarNode]()
    for pattern in patterns.items:
        text = pattern.text if isinstance(pattern, ScalarNode) else ""
        for file in expand_source_pattern(state, pattern, unmatched_patterns):
            if file not in state.seen_files and not state.is_library_file(file):
                _read_listed_slice(state, file, text, ignored_files)
    _read_agreements(state)
    # Last, when it is known which files no pattern names.
    report_missing_sources(state, unmatched_patterns)
    report_other_endings(state, patterns.items)


def _read_agreements(state: ReadingState) -> None:
    """Read what partners agreed on, whatever `sources` names: in a file that is not read it would count for nothing."""
    partner_tables = [document.root.get("partners") for document in state.documents]
    partner_ids = {key: None for table in partner_tables if isinstance(table, MappingNode) for key in table.entries}
    found = file_patterns.list_yaml_files(state.files, SIGNATURE_FOLDER, is_deep=False)
    signed = (
        file for file in found if partner_ids.keys() >= {*posixpath.splitext(posixpath.basename(file))[0].split("-")}
    )
    for file in (*map(agreement_file, partner_ids), *signed):
        if file not in state.seen_files and state.files.has_path(file):
            _read_listed_slice(state, file, SIGNATURE_FOLDER, [])


def _read_listed_slice(state: ReadingState, file: str, pattern: str, ignored_files: list[IgnoredFile]) -> None:
    """Read a file that a pattern of `sources` names; one that only a wildcard found is left out if it is no slice."""
    state.seen_files.add(file)
    parsed_slice = parse_file(state, file)
    if pattern == file:
        _keep_slice(state, parsed_slice)
    elif _is_other_file(state, parsed_slice) or _is_pass(parsed_slice):
        return  # it is judged where it is used
    elif _is_strange(parsed_slice, is_anywhere=pattern.startswith("**")):
        ignored_files.append((file, None))
    else:
        _keep_slice(state, parsed_slice)


def _is_strange(parsed_slice: Slice, *, is_anywhere: bool = False) -> bool:
    """Whether a file is another program's, though it has sections that are called like ours; among files that were found
    anywhere, also one without sections.
    """
    if parsed_slice.document is None:
        is_known = parsed_slice.diagnostics[0].rule == "too-large" or _looks_like_slice(parsed_slice)
        return is_anywhere and not is_known
    if resembles_slice(parsed_slice.document.root) is False:
        return True
    has_section = not parsed_slice.sections or not list_sections().isdisjoint(parsed_slice.sections)
    return is_anywhere and not has_section and not _is_meant_as_slice(parsed_slice.document)


def _is_other_file(state: ReadingState, parsed_slice: Slice) -> bool:
    """Whether a file is a baseline, or says that it is a project of its own: that is told, since it may be a slip."""
    if PROJECT_KEY in parsed_slice.sections and parsed_slice.document is not None:
        has_name = "project" in parsed_slice.sections
        state.diagnostics.append(
            Diagnostic(
                "ignored-file",
                f"`{PROJECT_KEY}:` makes this file a project of its own: it is no part of this one",
                parsed_slice.document.root.entries[PROJECT_KEY].key_span,
                severity=Severity.NOTE if has_name else Severity.WARNING,
                help=f"take the line away if it is meant as one; only {PROJECT_FILE} has it",
            )
        )
    return not _OTHER_FILE_KEYS.isdisjoint(parsed_slice.sections)


def _is_pass(parsed_slice: Slice) -> bool:
    """Whether a file is a pass of the project: rules to rewrite it by, and nothing that it holds."""
    if not parsed_slice.file.startswith(PASS_FOLDER) or parsed_slice.document is None:
        return False
    return isinstance(parsed_slice.document.root.get("rules"), SequenceNode)


def _read_found_slice(state: ReadingState, file: str, ignored_files: list[IgnoredFile]) -> None:
    """Read a YAML file that nobody names if it holds a section, or add it to those that are not read."""
    known_sections = list_sections() - COMMON_SECTIONS
    state.seen_files.add(file)
    parsed_slice = parse_file(state, file)
    # Tested on the text, since a baseline that a merge broke cannot be parsed.
    if baseline_reading.is_baseline(parsed_slice.text) or _is_pass(parsed_slice):
        return  # broken or not, it is judged where it is used
    # A repository holds other YAML as well, some of it templates that no parser reads. A broken file is an error
    # only if it seems to be meant as a slice.
    if parsed_slice.document is None:
        if parsed_slice.diagnostics[0].rule == "too-large" or _looks_like_slice(parsed_slice):
            _keep_slice(state, parsed_slice)
        else:
            ignored_files.append((file, None))
    elif _is_strange(parsed_slice):
        ignored_files.append((file, None))
    elif not known_sections.isdisjoint(parsed_slice.sections) or _is_meant_as_slice(parsed_slice.document):
        if not _is_other_file(state, parsed_slice):
            _keep_slice(state, parsed_slice)
    elif parsed_slice.sections and not (
        _leave_out_frames(state, parsed_slice.document) or _leave_out_libraries(state, parsed_slice.document)
    ):
        # With a guess from the first key that is nearly the name of a section, such as `group:`.
        ignored_files.append((file, _guess_section(parsed_slice.document, known_sections)))


def _guess_section(document: YamlDocument, known_sections: frozenset[str]) -> str | None:
    from archgen.schema.key_places import may_be_section

    for entry in document.root:
        guess = find_closest(entry.key, known_sections)
        if guess and may_be_section(entry, guess):
            return guess
    return None


def _report_ignored_files(state: ReadingState, ignored_files: list[IgnoredFile]) -> None:
    """List files that are not read in one note, without parameters of nodes, and what stands in a generated workspace."""
    named_paths = set(_list_parameter_paths(state)) if ignored_files else set()
    ignored_files = [
        (file, guess)
        for file, guess in ignored_files
        if named_paths.isdisjoint(_list_endings(file, named_paths)) and (guess or not _is_in_workspace(state, file))
    ]
    # With a broken archgen.yaml it is unknown whether it has `sources`: the note could be wrong.
    if ignored_files and PROJECT_FILE not in state.broken_files:
        state.diagnostics.append(_diagnose_ignored_files(ignored_files))


def _is_in_workspace(state: ReadingState, file: str) -> bool:
    """Whether a file stands below a folder that `archgen generate` has a record in."""
    parents = PurePosixPath(file).parents
    return any(state.files.has_path(f"{folder}/{_RECORD_FOLDER}") for folder in parents if folder.name)


def read_library_slices(state: ReadingState, folder: str) -> None:
    """Read every YAML file of a library that holds a section; what does not is nobody's mistake here."""
    known_sections = list_sections() - COMMON_SECTIONS
    for file in file_patterns.list_yaml_files(state.files, folder, SKIPPED_FOLDERS):
        state.seen_files.add(file)
        parsed_slice = parse_file(state, file)
        # A library may have an archgen.yaml, so that it can be checked by itself; others are projects of their own.
        if baseline_reading.is_baseline(parsed_slice.text) or (
            file != f"{folder}/{PROJECT_FILE}" and _is_other_file(state, parsed_slice)
        ):
            continue
        if parsed_slice.document is None:
            if _looks_like_slice(parsed_slice):
                _keep_slice(state, parsed_slice)
        elif not _is_strange(parsed_slice) and (
            not known_sections.isdisjoint(parsed_slice.sections) or _is_meant_as_slice(parsed_slice.document)
        ):
            _keep_slice(state, parsed_slice)


def _list_parameter_paths(state: ReadingState) -> Iterator[str]:
    """Yield the paths of the parameter files that nodes name: these are read, as what they are."""
    for document in state.documents:
        for entry in list_entries(document.root, "nodes"):
            files = find_value(entry.value, "parameter_files")
            for item in files.items if isinstance(files, SequenceNode) else ():
                if isinstance(item, ScalarNode):
                    yield posixpath.normpath(item.text)


def _list_endings(path: str, named_paths: set[str]) -> Iterator[str]:
    """Yield the path and what is left of it without its first folders: a node may name it from its package's folder."""
    parts = path.split("/") if named_paths else []
    return ("/".join(parts[start:]) for start in range(len(parts)))


def _is_meant_as_slice(document: YamlDocument) -> bool:
    """Whether a file without sections was meant to have one: then its slip is an error at its place."""
    from archgen.schema.key_places import is_meant_for_language

    # Other programs' files may have thousands of keys.
    entries = islice(document.root, _MAX_SECTIONS)
    return any(is_meant_for_language(entry) for entry in entries if entry.key not in COMMON_SECTIONS)


def _leave_out_frames(state: ReadingState, document: YamlDocument) -> bool:
    """Report frames in a file that nothing else makes a slice, if they are ours by their looks; whether they are."""
    from archgen.schema.key_places import looks_like_frames

    entry = document.root.entries.get("frames")
    if entry is None or not isinstance(entry.value, MappingNode) or not looks_like_frames(entry.value):
        return False
    message = "`frames` alone makes no part of the project of a file: it is not read"
    help_line = f"name the file in `sources` of {PROJECT_FILE}, or write them beside another section"
    state.diagnostics.append(
        Diagnostic("ignored-file", message, entry.key_span, severity=Severity.WARNING, help=help_line)
    )
    # What stands there is not unknown, only not read.
    state.lost_keys.update(entry.value.entries)
    return True


def _leave_out_libraries(state: ReadingState, document: YamlDocument) -> bool:
    """Report a file with nothing but libraries, if they are ours by their looks; whether they are."""
    entry = document.root.entries.get("libraries")
    if entry is None or len(document.root.entries) > 1 or not isinstance(entry.value, MappingNode):
        return False
    values = [part.value.get("path") if isinstance(part.value, MappingNode) else part.value for part in entry.value]
    if not values or not all(isinstance(value, ScalarNode) and isinstance(value.value, str) for value in values):
        return False
    message = f"only {PROJECT_FILE} names libraries: this file is not read"
    help_line = f"write them there, below `libraries`, or name the project's files in `sources` of {PROJECT_FILE}"
    state.diagnostics.append(Diagnostic("ignored-file", message, entry.key_span, help=help_line))
    return True


_FOREIGN_TEXT = re.compile(r"^(?:apiVersion|kind):|\{\{|\{%", re.MULTILINE)
"""What manifests of clusters and templates have, and slices never."""


def _looks_like_slice(parsed_slice: Slice) -> bool:
    """Whether a file that cannot be parsed was meant as a slice: a line begins a section, or its text is unknown."""
    text = parsed_slice.text
    if not text:
        return True
    sections = "|".join(sorted(list_sections() - COMMON_SECTIONS))
    section = re.search(rf"^[^\w\n]*+(?:{sections})[^\w\n:]*+:", text, re.MULTILINE)
    if section is None or _FOREIGN_TEXT.search(text):
        return False
    if parsed_slice.diagnostics[0].rule != "wrong-type":
        return True
    # The file is a list: of slices, where an entry resembles one.
    wrapped, _ = yaml_parser.parse_yaml(parsed_slice.file, f"entries:\n{text}")
    entries = wrapped.root.get("entries") if wrapped else None
    return not isinstance(entries, SequenceNode) or any(
        isinstance(item, MappingNode) and resembles_slice(item) for item in entries.items
    )


def _diagnose_ignored_files(ignored_files: list[tuple[str, str | None]]) -> Diagnostic:
    # Those that may be slices come first: of the others of a whole repository some stand for all.
    ordered_files = sorted(ignored_files, key=lambda ignored: not ignored[1])
    names = join_first([f"`{file}`" for file, _ in ordered_files], _NAMED_FILES)
    is_plural = len(ignored_files) > 1
    message = f"{names} {'hold' if is_plural else 'holds'} no element of the language and {'are' if is_plural else 'is'} not read"
    guesses = [f"did you mean `{guess}:` in `{file}`?" for file, guess in ignored_files if guess]
    help_line = (
        guesses[0] if guesses else f"name the project's files in `sources` of {PROJECT_FILE}, and this note goes away"
    )
    return Diagnostic("ignored-file", message, Span.of_file(PROJECT_FILE), help=help_line)
