"""Which files a pattern of `sources` means, and what to say of one that means none."""

from __future__ import annotations

import posixpath
from typing import TYPE_CHECKING

from archgen.diagnostics.diagnostic import Diagnostic, Severity
from archgen.diagnostics.suggestions import find_closest
from archgen.project.slice_parsing import ReadingState, find_written_keys, parse_file
from archgen.schema import list_sections
from archgen.syntax import file_patterns
from archgen.syntax.yaml_tree import ScalarNode

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from archgen.syntax.yaml_tree import YamlNode


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
