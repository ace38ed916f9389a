"""What a comparison looks at of a checked project."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen import pipeline
from archgen.products.compared_versions import make_comparison_input


@pytest.mark.parametrize(
    ("project_section", "unnamed_keys"),
    [("", {"id", "title"}), ("project: {title: Robot}\n", {"id"}), ("project: {id: r, title: Robot}\n", set())],
)
def test_keys_that_nobody_wrote_are_told(tmp_path: Path, project_section: str, unnamed_keys: set[str]) -> None:
    file = tmp_path / "robot.yaml"
    file.write_text(f"archgen: 1\n{project_section}hosts: {{pc: {{}}}}\n", encoding="utf-8")
    checked_project = pipeline.check_project(file)
    version = make_comparison_input(checked_project)
    assert version.unnamed_keys == unnamed_keys
    assert version.architecture is checked_project.architecture
    assert version.sound_files == {"robot.yaml"}
    assert version.unread_files == ()
