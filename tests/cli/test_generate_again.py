"""A second run takes again what an earlier one made; it says and writes what one without anything kept does."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.cli.conftest import Run

ROBOT = """\
archgen: 1
project: {id: farm, title: Farm}
ros: {distro: jazzy}
types: {Battery: std_msgs/msg/Float32}
groups:
  base:
    components:
      wheels: {outputs: {battery: Battery}, timing: {rate: 20 Hz}}
      guard: {inputs: {battery: wheels.battery}, parameters: {lowest: 0.2}}
"""
PACKAGE = Path("ws/src/farm_base")


def _append(path: Path, text: str) -> None:
    path.write_text(path.read_text(encoding="utf-8") + text, encoding="utf-8")


def _change_model(old: str, new: str) -> Callable[[Path], object]:
    return lambda folder: (folder / "archgen.yaml").write_text(ROBOT.replace(old, new), encoding="utf-8")


CHANGES: dict[str, Callable[[Path], object]] = {
    "nothing": lambda _folder: None,
    "a file is deleted": lambda folder: (folder / PACKAGE / "package.xml").unlink(),
    "a file is edited by hand": lambda folder: _append(folder / PACKAGE / "setup.py", "# mine\n"),
    "own code is changed": lambda folder: _append(
        folder / PACKAGE / "farm_base/guard.py", "\n\ndef f(node):\n    node.publish_stop()\n"
    ),
    "own code is deleted": lambda folder: (folder / PACKAGE / "farm_base/guard.py").unlink(),
    "an element is renamed": _change_model("guard", "warden"),
    "a type is changed": _change_model("Float32", "Float64"),
    "lines move": _change_model("groups:", "# a comment\n\ngroups:"),
}


@pytest.mark.parametrize("change", CHANGES)
def test_a_run_with_what_is_kept_is_as_one_without(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, run: Run, change: str
) -> None:
    outcomes = []
    for name in ("kept", "anew"):
        folder, cache = tmp_path / name, tmp_path / "cache"
        folder.mkdir()
        monkeypatch.chdir(folder)
        monkeypatch.setenv("XDG_CACHE_HOME", str(cache))
        (folder / "archgen.yaml").write_text(ROBOT, encoding="utf-8")
        assert run("generate", "ros2_python", "-o", "ws").status == 0
        CHANGES[change](folder)
        if name == "anew":
            shutil.rmtree(cache)
        result = run("generate", "ros2_python", "-o", "ws")
        files = {path.relative_to(folder): path.read_bytes() for path in folder.rglob("*") if path.is_file()}
        outcomes.append((result, files))
    assert outcomes[0] == outcomes[1]
