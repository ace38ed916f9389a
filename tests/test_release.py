"""What a release is made of: version and notes, the image, and what a maintainer is told."""

from __future__ import annotations

import fnmatch
import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from archgen import __version__
from tests.outside_tools import run_judge
from tests.running import ROOT


def cut(root: Path, *words: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(  # noqa: S603 - our own tool
        [sys.executable, root / "tools/cut_release.py", *words], capture_output=True, text=True, check=False
    )


@pytest.fixture
def root(tmp_path: Path) -> Path:
    """Give a copy of what a release changes."""
    for name in ("tools/cut_release.py", "archgen/__init__.py"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        shutil.copy(ROOT / name, tmp_path / name)
    (tmp_path / "CHANGELOG.md").write_text(
        "# What changed\n\n## Unreleased\n\n### Added\n\n- A verb.\n\n## 0.1.0\n\n- All.\n"
    )
    return tmp_path


def test_a_release_has_the_version_and_the_notes_of_what_was_unreleased(root: Path) -> None:
    assert cut(root, "7.8.9").returncode == 0
    assert '__version__ = "7.8.9"' in (root / "archgen/__init__.py").read_text()
    assert (root / "CHANGELOG.md").read_text() == (
        "# What changed\n\n## Unreleased\n\n## 7.8.9\n\n### Added\n\n- A verb.\n\n## 0.1.0\n\n- All.\n"
    )
    assert cut(root, "--notes", "7.8.9").stdout == "### Added\n\n- A verb.\n"


@pytest.mark.parametrize("words", [("7.8",), ("v7.8.9",), (__version__,), ("--notes", "9.9.9")])
def test_what_cannot_be_released_is_refused_and_nothing_is_written(root: Path, words: tuple[str, ...]) -> None:
    before = (root / "CHANGELOG.md").read_text(), (root / "archgen/__init__.py").read_text()
    assert cut(root, *words).returncode == 1
    assert before == ((root / "CHANGELOG.md").read_text(), (root / "archgen/__init__.py").read_text())


def test_nothing_is_released_twice(root: Path) -> None:
    cut(root, "7.8.9")
    assert cut(root, "7.9.0").returncode == 1


def test_the_image_is_made_of_what_the_package_needs() -> None:
    taken = [
        line.removeprefix("!")
        for line in (ROOT / ".dockerignore").read_text(encoding="utf-8").splitlines()
        if line.startswith("!")
    ]
    wheel = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    needed = [*wheel["tool"]["hatch"]["build"]["targets"]["wheel"]["force-include"], "archgen", "README.md", "LICENSE"]
    left_out = [
        name for name in needed if not any(fnmatch.fnmatch(f"{name}/", f"{one}/*") or name == one for one in taken)
    ]
    assert left_out == []
    assert all((ROOT / one).exists() for one in taken)
    copied = re.findall(r"^COPY (?!--from)(\S+)", (ROOT / "Dockerfile").read_text(encoding="utf-8"), re.MULTILINE)
    assert copied == ["ci/locked/run.txt", "."]


def test_the_linter_of_dockerfiles_finds_nothing() -> None:
    program = Path(sys.executable).with_name("hadolint")
    done = run_judge(program, "--failure-threshold", "style", ROOT / "Dockerfile", cwd=ROOT)
    assert (done.returncode, done.stdout) == (0, "")
