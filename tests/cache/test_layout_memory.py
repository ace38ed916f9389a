"""The memory of layouts: choices by what decides them; what is damaged, or another program's, is none."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.cache.layout_memory import NO_MEMORY, LayoutMemory


def test_a_choice_is_recalled_by_problem_and_program(tmp_path: Path) -> None:
    memory = LayoutMemory(tmp_path, "program")
    memory.keep_choice("problem", ("rankdir=LR", ["a -> b;"]))
    assert memory.recall_choice("problem") == ["rankdir=LR", ["a -> b;"]]
    assert memory.recall_choice("another problem") is None
    assert LayoutMemory(tmp_path, "another program").recall_choice("problem") is None


@pytest.mark.parametrize("damage", [b"", b"null", b'["rankdir"', b"\xff"])
def test_a_damaged_file_is_none(damage: bytes, tmp_path: Path) -> None:
    memory = LayoutMemory(tmp_path, "program")
    memory.keep_choice("problem", 3)
    (file,) = tmp_path.iterdir()
    file.write_bytes(damage)
    assert memory.recall_choice("problem") is None


def test_without_a_folder_nothing_is_remembered() -> None:
    NO_MEMORY.keep_choice("problem", 3)
    assert NO_MEMORY.recall_choice("problem") is None
