"""Inputs at which a reader broke once, each as small as it could be made: they break nothing any more.

`make fuzz` writes what it finds into `.make/fuzzed/found`; what is mended is moved into `tests/fuzz/kept`, called after its target.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.fuzz import fuzz_targets
from tests.fuzz.fuzz_targets import Target, list_targets
from tests.fuzz.run_fuzz import find_fault
from tests.property_sizes import try_some

KEPT = sorted((Path(__file__).parent / "kept").iterdir())
TARGETS = {target.name: target for target in list_targets()}
DRAWING = {"documents", "written", "backends"}
"""Those that take seconds for each input."""


@pytest.fixture(autouse=True)
def _judge_all(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(fuzz_targets, "JUDGED_ONE_IN", 1)


def break_target(target: Target, data: bytes, folder: Path) -> str:
    fault = find_fault(target, data, folder)
    return "" if fault is None else fault[1]


@pytest.mark.parametrize("path", KEPT, ids=lambda path: path.name)
def test_a_kept_input_breaks_nothing(path: Path, tmp_path: Path) -> None:
    assert break_target(TARGETS[path.name.partition("-")[0]], path.read_bytes(), tmp_path) == ""


@pytest.mark.parametrize("name", try_some(TARGETS, 8))
def test_fixtures_break_nothing(name: str, tmp_path: Path) -> None:
    """What is changed from them is tried by `make fuzz` and in a slow test: other fixtures would be changed otherwise."""
    seeds = list(TARGETS[name].list_seeds())
    assert seeds, "the fixtures are elsewhere"
    inputs = seeds[:: len(seeds) // (1 if name in DRAWING else 6) + 1]
    assert [break_target(TARGETS[name], data, tmp_path) for data in inputs] == [""] * len(inputs)
