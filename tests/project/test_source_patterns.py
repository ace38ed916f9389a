"""Which files the patterns of `sources` mean, and what is said of one that means none."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.diagnostics.source_span import NO_SPAN
from archgen.project.slice_parsing import ReadingState
from archgen.project.source_patterns import expand_source_pattern, report_missing_sources
from archgen.syntax.folder_files import FolderFiles
from archgen.syntax.yaml_tree import ScalarNode

FILES = {"groups/a.yaml": "groups: {a: A}\n", "groups/b.yaml": "groups: {b: B}\n", "notes/c.yaml": "colour: red\n"}


def make_state(folder: Path) -> ReadingState:
    for name, text in FILES.items():
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_text(text)
    return ReadingState(FolderFiles(folder))


def scalar(text: str) -> ScalarNode:
    return ScalarNode(text, text, NO_SPAN)


@pytest.mark.parametrize(
    ("pattern", "files", "said"),
    [
        ("groups/*.yaml", ["groups/a.yaml", "groups/b.yaml"], []),
        ("groups/b.yaml", ["groups/b.yaml"], []),
        # A folder is no file, whatever is in it.
        ("groups", [], ["`groups` matches no file"]),
        ("../other/*.yaml", [], ["`../other/*.yaml` leads out of the project's folder"]),
    ],
)
def test_files_of_a_pattern(pattern: str, files: list[str], said: list[str], tmp_path: Path) -> None:
    state = make_state(tmp_path)
    assert list(expand_source_pattern(state, scalar(pattern))) == files
    assert [each.message for each in state.diagnostics] == said


@pytest.mark.parametrize(
    ("pattern", "help_line", "lost_keys"),
    [
        ("group/*.yaml", "did you mean `groups/*.yaml`?", {"groups", "a", "b"}),
        ("groups", "did you mean `groups/*.yaml`?", {"groups", "a", "b"}),
        # What is in it is no slice: nothing of the project is lost.
        ("note/*.yaml", "paths are relative to the folder of archgen.yaml", set()),
        ("elsewhere/*.yml", "paths are relative to the folder of archgen.yaml", set()),
    ],
)
def test_a_pattern_that_means_no_file_is_guessed_by_what_lies_there(
    pattern: str, help_line: str, lost_keys: set[str], tmp_path: Path
) -> None:
    state = make_state(tmp_path)
    report_missing_sources(state, [scalar(pattern)])
    assert [each.help for each in state.diagnostics] == [help_line]
    assert lost_keys <= state.lost_keys
    assert state.partial == bool(lost_keys)
