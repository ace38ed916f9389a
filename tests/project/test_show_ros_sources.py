"""`tools/show_ros_sources.py`: facts beside the lines they were read from, from clones of the repositories."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from types import ModuleType

import pytest

from archgen.project.shipped_sources import ShippedSource
from tests.repositories import repository
from tests.running import ROOT


@pytest.fixture(name="tool")
def load_tool() -> ModuleType:
    spec = importlib.util.spec_from_file_location("show_ros_sources", ROOT / "tools" / "show_ros_sources.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def make_source(lines: dict[str, int]) -> ShippedSource:
    return ShippedSource(
        "https://example.org/owner/it", "1.0", "1.0", "HEAD", "2026-01-31", "source text", {"src/it.cpp": lines}
    )


def test_each_fact_stands_beside_its_line(tool: ModuleType, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    repository(tmp_path / "owner" / "it", {"src/it.cpp": '\nadvertise("scan");\n'})
    source = make_source({"outputs.scan": 2, "outputs.points": 1, "outputs.cloud": 9})
    clone = tool.find_clone(tmp_path, source)
    assert clone == tmp_path / "owner" / "it"
    assert tool.show_source(clone, "jazzy it", source) == 2
    captured = capsys.readouterr()
    assert captured.out == 'jazzy it outputs.scan: src/it.cpp:2: advertise("scan");\n'
    assert captured.err.splitlines() == [
        "jazzy it outputs.points: not at https://example.org/owner/it/blob/HEAD/src/it.cpp#L1",
        "jazzy it outputs.cloud: not at https://example.org/owner/it/blob/HEAD/src/it.cpp#L9",
    ]


def test_a_clone_that_is_not_there_is_left_out(tool: ModuleType, tmp_path: Path) -> None:
    assert tool.find_clone(tmp_path, make_source({})) is None
    assert tool.main([str(tmp_path)]) == 0


def test_wrong_words_are_told(tool: ModuleType, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert tool.main([]) == 2
    assert tool.main([str(tmp_path / "nowhere")]) == 2
    assert "usage" in capsys.readouterr().err
