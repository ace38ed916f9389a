"""The core without its plug-ins: its tests import none, and pass where all are taken out."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.module_graph import find_imports, list_modules
from tests.running import ROOT

PLUGINS = ("archgen.plugins", "tests.plugins")
ROOMS = sorted(folder.name for folder in (ROOT / "archgen").iterdir() if (folder / "__init__.py").is_file())
CORE_ROOMS = [room for room in ROOMS if room not in {"plugins", "plugin"}]
TRIED_ALONE = (
    "checking",
    "compose",
    "edit",
    "findings",
    "importers",
    "language",
    "merge",
    "model",
    "project",
    "schema",
)
"""Rooms from all floors of the core whose tests are run without plug-ins: those that need neither programs nor a minute."""
LEFT_OUT = shutil.ignore_patterns("__pycache__", "plugins", "node_modules", "*.pyc")


def test_tests_of_the_core_import_no_plug_in() -> None:
    importing = [
        f"{module} imports {name}"
        for module in list_modules()
        if module.startswith("tests.") and module.split(".")[1] in CORE_ROOMS
        for name in find_imports(module)
        if name.startswith(PLUGINS)
    ]
    assert importing == []


@pytest.fixture(scope="module")
def core(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Copy the package and its tests without plug-ins."""
    top = tmp_path_factory.mktemp("core") / "archgen"
    top.mkdir()
    for path in ROOT.iterdir():
        if path.name in {"archgen", "tests"}:
            shutil.copytree(path, top / path.name, ignore=LEFT_OUT)
        elif not path.name.startswith(".") and path.name != "archgen-out":
            (top / path.name).symlink_to(path)
    return top


def run_core(core: Path, *words: str) -> subprocess.CompletedProcess[str]:
    """Run Python on the copy: nothing of the checkout's own package is imported."""
    environment = {**os.environ, "PYTHONPATH": str(core), "XDG_CACHE_HOME": str(core.parent / "cache")}
    return subprocess.run(  # noqa: S603 - ourselves
        [sys.executable, *words], cwd=core, env=environment, capture_output=True, text=True, check=False
    )


def test_verbs_say_what_is_taken_out(core: Path) -> None:
    done = run_core(core, "-m", "archgen", "check", "examples/first_robot")
    assert done.returncode == 0, done.stderr
    (core / "a.csv").write_text("Group,Component\narm,grip\n", encoding="utf-8")
    done = run_core(core, "-m", "archgen", "init", "robot", "--from", "a.csv", "--yes")
    assert (done.returncode, done.stderr) == (
        2,
        "Error: there is no plug-in that reads tables: it is taken out of archgen.plugins\n",
    )
    done = run_core(core, "-m", "archgen", "import", "aadl", "a.csv")
    assert done.returncode == 2
    assert "there is no file and no format `aadl`" in done.stderr
    assert run_core(core, "-m", "archgen", "import", "--help").returncode == 0


@pytest.mark.slow
@pytest.mark.parametrize("room", TRIED_ALONE)
def test_the_tests_of_the_core_pass_alone(room: str, core: Path) -> None:
    done = run_core(core, "-m", "pytest", "-q", "-p", "no:cacheprovider", f"tests/{room}")
    assert done.returncode == 0, done.stdout[-3000:]
