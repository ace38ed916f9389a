"""CONTRIBUTING.md names every room."""

from __future__ import annotations

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


def test_every_room_has_a_line_and_every_line_a_room() -> None:
    text = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    named = {
        word for cell in re.findall(r"^\| (`[^|]+`) \|", text, re.MULTILINE) for word in re.findall(r"`([^`]+)`", cell)
    }
    rooms = {f"{init.parent.name}/" for init in (ROOT / "archgen").glob("*/__init__.py")}
    files = {file.name for file in (ROOT / "archgen").glob("*.py")} - {"__init__.py", "__main__.py"}
    assert named == rooms | files
