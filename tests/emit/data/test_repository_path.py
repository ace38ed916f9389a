"""Where a file stands in its repository."""

from __future__ import annotations

import pytest

from archgen.emit.data.findings_data import path_in_repository


@pytest.mark.parametrize(
    ("file", "folder", "path"),
    [
        ("a.yaml", "", "a.yaml"),
        ("a.yaml", "robot", "robot/a.yaml"),
        ("a.yaml", "robot/", "robot/a.yaml"),
        ("../shared/a.yaml", "robot", "shared/a.yaml"),
        ("../a.yaml", "", None),
        ("../../a.yaml", "robot", None),
        ("/etc/passwd", "robot", None),
        ("", "robot", None),
    ],
)
def test_a_path_begins_at_the_repository_and_never_leaves_it(file: str, folder: str, path: str | None) -> None:
    assert path_in_repository(file, folder) == path
