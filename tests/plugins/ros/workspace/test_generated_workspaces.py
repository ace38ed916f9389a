"""What archgen makes of a design, held against that design: what is drawn is what would run."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

from tests.cli.conftest import Run
from tests.running import ROOT


@pytest.mark.parametrize(
    "name",
    [
        pytest.param(name, marks=() if name == "examples/first_robot" else pytest.mark.slow)
        for name in (
            "example_ramcip",
            *(
                f"examples/{each}"
                for each in ("arm", "bringup", "cleaning_robot", "drone", "first_robot", "headlamp", "partners")
            ),
        )
    ],
)
def test_a_generated_workspace_is_as_designed(tmp_path: Path, run: Run, name: str) -> None:
    pytest.importorskip("tree_sitter_cpp")
    for backend in ("ros_interfaces", "ros2_python", "ros2_cpp", "ros2_launch"):
        run("generate", "-C", str(ROOT / name), backend, "-o", str(tmp_path / backend))
        if (tmp_path / backend / "src").is_dir():
            shutil.copytree(tmp_path / backend / "src", tmp_path / "ws", dirs_exist_ok=True)
    assert list((tmp_path / "ws").rglob("*.launch.xml"))
    done = run("conform", "-C", str(ROOT / name), "--against", str(tmp_path / "ws"), "--format", "json")
    told = [
        f"{each['rule']}: {each['message'].split('`')[1]}"
        for each in json.loads(done.out)["diagnostics"]
        if each["severity"] != "note"
    ]
    assert told == []
