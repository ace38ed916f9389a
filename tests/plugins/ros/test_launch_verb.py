"""`archgen import launch`: values of launch arguments are taken from the command line, and known again."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cli.conftest import Run


def test_launch_arguments_are_given_and_remembered(run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("a.launch.xml").write_text('<launch><arg name="n"/><node pkg="p" exec="e" name="$(var n)"/></launch>')
    assert run("import", "launch", "a.launch.xml", "n:=first", "-o", "robot").status == 0
    text = Path("robot/a_launch.yaml").read_text()
    assert text.startswith("# From a.launch.xml n:=first by `archgen import launch`;")
    assert "\n  first:\n" in text
    assert run("import", "a.launch.xml", "n:=first", "-o", "robot", "--merge").status == 0
    done = run("import", "a.launch.xml", "n:=second", "-o", "robot", "--merge")
    assert done.status == 2
    assert "a_launch.yaml does not come from this file: nothing was written" in done.err
    assert run("import", "a.launch.xml", f"n:={'long' * 100}", "-o", "third").status == 0
    done = run("import", "a.launch.xml", "m:=first", "-o", "other")
    assert done.status == 1
    assert "declares an argument `m`\n  = help: did you mean `n`?" in done.err
