"""Edited files are written all or none, never over what changed meanwhile or through a link, and put back as they were."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from archgen.edit.element_edit import FileEdit
from archgen.emit.file_tree import OutputError
from archgen.products.written_edits import undo_last, write_edits
from tests.running import contents

PROJECT = "archgen: 1\nhosts: {pc: PC}\n"


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Give a project, and a cache of its own."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    (tmp_path / "robot").mkdir()
    (tmp_path / "robot" / "archgen.yaml").write_text(PROJECT, encoding="utf-8")
    return tmp_path / "robot"


def test_a_file_that_changed_meanwhile_is_left_as_it_is(folder: Path) -> None:
    edit = FileEdit("archgen.yaml", PROJECT.encode(), b"archgen: 1\n", 1)
    (folder / "archgen.yaml").write_text("archgen: 1 # another rename\n", encoding="utf-8")
    with pytest.raises(OutputError, match="was changed, moved or removed since it was read"):
        write_edits(folder, [edit], "x")
    (folder / "archgen.yaml").unlink()
    with pytest.raises(OutputError, match="was changed, moved or removed"):
        write_edits(folder, [edit], "x")


def test_a_link_that_came_meanwhile_is_not_followed(folder: Path, tmp_path: Path) -> None:
    outside = tmp_path / "outside.yaml"
    outside.write_text(PROJECT, encoding="utf-8")
    (folder / "archgen.yaml").unlink()
    (folder / "archgen.yaml").symlink_to(outside)
    with pytest.raises(OutputError, match="is a link, or lies outside of the project"):
        write_edits(folder, [FileEdit("archgen.yaml", PROJECT.encode(), b"", 1)], "x")
    assert outside.read_text(encoding="utf-8") == PROJECT


def test_all_files_are_written_or_none(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (folder / "two.yaml").write_text("hosts: {}\n", encoding="utf-8")
    edits = [
        FileEdit("archgen.yaml", PROJECT.encode(), b"archgen: 1\n", 1),
        FileEdit("new/one.yaml", None, b"hosts: {a: A}\n", 1),
        FileEdit("two.yaml", b"hosts: {}\n", b"hosts: {b: B}\n", 1),
    ]
    before = contents(folder)
    replace = os.replace

    def fail_on_two(source: str, target: str) -> None:
        if str(target).endswith("two.yaml") and b"b: B" in Path(source).read_bytes():
            raise OSError(28, "No space left on device")
        replace(source, target)

    monkeypatch.setattr(os, "replace", fail_on_two)
    with pytest.raises(OutputError, match=r"cannot write two\.yaml"):
        write_edits(folder, edits, "x")
    assert {name: data for name, data in contents(folder).items() if data} == before
    monkeypatch.undo()


def test_a_killed_edit_is_undone(folder: Path) -> None:
    (folder / "two.yaml").write_text("hosts: {}\n", encoding="utf-8")
    edits = [
        FileEdit("archgen.yaml", PROJECT.encode(), b"archgen: 1\n", 1),
        FileEdit("two.yaml", b"hosts: {}\n", b"hosts: {b: B}\n", 1),
    ]
    write_edits(folder, edits, "x")
    (folder / "two.yaml").write_bytes(b"hosts: {}\n")  # as if it had ended before that one
    assert undo_last(folder).files == ("archgen.yaml", "two.yaml")
    assert (folder / "archgen.yaml").read_text(encoding="utf-8") == PROJECT
