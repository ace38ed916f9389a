"""Which files a pattern of `sources` means, and what to say of one that means none.

Say which files hold a part of an architecture and are not read, and why: a slice is never lost in silence.
"""

from __future__ import annotations

import posixpath
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence

from archgen.diagnostics import Diagnostic, Severity, Span, find_closest, join_words
from archgen.frozen import replace
from archgen.language.language_tables import COMMON_SECTIONS, SECTION_KINDS
from archgen.project.project_search import PROJECT_FILE
from archgen.project.slice_parsing import ReadingState, find_written_keys, parse_file, parse_slice
from archgen.schema import list_sections
from archgen.schema.language_schema import list_keys, load_schema, resembles_slice
from archgen.syntax import file_patterns
from archgen.syntax.project_files import read_text_file
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode, YamlNode, list_entries

SKIPPED_FOLDERS = frozenset({"backends"})
"""Folders that are not searched for slices unless `sources` names them."""
_GUESS_BUDGET = 300_000
"""How many names of files are compared with patterns that match none, so that a million of them take no minutes."""


def report_missing_sources(state: ReadingState, patterns: Iterable[ScalarNode]) -> None:
    """Report patterns that match no file. What is in the files that one most likely means counts as not understood."""
    candidates: set[str] | None = None
    guess_count = 0
    for pattern in patterns:
        if candidates is None:
            yaml_files = file_patterns.list_yaml_files(state.files, skipped_folders=SKIPPED_FOLDERS)
            unread_files = [file for file in yaml_files if file not in state.seen_files]
            candidates = {*unread_files, *map(_widen_pattern, unread_files)}
        folder_patterns = (f"{pattern.text.rstrip('/')}/*{ending}" for ending in file_patterns.YAML_ENDINGS)
        guess_count += len(candidates)
        near_names = candidates if guess_count <= _GUESS_BUDGET else ()
        folder_pattern = next((each for each in folder_patterns if each in candidates), None)
        guess = folder_pattern or find_closest(pattern.text, near_names)
        meant_files = file_patterns.expand_pattern(state.files, guess) if guess else ()
        lost_keys = {key for file in meant_files for key in find_written_keys(parse_file(state, file).text)}
        if lost_keys.isdisjoint(list_sections()):
            state.diagnostics.append(_diagnose_missing_source(pattern))
            continue
        state.seen_files.update(meant_files)  # what is said of them is said here
        state.lost_keys.update(lost_keys)
        state.partial = True
        state.diagnostics.append(_diagnose_missing_source(pattern, guess))


def report_other_endings(state: ReadingState, patterns: Iterable[YamlNode]) -> None:
    """Report YAML files that a pattern would match if they ended as it does: a partner writes `.yml` where others do not."""
    for pattern in patterns:
        if not isinstance(pattern, ScalarNode) or not file_patterns.is_yaml_name(pattern.text):
            continue
        stem, ending = posixpath.splitext(pattern.text)
        if not file_patterns.is_inside_project(pattern.text) or "*" not in stem:
            continue
        unread_files: dict[str, list[str]] = {}
        for file in file_patterns.expand_pattern(state.files, f"{stem}.*"):
            other = posixpath.splitext(file)[1]
            if other != ending and file_patterns.is_yaml_name(file) and file not in state.seen_files:
                unread_files.setdefault(other, []).append(file)
        for other, files in unread_files.items():
            state.seen_files.update(files)  # what is said of them is said here
            names = ", ".join(f"`{file}`" for file in files)
            state.diagnostics.append(
                Diagnostic(
                    "ignored-file",
                    f"{names} {'is' if len(files) == 1 else 'are'} not read: `{pattern.text}` names files that end in `{ending}`",
                    pattern.span,
                    severity=Severity.WARNING,
                    help=f"add `{stem}{other}`, or let {'its name' if len(files) == 1 else 'their names'} end in `{ending}`",
                )
            )


def _widen_pattern(file: str) -> str:
    """Return the pattern of all files beside a file: `groups/*.yaml` for `groups/sensing.yaml`."""
    folder, slash, _ = file.rpartition("/")
    return f"{folder}{slash}*{posixpath.splitext(file)[1]}"


def _diagnose_missing_source(pattern: ScalarNode, guess: str | None = None) -> Diagnostic:
    # With a guess the project's own files are not read: an error, since everything that they declare is missing.
    return Diagnostic(
        "missing-source",
        f"`{pattern.text}` matches no file",
        pattern.span,
        severity=Severity.ERROR if guess else None,
        help=f"did you mean `{guess}`?" if guess else "paths are relative to the folder of archgen.yaml",
    )


