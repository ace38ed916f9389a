"""Every file of the package is counted once, for what it is for."""

from __future__ import annotations

import runpy

import pytest

from tests.running import ROOT

TOOL = runpy.run_path(str(ROOT / "tools" / "capability_sizes.py"))


def test_every_file_has_a_capability_and_every_capability_files() -> None:
    sizes = TOOL["measure_sizes"]()
    assert all(size.files for size in sizes.values())
    files = list((ROOT / "archgen").rglob("*.py"))
    assert sum(size.files for size in sizes.values()) == len(files) - len(TOOL["GENERATED"])


@pytest.mark.parametrize(
    ("file", "capability"),
    [
        ("views/timing/timing_tables.py", "timing, with its tables and printing"),
        ("views/lookup.py", "views that all outputs share"),
        ("emit/terminal/timing_text.py", "timing, with its tables and printing"),
        ("emit/terminal/findings_text.py", "data, terminal, other formats"),
        ("frozen.py", "reading, linking, checking"),
    ],
)
def test_the_longest_beginning_counts(file: str, capability: str) -> None:
    assert TOOL["find_capability"](file) == capability


def test_a_file_of_a_new_room_is_asked_for() -> None:
    with pytest.raises(ValueError, match=r"archgen/kitchen/stove\.py belongs to no capability"):
        TOOL["find_capability"]("kitchen/stove.py")
