"""The example of a plug-in is a package: installed in a fresh environment, its importer reads and its rule judges."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.running import ROOT
from tests.test_installed_plugins import make_environment, run_here

pytestmark = pytest.mark.build
EXAMPLE = ROOT / "examples" / "plugin"
PROJECT = "archgen: 1\ngroups: {g: {components: {arm: {outputs: {o: std_msgs/msg/Bool}}}}}\n"


@pytest.fixture(scope="module")
def python(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Give the Python of an environment that has the example installed, from a wheel that is built of it."""
    folder = tmp_path_factory.mktemp("example")
    make_environment(folder / "venv")
    python = folder / "venv" / "bin" / "python"
    options = ("--no-index", "--no-deps", "--no-build-isolation", "--quiet", "--disable-pip-version-check")
    command = (sys.executable, "-m", "pip", "--python", python, "install", *options, EXAMPLE)
    environment = {key: value for key, value in os.environ.items() if not key.startswith("PYTHON")}
    done = subprocess.run(command, env=environment, capture_output=True, check=False, text=True)  # noqa: S603 - our own example
    assert done.returncode == 0, done.stderr
    return python


def test_the_importer_reads(python: Path, tmp_path: Path) -> None:
    (tmp_path / "robot.toy").write_text("Left arm\n\nHead\n", encoding="utf-8")
    done = run_here(python, tmp_path, "-m", "archgen", "import", "robot.toy", "-o", "robot")
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("taken: 2 line\n")
    written = (tmp_path / "robot" / "toy_types.yaml").read_text(encoding="utf-8")
    assert written.endswith("component_types:\n  left_arm:\n    title: Left arm\n  head:\n    title: Head\n"), written


def test_the_rule_judges_and_is_explained(python: Path, tmp_path: Path) -> None:
    (tmp_path / "archgen.yaml").write_text(PROJECT, encoding="utf-8")
    done = run_here(python, tmp_path, "-m", "archgen", "check")
    assert "warning[unowned-component]: `g.arm` has no owner" in done.stdout
    assert "unowned-component" not in run_here(python, tmp_path, "-m", "archgen", "--no-plugins", "check").stdout
    done = run_here(python, tmp_path, "-m", "archgen", "explain", "unowned-component")
    assert (
        done.stdout
        == "unowned-component (warning, of archgen-toy 1.0)\n\nA component has no owner.\n\nNobody answers for it.\n"
    )


def test_the_version_names_the_package(python: Path, tmp_path: Path) -> None:
    done = run_here(python, tmp_path, "-m", "archgen", "--version")
    assert done.stdout.endswith("plug-in archgen-toy 1.0: importers toy, rules toy\n")
