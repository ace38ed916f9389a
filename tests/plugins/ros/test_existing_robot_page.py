"""The page about robots that exist: its launch file becomes the YAML and the note that stand there, its shell lines are shell."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from archgen.importers.import_formats import list_import_formats
from archgen.plugins.ros.launch.launch_import import read_launch
from archgen.syntax.yaml_writer import write_yaml
from tests.judged_projects import check_text
from tests.outside_tools import run_judge
from tests.running import ROOT

PAGE = (ROOT / "docs" / "existing_robot.md").read_text(encoding="utf-8")
SCRIPTS = re.findall(r"^    \{\n.*?^    \} > robot.txt[^\n]*\n", PAGE, re.MULTILINE | re.DOTALL)


def find_block(language: str) -> str:
    """Return the only block in a language."""
    (block,) = re.findall(rf"^```{language}\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)
    return str(block)


def test_the_launch_file_becomes_what_the_page_says(tmp_path: Path) -> None:
    path = tmp_path / "robot.launch.py"
    path.write_text(find_block("python"), encoding="utf-8")
    imported = read_launch([path])
    (name,) = imported.slices
    assert write_yaml(imported.slices[name], imported.comments[name]) == find_block("yaml")
    for note in imported.notes:
        assert f"    {note.fate}: {note.span}: {note.kind}: {note.message}\n" in PAGE
    assert len(imported.notes) == 1


def test_what_comes_out_is_a_sound_project() -> None:
    findings = check_text("archgen: 1\nproject: {id: robot}\n" + find_block("yaml"))
    assert {finding.rule for finding in findings} == {"unjustified-node"}


def test_the_formats_are_there() -> None:
    assert set(re.findall(r"archgen import (\w+) ", PAGE)) == {"workspace", "launch", "package", "ros2", "orca"}
    assert set(list_import_formats()) >= {"launch", "package", "ros1", "ros2", "orca"}


@pytest.mark.parametrize("script", SCRIPTS, ids=["ros2", "ros1"])
def test_the_lines_to_copy_are_shell(script: str) -> None:
    run_judge("sh", "-n", "-c", script)
    assert "\\$ ros" in script
