"""The commands of the page about UML do what it says."""

from __future__ import annotations

import shutil
from pathlib import Path

from tests.running import ROOT, archgen_here

PAGE = (ROOT / "docs" / "uml.md").read_text(encoding="utf-8")


def test_the_commands_of_the_page_work(tmp_path: Path) -> None:
    commands = [line.partition("#")[0].split()[1:] for line in PAGE.splitlines() if line.startswith("    archgen ")]
    assert len(commands) == 4
    shutil.copy(ROOT / "examples" / "headlamp" / "headlamp.xmi", tmp_path)
    project = tmp_path / "headlamp"
    for number, words in enumerate(commands):
        # A model is merged into what came from it: see below.
        if "--merge" in words:
            continue
        archgen_here(*words, cwd=tmp_path if number == 0 else project)
    shutil.copy(project / "robot.uml", tmp_path)
    archgen_here("import", "xmi", "robot.uml", "-o", "robot", cwd=tmp_path)
    merged = archgen_here("import", "xmi", "../robot.uml", "--merge", cwd=tmp_path / "robot")
    assert b"as before" in merged.stdout


def test_every_dialect_that_is_named_is_tested() -> None:
    tests = (ROOT / "tests" / "plugins" / "xmi" / "test_dialects.py").read_text(encoding="utf-8")
    for name in ("papyrus_has", "papyrus_for_robotics", "enterprise_architect", "visual_paradigm", "magicdraw"):
        assert f"def test_{name}" in tests