def expand_source_pattern(
    state: ReadingState, pattern: YamlNode, unmatched_patterns: list[ScalarNode] | None = None
) -> Iterator[str]:
    """Yield the files that one pattern matches; report a pattern that leaves the project or matches nothing.

    One that matches nothing is added to `unmatched_patterns` instead, if given.
    """
    if not isinstance(pattern, ScalarNode):
        return
    if not file_patterns.is_inside_project(pattern.text):
        message = f"`{pattern.text}` leads out of the project's folder"
        help_line = "write paths relative to the folder of archgen.yaml, with `/`"
        state.diagnostics.append(Diagnostic("wrong-value", message, pattern.span, help=help_line))
        return
    matching_files = file_patterns.expand_pattern(state.files, pattern.text)
    # A folder is no file; with YAML files in it, these are what is meant.
    if len(matching_files) == 1 and file_patterns.list_yaml_files(state.files, matching_files[0], is_deep=False):
        matching_files = ()
    if not matching_files and unmatched_patterns is not None:
        unmatched_patterns.append(pattern)
    elif not matching_files:
        state.diagnostics.append(_diagnose_missing_source(pattern))
    yield from matching_files


_MAX_SIBLINGS = 100
"""A folder with more files of other names is one of data, such as labelled pictures: none is taken for a slice."""
_OTHER_ENDING = re.compile(
    r"\.(?:json[c5]?|te?xt|cfg|conf|te?mp|old|bak|orig|save)\Z|\.y[a-z]{0,3}m[a-z]?l?[0-9~]?\Z|ya?ml"
)
"""How the name of a slice may end that was exported, copied, renamed by another program, or mistyped."""
_SECTION_LINE = re.compile(
    rf"^[ \t{{\-\xEF\xBB\xBF]*+[\"']?(?:{'|'.join(sorted(SECTION_KINDS.keys() - COMMON_SECTIONS))})[\"']?[ \t]*+:".encode(
        "latin-1"
    ),
    re.MULTILINE,
)
_TOOL_FOLDERS = (".git/", ".hg/", ".svn/", ".archgen/")
_TOOL_FILES = frozenset({"HEAD", "pyvenv.cfg", "CACHEDIR.TAG"})
"""Files that tell folders of tools: repositories, environments of Python, caches."""


def report_unread_slices(
    state: ReadingState, walked: file_patterns.WalkedFiles, sources_entry: MappingEntry | None
) -> None:
    """Name the files that may be slices and that nothing reads: for their name, their place, or what `sources` names."""
    unread_files = [file for file in walked.files if file not in state.seen_files and not state.is_library_file(file)]
    candidates = {
        "left_out": filter(file_patterns.is_yaml_name, unread_files),
        "misnamed": _list_misnamed_files(state, unread_files),
        "hidden": _list_hidden_files(state, walked.passed_over),
    }
    unread_slices = {
        reason: found
        for reason, files in candidates.items()
        if (found := [file for file in files if _has_section_line(state, file)])
    }
    projects = [
        file for file in walked.passed_over if file.endswith(f"/{PROJECT_FILE}") and not state.is_library_file(file)
    ]
    if unread_slices or projects:
        # Imported here: hardly any project has such files.
        from archgen.project.source_patterns import name_unread_slices

        name_unread_slices(state, unread_slices, projects, sources_entry)


def _list_misnamed_files(state: ReadingState, files: Iterable[str]) -> Iterator[str]:
    """Yield files that are not called as YAML files are, and may be slices all the same."""
    by_folder: dict[str, list[str]] = {}
    for file in files:
        folder, _, name = file.rpartition("/")
        if not file_patterns.is_yaml_name(name) and ("." not in name or _OTHER_ENDING.search(name.lower())):
            by_folder.setdefault(folder, []).append(file)
    for siblings in by_folder.values():
        # A copy that an editor keeps beside a file of the project is no loss.
        copied = (re.sub(r"(?<=ml)[^/]*+\Z", "", file) for file in siblings)
        if len(siblings) <= _MAX_SIBLINGS:
            yield from (file for file, name in zip(siblings, copied, strict=True) if name not in state.seen_files)


def _list_hidden_files(state: ReadingState, passed_over: Iterable[str]) -> Iterator[str]:
    """Yield the YAML files in what is not searched: hidden files and folders, outputs, backends."""
    for path in passed_over:
        if state.is_library_file(path) or path.endswith((f"/{PROJECT_FILE}", *_TOOL_FOLDERS)):
            continue
        if not path.endswith("/"):
            yield from filter(file_patterns.is_yaml_name, (path,))
            continue
        if state.files.is_behind_link(path[:-1]):  # it may lead out of the project
            continue
        for folder, folders, names in state.files.walk_folders(path[:-1]):
            if not _TOOL_FILES.isdisjoint(names) or PROJECT_FILE in names:
                folders.clear()
                continue
            paths = (posixpath.join(path, folder, name) for name in names)
            yield from (file for file in paths if file_patterns.is_yaml_name(file) and file not in state.seen_files)


def _has_section_line(state: ReadingState, file: str) -> bool:
    data = state.files.fetch_bytes(file)
    return isinstance(data, bytes) and _SECTION_LINE.search(data) is not None


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
