"""Two short texts, compared."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping
from functools import lru_cache
from pathlib import Path

import pytest

from archgen import pipeline
from archgen.compare import Change, Comparison
from archgen.compare.compare_versions import compare_versions
from archgen.model.architecture import Architecture
from archgen.pipeline import CheckedProject
from archgen.products.compared_versions import make_comparison_input

Compared = Callable[[str, str], Comparison]
ComparedFolders = Callable[[Mapping[str, str], Mapping[str, str]], Comparison]
Checked = Callable[[str], Architecture]
JudgeText = Callable[..., CheckedProject]
Told = Callable[[str, str], list[str]]


@pytest.fixture
def checked(tmp_path: Path) -> Checked:
    """Check a one-file project, and return its architecture."""

    def run(text: str) -> Architecture:
        (tmp_path / "robot.yaml").write_text(text, encoding="utf-8")
        return pipeline.check_project(tmp_path / "robot.yaml").architecture

    return run


@pytest.fixture(scope="session")
def judge_text(tmp_path_factory: pytest.TempPathFactory) -> JudgeText:
    """Check a one-file project, the same text once for many tests: most edit one that their file holds.

    A copy has nothing in common with the other one but the text.
    """
    folder = tmp_path_factory.mktemp("judged")
    numbers = itertools.count()

    @lru_cache(maxsize=128)
    def judge(text: str, *, is_copy: bool = False) -> CheckedProject:  # noqa: ARG001 - it is in the key
        file = folder / str(next(numbers)) / "robot.yaml"
        file.parent.mkdir()
        file.write_text(text, encoding="utf-8")
        return pipeline.check_project(file)

    return judge


@pytest.fixture
def compared(judge_text: JudgeText) -> Compared:
    """Compare two one-file projects."""

    def run(before: str, after: str) -> Comparison:
        sides = (judge_text(before), judge_text(after, is_copy=before == after))
        return compare_versions(*map(make_comparison_input, sides))

    return run


@pytest.fixture
def compared_folders(tmp_path: Path) -> ComparedFolders:
    """Compare two projects of several files each."""

    def run(*versions: Mapping[str, str]) -> Comparison:
        sides = []
        for number, files in enumerate(versions):
            for name, text in files.items():
                file = tmp_path / str(number) / name
                file.parent.mkdir(parents=True, exist_ok=True)
                file.write_text(text, encoding="utf-8")
            sides.append(make_comparison_input(pipeline.check_project(tmp_path / str(number))))
        return compare_versions(*sides)

    return run


@pytest.fixture
def told(compared: Compared) -> Told:
    """Give all changes as `kind sort element: text`, parts indented below."""

    def tell(before: str, after: str) -> list[str]:
        return [line for change in compared(before, after).changes for line in _lines(change, "")]

    return tell


def _lines(change: Change, indent: str) -> list[str]:
    line = f"{indent}{change.kind} {change.element_kind} {change.element_id}: {change.text}"
    return [line, *(below for part in change.parts for below in _lines(part, f"{indent}  "))]
