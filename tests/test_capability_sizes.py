"""Every file of the package is counted once, for what it is for."""

from __future__ import annotations

import runpy

import pytest

from tests.running import ROOT

TOOL = runpy.run_path(str(ROOT / "tools" / "capability_sizes.py"))


def test_every_file_has_a_capability_and_every_capability_files() -> None:
    sizes = TOOL["measure_sizes"]()
    assert all(size.files for size in sizes.values())
    files = [file for file in (ROOT / "archgen").rglob("*.py") if "backends" not in file.parts]
    assert sum(size.files for size in sizes.values()) == len(files)


@pytest.mark.parametrize(
    ("file", "capability"),
    [
        ("views/timing/timing_tables.py", "timing, with its tables and printing"),
        ("views/lookup.py", "views that all outputs share"),
        ("emit/terminal/timing_text.py", "timing, with its tables and printing"),
        ("emit/terminal/findings_text.py", "data, terminal, other formats"),
        ("frozen.py", "reading, linking, checking"),
        ("plugins/orca/orca_import.py", "plug-in `orca`"),
        ("plugins/__init__.py", "importers, what plug-ins may use"),
    ],
)
def test_the_longest_beginning_counts(file: str, capability: str) -> None:
    assert TOOL["find_capability"](file) == capability


def test_a_file_of_a_new_room_is_asked_for() -> None:
    with pytest.raises(ValueError, match=r"archgen/kitchen/stove\.py belongs to no capability"):
        TOOL["find_capability"]("kitchen/stove.py")


def test_the_table_says_how_large_the_core_is_and_each_plug_in() -> None:
    size = TOOL["Size"]
    sizes = {"rules and findings": size(2, 30), "plug-in `orca`": size(1, 4), "simulation of timing": size(3, 50)}
    assert TOOL["write_table"](sizes).splitlines()[2:] == [
        "| **the core** | 5 | 80 |",
        "| simulation of timing | 3 | 50 |",
        "| rules and findings | 2 | 30 |",
        "| **the plug-ins** | 1 | 4 |",
        "| plug-in `orca` | 1 | 4 |",
        "| **all** | 6 | 84 |",
    ]
