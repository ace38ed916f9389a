"""Which files a pattern means."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.syntax.file_patterns import expand_pattern, is_inside_project, matches_pattern
from archgen.syntax.folder_files import FolderFiles

FILES = (
    "archgen.yaml",
    "groups/b.yaml",
    "groups/a.yaml",
    "groups/deep/c.yaml",
    "groups-more/d.yaml",
    "groups/.hidden.yaml",
    "groups/note.txt",
    "archgen-out/packed.yaml",
    "build/e.yaml",
    "other/archgen.yaml",
    "other/f.yaml",
)


@pytest.mark.parametrize(
    ("pattern", "inside"),
    [
        ("groups/*.yaml", True),
        ("a", True),
        ("", False),
        ("/etc/passwd", False),
        ("../x", False),
        ("a/../../x", False),
        ("a\\b", False),
        ("a\0b", False),
        ("a..b", True),
    ],
)
def test_a_pattern_never_leaves_the_project(pattern: str, inside: bool) -> None:  # noqa: FBT001
    assert is_inside_project(pattern) is inside


@pytest.mark.parametrize(
    ("pattern", "file", "matches"),
    [
        ("*.yaml", "a.yaml", True),
        ("*.yaml", "deep/a.yaml", False),
        ("**/*.yaml", "a.yaml", True),
        ("**/*.yaml", "deep/er/a.yaml", True),
        ("**", "deep/a.yaml", True),
        ("?.yaml", "a.yaml", True),
        ("?.yaml", "ab.yaml", False),
        ("[ab].yaml", "b.yaml", True),
        ("[!ab].yaml", "b.yaml", False),
        ("[!ab].yaml", "c.yaml", True),
        ("x[!a]y", "x/y", False),
        ("[a-c].yaml", "b.yaml", True),
        ("a.yaml", "axyaml", False),
        ("[.yaml", "[.yaml", True),
        ("/a", "a", False),
    ],
)
def test_stars_stay_in_a_folder_and_double_stars_go_down(pattern: str, file: str, matches: bool) -> None:  # noqa: FBT001
    assert matches_pattern(pattern, file) is matches


@pytest.mark.parametrize(
    ("pattern", "files"),
    [
        ("groups/*.yaml", ("groups/a.yaml", "groups/b.yaml")),
        ("groups/**/*.yaml", ("groups/a.yaml", "groups/b.yaml", "groups/deep/c.yaml")),
        ("**/*.yaml", ("archgen.yaml", "groups/a.yaml", "groups/b.yaml", "groups/deep/c.yaml", "groups-more/d.yaml")),
        ("archgen-out/packed.yaml", ("archgen-out/packed.yaml",)),
        ("other/*.yaml", ("other/archgen.yaml", "other/f.yaml")),
        ("build/*.yaml", ("build/e.yaml",)),
        ("groups/gone.yaml", ()),
        ("gone/*.yaml", ()),
    ],
)
def test_wildcards_leave_out_hidden_files_outputs_and_other_projects(
    tmp_path: Path, pattern: str, files: tuple[str, ...]
) -> None:
    for file in FILES:
        (tmp_path / file).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / file).touch()
    assert expand_pattern(FolderFiles(tmp_path), pattern, frozenset({"build"})) == files
