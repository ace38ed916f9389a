"""Running archgen as people do: the same way in, in this process, with what it prints and its exit status."""

from __future__ import annotations

import gc
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest

from archgen.__main__ import main
from tests.judged_projects import judge_shipped_once

ROOT = Path(__file__).resolve().parents[2]
BROKEN = """\
archgen: 1
groups:
  sensing:
    components:
      camera: {outputs: {image: Colour image}}
      screen: {inputs: {image: camera.imgae}}
"""


@dataclass(frozen=True)
class Ran:
    """What a run left behind."""

    status: int
    out: str
    err: str


Run = Callable[..., Ran]


@pytest.fixture
def run(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Iterator[Run]:
    """Give a function that runs a verb."""

    def call(*words: object) -> Ran:
        monkeypatch.setattr(sys, "argv", ["archgen", *map(str, words)])
        with pytest.raises(SystemExit) as stopped, judge_shipped_once():
            main()
        printed = capsys.readouterr()
        code = stopped.value.code
        return Ran(code if isinstance(code, int) else 0, printed.out, printed.err)

    for name in ("FORCE_COLOR", "COLUMNS"):  # pytest's workers set COLUMNS
        monkeypatch.delenv(name, raising=False)
    for name in ("GITHUB_WORKSPACE", "GITHUB_ACTOR", "GITHUB_EVENT_NAME", "GITHUB_EVENT_PATH", "GITLAB_USER_LOGIN"):
        monkeypatch.delenv(name, raising=False)
    collecting = gc.isenabled()
    yield call
    if collecting:
        gc.enable()


@pytest.fixture
def first(tmp_path: Path) -> Path:
    """Give a copy of the first robot."""
    folder = tmp_path / "first_robot"
    folder.mkdir()
    text = (ROOT / "examples" / "first_robot" / "archgen.yaml").read_text(encoding="utf-8")
    (folder / "archgen.yaml").write_text(text, encoding="utf-8")
    return folder


@pytest.fixture
def broken(tmp_path: Path) -> Path:
    """Give a project with a slip in a reference."""
    folder = tmp_path / "broken"
    folder.mkdir()
    (folder / "archgen.yaml").write_text(BROKEN, encoding="utf-8")
    return folder
