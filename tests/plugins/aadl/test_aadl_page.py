"""The page on AADL says what the import does: its example is imported, its commands are run."""

from __future__ import annotations

import re
import shlex
from pathlib import Path
from typing import Any

import yaml

from tests.plugins.aadl.aadl_texts import MODELS, import_text, merge_slices
from tests.running import ROOT, archgen_here

PAGE = (ROOT / "docs" / "aadl.md").read_text(encoding="utf-8")


def _drop_hints(data: dict[str, Any]) -> dict[str, Any]:
    return {
        key: _drop_hints(value) if isinstance(value, dict) else value for key, value in data.items() if key != "hints"
    }


def test_the_example_of_the_page(tmp_path: Path) -> None:
    match = re.search(r"```aadl\n(.*?)```\n.*?```yaml\n(.*?)```", PAGE, re.DOTALL)
    assert match
    assert _drop_hints(merge_slices(import_text(tmp_path, match[1]))) == yaml.safe_load(match[2])


def test_the_commands_of_the_page(tmp_path: Path) -> None:
    for source, target in (("chatter", "talking"), ("ros", "ros"), ("amcl", "model/amcl")):
        (tmp_path / "model").mkdir(exist_ok=True)
        (tmp_path / f"{target}.aadl").write_bytes((MODELS / f"{source}.aadl").read_bytes())
    commands = [line.strip() for line in PAGE.splitlines() if line.startswith("    archgen import aadl")]
    assert len(commands) == 2
    for command in commands:
        archgen_here(*shlex.split(command.replace("model/*.aadl", "model/amcl.aadl"))[1:], cwd=tmp_path)
    assert (tmp_path / "robot" / "groups.yaml").is_file()
